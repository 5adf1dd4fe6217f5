// SPDX-License-Identifier: GPL-3.0-or-later
// Closed plane curves along an axis: prisms and letters. And polygons.
//
// Along a ray, where it crosses the curves, inside and outside take turns. The turns, cut with the slab
// between the lids, are the hits, so that there is no gap where the sides meet the lids.
#include "core/polynomial.h"
#include "core/shape_impl.h"
#include "core/shape_swept.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <stdexcept>

namespace pnr {

struct PrismData {
    std::vector<CurvePiece> pieces; // (x, z)
    double low = 0, high = 1;
    bool conic = false;
    Bounds bounds;
};

struct TextData {
    struct Glyph {
        std::shared_ptr<const std::vector<CurvePiece>> outline;
        Vec2 origin{0};
        Vec2 low{infinity}, high{-infinity}; // of the outline, placed
    };
    std::vector<Glyph> glyphs;
    double low = 0, high = 1; // along z
    Bounds bounds;
};

struct PolygonData {
    std::vector<CurvePiece> sides; // in the plane
    Vec3 origin{0}, x{0}, y{0}, normal{0};
    Bounds bounds;
};

namespace {

// Where a ray crosses the wall over a curve.
struct Crossing {
    double t = 0;
    double s = 0;
    const CurvePiece* piece = nullptr;
};
using Crossings = boost::container::small_vector<Crossing, 8>;

void sort_crossings(Crossings& crossings) {
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
}

struct Box2 {
    Vec2 low{infinity}, high{-infinity};
};

Box2 box_of(std::span<const CurvePiece> pieces) {
    Box2 box;
    for (const CurvePiece& p : pieces)
        box.low = glm::min(box.low, p.low), box.high = glm::max(box.high, p.high);
    return box;
}

// ---- straight
// ------------------------------------------------------------------------------------------------------

// The line o + t d in the curves' plane; nothing if d is zero.
void cross_walls(std::span<const CurvePiece> pieces, Vec2 o, Vec2 d, Crossings& out) {
    const double d2 = glm::dot(d, d);
    if (!(d2 > 0)) return;
    for (const CurvePiece& piece : pieces) {
        double roots[3];
        const int count = cross_line(piece, d.y, -d.x, o.y * d.x - o.x * d.y, roots);
        for (int i = 0; i < count; ++i)
            out.push_back({glm::dot(piece_point(piece, roots[i]) - o, d) / d2, roots[i], &piece});
    }
    sort_crossings(out);
}

// A wall's normal in the plane, to either side.
Vec2 wall_normal(const Crossing& c) {
    const Vec2 tangent = piece_tangent(*c.piece, c.s);
    return {tangent.y, -tangent.x};
}

// The lids of a straight or conic body, whose axis is number `axis`, at both ends of a stretch inside its
// walls.
struct Lids {
    const Ray& ray;
    int axis;
    Span slab;
    bool open;

