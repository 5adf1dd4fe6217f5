// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps of a ball: one that moves and changes its size along a spline.
//
// On the unit ray o + t d, the ball at s is met between c(s) - sqrt(h(s)) and c(s) + sqrt(h(s)), c the place
// of its centre along the ray and h its radius squared less the centre's distance from the ray squared. Over
// a stretch of s where h >= 0 these intervals hang together, so that their union reaches from the least lower
// end to the greatest upper end. Stretches are found by the roots of h; the least end by samples, and the
// slope between them; no polynomial of degree ten is solved.
#include "core/polynomial.h"
#include "core/shape_impl.h"
#include "core/shape_swept.h"

#include <algorithm>
#include <stdexcept>

namespace pnr {

namespace {

// In Bernstein form, `degree` 1 or 3.
struct SweptPiece {
    int degree = 3;
    std::array<Vec3, 4> centers{};
    std::array<double, 4> radii{};
    std::array<double, 7> radius2{}; // of degree 2 degree
    Bounds bounds;
};

} // namespace

struct SphereSweepData {
    std::vector<SweptPiece> pieces;
    Bounds bounds;
};

namespace {

template <std::size_t N>
std::span<const double> form(const std::array<double, N>& b, int degree) {
    return {b.data(), static_cast<std::size_t>(degree) + 1};
}

SweptPiece make_piece(int degree, const std::array<SweepPoint, 4>& points) {
    SweptPiece piece;
    piece.degree = degree;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
        piece.centers[i] = points[i].center;
        piece.radii[i] = points[i].radius;
        const double radius = std::abs(points[i].radius);
        piece.bounds = merge(piece.bounds, Bounds{points[i].center - radius, points[i].center + radius});
    }
    bernstein_product(form(piece.radii, degree), form(piece.radii, degree), piece.radius2.data());
    return piece;
}

SweepPoint mix(const SweepPoint& a, double wa, const SweepPoint& b, double wb, const SweepPoint& c = {{}, 0},
               double wc = 0) {
    return {wa * a.center + wb * b.center + wc * c.center, wa * a.radius + wb * b.radius + wc * c.radius};
}

// ---- one piece on one ray
// ----------------------------------------------------------------------------------------------------

// c and h in Bernstein form.
struct OnRay {
    int degree = 3; // of c, half of h's
    std::array<double, 4> c{};
    std::array<double, 7> h{};
};

OnRay on_ray(const SweptPiece& piece, Vec3 o, Vec3 d) {
    OnRay part;
    part.degree = piece.degree;
    std::array<double, 4> across[3];
    for (std::size_t i = 0; i <= static_cast<std::size_t>(piece.degree); ++i) {
        const Vec3 from = piece.centers[i] - o;
        part.c[i] = glm::dot(from, d);
        const Vec3 away = from - part.c[i] * d;
        for (int k = 0; k < 3; ++k) across[k][i] = away[k];
    }
    part.h = piece.radius2;
    for (const auto& q : across) {
        std::array<double, 7> square;
        bernstein_product(form(q, piece.degree), form(q, piece.degree), square.data());
        for (std::size_t i = 0; i <= 2 * static_cast<std::size_t>(piece.degree); ++i) part.h[i] -= square[i];
    }
    return part;
}

template <std::size_t N>
void halve(const std::array<double, N>& b, int degree, std::array<double, N>& left,
           std::array<double, N>& right) {
    right = b;
    for (int k = 0; k <= degree; ++k) {
        left[static_cast<std::size_t>(k)] = right[0];
        for (int i = 0; i < degree - k; ++i)
            right[static_cast<std::size_t>(i)] =
                0.5 * (right[static_cast<std::size_t>(i)] + right[static_cast<std::size_t>(i) + 1]);
    }
}

// c - sqrt(h) at s, and a number with the sign of its slope; sign -1: of -c - sqrt(h).
struct End {
    double s, value, slope;
};

template <std::size_t N>
double slope_at(const std::array<double, N>& b, int degree, double s) {
    std::array<double, N> d{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(degree); ++i) d[i] = degree * (b[i + 1] - b[i]);
    return bernstein_value(form(d, degree - 1), s);
}

End end_at(const OnRay& r, double sign, double s) {
    const double h = std::max(0.0, bernstein_value(form(r.h, 2 * r.degree), s)), root = std::sqrt(h);
    return {s, sign * bernstein_value(form(r.c, r.degree), s) - root,
            2 * sign * slope_at(r.c, r.degree, s) * root - slope_at(r.h, 2 * r.degree, s)};
}

// From a falling slope at a to a rising one at b: where it is level. The value is flat there, so that half of
// the digits of s give it in full.
End level_between(const OnRay& r, double sign, End a, End b) {
    End best = a.value < b.value ? a : b;
    int kept = 0; // how often the same side was kept: then its slope counts half [Illinois method]
    for (int step = 0; step < 40 && b.s - a.s > 1e-9; ++step) {
        double s = a.s - a.slope * (b.s - a.s) / (b.slope - a.slope);
        if (!(s > a.s && s < b.s) || step % 4 == 3) s = 0.5 * (a.s + b.s);
        const End next = end_at(r, sign, s);
        if (next.value < best.value) best = next;
        const bool falls = next.slope < 0;
        (falls ? a : b) = next;
        if (step > 0 && kept == (falls ? 1 : -1)) (falls ? b : a).slope *= 0.5;
        kept = falls ? 1 : -1;
    }
    return best;
}

// The same between two balls: h is quadratic and c linear, so that the level place is known.
End least_of_cone(const OnRay& r, double sign, double low, double high) {
    const End a = end_at(r, sign, low), b = end_at(r, sign, high);
    End best = a.value < b.value ? a : b;
    // h = h0 + h1 s + h2 s^2; where sign c' = h' / (2 sqrt(h)): 4 h (c'^2 - h2) = h1^2 - 4 h0 h2.
    const double h0 = r.h[0], h1 = 2 * (r.h[1] - r.h[0]), h2 = r.h[2] - 2 * r.h[1] + r.h[0],
                 c1 = sign * (r.c[1] - r.c[0]);
    const double h = (h1 * h1 - 4 * h0 * h2) / (4 * (c1 * c1 - h2));
    if (!(h >= 0)) return best;
    const double s =
        std::abs(h2) > 1e-9 * std::abs(h1) ? (2 * c1 * std::sqrt(h) - h1) / (2 * h2) : (h - h0) / h1;
    if (!(s > low && s < high)) return best;
    const End level = end_at(r, sign, s);
    return level.value < best.value ? level : best;
}

// The least one on the stretch [low, high] of s, whose ends are roots of h or the piece's own. Samples are
// close together at the ends, where the square root is steep.
End least_end(const OnRay& r, double sign, double low, double high) {
    constexpr int count = 12;
    if (r.degree == 1) return least_of_cone(r, sign, low, high);
    End samples[count + 1];
    for (int i = 0; i <= count; ++i) {
        const double share = 0.5 - 0.5 * std::cos(pi * i / count);
        samples[i] = end_at(r, sign, i == count ? high : low + (high - low) * share);
    }
    End best = samples[0];
    for (int i = 0; i <= count; ++i) {
        if (samples[i].value < best.value) best = samples[i];
        const int before = i > 0 ? i - 1 : i, behind = i < count ? i + 1 : i;
        if (samples[before].value < samples[i].value || samples[behind].value < samples[i].value) continue;
        const bool falls = samples[i].slope < 0;
        const End& other = samples[falls ? behind : before];
        if (other.s == samples[i].s) continue; // it falls out of the stretch
        const End level =
            falls ? level_between(r, sign, samples[i], other) : level_between(r, sign, other, samples[i]);
        if (level.value < best.value) best = level;
    }
    return best;
}

struct SweptSpan {
    double enter, leave; // along the unit ray
    double s_enter, s_leave;
    const SweptPiece* piece_enter;
    const SweptPiece* piece_leave;
};
using SweptSpans = boost::container::small_vector<SweptSpan, 8>;

void add_spans(const SweptPiece& piece, Vec3 o, Vec3 d, SweptSpans& spans) {
    const OnRay r = on_ray(piece, o, d);
    const auto h = form(r.h, 2 * r.degree);
    if (std::all_of(h.begin(), h.end(), [](double x) { return x < 0; })) return;
    double ends[8];
    int count = 0;
    if (h.front() >= 0) ends[count++] = 0;
    count += bernstein_roots(h, ends + count);
    if (h.back() >= 0) ends[count++] = 1;
    for (int i = 0; i + 1 < count; i += 2) {
        const End enter = least_end(r, 1, ends[i], ends[i + 1]),
                  leave = least_end(r, -1, ends[i], ends[i + 1]);
        spans.push_back({enter.value, -leave.value, enter.s, leave.s, &piece, &piece});
    }
}

Vec3 center_at(const SweptPiece& piece, double s) {
    Vec3 center(0);
    for (int k = 0; k < 3; ++k) {
        std::array<double, 4> b{};
        for (std::size_t i = 0; i < 4; ++i) b[i] = piece.centers[i][k];
        center[k] = bernstein_value(form(b, piece.degree), s);
    }
    return center;
}

// Whether the polynomial is >= 0 anywhere on [0, 1].
bool reaches_zero(const std::array<double, 7>& h, int degree, int depth) {
    if (h[0] >= 0 || h[static_cast<std::size_t>(degree)] >= 0) return true;
    const auto b = form(h, degree);
    if (depth == 0 || std::all_of(b.begin(), b.end(), [](double x) { return x < 0; })) return false;
    std::array<double, 7> left, right;
    halve(h, degree, left, right);
    return reaches_zero(left, degree, depth - 1) || reaches_zero(right, degree, depth - 1);
}

} // namespace

