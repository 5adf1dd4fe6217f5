// SPDX-License-Identifier: GPL-3.0-or-later
// Julia sets of quaternions [Hart, Sandin and Kauffman 1989, "Ray tracing deterministic 3-D fractals"] and of
// hypercomplex numbers (i i = j j = -1, k k = 1), which are pairs of complex numbers that no function mixes.
// A point counts as inside when its orbit is still in a ball after max_iteration - 1 steps; radius and start
// are POV-Ray 3.7's.
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace pnr {

namespace {

using Complex = std::complex<double>;
using Map = JuliaFractalData::Map;

struct Quaternion {
    double a = 0;
    Vec3 v{0};

    Quaternion operator*(const Quaternion& q) const {
        return {a * q.a - glm::dot(v, q.v), a * q.v + q.a * v + glm::cross(v, q.v)};
    }
    Quaternion operator+(const Quaternion& q) const { return {a + q.a, v + q.v}; }
    double norm2() const { return a * a + glm::dot(v, v); }
};

// The fourth coordinate of a point of the cut.
struct Cut {
    Vec3 slope;
    double constant;

    explicit Cut(const JuliaFractalData& d)
        : slope(-Vec3(d.slice[0], d.slice[1], d.slice[2]) / d.slice[3]),
          constant(d.slice_distance / d.slice[3]) {}
    double at(Vec3 p) const { return glm::dot(slope, p) + constant; }
};

double parameter_size(const JuliaFractalData& d) {
    double sum = 0;
    for (const double p : d.parameter) sum += p * p;
    return std::sqrt(sum);
}

double radius_of(const JuliaFractalData& d) {
    return d.algebra == JuliaFractalData::Algebra::quaternion ? std::min(2.0, 1 + parameter_size(d)) : 4.0;
}

// Where an orbit ends: |q|^2 over radius^2, and how it changes with the point. Escaped: more than 1.
struct Orbit {
    double size2 = 0;
    Vec3 gradient{0};    // of size2
    double distance = 0; // if escaped: about how far the set is, by |q| ln |q| / |dq|
};

double distance_estimate(double size2, double steepness2, double inverse_radius2) {
    const double r = std::sqrt(size2 / inverse_radius2); // |q|
    return steepness2 > 0 ? 0.5 * r * std::log(std::max(r, 1.0001)) / std::sqrt(steepness2) : 0;
}

Orbit quaternion_orbit(const JuliaFractalData& d, Vec3 p, bool want_gradient) {
    const Cut cut(d);
    const Quaternion c{d.parameter[0], {d.parameter[1], d.parameter[2], d.parameter[3]}};
    const double radius = radius_of(d), scale = 1 / (radius * radius);
    Quaternion q{p.x, {p.y, p.z, cut.at(p)}};
    Quaternion dx{1, {0, 0, cut.slope.x}}, dy{0, {1, 0, cut.slope.y}}, dz{0, {0, 1, cut.slope.z}};
    double growth2 = 1; // |dq|^2 without directions
    const auto step = [&](const Quaternion& v) {
        if (d.map == Map::cube) return v * q * q + q * v * q + q * q * v;
        return v * q + q * v;
    };
    Orbit orbit;
    for (int i = 1;; ++i) {
        orbit.size2 = q.norm2() * scale;
        if (i >= d.max_iteration || orbit.size2 > 1) break;
        const double n = q.norm2();
        growth2 *= d.map == Map::cube ? 9 * n * n : 4 * n;
        if (want_gradient) dx = step(dx), dy = step(dy), dz = step(dz);
        q = (d.map == Map::cube ? q * q * q : q * q) + c;
    }
    orbit.distance = distance_estimate(orbit.size2, growth2, scale);
    if (want_gradient) {
        const auto along = [&](const Quaternion& v) { return 2 * scale * (q.a * v.a + glm::dot(q.v, v.v)); };
        orbit.gradient = {along(dx), along(dy), along(dz)};
    }
    return orbit;
}

// f(z) and f'(z).
std::pair<Complex, Complex> map_value(const JuliaFractalData& d, Complex z) {
    const Complex i(0, 1), one(1, 0);
    switch (d.map) {
    case Map::exp: {
        const Complex e = std::exp(z);
        return {e, e};
    }
    case Map::reciprocal:
        return {one / z, -one / (z * z)};
    case Map::sin:
        return {std::sin(z), std::cos(z)};
    case Map::asin:
        return {std::asin(z), one / std::sqrt(one - z * z)};
    case Map::sinh:
        return {std::sinh(z), std::cosh(z)};
    case Map::asinh:
        return {std::asinh(z), one / std::sqrt(one + z * z)};
    case Map::cos:
        return {std::cos(z), -std::sin(z)};
    case Map::acos:
        return {std::acos(z), -one / std::sqrt(one - z * z)};
    case Map::cosh:
        return {std::cosh(z), std::sinh(z)};
    case Map::acosh:
        return {std::acosh(z), one / (std::sqrt(z - one) * std::sqrt(z + one))};
    case Map::tan: {
        const Complex t = std::tan(z);
        return {t, one + t * t};
    }
    case Map::atan:
        return {std::atan(z), one / (one + z * z)};
    case Map::tanh: {
        const Complex t = std::tanh(z);
        return {t, one - t * t};
    }
    case Map::atanh:
        return {std::atanh(z), one / (one - z * z)};
    case Map::ln:
        return {std::log(z), one / z};
    case Map::power: {
        const Complex e(d.power[0], d.power[1]), v = std::pow(z, e);
        return {v, e * v / z};
    }
    default: // square; POV-Ray's cube of hypercomplex numbers is their square
        return {z * z, 2.0 * z};
    }
}

Orbit hypercomplex_orbit(const JuliaFractalData& d, Vec3 p, bool) {
    const Cut cut(d);
    const double w = cut.at(p), radius = radius_of(d), scale = 0.5 / (radius * radius);
    Complex a(p.x + w, p.y - p.z), b(p.x - w, p.y + p.z);
    const Complex ca(d.parameter[0] + d.parameter[3], d.parameter[1] - d.parameter[2]),
        cb(d.parameter[0] - d.parameter[3], d.parameter[1] + d.parameter[2]);
    Complex da(1, 0), db(1, 0);
    Orbit orbit;
    for (int i = 1;; ++i) {
        orbit.size2 = (std::norm(a) + std::norm(b)) * scale;
        if (!std::isfinite(orbit.size2)) orbit.size2 = 1e30;
        if (i >= d.max_iteration || orbit.size2 > 1) break;
        const auto [fa, slope_a] = map_value(d, a);
        const auto [fb, slope_b] = map_value(d, b);
        da *= slope_a, db *= slope_b;
        a = fa + ca, b = fb + cb;
    }
    const double steepness2 = std::norm(da) + std::norm(db);
    if (!std::isfinite(steepness2)) return orbit;
    orbit.distance = distance_estimate(orbit.size2, steepness2, 2 * scale);
    const auto along = [&](Complex ea, Complex eb) { // how the start moves along an axis
        return 2 * scale * (std::real(std::conj(a) * da * ea) + std::real(std::conj(b) * db * eb));
    };
    const Vec3 s = cut.slope;
    orbit.gradient = {along({1 + s.x, 0}, {1 - s.x, 0}), along({s.y, 1}, {-s.y, 1}),
                      along({s.z, -1}, {-s.z, 1})};
    return orbit;
}

Orbit orbit_of(const JuliaFractalData& d, Vec3 p, bool want_gradient) {
    return d.algebra == JuliaFractalData::Algebra::quaternion ? quaternion_orbit(d, p, want_gradient)
                                                              : hypercomplex_orbit(d, p, want_gradient);
}

bool holds(const JuliaFractalData& d, Vec3 p) { return orbit_of(d, p, false).size2 <= 1; }

struct Walk {
    const JuliaFractalData& data;
    const Ray& ray;
    HitList& hits;

    // Between two points of the ray that lie on different sides.
    void add(double a, double b, bool inside_first) {
        const double fine =
            std::max(2e-10 * radius_of(data) / glm::length(ray.direction), 0x1p-50 * std::abs(b));
        while (b - a > fine) {
            const double middle = 0.5 * (a + b);
            (holds(data, ray.origin + middle * ray.direction) == inside_first ? a : b) = middle;
        }
        const Orbit orbit = orbit_of(data, ray.origin + a * ray.direction, true);
        const double length = glm::length(orbit.gradient);
        const bool usable = length > 0 && std::isfinite(length);
        const Vec3 back = inside_first ? ray.direction : -ray.direction;
        hits.push_back({a, usable ? orbit.gradient / length : back, Vec2(0), 1e-9 * radius_of(data)});
    }
};

} // namespace

Bounds bounds_of(const JuliaFractal& shape) {
    const double r = radius_of(*shape.data);
    return {Vec3(-r), Vec3(r)};
}

void intersect(const JuliaFractal& shape, const Ray& ray, HitList& hits, int enough) {
    const JuliaFractalData& data = *shape.data;
    const double radius = radius_of(data), speed = glm::length(ray.direction);
    HitList ends;
    const Ray line{ray.origin, ray.direction, -infinity, infinity};
    if (intersect_shape(Sphere{Vec3(0), radius}, line, ends) < 2) return;
    const double start = std::max(ends.front().t, ray.t_min), end = std::min(ends.back().t, ray.t_max);
    if (!(start < end)) return;
    // Steps as long as the set is far, but no shorter than half of what the author calls precise; inside,
    // where nothing tells how far its end is, twice that.
    const double shortest = std::min(0.5 / data.precision, 0.02 * radius) / speed;
    Walk walk{data, ray, hits};
    double before = start, t = start;
    bool inside = holds(data, ray.origin + start * ray.direction);
    if (inside && start == ends.front().t) { // the ball itself cuts the set off
        hits.push_back(ends.front());
        hits.back().error = 1e-9 * radius;
    }
    while (t < end && static_cast<int>(hits.size()) < enough) {
        const Orbit orbit = orbit_of(data, ray.origin + t * ray.direction, false);
        const bool now = orbit.size2 <= 1;
        if (now != inside) walk.add(before, t, inside);
        inside = now;
        before = t;
        t += now ? 2 * shortest : std::max(shortest, orbit.distance / speed);
    }
    if (inside && end == ends.back().t && static_cast<int>(hits.size()) < enough) {
        hits.push_back(ends.back());
        hits.back().error = 1e-9 * radius;
    }
}

bool is_inside(const JuliaFractal& shape, Vec3 p) {
    const double r = radius_of(*shape.data);
    return glm::dot(p, p) <= r * r && holds(*shape.data, p);
}

} // namespace pnr