    void add(HitList& hits, double t, bool entering) const {
        if (open || !std::isfinite(t)) return;
        Vec3 normal(0);
        normal[axis] = (ray.direction[axis] > 0) == entering ? -1 : 1;
        add_hit(hits, ray, t, normal);
    }
};

// Hits of the body that is inside between the 1st and 2nd crossing, the 3rd and 4th ... and in the slab.
template <class Normal>
void add_turns(const Crossings& crossings, const Lids& lids, double error, Normal normal_of, HitList& hits) {
    const auto wall = [&](const Crossing& c, bool entering) {
        const Vec3 n = normal_of(c);
        const bool inwards = (glm::dot(n, lids.ray.direction) > 0) == entering;
        add_hit(hits, lids.ray, c.t, inwards ? -n : n, Vec2(0), error);
    };
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const Crossing &a = crossings[i], &b = crossings[i + 1];
        if (!(a.t <= lids.slab.leave) || !(b.t >= lids.slab.enter)) continue;
        if (a.t >= lids.slab.enter)
            wall(a, true);
        else
            lids.add(hits, lids.slab.enter, true);
        if (b.t <= lids.slab.leave)
            wall(b, false);
        else
            lids.add(hits, lids.slab.leave, false);
    }
}

// A ray along the axis crosses no wall.
void add_lids_alone(bool inside, const Lids& lids, HitList& hits) {
    if (!inside || lids.slab.empty()) return;
    lids.add(hits, lids.slab.enter, true);
    lids.add(hits, lids.slab.leave, false);
}

// `across`: the two other axes.
void meet_straight(std::span<const CurvePiece> pieces, Vec2 origin, const std::array<int, 2>& across,
                   const Lids& lids, double error, HitList& hits) {
    const Ray& ray = lids.ray;
    const Vec2 o = Vec2(ray.origin[across[0]], ray.origin[across[1]]) - origin,
               d(ray.direction[across[0]], ray.direction[across[1]]);
    if (!(glm::dot(d, d) > 1e-30 * glm::dot(ray.direction, ray.direction)))
        return add_lids_alone(curves_contain(pieces, o), lids, hits);
    Crossings crossings;
    cross_walls(pieces, o, d, crossings);
    const auto normal = [&](const Crossing& c) {
        const Vec2 flat = wall_normal(c);
        Vec3 n(0);
        n[across[0]] = flat.x;
        n[across[1]] = flat.y;
        return n;
    };
    add_turns(crossings, lids, error, normal, hits);
}

// ---- conic
// ---------------------------------------------------------------------------------------------------------

// Points (X, 1, Z) y of the curve (X, Z): the ray lies in a plane through the apex, which cuts the curve's
// plane in a line.
void cross_conic_walls(std::span<const CurvePiece> pieces, const Ray& ray, double side, Crossings& out) {
    const Vec3 o = ray.origin, d = ray.direction, n = glm::cross(o, d);
    for (const CurvePiece& piece : pieces) {
        double roots[3];
        const int count = cross_line(piece, n.x, n.z, n.y, roots);
        for (int i = 0; i < count; ++i) {
            const Vec2 at = piece_point(piece, roots[i]);
            const double x = d.x - d.y * at.x, z = d.z - d.y * at.y;
            const double t = std::abs(x) > std::abs(z) ? (o.y * at.x - o.x) / x : (o.y * at.y - o.z) / z;
            if (side * (o.y + t * d.y) > 0) out.push_back({t, roots[i], &piece});
        }
    }
    sort_crossings(out);
}

// The half on one side of the apex. Far towards the apex the ray is outside of the curve, so turns are
// counted from there.
void meet_conic_half(const PrismData& prism, double side, Lids lids, double error, HitList& hits) {
    const Ray& ray = lids.ray;
    lids.slab.cut(side * ray.origin.y, side * ray.direction.y, 0, infinity);
    if (lids.slab.empty()) return;
    Crossings crossings;
    cross_conic_walls(prism.pieces, ray, side, crossings);
    const bool falling = side * ray.direction.y < 0; // the apex comes last
    if (crossings.size() % 2) {                      // the ray stays inside on its way up
        const Crossing endless{falling ? -infinity : infinity, 0, nullptr};
        crossings.insert(falling ? crossings.begin() : crossings.end(), endless);
    }
    const auto normal = [&](const Crossing& c) {
        const Vec2 at = piece_point(*c.piece, c.s), n = wall_normal(c);
        return Vec3(n.x, -(n.x * at.x + n.y * at.y), n.y);
    };
    add_turns(crossings, lids, error, normal, hits);
}

bool is_inside_prism(const PrismData& prism, Vec3 p) {
    if (p.y < prism.low || p.y > prism.high) return false;
    if (!prism.conic) return curves_contain(prism.pieces, {p.x, p.z});
    return p.y != 0 && curves_contain(prism.pieces, {p.x / p.y, p.z / p.y});
}

double size_of(const Bounds& b) { return glm::length(b.high - b.low) + glm::length(b.high + b.low); }

} // namespace

Shape make_prism(const PrismWords& words, std::span<const Vec2> points, bool& is_closed) {
    auto prism = std::make_shared<PrismData>();
    prism->pieces = closed_curves(words.spline, points, is_closed);
    prism->low = std::min(words.from, words.to);
    prism->high = std::max(words.from, words.to);
    prism->conic = words.conic;
    const Box2 box = box_of(prism->pieces);
    for (const double y : {prism->low, prism->high})
        for (const Vec2 corner : {box.low, box.high}) {
            const double scale = words.conic ? y : 1;
            prism->bounds = merge(prism->bounds, Vec3(scale * corner.x, y, scale * corner.y));
        }
    if (words.conic && prism->low < 0 && prism->high > 0) prism->bounds = merge(prism->bounds, Vec3(0));
    return Prism{std::move(prism)};
}

Bounds bounds_of(const Prism& s) { return s.data->bounds; }

void intersect(const Prism& s, const Ray& ray, HitList& hits) {
    const PrismData& prism = *s.data;
    Span slab;
    slab.cut(ray.origin.y, ray.direction.y, prism.low, prism.high);
    if (slab.empty()) return;
    const double error = 0x1p-46 * size_of(prism.bounds);
    const Lids lids{ray, 1, slab, s.open};
    if (!prism.conic) return meet_straight(prism.pieces, Vec2(0), {0, 2}, lids, error, hits);
    meet_conic_half(prism, 1, lids, error, hits);
    meet_conic_half(prism, -1, lids, error, hits);
}

