// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/polynomial.h"
#include "core/shape_algebraic.h"
#include "core/shape_field.h"
#include "core/shape_swept.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

template <class... F>
struct Overload : F... {
    using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>; // clang 14 does not find it by itself

constexpr Bounds everywhere{Vec3(-infinity), Vec3(infinity)};

// Half extents of a disc of radius 1 with the unit normal n.
Vec3 disc_extent(Vec3 n) { return glm::sqrt(glm::max(Vec3(0), Vec3(1) - n * n)); }

Bounds cone_bounds(Vec3 base, Vec3 cap, double base_radius, double cap_radius) {
    const double height = glm::length(cap - base);
    const Vec3 extent = height > 0 ? disc_extent((cap - base) / height) : Vec3(1);
    const Vec3 b = std::abs(base_radius) * extent, c = std::abs(cap_radius) * extent;
    return merge(Bounds{base - b, base + b}, Bounds{cap - c, cap + c});
}

Bounds mesh_bounds(const MeshData& mesh) {
    Bounds b;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) b = merge(b, Vec3(mesh.positions[v]));
    return b;
}

// Collects hits inside the ray's open interval, kept in order of t.
struct Hits {
    const Ray& ray;
    HitList& list;
    std::size_t wanted; // so many of the first will do

    bool enough() const { return list.size() >= wanted; }

    void add(double t, Vec3 normal, Vec2 uv = Vec2(0)) {
        if (!(t > ray.t_min && t < ray.t_max)) return;
        list.push_back({t, normal, uv, 0});
        for (auto at = list.end() - 1; at != list.begin() && (at - 1)->t > t; --at) std::swap(*at, *(at - 1));
    }
};

double turn_of(double x, double z) { // the angle from +x towards +z as a share of the turn, in [0, 1)
    const double turn = std::atan2(z, x) / (2 * pi);
    return turn < 0 ? turn + 1 : turn;
}

struct Roots {
    int count = 0;
    double low = 0, high = 0;
};

