// SPDX-License-Identifier: GPL-3.0-or-later
// Lathes and surfaces of revolution: curves (r, y) that turn about the y axis.
#include "core/polynomial.h"
#include "core/shape_impl.h"
#include "core/shape_swept.h"

#include <algorithm>
#include <stdexcept>

namespace pnr {

// The curve in pieces. With s from 0 to 1 along a piece, y and r^2 are polynomials in s; a ray, where y tells
// the place on it, meets the piece where a y^2 + b y + c - r^2 = 0.
struct RevolvedPiece {
    int degree = 1;             // of y(s)
    int square_degree = 2;      // of the others
    double y[4];                // all in Bernstein form; y less LatheData::middle
    double y1[7], y2[7], r2[7]; // y, y^2 and r^2, in square_degree
    double low, high;           // of y
    double r2_low, r2_high;
    double v0, v1; // texture coordinate along the curve
    bool turned = false;
};

struct LatheData {
    std::vector<RevolvedPiece> pieces;
    double middle = 0; // height
    Bounds bounds;
    double low_r2 = 0, high_r2 = 0; // of a sor's lids
};

namespace {

std::span<const double> form(const double* b, int degree) {
    return {b, static_cast<std::size_t>(degree) + 1};
}

void raise_degree(const double* b, int degree, int to, double* raised) {
    const double ones[7] = {1, 1, 1, 1, 1, 1, 1};
    bernstein_product(form(b, degree), form(ones, to - degree), raised);
}

// Fills in what follows from y, degree, square_degree and r2.
void finish_piece(RevolvedPiece& p) {
    raise_degree(p.y, p.degree, p.square_degree, p.y1);
    double square[7];
    bernstein_product(form(p.y, p.degree), form(p.y, p.degree), square);
    raise_degree(square, 2 * p.degree, p.square_degree, p.y2);
    const auto [low, high] = std::minmax_element(p.y, p.y + p.degree + 1);
    p.low = *low, p.high = *high;
    const auto [r2_low, r2_high] = std::minmax_element(p.r2, p.r2 + p.square_degree + 1);
    p.r2_low = *r2_low, p.r2_high = *r2_high;
}

void finish_lathe(LatheData& lathe) {
    double radius2 = 0, low = infinity, high = -infinity;
    for (std::size_t i = 0; i < lathe.pieces.size(); ++i) {
        RevolvedPiece& p = lathe.pieces[i];
        radius2 = std::max(radius2, p.r2_high);
        low = std::min(low, p.low);
        high = std::max(high, p.high);
        p.v0 = static_cast<double>(i) / static_cast<double>(lathe.pieces.size());
        p.v1 = static_cast<double>(i + 1) / static_cast<double>(lathe.pieces.size());
    }
    const double radius = std::sqrt(radius2);
    lathe.bounds = {{-radius, lathe.middle + low, -radius}, {radius, lathe.middle + high, radius}};
}

// ---- rays
// ----------------------------------------------------------------------------------------------------------

// p(t) = o + t d with d unit; r^2(t) = a t^2 + 2 g t + c. The ray's own t is (t + shift) / speed.
struct AxisRay {
    Vec3 o, d;
    double a, g, c;
    double shift, speed;

