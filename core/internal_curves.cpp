// SPDX-License-Identifier: GPL-3.0-or-later
// Plane curves that are drawn out along z or turned about y, and tubes with POV-Ray's cross sections.
#include "core/internal_functions_impl.h"

#include <algorithm>
#include <numbers>

namespace pnr {

namespace {

constexpr double degree = std::numbers::pi / 180;

double limited(double value) { return std::clamp(value, -10.0, 10.0); }

struct PlanePoint {
    double x, y;
};

PlanePoint turned(PlanePoint p, double degrees) {
    const double c = std::cos(degrees * degree), s = std::sin(degrees * degree);
    return {p.x * c - p.y * s, p.x * s + p.y * c};
}

// Where the curve is asked. `turn` are the three arguments that most of these functions end with: switch,
// offset, angle. Switched on, the curve is moved out from the y axis, turned in its plane and then about y.
PlanePoint plane_point(const double* a, const double* turn) {
    if (!(turn[0] > 0)) return {a[0], a[1]};
    return turned({std::hypot(a[0], a[2]) - turn[1], a[1]}, turn[2]);
}

// The limit is the function's own; POV-Ray takes it as it is, negative ones too.
double within(double value, double limit) { return std::min(std::max(value, -limit), limit); }

// The distance from the middle of a cross section: 0 square, 1 round, 2 diamond, between and beyond them
// superellipses.
double cross_section(PlanePoint p, double type, double angle) {
    if (type == 1) return std::hypot(p.x, p.y);
    p = turned(p, angle);
    const double x = std::abs(p.x), y = std::abs(p.y);
    if (type == 0) return std::max(x, y);
    return std::pow(std::pow(x, 2 / type) + std::pow(y, 2 / type), type * 0.5);
}

} // namespace

double curve_algbr_cyl1(const double* a) {
    const auto [x, y] = plane_point(a, a + 5);
    return std::max(std::min(a[3] * (sqr(x) * (std::abs(x) - 1) + sqr(y)), a[4]), -a[4]);
}

double curve_algbr_cyl2(const double* a) {
    const auto [x, y] = plane_point(a, a + 5);
    const double x2 = x * x;
    return within(a[3] * (3 * x2 * y - 2 * x2 * x2 - sqr(y * (1 - y))), a[4]);
}

double curve_algbr_cyl3(const double* a) {
    const auto [x, y] = plane_point(a, a + 5);
    return within(a[3] * (x * y * y - sqr(x * x - y) - sqr(x * y)), a[4]);
}

double curve_algbr_cyl4(const double* a) {
    const auto [x, y] = plane_point(a, a + 5);
    return within(a[3] * (y * (y * y - 3 * x * x) - sqr(x * x + y * y)), a[4]);
}

double curve_devils_curve(const double* a) {
    const auto [x, y] = plane_point(a, a + 6);
    return limited(a[3] * (sqr(y) * (sqr(y) - sqr(a[5])) - sqr(x) * (sqr(x) - sqr(a[4]))));
}

double curve_folium(const double* a) {
    const auto [x, y] = plane_point(a, a + 6);
    return limited(-a[3] * (y * y * (1 + x * (a[5] - 4 * a[4])) + x * x * (1 + a[5])));
}

double curve_kampyle_of_eudoxus(const double* a) {
    const auto [x, y] = plane_point(a, a + 6);
    const double x2 = x * x;
    return limited(a[3] * (sqr(a[5]) * x2 * (x2 - a[4] * a[5]) - y * y));
}

double curve_lemniscate_of_gerono(const double* a) {
    const auto [x, y] = plane_point(a, a + 6);
    const double x2 = x * x;
    return limited(a[3] * (sqr(a[5]) * x2 * (sqr(a[4]) - x2) - y * y));
}

double curve_piriform(const double* a) {
    const auto [x, y] = plane_point(a, a + 7);
    return limited(a[3] * (sqr(a[6]) * cube(x) * (a[4] + x * a[5]) - y * y));
}

double curve_strophoid(const double* a) {
    const auto [x, y] = plane_point(a, a + 7);
    return limited(a[3] * (y * y * (x - a[5]) + sqr(a[6] * x) * (x + a[4])));
}

double curve_witch_of_agnesi(const double* a) {
    const auto [x, y] = plane_point(a, a + 6);
    return limited(a[3] * (a[5] - y * (x * x + sqr(a[4]))));
}

// `count` tubes that wind about y: a[4] period, a[5] minor, a[6] major radius, a[7] how much fatter along y.
double curve_helix1(const double* a) {
    constexpr double turn = 2 * std::numbers::pi;
    const double r = std::hypot(a[0], a[2]), count = a[3], period = a[4];
    const double x = a[0] == 0 && a[2] == 0 ? 1e-6 : a[0];
    double angle = std::fmod((std::atan2(a[2], x) + a[1] * period) * count, turn);
    if (angle < 0) angle += turn;
    const double along = (angle - std::numbers::pi) / period / (a[7] * count);
    return std::min(cross_section({r - a[6], along}, a[8], a[9]), r + a[6]) - a[5];
}

// One tube that is a plane figure moved round; its cross section turns with it, and a[9] does nothing.
double curve_helix2(const double* a) {
    const double angle = a[1] * a[4];
    const PlanePoint p{a[0] - a[6] * std::cos(angle), a[2] - a[6] * std::sin(angle)};
    return cross_section(p, a[8], -angle / degree) - a[5];
}

// A tube that winds out in the plane y = 0, a[3] from turn to turn, to the sphere of radius a[5].
double curve_spiral(const double* a) {
    const double x = a[0] == 0 && a[2] == 0 ? 1e-6 : a[0];
    const double r = std::hypot(x, a[2]), step = a[3];
    const double turns = 0.5 - std::atan2(a[2], x) / (2 * std::numbers::pi);
    const double off = std::abs(std::remainder(r - turns * step, step));
    const double far = std::sqrt(r * r + a[1] * a[1]);
    return std::max(std::min(cross_section({off, a[1]}, a[8], 0), far) - a[4], far - a[5]);
}

} // namespace pnr