// Real roots of a t^2 + 2 b t + c = 0 when `discriminant` = b^2 - a c is already known (each caller has a way
// to it that does not cancel), in increasing order.
Roots quadratic_roots(double a, double b, double c, double discriminant) {
    if (!(discriminant >= 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (a == 0) {
        if (b == 0) return {};
        return {1, -c / (2 * b), -c / (2 * b)};
    }
    const double r0 = q / a, r1 = q != 0 ? c / q : r0;
    return {2, std::min(r0, r1), std::max(r0, r1)};
}

// One Newton step for f(t) = 0, taken only where it helps.
template <class F, class D>
double polish(double t, F f, D derivative) {
    const double value = f(t), slope = derivative(t);
    if (slope == 0) return t;
    const double better = t - value / slope;
    return std::isfinite(better) && std::abs(f(better)) < std::abs(value) ? better : t;
}

// [Haines et al. 2019, "Precision improvements for ray/sphere intersection"]: the discriminant comes from the
// point of the line closest to the centre, so that small and far spheres keep their outline.
void intersect_sphere(const Sphere& s, Hits& out) {
    const Vec3 o = out.ray.origin - s.center, d = out.ray.direction;
    const double a = glm::dot(d, d), b = glm::dot(o, d), r2 = s.radius * s.radius;
    if (!(a > 0) || !(r2 > 0)) return;
    const Vec3 closest = o - (b / a) * d;
    const Roots roots = quadratic_roots(a, b, glm::dot(o, o) - r2, a * (r2 - glm::dot(closest, closest)));
    if (roots.count < 2) return;
    const auto f = [&](double t) {
        const Vec3 p = o + t * d;
        return glm::dot(p, p) - r2;
    };
    const auto slope = [&](double t) { return 2 * glm::dot(o + t * d, d); };
    for (double t : {roots.low, roots.high}) {
        t = polish(t, f, slope);
        out.add(t, o + t * d);
        if (out.enough()) return;
    }
}

Vec2 sphere_uv(Vec3 from_center) {
    const double latitude = std::asin(std::clamp(from_center.y / glm::length(from_center), -1.0, 1.0));
    return {turn_of(from_center.x, from_center.z), 0.5 + latitude / pi};
}

// A stretch of the ray inside a convex body, and the outward normals where it enters and leaves.
struct Stretch {
    double enter = -infinity, leave = infinity;
    Vec3 enter_normal{0}, leave_normal{0};

    void cut(double t0, Vec3 n0, double t1, Vec3 n1) {
        if (t0 > enter) enter = t0, enter_normal = n0;
        if (t1 < leave) leave = t1, leave_normal = n1;
    }
    bool empty() const { return !(enter <= leave); }
    void add_to(Hits& out) const {
        if (empty()) return;
        out.add(enter, enter_normal);
        out.add(leave, leave_normal);
    }
    // Cuts with low <= o + t d <= high, where the outward normals of the two ends are -n and n.
    bool cut_slab(double o, double d, double low, double high, Vec3 n) {
        if (d == 0) return o >= low && o <= high;
        const double t0 = (low - o) / d, t1 = (high - o) / d;
        if (d > 0)
            cut(t0, -n, t1, n);
        else
            cut(t1, n, t0, -n);
        return !empty();
    }
};

// Where POV-Ray lays the faces out: a band of the four sides, the lid over and the bottom under the second of
// them.
Vec2 box_uv(Vec3 p, Vec3 outward) { // p: shares of the box's edges
    if (outward.x < 0) return {0.25 * p.z, (1 + p.y) / 3};
    if (outward.z > 0) return {0.25 + 0.25 * p.x, (1 + p.y) / 3};
    if (outward.x > 0) return {0.75 - 0.25 * p.z, (1 + p.y) / 3};
    if (outward.z < 0) return {1 - 0.25 * p.x, (1 + p.y) / 3};
    return {0.25 + 0.25 * p.x, outward.y > 0 ? 1 - p.z / 3 : p.z / 3};
}

void intersect_box(const Box& box, Hits& out) {
    const Vec3 low = glm::min(box.low, box.high), high = glm::max(box.low, box.high);
    Stretch inside;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 n(0);
        n[axis] = 1;
        if (!inside.cut_slab(out.ray.origin[axis], out.ray.direction[axis], low[axis], high[axis], n)) return;
    }
    if (inside.empty()) return;
    const auto add = [&](double t, Vec3 normal) {
        const Vec3 p = out.ray.origin + t * out.ray.direction;
        out.add(t, normal, box_uv(glm::clamp((p - low) / (high - low), 0.0, 1.0), normal));
    };
    add(inside.enter, inside.enter_normal);
    if (!out.enough()) add(inside.leave, inside.leave_normal);
}

void intersect_plane(const Plane& p, Hits& out) {
    const double slope = glm::dot(p.normal, out.ray.direction);
    if (slope != 0) out.add((p.distance - glm::dot(p.normal, out.ray.origin)) / slope, p.normal);
}

void intersect_disc(const Disc& disc, Hits& out) {
    const Vec3 o = out.ray.origin - disc.center;
    const double slope = glm::dot(disc.normal, out.ray.direction);
    if (slope == 0) return;
    const double t = -glm::dot(disc.normal, o) / slope;
    const Vec3 p = o + t * out.ray.direction;
    const double distance = glm::length(p - glm::dot(p, disc.normal) * disc.normal);
    if (distance <= disc.radius && distance >= disc.hole) out.add(t, disc.normal);
}

// The cone |p_perpendicular|^2 = R(z)^2 along a ray, with z the height over the base and R linear in it.
struct ConeSide {
    Vec3 axis;        // unit
    Vec3 o, d;        // perpendicular parts of the ray from the base
    double oz, dz;    // its heights
    double r0, slope; // R(z) = r0 + slope z
    double a, b, c, discriminant;

    double value(double t) const {
        const Vec3 p = o + t * d;
        const double r = radius(t);
        return glm::dot(p, p) - r * r;
    }
    double radius(double t) const { return r0 + slope * (oz + t * dz); }
    double derivative(double t) const { return 2 * (glm::dot(o + t * d, d) - radius(t) * slope * dz); }
    Vec3 normal(double t) const {
        const Vec3 n = o + t * d - radius(t) * slope * axis;
        return n == Vec3(0) ? (slope < 0 ? axis : -axis) : n; // the apex
    }
};

ConeSide make_cone_side(const Cone& cone, double height, const Ray& ray) {
    ConeSide s;
    s.axis = (cone.cap - cone.base) / height;
    const Vec3 from_base = ray.origin - cone.base;
    s.oz = glm::dot(from_base, s.axis);
    s.dz = glm::dot(ray.direction, s.axis);
    s.o = from_base - s.oz * s.axis;
    s.d = ray.direction - s.dz * s.axis;
    s.r0 = cone.base_radius;
    s.slope = (cone.cap_radius - cone.base_radius) / height;
    const double r = s.r0 + s.slope * s.oz, rd = s.slope * s.dz;
    const double dd = glm::dot(s.d, s.d);
    s.a = dd - rd * rd;
    s.b = glm::dot(s.o, s.d) - r * rd;
    s.c = glm::dot(s.o, s.o) - r * r;
    // b^2 - a c without the squares that cancel: Lagrange's identity for o and d, and for both with (r, rd).
    const Vec3 across = glm::cross(s.o, s.d);
    const Vec3 mixed = r * s.d - rd * s.o;
    s.discriminant = glm::dot(mixed, mixed) - glm::dot(across, across);
    return s;
}

// The closed cone is convex: inside both the side and the slab between the lids. Taking the stretch of the
// ray in it, not single roots, leaves no gap at the rims.
void intersect_closed_cone(const ConeSide& s, double height, Hits& out) {
    Stretch inside;
    if (!inside.cut_slab(s.oz, s.dz, 0, height, s.axis)) return;
    const Roots roots = quadratic_roots(s.a, s.b, s.c, s.discriminant);
    if (roots.count == 0) {
        // No crossing: along the axis of a cylinder, or (by rounding) through the tip of a cone.
        if (s.a < 0 || (s.a == 0 && s.c <= 0)) inside.add_to(out);
        return;
    }
    double low = polish(
        roots.low, [&](double t) { return s.value(t); }, [&](double t) { return s.derivative(t); });
    double high = polish(
        roots.high, [&](double t) { return s.value(t); }, [&](double t) { return s.derivative(t); });
    if (roots.count == 1) (s.b > 0 ? low : high) = s.b > 0 ? -infinity : infinity;
    if (low > high) std::swap(low, high);
    const auto normal = [&](double t) { return std::isfinite(t) ? s.normal(t) : Vec3(0); };
    if (s.a >= 0) {
        inside.cut(low, normal(low), high, normal(high));
        return inside.add_to(out);
    }
    // Between the roots the line is outside; before and behind it is inside the two halves of the double
    // cone, of which one at most lies between the lids.
    Stretch before = inside, behind = inside;
    before.cut(-infinity, Vec3(0), low, normal(low));
    behind.cut(high, normal(high), infinity, Vec3(0));
    const auto length = [](const Stretch& x) { return x.empty() ? -1 : x.leave - x.enter; };
    (length(before) >= length(behind) ? before : behind).add_to(out);
}

void intersect_cone(const Cone& cone, Hits& out) {
    const double height = glm::length(cone.cap - cone.base);
    if (!(height > 0) || !(std::max(cone.base_radius, cone.cap_radius) > 0)) return;
    const ConeSide s = make_cone_side(cone, height, out.ray);
    if (!cone.open) return intersect_closed_cone(s, height, out);
    const Roots roots = quadratic_roots(s.a, s.b, s.c, s.discriminant);
    for (int i = 0; i < roots.count; ++i) {
        const double t = polish(
            i == 0 ? roots.low : roots.high, [&](double x) { return s.value(x); },
            [&](double x) { return s.derivative(x); });
        const double z = s.oz + t * s.dz;
        if (z >= 0 && z <= height) out.add(t, s.normal(t));
    }
}

bool inside_cone(const Cone& cone, Vec3 p) {
    const double height = glm::length(cone.cap - cone.base);
    if (!(height > 0)) return false;
    const Vec3 axis = (cone.cap - cone.base) / height, from_base = p - cone.base;
    const double z = glm::dot(from_base, axis);
    if (!(z >= 0 && z <= height)) return false;
    const Vec3 away = from_base - z * axis;
    const double r = cone.base_radius + (cone.cap_radius - cone.base_radius) * (z / height);
    return glm::dot(away, away) <= r * r;
}

// ---- torus
// ----------------------------------------------------------------------------------------------------

// f(t) = (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + z^2), written as a product of distances where that cancels
// less: with q = hypot(x, z): f = (q^2 + y^2 + R^2 - r^2 - 2 R q)(... + 2 R q) = ((q - R)^2 + y^2 - r^2)((q +
// R)^2 + y^2 - r^2).
struct TorusAlongRay {
    double major, minor;
    Vec3 o, d; // d unit

    double value(double t) const {
        const Vec3 p = o + t * d;
        const double q = std::hypot(p.x, p.z), y2 = p.y * p.y - minor * minor;
        return ((q - major) * (q - major) + y2) * ((q + major) * (q + major) + y2);
    }
    Vec3 gradient(Vec3 p) const {
        const double k = glm::dot(p, p) + major * major - minor * minor;
        return 4.0 * Vec3(p.x * (k - 2 * major * major), p.y * k, p.z * (k - 2 * major * major));
    }
};

void intersect_torus(const Torus& torus, Hits& out) {
    const double speed = glm::length(out.ray.direction);
    const double outer = torus.major + std::abs(torus.minor);
    if (!(speed > 0) || !(outer > 0) || torus.minor == 0) return;
    // In units of the outer radius, from the point closest to the centre, along a unit direction: then all
    // numbers in the polynomial are of order one.
    const Vec3 unit = out.ray.direction / speed;
    const double nearest = -glm::dot(out.ray.origin, unit);
    TorusAlongRay f{torus.major / outer, std::abs(torus.minor) / outer,
                    (out.ray.origin + nearest * unit) / outer, unit};
    const double reach2 = 1 - glm::dot(f.o, f.o);
    if (!(reach2 > 0)) return;
    const double reach = std::sqrt(reach2) * (1 + 1e-12);
    const double k = glm::dot(f.o, f.o) + f.major * f.major - f.minor * f.minor, od = glm::dot(f.o, f.d);
    const double m4 = 4 * f.major * f.major;
    const double c[5] = {f.value(0), 4 * k * od - 2 * m4 * (f.o.x * f.d.x + f.o.z * f.d.z),
                         2 * k + 4 * od * od - m4 * (f.d.x * f.d.x + f.d.z * f.d.z), 4 * od, 1};
    const auto slope = [&](double t) { return glm::dot(f.gradient(f.o + t * f.d), f.d); };
    double roots[4];
    const int count = real_roots(c, -reach, reach, roots);
    for (int i = 0; i < count; ++i)
        roots[i] = polish(
            roots[i], [&](double t) { return f.value(t); }, slope);
    for (int i = 0; i < count; ++i) {
        const Vec3 p = f.o + roots[i] * f.d;
        const double q = std::hypot(p.x, p.z) - f.major;
        const double around = turn_of(-p.x, p.z),
                     across = turn_of(-q, -p.y); // from the far sides, as POV-Ray has it
        out.add((nearest + roots[i] * outer) / speed, f.gradient(p), {around, across});
    }
}

} // namespace