    double r2(double t) const { return (a * t + 2 * g) * t + c; }
};

// From where numbers stay small: the height of the curve's middle, or, on a flat ray, the place closest to
// the axis.
AxisRay make_axis_ray(const Ray& ray, double middle) {
    AxisRay r;
    r.speed = glm::length(ray.direction);
    r.d = ray.direction / r.speed;
    r.o = ray.origin - Vec3(0, middle, 0);
    r.a = r.d.x * r.d.x + r.d.z * r.d.z;
    r.shift = r.a < 0.5 ? -r.o.y / r.d.y : -(r.o.x * r.d.x + r.o.z * r.d.z) / r.a;
    r.o += r.shift * r.d;
    if (r.a < 0.5) r.o.y = 0;
    r.g = r.o.x * r.d.x + r.o.z * r.d.z;
    r.c = r.o.x * r.o.x + r.o.z * r.o.z;
    return r;
}

// Whether the ray comes as close to the axis as the piece, at its heights, and as far.
bool comes_near(const AxisRay& ray, const RevolvedPiece& p) {
    Span span;
    const double slack = 1e-9 * (std::abs(p.low) + std::abs(p.high) + std::sqrt(p.r2_high));
    span.cut(ray.o.y, ray.d.y, p.low - slack, p.high + slack);
    if (span.empty()) return false;
    const double nearest = ray.a > 0 ? std::clamp(-ray.g / ray.a, span.enter, span.leave) : span.enter;
    if (std::isfinite(nearest) && ray.r2(nearest) > p.r2_high * (1 + 1e-9) + 1e-30) return false;
    if (!std::isfinite(span.enter) || !std::isfinite(span.leave)) return true;
    return std::max(ray.r2(span.enter), ray.r2(span.leave)) >= p.r2_low * (1 - 1e-9);
}

double slope(const double* b, int degree, double s) {
    double d[6];
    for (int i = 0; i < degree; ++i) d[i] = degree * (b[i + 1] - b[i]);
    return bernstein_value({d, static_cast<std::size_t>(degree)}, s);
}

// Newton's steps for y(s) = y(t), r^2(s) = r^2(t).
void refine(const RevolvedPiece& p, const AxisRay& ray, double& s, double& t) {
    for (int step = 0; step < 3; ++step) {
        const double ey = bernstein_value(form(p.y, p.degree), s) - (ray.o.y + t * ray.d.y);
        const double er = bernstein_value(form(p.r2, p.square_degree), s) - ray.r2(t);
        const double sy = slope(p.y, p.degree, s), sr = slope(p.r2, p.square_degree, s),
                     st = 2 * (ray.a * t + ray.g);
        const double det = ray.d.y * sr - sy * st;
        const double ds = (ey * st - er * ray.d.y) / det, dt = (sr * ey - sy * er) / det;
        if (!(std::abs(ds) < 1e-3) || !std::isfinite(dt)) return;
        s = std::clamp(s + ds, 0.0, 1.0);
        t += dt;
    }
}

void meet_at(const RevolvedPiece& p, const AxisRay& ray, double s, double t, const Ray& said, HitList& hits) {
    refine(p, ray, s, t);
    const double x = ray.o.x + t * ray.d.x, z = ray.o.z + t * ray.d.z, side = p.turned ? -1 : 1;
    const double sy = slope(p.y, p.degree, s), sr = slope(p.r2, p.square_degree, s);
    Vec3 normal = side * Vec3(x * sy, -0.5 * sr, z * sy);
    if (normal == Vec3(0)) normal = Vec3(0, -side, 0);
    const double size = std::abs(p.low) + std::abs(p.high) + std::sqrt(p.r2_high);
    add_hit(hits, said, (t + ray.shift) / ray.speed, normal, {turn_about_y(x, z), p.v0 + s * (p.v1 - p.v0)},
            0x1p-44 * size);
}

void meet_piece(const RevolvedPiece& p, const AxisRay& ray, const Ray& said, HitList& hits) {
    constexpr double flat =
        1e-6; // the two hits at one height are too close together on the curve to be told apart
    double f[7], roots[6];
    const double dy = ray.d.y, oy = ray.o.y;
    if (std::abs(dy) < flat) {
        for (int i = 0; i <= p.degree; ++i) f[i] = p.y[i] - oy;
        const int count = bernstein_roots(form(f, p.degree), roots);
        for (int i = 0; i < count; ++i) {
            const double r2 =
                bernstein_value(form(p.r2, p.square_degree), roots[i]) - (ray.c - ray.g * ray.g / ray.a);
            if (!(r2 >= 0)) continue;
            for (const double sign : {-1.0, 1.0})
                meet_at(p, ray, roots[i], (-ray.g + sign * std::sqrt(ray.a * r2)) / ray.a, said, hits);
        }
        return;
    }
    // u = y - oy = t dy: a u^2 + 2 g dy u + dy^2 (c - r^2) = 0
    const double f1 = 2 * (ray.g * dy - ray.a * oy),
                 f0 = ray.a * oy * oy - 2 * ray.g * dy * oy + dy * dy * ray.c;
    for (int i = 0; i <= p.square_degree; ++i) f[i] = ray.a * p.y2[i] + f1 * p.y1[i] - dy * dy * p.r2[i] + f0;
    const int count = bernstein_roots(form(f, p.square_degree), roots);
    for (int i = 0; i < count; ++i) {
        const double u = bernstein_value(form(p.y, p.degree), roots[i]) - oy;
        double t = u / dy;
        if (std::abs(dy) < 0.1) { // the distance from the axis tells more, the height only the side
            const double r2 =
                bernstein_value(form(p.r2, p.square_degree), roots[i]) - (ray.c - ray.g * ray.g / ray.a);
            t = (-ray.g + std::copysign(std::sqrt(ray.a * std::max(0.0, r2)), t * ray.a + ray.g)) / ray.a;
        }
        meet_at(p, ray, roots[i], t, said, hits);
    }
}

void meet_pieces(const LatheData& lathe, const AxisRay& axis_ray, const Ray& ray, HitList& hits) {
    for (const RevolvedPiece& piece : lathe.pieces)
        if (comes_near(axis_ray, piece)) meet_piece(piece, axis_ray, ray, hits);
}

bool inside_pieces(const LatheData& lathe, Vec3 p) {
    const double y = p.y - lathe.middle, r2 = p.x * p.x + p.z * p.z;
    bool inside = false;
    for (const RevolvedPiece& piece : lathe.pieces) {
        if (y < piece.low || y > piece.high || r2 > piece.r2_high) continue;
        double f[4], roots[3];
        for (int i = 0; i <= piece.degree; ++i) f[i] = piece.y[i] - y;
        const int count = bernstein_roots(form(f, piece.degree), roots);
        for (int i = 0; i < count; ++i)
            inside ^= bernstein_value(form(piece.r2, piece.square_degree), roots[i]) > r2;
    }
    return inside;
}

} // namespace

Shape make_lathe(SplineKind kind, std::span<const Vec2> points) {
    std::vector<CurvePiece> curve = open_curve(kind, points);
    orient_pieces(curve);
    auto lathe = std::make_shared<LatheData>();
    double low = infinity, high = -infinity;
    for (const CurvePiece& c : curve) low = std::min(low, c.low.y), high = std::max(high, c.high.y);
    lathe->middle = 0.5 * (low + high);
    for (const CurvePiece& c : curve) {
        RevolvedPiece& p = lathe->pieces.emplace_back();
        p.degree = c.degree;
        p.square_degree = 2 * c.degree;
        p.turned = c.turned;
        double x[4];
        for (std::size_t i = 0; i <= static_cast<std::size_t>(c.degree); ++i)
            x[i] = c.points[i].x, p.y[i] = c.points[i].y - lathe->middle;
        bernstein_product(form(x, p.degree), form(x, p.degree), p.r2);
        finish_piece(p);
    }
    finish_lathe(*lathe);
    return Lathe{std::move(lathe)};
}

Shape make_sor(std::span<const Vec2> points) {
    if (points.size() < 4) throw std::invalid_argument("a sor needs at least 4 points");
    auto sor = std::make_shared<LatheData>();
    const auto slope_at = [&](std::size_t i) { // of r^2 over the height
        return 2 * points[i].x * (points[i + 1].x - points[i - 1].x) / (points[i + 1].y - points[i - 1].y);
    };
    const std::size_t end = points.size() - 2;
    sor->middle = 0.5 * (points[1].y + points[end].y);
    sor->low_r2 = points[1].x * points[1].x;
    sor->high_r2 = points[end].x * points[end].x;
    for (std::size_t i = 1; i < end; ++i) {
        const double height = points[i + 1].y - points[i].y;
        if (!(height > 0) || points[i - 1].y >= points[i + 1].y || points[i].y >= points[i + 2].y)
            throw std::invalid_argument("the heights of a sor's points must grow from one to the next");
        RevolvedPiece& p = sor->pieces.emplace_back();
        p.degree = 1;
        p.square_degree = 3;
        p.y[0] = points[i].y - sor->middle, p.y[1] = points[i + 1].y - sor->middle;
        p.r2[0] = points[i].x * points[i].x, p.r2[3] = points[i + 1].x * points[i + 1].x;
        p.r2[1] = p.r2[0] + slope_at(i) * height / 3, p.r2[2] = p.r2[3] - slope_at(i + 1) * height / 3;
        finish_piece(p);
    }
    finish_lathe(*sor);
    return Sor{std::move(sor)};
}

Bounds bounds_of(const Lathe& s) { return s.data->bounds; }
Bounds bounds_of(const Sor& s) { return s.data->bounds; }

void intersect(const Lathe& s, const Ray& ray, HitList& hits) {
    meet_pieces(*s.data, make_axis_ray(ray, s.data->middle), ray, hits);
}

void intersect(const Sor& s, const Ray& ray, HitList& hits) {
    const AxisRay axis_ray = make_axis_ray(ray, s.data->middle);
    meet_pieces(*s.data, axis_ray, ray, hits);
    if (s.open || axis_ray.d.y == 0) return;
    for (const bool top : {false, true}) {
        const double height = top ? s.data->pieces.back().y[1] : s.data->pieces.front().y[0];
        const double t = (height - axis_ray.o.y) / axis_ray.d.y;
        if (axis_ray.r2(t) < (top ? s.data->high_r2 : s.data->low_r2))
            add_hit(hits, ray, (t + axis_ray.shift) / axis_ray.speed, Vec3(0, top ? 1 : -1, 0));
    }
}

bool is_inside(const Lathe& s, Vec3 p) { return inside_pieces(*s.data, p); }
bool is_inside(const Sor& s, Vec3 p) { return inside_pieces(*s.data, p); }

} // namespace pnr
