// SPDX-License-Identifier: GPL-3.0-or-later
// Superellipsoids and ovuses. Both are, but for superellipsoids with an exponent above 2, level sets of
// convex functions: from outside, Newton's steps along a ray go towards the surface and never past it.
#include "core/shape_algebraic.h"
#include "core/shape_impl.h"

#include <algorithm>

namespace pnr {

namespace {

struct ValueAndSlope {
    double value, slope;
};

// From `start`, where the convex function is positive and falls (in the direction of `sign`), to its first
// zero; infinity if there is none before `end`.
template <class F>
double newton_inwards(const F& f, double start, double end, double sign) {
    double t = start;
    for (int step = 0; step < 200; ++step) {
        const ValueAndSlope at = f(t);
        if (at.value <= 0) return t;
        if (!(sign * at.slope < 0)) return infinity;
        const double next = t - at.value / at.slope;
        if (!(sign * next <= sign * end)) return infinity;
        if (sign * (next - t) <= 0x1p-52 * std::abs(t)) return next;
        t = next;
    }
    return t;
}

// Both ends of the stretch in which a convex function is negative, within `span`, at whose ends it is not.
template <class F, class Add>
void meet_convex(const F& f, const Span& span, Add add) {
    const double enter = newton_inwards(f, span.enter, span.leave, 1);
    if (!std::isfinite(enter)) return;
    const double leave = newton_inwards(f, span.leave, span.enter, -1);
    if (!std::isfinite(leave)) return;
    add(enter);
    add(std::max(enter, leave));
}

// ---- superellipsoid
// ------------------------------------------------------------------------------------------------

// g = ((|x|^a + |y|^a)^(b/a) + |z|^b)^(1/b), a = 2/e, b = 2/n: of degree one, so that no power overflows.
struct Gauge {
    double a, b;

    // w = (u^e + v^e)^(1/e) and its slopes in u and v, which are (u / w)^(e - 1) and so on.
    struct Combined {
        double w, by_u, by_v;
    };
    static Combined combine(double u, double v, double e) {
        const bool u_big = u >= v;
        const double big = u_big ? u : v, small = u_big ? v : u;
        if (!(big > 0)) return {0, 0, 0};
        const double power = std::pow(small / big, e), sum = 1 + power, w = big * std::pow(sum, 1 / e);
        const double by_big = w / (big * sum);
        const double by_small = small > 0 ? std::min(power * w / (small * sum), 1e6)
                                : e > 1   ? 0
                                          : 1e6; // a cusp
        return {w, u_big ? by_big : by_small, u_big ? by_small : by_big};
    }
    double value(Vec3 p) const {
        return combine(combine(std::abs(p.x), std::abs(p.y), a).w, std::abs(p.z), b).w;
    }
    struct ValueAndGradient {
        double value;
        Vec3 gradient;
    };
    ValueAndGradient at(Vec3 p) const {
        const Combined flat = combine(std::abs(p.x), std::abs(p.y), a),
                       whole = combine(flat.w, std::abs(p.z), b);
        return {whole.w,
                {std::copysign(whole.by_u * flat.by_u, p.x), std::copysign(whole.by_u * flat.by_v, p.y),
                 std::copysign(whole.by_v, p.z)}};
    }
};

Gauge gauge_of(const Superellipsoid& s) { return {2 / s.east_west, 2 / s.north_south}; }

// Where the body is hollow (an exponent above 2): by halving a stretch in which no coordinate changes its
// sign, as long as rounding lets it, where bounds of the function do not rule a zero out.
struct HollowSearch {
    Gauge gauge;
    Vec3 o, d;