Shape make_sphere_sweep(SweepKind kind, std::span<const SweepPoint> points) {
    const bool linear = kind == SweepKind::linear;
    if (points.size() < (linear ? 2 : 4))
        throw std::invalid_argument(linear ? "a linear sphere_sweep needs at least 2 spheres"
                                           : "a sphere_sweep along a spline needs at least 4 spheres");
    auto sweep = std::make_shared<SphereSweepData>();
    const std::size_t used = linear ? 2 : 4;
    for (std::size_t i = 0; i + used <= points.size(); ++i) {
        const SweepPoint* p = &points[i];
        if (linear)
            sweep->pieces.push_back(make_piece(1, {p[0], p[1]}));
        else if (kind == SweepKind::cubic) // Catmull and Rom's
            sweep->pieces.push_back(make_piece(3, {p[1], mix(p[1], 1, p[2], 1 / 6.0, p[0], -1 / 6.0),
                                                   mix(p[2], 1, p[1], 1 / 6.0, p[3], -1 / 6.0), p[2]}));
        else
            sweep->pieces.push_back(make_piece(
                3, {mix(p[0], 1 / 6.0, p[1], 4 / 6.0, p[2], 1 / 6.0), mix(p[1], 2 / 3.0, p[2], 1 / 3.0),
                    mix(p[1], 1 / 3.0, p[2], 2 / 3.0), mix(p[1], 1 / 6.0, p[2], 4 / 6.0, p[3], 1 / 6.0)}));
        sweep->bounds = merge(sweep->bounds, sweep->pieces.back().bounds);
    }
    return SphereSweep{std::move(sweep)};
}

