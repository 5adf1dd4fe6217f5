// SPDX-License-Identifier: GPL-3.0-or-later
// Blobs [Wyvill, McPheeters and Wyvill 1986, "Data structure for soft objects", for sums of fields with an
// end; POV-Ray 3.7's for the field itself]. Along a ray each component's field is the square of a quadratic,
// so between the places where influences begin and end the sum is a quartic.
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Bounds component_box(const BlobComponent& c) {
    const Bounds own =
        merge(Bounds{c.base - c.radius, c.base + c.radius}, Bounds{c.cap - c.radius, c.cap + c.radius});
    Bounds box;
    for (int corner = 0; corner < 8; ++corner)
        box = merge(box, transform_point(c.transform.matrix, {corner & 1 ? own.high.x : own.low.x,
                                                              corner & 2 ? own.high.y : own.low.y,
                                                              corner & 4 ? own.high.z : own.low.z}));
    return box;
}

void add_nodes(BlobData& blob, const std::vector<Bounds>& boxes, std::uint32_t* first, std::uint32_t* last) {
    const std::size_t at = blob.nodes.size();
    blob.nodes.emplace_back();
    Bounds box, middles;
    for (const std::uint32_t* i = first; i != last; ++i) {
        box = merge(box, boxes[*i]);
        middles = merge(middles, boxes[*i].low + boxes[*i].high);
    }
    if (last - first == 1) {
        blob.nodes[at].component = *first;
    } else {
        const Vec3 size = middles.high - middles.low;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        std::uint32_t* const half = first + (last - first) / 2;
        std::nth_element(first, half, last, [&](std::uint32_t a, std::uint32_t b) {
            const double x = boxes[a].low[axis] + boxes[a].high[axis],
                         y = boxes[b].low[axis] + boxes[b].high[axis];
            return x != y ? x < y : a < b;
        });
        add_nodes(blob, boxes, first, half);
        add_nodes(blob, boxes, half, last);
    }
    blob.nodes[at].box = box;
    blob.nodes[at].skip = static_cast<std::uint32_t>(blob.nodes.size());
}

bool holds(const Bounds& b, Vec3 p) {
    return p.x >= b.low.x && p.x <= b.high.x && p.y >= b.low.y && p.y <= b.high.y && p.z >= b.low.z &&
           p.z <= b.high.z;
}