bool is_inside(const Prism& s, Vec3 p) { return is_inside_prism(*s.data, p); }

// ---- text
// ----------------------------------------------------------------------------------------------------------

Shape make_text(std::span<const PlacedGlyph> glyphs, double thickness) {
    auto text = std::make_shared<TextData>();
    text->low = std::min(0.0, thickness);
    text->high = std::max(0.0, thickness);
    for (const PlacedGlyph& glyph : glyphs) {
        if (!glyph.outline || glyph.outline->empty()) continue;
        const Box2 box = box_of(*glyph.outline);
        text->glyphs.push_back(
            {glyph.outline, glyph.origin, box.low + glyph.origin, box.high + glyph.origin});
        const TextData::Glyph& placed = text->glyphs.back();
        text->bounds =
            merge(text->bounds, Bounds{Vec3(placed.low, text->low), Vec3(placed.high, text->high)});
    }
    return Text{std::move(text)};
}

Bounds bounds_of(const Text& s) { return s.data->bounds; }

void intersect(const Text& s, const Ray& ray, HitList& hits) {
    const TextData& text = *s.data;
    Span slab;
    slab.cut(ray.origin.z, ray.direction.z, text.low, text.high);
    if (slab.empty()) return;
    const double error = 0x1p-46 * size_of(text.bounds);
    for (const TextData::Glyph& glyph : text.glyphs) {
        Span near = slab;
        near.cut(ray.origin.x, ray.direction.x, glyph.low.x, glyph.high.x);
        near.cut(ray.origin.y, ray.direction.y, glyph.low.y, glyph.high.y);
        if (near.empty() || near.leave < ray.t_min || near.enter > ray.t_max) continue;
        meet_straight(*glyph.outline, glyph.origin, {0, 1}, {ray, 2, slab, false}, error, hits);
    }
}

bool is_inside(const Text& s, Vec3 p) {
    if (p.z < s.data->low || p.z > s.data->high) return false;
    return std::any_of(s.data->glyphs.begin(), s.data->glyphs.end(), [&](const TextData::Glyph& glyph) {
        return curves_contain(*glyph.outline, Vec2(p.x, p.y) - glyph.origin);
    });
}

// ---- polygon
// -------------------------------------------------------------------------------------------------------

namespace {

// The sum of the corners' cross products [Newell; Sutherland, Sproull and Schumacker 1974]: a normal,
// whatever the shape.
Vec3 area_normal(std::span<const Vec3> points) {
    Vec3 n(0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        n += glm::cross(points[i] - points[0], points[i + 1] - points[0]);
    return n;
}

} // namespace

Shape make_polygon(std::span<const Vec3> points) {
    if (points.size() < 3) throw std::invalid_argument("a polygon needs at least 3 corners");
    auto polygon = std::make_shared<PolygonData>();
    std::size_t first_end = 1; // of the first part
    while (first_end < points.size() && points[first_end] != points[0]) ++first_end;
    Vec3 normal = area_normal(points.subspan(0, std::min(first_end + 1, points.size())));
    if (!(glm::length(normal) > 0)) normal = area_normal(points);
    if (!(glm::length(normal) > 0))
        throw std::invalid_argument("the corners of a polygon must not lie in one line");
    polygon->normal = glm::normalize(normal);
    polygon->origin = points[0];
    const Frame frame = make_frame(polygon->normal);
    polygon->x = frame.x, polygon->y = frame.y;
    std::vector<Vec2> flat;
    for (const Vec3& p : points) {
        const Vec3 from = p - polygon->origin;
        flat.emplace_back(glm::dot(from, frame.x), glm::dot(from, frame.y));
        polygon->bounds = merge(polygon->bounds, p);
    }
    bool is_closed = true;
    polygon->sides = closed_curves(SplineKind::linear, flat, is_closed);
    return Polygon{std::move(polygon)};
}

Bounds bounds_of(const Polygon& s) { return s.data->bounds; }

void intersect(const Polygon& s, const Ray& ray, HitList& hits) {
    const PolygonData& polygon = *s.data;
    const double slope = glm::dot(polygon.normal, ray.direction);
    const Vec3 o = ray.origin - polygon.origin;
    const double t = -glm::dot(polygon.normal, o) / slope;
    if (slope == 0 || !(t > ray.t_min && t < ray.t_max)) return;
    const Vec3 at = o + t * ray.direction;
    const Vec2 flat(glm::dot(at, polygon.x), glm::dot(at, polygon.y));
    if (curves_contain(polygon.sides, flat)) add_hit(hits, ray, t, polygon.normal);
}

bool is_inside(const Polygon&, Vec3) { return false; }

} // namespace pnr