Bounds bounds_of(const SphereSweep& s) { return s.data->bounds; }

void intersect(const SphereSweep& s, const Ray& ray, HitList& hits) {
    const double speed = glm::length(ray.direction);
    const Vec3 d = ray.direction / speed;
    const Bounds& all = s.data->bounds;
    const double shift = glm::dot(0.5 * (all.low + all.high) - ray.origin, d);
    const Vec3 o = ray.origin + shift * d;
    SweptSpans spans;
    for (const SweptPiece& piece : s.data->pieces) {
        Span near;
        near.cut(o, d, piece.bounds);
        if (!near.empty()) add_spans(piece, o, d, spans);
    }
    std::sort(spans.begin(), spans.end(),
              [](const SweptSpan& a, const SweptSpan& b) { return a.enter < b.enter; });
    const double size = glm::length(all.high - all.low);
    const auto add = [&](double t, double at, const SweptPiece& piece) {
        add_hit(hits, ray, (t + shift) / speed, o + t * d - center_at(piece, at), Vec2(0), 0x1p-44 * size);
    };
    for (std::size_t i = 0, next = 0; i < spans.size(); i = next) { // what overlaps is one
        SweptSpan whole = spans[i];
        for (next = i + 1; next < spans.size() && spans[next].enter <= whole.leave; ++next)
            if (spans[next].leave > whole.leave)
                whole.leave = spans[next].leave, whole.s_leave = spans[next].s_leave,
                whole.piece_leave = spans[next].piece_leave;
        add(whole.enter, whole.s_enter, *whole.piece_enter);
        add(whole.leave, whole.s_leave, *whole.piece_leave);
    }
}

bool is_inside(const SphereSweep& s, Vec3 p) {
    return std::any_of(s.data->pieces.begin(), s.data->pieces.end(), [&](const SweptPiece& piece) {
        if (glm::any(glm::lessThan(p, piece.bounds.low)) || glm::any(glm::greaterThan(p, piece.bounds.high)))
            return false;
        std::array<double, 7> h = piece.radius2;
        for (int k = 0; k < 3; ++k) {
            std::array<double, 4> q{};
            for (std::size_t i = 0; i < 4; ++i) q[i] = piece.centers[i][k] - p[k];
            std::array<double, 7> square;
            bernstein_product(form(q, piece.degree), form(q, piece.degree), square.data());
            for (std::size_t i = 0; i <= 2 * static_cast<std::size_t>(piece.degree); ++i) h[i] -= square[i];
        }
        return reaches_zero(h, 2 * piece.degree, 30);
    });
}

} // namespace pnr
