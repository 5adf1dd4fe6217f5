// SPDX-License-Identifier: GPL-3.0-or-later
// Internal functions that are distances, densities and combinations of them.
#include "core/internal_functions_impl.h"

#include <algorithm>
#include <numbers>

namespace pnr {

namespace {

constexpr double turn = 2 * std::numbers::pi;

double radius2(const double* a) { return sqr(a[0]) + sqr(a[1]) + sqr(a[2]); }

double polynomial(const double* c, double y) { return c[0] + y * (c[1] + y * (c[2] + y * (c[3] + y * c[4]))); }

} // namespace

// Two components, at x = +-distance / 2.
double shape_blob(const double* a) {
    const double ring = sqr(a[1]) + sqr(a[2]);
    const double first = 1 - (sqr(a[0] + a[3] / 2) + ring) * sqr(a[5]);
    const double second = 1 - (sqr(a[0] - a[3] / 2) + ring) * sqr(a[7]);
    return -(first > 0 ? a[4] * sqr(first) : 0) - (second > 0 ? a[6] * sqr(second) : 0);
}

double shape_blob2(const double* a) {
    const double ring = sqr(a[1]) + sqr(a[2]);
    const double first = std::exp(-(sqr(a[0]) + ring) * a[4]);
    const double second = std::exp(-(sqr(a[0] - a[3]) + ring) * a[4]);
    return a[6] - a[5] * (first + second);
}

double shape_ellipsoid(const double* a) {
    return std::sqrt(sqr(a[0] * a[3]) + sqr(a[1] * a[4]) + sqr(a[2] * a[5]));
}

double shape_cross_ellipsoids(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]), e2 = sqr(a[3]);
    const double nearest = std::min({x2 * e2 + y2 + z2, x2 + y2 * e2 + z2, x2 + y2 + z2 * e2});
    return a[6] - a[5] * std::exp(-nearest * a[4]);
}

double shape_isect_ellipsoids(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]), e2 = sqr(a[3]);
    const double farthest = std::max({x2 * e2 + y2 + z2, x2 + y2 * e2 + z2, x2 + y2 + z2 * e2});
    return a[6] - a[5] * std::exp(-farthest * a[4]);
}

double shape_ph(const double* a) {
    const double ring = std::hypot(a[0], a[2]);
    return ring == 0 && a[1] == 0 ? 0 : std::atan2(ring, a[1]);
}

double shape_th(const double* a) { return a[0] == 0 && a[2] == 0 ? 0 : std::atan2(a[0], a[2]); }

double shape_r(const double* a) { return std::sqrt(radius2(a)); }

double shape_poly4(const double* a) { return std::hypot(a[0], a[2]) - polynomial(a + 3, a[1]); }

// Tubes about y, one in each of so many equal sectors.
double shape_polytubes(const double* a) {
    const double r = std::hypot(a[0], a[2]), sector = turn / a[3];
    double angle = std::atan2(a[0] == 0 && a[2] == 0 ? 1e-6 : a[0], a[2]);
    angle = std::fmod(angle, sector);
    if (angle < 0) angle += sector;
    angle -= sector / 2;
    return std::hypot(r * std::cos(angle) - 1, r * std::sin(angle)) - polynomial(a + 4, a[1]);
}

double shape_rounded_box(const double* a) {
    const auto beyond = [&](int axis) {
        return std::max(std::abs(a[axis]) - (a[4 + axis] - a[3]), 0.0);
    };
    return std::sqrt(sqr(beyond(0)) + sqr(beyond(1)) + sqr(beyond(2))) - a[3] - 1e-6;
}

double shape_sphere(const double* a) { return shape_r(a) - a[3]; }

double shape_spikes_2d(const double* a) {
    return a[1] -
           a[3] * std::cos(a[4] * a[0]) * std::cos(a[5] * a[2]) * std::exp(-a[6] * (sqr(a[0]) + sqr(a[2])));
}

double shape_superellipsoid(const double* a) {
    const double ring = std::pow(std::abs(a[0]), 2 / a[3]) + std::pow(std::abs(a[1]), 2 / a[3]);
    return 1 - std::pow(std::pow(ring, a[3] / a[4]) + std::pow(std::abs(a[2]), 2 / a[4]), a[4] * 0.5);
}

double shape_torus(const double* a) { return std::hypot(std::hypot(a[0], a[2]) - a[3], a[1]) - a[4]; }

} // namespace pnr
