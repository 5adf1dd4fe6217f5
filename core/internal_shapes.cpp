// SPDX-License-Identifier: GPL-3.0-or-later
// Internal functions that are distances, densities and combinations of them.
#include "core/internal_functions_impl.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace pnr {

namespace {

constexpr double turn = 2 * std::numbers::pi;

double radius2(const double* a) { return sqr(a[0]) + sqr(a[1]) + sqr(a[2]); }

// POV-Ray lets it end at -5.
double polynomial(const double* c, double y) {
    return std::max(c[0] + y * (c[1] + y * (c[2] + y * (c[3] + y * c[4]))), -5.0);
}

// Of the three ellipsoids about the axes.
std::array<double, 3> ellipsoid_densities(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]), e = a[3];
    return {std::exp(-a[4] * (x2 + e * (y2 + z2))), std::exp(-a[4] * (y2 + e * (x2 + z2))),
            std::exp(-a[4] * (z2 + e * (x2 + y2)))};
}

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
    const auto densities = ellipsoid_densities(a);
    return a[6] - a[5] * *std::max_element(densities.begin(), densities.end());
}

double shape_isect_ellipsoids(const double* a) {
    const auto densities = ellipsoid_densities(a);
    return a[6] - a[5] * *std::min_element(densities.begin(), densities.end());
}

double shape_ph(const double* a) {
    const double ring = std::hypot(a[0], a[2]);
    return ring == 0 && a[1] == 0 ? 0 : std::atan2(ring, a[1]);
}

double shape_th(const double* a) { return a[0] == 0 && a[2] == 0 ? 0 : std::atan2(a[0], a[2]); }

double shape_r(const double* a) { return std::sqrt(radius2(a)); }

double shape_poly4(const double* a) { return std::hypot(a[0], a[2]) - polynomial(a + 3, a[1]); }

// Lines along y in the middle of so many equal sectors, as far from the axis as the polynomial says.
double shape_polytubes(const double* a) {
    if (a[3] == 0) return 10000;
    const double r = std::hypot(a[0], a[2]);
    const double angle = r == 0 ? 0 : std::remainder(std::atan2(a[0], a[2]), turn / a[3]);
    return std::hypot(r * std::cos(angle) - polynomial(a + 4, a[1]), r * std::sin(angle));
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