    double value(double t) const { return gauge.value(o + t * d) - 1; }
    // The function grows with each coordinate's size, so that the box around a stretch of the ray bounds it.
    bool may_be_zero(double t0, double t1) const {
        const Vec3 p = glm::abs(o + t0 * d), q = glm::abs(o + t1 * d);
        return gauge.value(glm::min(p, q)) <= 1 && gauge.value(glm::max(p, q)) >= 1;
    }
    template <class Add>
    void search(double t0, double t1, double f0, double f1, int depth, const Add& add) const {
        if (!may_be_zero(t0, t1)) return;
        if (depth == 0) {
            if ((f0 < 0) != (f1 < 0)) add(close_in(t0, t1, f0, f1));
            return;
        }
        const double middle = 0.5 * (t0 + t1), f = value(middle);
        search(t0, middle, f0, f, depth - 1, add);
        search(middle, t1, f, f1, depth - 1, add);
    }
    double close_in(double t0, double t1, double f0,
                    double f1) const { // false position, the kept end's value halved
        for (int step = 0; step < 60 && t1 - t0 > 0x1p-50; ++step) {
            double t = t0 + (t1 - t0) * (f0 / (f0 - f1));
            if (!(t > t0 && t < t1) || step % 4 == 3) t = 0.5 * (t0 + t1);
            const double f = value(t);
            if (f == 0) return t;
            if ((f < 0) == (f0 < 0))
                t0 = t, f0 = f, f1 *= 0.5;
            else
                t1 = t, f1 = f, f0 *= 0.5;
        }
        return 0.5 * (t0 + t1);
    }
};

} // namespace

Bounds bounds_of(const Superellipsoid&) { return {Vec3(-1), Vec3(1)}; }

void intersect(const Superellipsoid& s, const Ray& ray, HitList& hits) {
    Span span; // a little more than the body, so that its faces are met from outside
    span.cut(ray.origin, ray.direction, {Vec3(-1.001), Vec3(1.001)});
    if (span.empty() || !std::isfinite(span.enter)) return;
    const double shift = span.enter;
    const Vec3 o = ray.origin + shift * ray.direction, d = ray.direction;
    const Gauge gauge = gauge_of(s);
    const auto add = [&](double t) {
        add_hit(hits, ray, t + shift, gauge.at(o + t * d).gradient, Vec2(0), 1e-14);
    };
    const double length = span.leave - span.enter;
    if (s.east_west <= 2 && s.north_south <= 2) {
        const auto f = [&](double t) {
            const auto [value, gradient] = gauge.at(o + t * d);
            return ValueAndSlope{value - 1, glm::dot(gradient, d)};
        };
        return meet_convex(f, {0, length}, add);
    }
    double ends[5] = {0, length, length, length, length};
    for (int k = 0; k < 3; ++k)
        if (const double t = -o[k] / d[k]; t > 0 && t < length) ends[k + 1] = t;
    std::sort(ends, ends + 5);
    const HollowSearch search{gauge, o, d};
    for (int i = 0; i < 4; ++i)
        if (ends[i] < ends[i + 1])
            search.search(ends[i], ends[i + 1], search.value(ends[i]), search.value(ends[i + 1]), 6, add);
}

bool is_inside(const Superellipsoid& s, Vec3 p) { return gauge_of(s).value(p) <= 1; }

// ---- ovus
// ----------------------------------------------------------------------------------------------------------

namespace {

// In the half plane (r, y): two circles about the axis and an arc that touches both from around, centre
// (-far, height).
struct Egg {
    double bottom, top, arc, far, height;
    bool ball; // one holds the other
};

// As POV-Ray has it: the arc's radius is twice the greater ball's.
Egg egg_of(const Ovus& s) {
    Egg egg{s.bottom, s.top, 2 * std::max(s.bottom, s.top), 0, 0, s.top >= 2 * s.bottom};
    // Its centre is arc - bottom away from <0, 0> and arc - top from <0, bottom>.
    const double a = egg.arc - s.bottom, b = egg.arc - s.top;
    egg.height = (a * a - b * b + s.bottom * s.bottom) / (2 * s.bottom);
    egg.far = std::sqrt(std::max(0.0, a * a - egg.height * egg.height));
    return egg;
}

// The distance to the surface, negative inside, and where it grows.
struct EggDistance {
    double value;
    Vec3 outwards;
};

EggDistance egg_distance(const Egg& egg, Vec3 p) {
    const double r = std::hypot(p.x, p.z);
    const auto ball = [&](double center, double radius) {
        const Vec3 from = p - Vec3(0, center, 0);
        const double length = glm::length(from);
        return EggDistance{length - radius, length > 0 ? from / length : Vec3(0, 1, 0)};
    };
    if (egg.ball) return ball(egg.bottom, egg.top);
    // Which arc is nearest: by the side of the lines from the arc's centre through the balls' centres.
    const Vec2 from(r + egg.far, p.y - egg.height);
    const double below = from.x * (0 - egg.height) - from.y * egg.far,
                 above = from.x * (egg.bottom - egg.height) - from.y * egg.far;
    if (below > 0) return ball(0, egg.bottom);
    if (above < 0) return ball(egg.bottom, egg.top);
    const double length = glm::length(from);
    const Vec2 n = from / length;
    return {length - egg.arc, r > 0 ? Vec3(n.x * p.x / r, n.y, n.x * p.z / r) : Vec3(n.x, n.y, 0)};
}

} // namespace

Bounds bounds_of(const Ovus& s) {
    const Egg egg = egg_of(s);
    const double high = s.bottom + s.top;
    if (egg.ball) return {{-s.top, s.bottom - s.top, -s.top}, {s.top, high, s.top}};
    double widest = std::max(s.bottom, s.top);
    if (egg.height >= 0 && egg.height <= s.bottom) widest = egg.arc - egg.far;
    return {{-widest, -s.bottom, -widest}, {widest, high, widest}};
}

void intersect(const Ovus& s, const Ray& ray, HitList& hits) {
    const Egg egg = egg_of(s);
    const Bounds box = bounds_of(s);
    const double size = glm::length(box.high - box.low);
    Span span;
    span.cut(ray.origin, ray.direction, {box.low - 1e-3 * size, box.high + 1e-3 * size});
    if (span.empty() || !std::isfinite(span.enter)) return;
    const double shift = span.enter;
    const Vec3 o = ray.origin + shift * ray.direction, d = ray.direction;
    const auto f = [&](double t) {
        const EggDistance at = egg_distance(egg, o + t * d);
        return ValueAndSlope{at.value, glm::dot(at.outwards, d)};
    };
    const double middle = 0.5 * (box.low.y + box.high.y); // texture coordinates are angles as seen from there
    meet_convex(f, {0, span.leave - span.enter}, [&](double t) {
        const Vec3 p = o + t * d;
        const Vec2 uv(turn_about_y(p.x, p.z), 0.5 + std::atan2(p.y - middle, std::hypot(p.x, p.z)) / pi);
        add_hit(hits, ray, t + shift, egg_distance(egg, p).outwards, uv, 1e-14 * size);
    });
}

bool is_inside(const Ovus& s, Vec3 p) { return egg_distance(egg_of(s), p).value <= 0; }

} // namespace pnr