Bounds shape_bounds(const Shape& shape) {
    return std::visit(
        Overload{
            [](const Sphere& s) {
                return Bounds{s.center - std::abs(s.radius), s.center + std::abs(s.radius)};
            },
            [](const Box& b) {
                return Bounds{glm::min(b.low, b.high), glm::max(b.low, b.high)};
            },
            [](const Plane&) { return everywhere; },
            [](const Cylinder& c) { return cone_bounds(c.base, c.cap, c.radius, c.radius); },
            [](const Cone& c) { return cone_bounds(c.base, c.cap, c.base_radius, c.cap_radius); },
            [](const Torus& t) {
                const double minor = std::abs(t.minor), outer = std::abs(t.major) + minor;
                return Bounds{{-outer, -minor, -outer}, {outer, minor, outer}};
            },
            [](const Disc& d) {
                const Vec3 e = std::abs(d.radius) * disc_extent(d.normal);
                return Bounds{d.center - e, d.center + e};
            },
            [](const Mesh& m) { return m.data ? mesh_bounds(*m.data) : Bounds{}; },
            [](const BicubicPatch& p) {
                Bounds b;
                for (const Vec3& point : p.points) b = merge(b, point);
                return b;
            },
            [](const Isosurface& s) { return bounds_of(s); },
            [](const Blob& s) { return bounds_of(s); },
            [](const HeightField& s) { return bounds_of(s); },
            [](const JuliaFractal& s) { return bounds_of(s); },
            [](const Parametric& s) { return bounds_of(s); },
            [](const Quadric& s) { return bounds_of(s); },
            [](const PolynomialSurface& s) { return bounds_of(s); },
            [](const Superellipsoid& s) { return bounds_of(s); },
            [](const Ovus& s) { return bounds_of(s); },
            [](const Lathe& s) { return bounds_of(s); },
            [](const Sor& s) { return bounds_of(s); },
            [](const Prism& s) { return bounds_of(s); },
            [](const SphereSweep& s) { return bounds_of(s); },
            [](const Polygon& s) { return bounds_of(s); },
            [](const Text& s) { return bounds_of(s); },
        },
        shape);
}

static bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool has_finite_numbers(const Shape& shape) {
    return std::visit(
        Overload{
            [](const Sphere& s) { return is_finite(s.center) && std::isfinite(s.radius); },
            [](const Box& b) { return is_finite(b.low) && is_finite(b.high); },
            [](const Plane& p) { return is_finite(p.normal) && std::isfinite(p.distance); },
            [](const Cylinder& c) {
                return is_finite(c.base) && is_finite(c.cap) && std::isfinite(c.radius);
            },
            [](const Cone& c) {
                return is_finite(c.base) && is_finite(c.cap) && std::isfinite(c.base_radius + c.cap_radius);
            },
            [](const Torus& t) { return std::isfinite(t.major + t.minor); },
            [](const Disc& d) {
                return is_finite(d.center) && is_finite(d.normal) && std::isfinite(d.radius) &&
                       !std::isnan(d.hole);
            },
            [](const Mesh& m) {
                return !m.data || std::all_of(m.data->positions.begin(), m.data->positions.end(),
                                              [](Vec3f p) { return is_finite(Vec3(p)); });
            },
            [](const BicubicPatch& p) {
                return std::all_of(p.points.begin(), p.points.end(), [](Vec3 q) { return is_finite(q); });
            },
            [](const auto&) { return true; }, // those that are made of finite numbers alone
        },
        shape);
}