bool crosses(const Bounds& b, Vec3 origin, Vec3 direction) {
    double enter = -infinity, leave = infinity;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0) {
            if (origin[k] < b.low[k] || origin[k] > b.high[k]) return false;
            continue;
        }
        const double t0 = (b.low[k] - origin[k]) / direction[k], t1 = (b.high[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    return enter <= leave;
}

// Calls f for the components whose box passes.
template <class Passes, class F>
void visit(const BlobData& blob, Passes passes, F f) {
    for (std::size_t i = 0; i < blob.nodes.size();) {
        const BlobData::Node& node = blob.nodes[i];
        if (!passes(node.box)) {
            i = node.skip;
            continue;
        }
        if (node.component != BlobData::no_component) f(blob.components[node.component]);
        ++i;
    }
}

// From the nearest point of the component's axis to p, in the component's space.
Vec3 from_axis(const BlobComponent& c, Vec3 p) {
    const Vec3 axis = c.cap - c.base, d = p - c.base;
    const double length2 = glm::dot(axis, axis);
    return length2 > 0 ? d - std::clamp(glm::dot(d, axis) / length2, 0.0, 1.0) * axis : d;
}

double component_density(const BlobComponent& c, Vec3 p) {
    const Vec3 away = from_axis(c, transform_point(c.transform.inverse, p));
    const double u = 1 - glm::dot(away, away) / (c.radius * c.radius);
    return u > 0 ? c.strength * u * u : 0;
}

Vec3 component_gradient(const BlobComponent& c, Vec3 p) {
    const Vec3 away = from_axis(c, transform_point(c.transform.inverse, p));
    const double u = 1 - glm::dot(away, away) / (c.radius * c.radius);
    if (!(u > 0)) return Vec3(0);
    return transform_normal(c.transform, (-4 * c.strength * u / (c.radius * c.radius)) * away);
}

// Where along the ray a component has influence: its density is strength times the square of c0 + c1 t + c2
// t^2.
struct Piece {
    double from, to;
    double c0, c1, c2, strength;
};
using Pieces = boost::container::small_vector<Piece, 16>;

// Where 1 - |o + t d|^2 / r^2 is positive in [from, to].
void add_piece(Pieces& pieces, Vec3 o, Vec3 d, double radius, double strength, double from, double to) {
    const double r2 = radius * radius, a = glm::dot(d, d), b = glm::dot(o, d);
    if (!(a > 0)) {
        const double u = 1 - glm::dot(o, o) / r2;
        if (u > 0 && from < to) pieces.push_back({from, to, u, 0, 0, strength});
        return;
    }
    const double nearest = -b / a;
    const Vec3 closest = o + nearest * d;
    const double h2 = r2 - glm::dot(closest, closest);
    if (!(h2 > 0)) return;
    const double half = std::sqrt(h2 / a);
    from = std::max(from, nearest - half);
    to = std::min(to, nearest + half);
    if (from < to) pieces.push_back({from, to, 1 - glm::dot(o, o) / r2, -2 * b / r2, -a / r2, strength});
}

void add_pieces(Pieces& pieces, const BlobComponent& c, Vec3 origin, Vec3 direction) {
    const Vec3 o = transform_point(c.transform.inverse, origin) - c.base;
    const Vec3 d = transform_vector(c.transform.inverse, direction);
    const Vec3 axis = c.cap - c.base;
    const double length2 = glm::dot(axis, axis);
    if (!(length2 > 0)) return add_piece(pieces, o, d, c.radius, c.strength, -infinity, infinity);
    // Heights over the base, the whole axis being 1; the ends are round.
    const double z = glm::dot(o, axis) / length2, dz = glm::dot(d, axis) / length2;
    const Vec3 across = o - z * axis, across_d = d - dz * axis;
    if (dz == 0) {
        if (z <= 0) return add_piece(pieces, o, d, c.radius, c.strength, -infinity, infinity);
        if (z >= 1) return add_piece(pieces, o - axis, d, c.radius, c.strength, -infinity, infinity);
        return add_piece(pieces, across, across_d, c.radius, c.strength, -infinity, infinity);
    }
    const double at_base = -z / dz, at_cap = (1 - z) / dz;
    const bool upwards = dz > 0;
    add_piece(pieces, o, d, c.radius, c.strength, upwards ? -infinity : at_base,
              upwards ? at_base : infinity);
    add_piece(pieces, across, across_d, c.radius, c.strength, std::min(at_base, at_cap),
              std::max(at_base, at_cap));
    add_piece(pieces, o - axis, d, c.radius, c.strength, upwards ? at_cap : -infinity,
              upwards ? infinity : at_cap);
}

struct Quartic {
    double c[5]{};

    double at(double s) const { return (((c[4] * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0]; }
    Quartic derivative() const { return {{c[1], 2 * c[2], 3 * c[3], 4 * c[4], 0}}; }

    // Bernstein's coefficients over [-half, half] enclose the values.
    bool keeps_sign(double half) const {
        const double a1 = c[1] * half, a2 = c[2] * half * half, a3 = c[3] * half * half * half,
                     a4 = c[4] * half * half * half * half;
        const double b[5] = {c[0] - a1 + a2 - a3 + a4, c[0] - 0.5 * a1 + 0.5 * a3 - a4, c[0] - a2 / 3 + a4,
                             c[0] + 0.5 * a1 - 0.5 * a3 - a4, c[0] + a1 + a2 + a3 + a4};
        const auto [low, high] = std::minmax_element(b, b + 5);
        return *low > 0 || *high < 0;
    }
};

// A root between a and b, at which the signs differ: Newton's steps, halving where they leave the bracket.
double root_between(const Quartic& f, const Quartic& slope, double a, double b) {
    const bool rises = f.at(a) < 0;
    double s = 0.5 * (a + b);
    for (int i = 0; i < 80; ++i) {
        const double value = f.at(s);
        ((value < 0) == rises ? a : b) = s;
        double next = s - value / slope.at(s);
        if (!(next > a && next < b)) next = 0.5 * (a + b);
        if (std::abs(next - s) <= 0x1p-52 * std::abs(next) || b - a <= 0) break;
        s = next;
    }
    return s;
}

// Roots in (low, high) where the sign changes, in order: between those of the derivative the polynomial is
// monotone.
int sign_changes(const Quartic& f, int degree, double low, double high, double (&roots)[4]) {
    double bends[4];
    int bend_count = 0;
    if (degree > 1) bend_count = sign_changes(f.derivative(), degree - 1, low, high, bends);
    const Quartic slope = f.derivative();
    int count = 0;
    double a = low;
    bool negative = f.at(a) < 0;
    for (int i = 0; i <= bend_count; ++i) {
        const double b = i < bend_count ? bends[i] : high;
        const bool next = f.at(b) < 0;
        if (next != negative && count < 4) roots[count++] = root_between(f, slope, a, b);
        a = b, negative = next;
    }
    return count;
}

struct Surface {
    const BlobData& blob;
    const Ray& ray;
    HitList& hits;
    double shift, rate; // t of the ray = shift + t of the pieces / rate
    double size;
    int enough;

    void add(double along) {
        const double t = shift + along / rate;
        if (!(t > ray.t_min && t < ray.t_max)) return;
        const Vec3 p = ray.origin + t * ray.direction;
        Vec3 gradient(0);
        double strength = 0;
        visit(
            blob, [&](const Bounds& b) { return holds(b, p); },
            [&](const BlobComponent& c) {
                gradient += component_gradient(c, p), strength += std::abs(c.strength);
            });
        const double steepness = glm::length(gradient);
        const double error = steepness > 0 ? 1e-14 * strength / steepness : 0;
        hits.push_back(
            {t, steepness > 0 ? -gradient : -ray.direction, Vec2(0), std::max(1e-11 * size, error)});
    }
    bool done() const { return static_cast<int>(hits.size()) >= enough; }
};

void find_crossings(const Pieces& pieces, Surface& surface) {
    boost::container::small_vector<double, 32> ends;
    for (const Piece& piece : pieces) ends.push_back(piece.from), ends.push_back(piece.to);
    std::sort(ends.begin(), ends.end());
    bool inside = false;
    for (std::size_t i = 0; i + 1 < ends.size() && !surface.done(); ++i) {
        const double from = ends[i], to = ends[i + 1], middle = 0.5 * (from + to), half = 0.5 * (to - from);
        if (!(half > 0)) continue;
        Quartic sum{{-surface.blob.threshold, 0, 0, 0, 0}};
        for (const Piece& p : pieces) {
            if (p.from > from || p.to < to) continue;
            const double u0 = p.c0 + (p.c1 + p.c2 * middle) * middle, u1 = p.c1 + 2 * p.c2 * middle,
                         u2 = p.c2;
            sum.c[0] += p.strength * u0 * u0;
            sum.c[1] += p.strength * 2 * u0 * u1;
            sum.c[2] += p.strength * (u1 * u1 + 2 * u0 * u2);
            sum.c[3] += p.strength * 2 * u1 * u2;
            sum.c[4] += p.strength * u2 * u2;
        }
        // The sign is carried over from piece to piece, so that rounding at their ends loses no crossing.
        const bool starts_inside = sum.at(-half) > 0;
        if (starts_inside != inside) surface.add(from);
        inside = starts_inside;
        if (sum.keeps_sign(half)) continue;
        double roots[4];
        for (double& c : sum.c) c = -c; // negative inside
        const int count = sign_changes(sum, 4, -half, half, roots);
        for (int k = 0; k < count; ++k) surface.add(middle + roots[k]), inside = !inside;
    }
    if (inside && !surface.done()) surface.add(ends.back());
}

} // namespace

void finish_blob(BlobData& blob) {
    blob.nodes.clear();
    std::vector<Bounds> boxes;
    std::vector<std::uint32_t> order;
    for (const BlobComponent& c : blob.components) {
        order.push_back(static_cast<std::uint32_t>(boxes.size()));
        boxes.push_back(component_box(c));
    }
    if (!order.empty()) add_nodes(blob, boxes, order.data(), order.data() + order.size());
}

double blob_density(const BlobData& blob, Vec3 p) {
    double sum = 0;
    visit(
        blob, [&](const Bounds& b) { return holds(b, p); },
        [&](const BlobComponent& c) { sum += component_density(c, p); });
    return sum;
}

BlobShares blob_shares(const BlobData& blob, Vec3 p) {
    boost::container::small_vector<BlobShare, 8> all;
    visit(
        blob, [&](const Bounds& b) { return holds(b, p); },
        [&](const BlobComponent& c) {
            const double density = component_density(c, p);
            if (!(density > 0)) return;
            const auto same = [&](const BlobShare& s) { return s.texture == c.texture; };
            const auto known = std::find_if(all.begin(), all.end(), same);
            if (known == all.end())
                all.push_back({c.texture, density});
            else
                known->share += density;
        });
    std::stable_sort(all.begin(), all.end(),
                     [](const BlobShare& a, const BlobShare& b) { return a.share > b.share; });
    BlobShares shares;
    for (std::size_t i = 0; i < shares.size() && i < all.size(); ++i) shares[i] = all[i];
    return shares;
}

// Components that take away do not reach farther than those that give.
Bounds bounds_of(const Blob& shape) {
    Bounds all;
    for (const BlobComponent& c : shape.data->components)
        if (c.strength > 0) all = merge(all, component_box(c));
    return all;
}

void intersect(const Blob& shape, const Ray& ray, HitList& hits, int enough) {
    const BlobData& blob = *shape.data;
    const double speed = glm::length(ray.direction);
    if (blob.nodes.empty() || !(speed > 0)) return;
    const Bounds& box = blob.nodes.front().box;
    // Along a unit direction, from the point nearest to the middle: then all numbers are of the blob's size.
    const Vec3 direction = ray.direction / speed;
    const double nearest = glm::dot(0.5 * (box.low + box.high) - ray.origin, direction);
    const Vec3 origin = ray.origin + nearest * direction;
    Pieces pieces;
    visit(
        blob, [&](const Bounds& b) { return crosses(b, origin, direction); },
        [&](const BlobComponent& c) { add_pieces(pieces, c, origin, direction); });
    if (pieces.empty()) return;
    Surface surface{blob, ray, hits, nearest / speed, speed, glm::length(box.high - box.low), enough};
    find_crossings(pieces, surface);
}

bool is_inside(const Blob& shape, Vec3 p) { return blob_density(*shape.data, p) > shape.data->threshold; }

} // namespace pnr