const char* shape_name(const Shape& shape) {
    return std::visit(Overload{
                          [](const Sphere&) { return "sphere"; },
                          [](const Box&) { return "box"; },
                          [](const Plane&) { return "plane"; },
                          [](const Cylinder&) { return "cylinder"; },
                          [](const Cone&) { return "cone"; },
                          [](const Torus&) { return "torus"; },
                          [](const Disc&) { return "disc"; },
                          [](const Mesh&) { return "mesh"; },
                          [](const BicubicPatch&) { return "bicubic_patch"; },
                          [](const Isosurface&) { return "isosurface"; },
                          [](const Blob&) { return "blob"; },
                          [](const HeightField&) { return "height_field"; },
                          [](const JuliaFractal&) { return "julia_fractal"; },
                          [](const Parametric&) { return "parametric"; },
                          [](const Quadric&) { return "quadric"; },
                          [](const PolynomialSurface&) { return "poly"; },
                          [](const Superellipsoid&) { return "superellipsoid"; },
                          [](const Ovus&) { return "ovus"; },
                          [](const Lathe&) { return "lathe"; },
                          [](const Sor&) { return "sor"; },
                          [](const Prism&) { return "prism"; },
                          [](const SphereSweep&) { return "sphere_sweep"; },
                          [](const Polygon&) { return "polygon"; },
                          [](const Text&) { return "text"; },
                      },
                      shape);
}

int intersect_shape(const Shape& shape, const Ray& ray, HitList& hits, int enough) {
    hits.clear();
    Hits out{ray, hits, static_cast<std::size_t>(std::max(1, enough))};
    std::visit(Overload{
                   [&](const Sphere& s) { intersect_sphere(s, out); },
                   [&](const Box& b) { intersect_box(b, out); },
                   [&](const Plane& p) { intersect_plane(p, out); },
                   [&](const Cylinder& c) {
                       intersect_cone({c.base, c.cap, c.radius, c.radius, c.open}, out);
                   },
                   [&](const Cone& c) { intersect_cone(c, out); },
                   [&](const Torus& t) { intersect_torus(t, out); },
                   [&](const Disc& d) { intersect_disc(d, out); },
                   [](const Mesh&) {},
                   [](const BicubicPatch&) {},
                   [&](const Isosurface& s) { intersect(s, ray, hits, enough); },
                   [&](const Blob& s) { intersect(s, ray, hits, enough); },
                   [&](const HeightField& s) { intersect(s, ray, hits, enough); },
                   [&](const JuliaFractal& s) { intersect(s, ray, hits, enough); },
                   [](const Parametric&) {},
                   [&](const Quadric& s) { intersect(s, ray, hits); },
                   [&](const PolynomialSurface& s) { intersect(s, ray, hits); },
                   [&](const Superellipsoid& s) { intersect(s, ray, hits); },
                   [&](const Ovus& s) { intersect(s, ray, hits); },
                   [&](const Lathe& s) { intersect(s, ray, hits); },
                   [&](const Sor& s) { intersect(s, ray, hits); },
                   [&](const Prism& s) { intersect(s, ray, hits); },
                   [&](const SphereSweep& s) { intersect(s, ray, hits); },
                   [&](const Polygon& s) { intersect(s, ray, hits); },
                   [&](const Text& s) { intersect(s, ray, hits); },
               },
               shape);
    return static_cast<int>(hits.size());
}

Vec2 uv_of(const Shape& shape, const ShapeHit& hit) {
    return std::holds_alternative<Sphere>(shape) ? sphere_uv(hit.normal) : hit.uv;
}

bool has_uv(const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->data && !mesh->data->uvs.empty();
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Box>(shape) ||
           std::holds_alternative<Torus>(shape) || std::holds_alternative<Lathe>(shape) ||
           std::holds_alternative<Sor>(shape) || std::holds_alternative<Ovus>(shape);
}

bool inside_shape(const Shape& shape, Vec3 p) {
    return std::visit(
        Overload{
            [&](const Sphere& s) { return glm::dot(p - s.center, p - s.center) <= s.radius * s.radius; },
            [&](const Box& b) {
                const Vec3 low = glm::min(b.low, b.high), high = glm::max(b.low, b.high);
                return glm::all(glm::lessThanEqual(low, p)) && glm::all(glm::lessThanEqual(p, high));
            },
            [&](const Plane& s) { return glm::dot(s.normal, p) <= s.distance; },
            [&](const Cylinder& c) {
                return inside_cone({c.base, c.cap, c.radius, c.radius, c.open}, p);
            },
            [&](const Cone& c) { return inside_cone(c, p); },
            [&](const Torus& t) {
                return std::hypot(std::hypot(p.x, p.z) - t.major, p.y) <= std::abs(t.minor);
            },
            [&](const Disc& d) { return glm::dot(d.normal, p - d.center) <= 0; },
            [](const Mesh&) { return false; },
            [](const BicubicPatch&) { return false; },
            [&](const Isosurface& s) { return is_inside(s, p); },
            [&](const Blob& s) { return is_inside(s, p); },
            [&](const HeightField& s) { return is_inside(s, p); },
            [&](const JuliaFractal& s) { return is_inside(s, p); },
            [](const Parametric&) { return false; },
            [&](const Quadric& s) { return is_inside(s, p); },
            [&](const PolynomialSurface& s) { return is_inside(s, p); },
            [&](const Superellipsoid& s) { return is_inside(s, p); },
            [&](const Ovus& s) { return is_inside(s, p); },
            [&](const Lathe& s) { return is_inside(s, p); },
            [&](const Sor& s) { return is_inside(s, p); },
            [&](const Prism& s) { return is_inside(s, p); },
            [&](const SphereSweep& s) { return is_inside(s, p); },
            [&](const Polygon& s) { return is_inside(s, p); },
            [&](const Text& s) { return is_inside(s, p); },
        },
        shape);
}

bool has_endless_inside(const Shape& shape) {
    if (const auto* quadric = std::get_if<Quadric>(&shape)) return has_endless_inside(*quadric);
    return std::holds_alternative<Plane>(shape) || std::holds_alternative<Disc>(shape) ||
           std::holds_alternative<HeightField>(shape);
}

} // namespace pnr
