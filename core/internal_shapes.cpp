// SPDX-License-Identifier: GPL-3.0-or-later
// Internal functions that are distances, densities and combinations of them.
#include "core/internal_functions_impl.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace pnr {

namespace {

constexpr double turn = 2 * std::numbers::pi;

double radius2(const double* a) { return sqr(a[0]) + sqr(a[1]) + sqr(a[2]); }

double polynomial(const double* c, double y) {
    return c[0] + y * (c[1] + y * (c[2] + y * (c[3] + y * c[4])));
}

// Of three ellipsoids about the axes, with so much of the squares across them.
std::array<double, 3> ellipsoid_densities(const double* a, double e, double strength) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return {std::exp(-strength * (x2 + e * (y2 + z2))), std::exp(-strength * (y2 + e * (x2 + z2))),
            std::exp(-strength * (z2 + e * (x2 + y2)))};
}

// Where the point lies in its cell of a honeycomb whose sides are 1 and whose neighbours lie sqrt(3) apart
// along x: how far towards the nearest neighbour, and how far beside that line.
std::array<double, 2> honeycomb(double x, double y) {
    const double across = std::numbers::sqrt3, up = 3;
    double px = std::remainder(x, across), py = std::remainder(y, up);
    const double qx = std::remainder(x - across / 2, across), qy = std::remainder(y - up / 2, up);
    if (qx * qx + qy * qy < px * px + py * py) px = qx, py = qy;
    px = std::abs(px), py = std::abs(py);
    const double towards = px / 2 + py * across / 2;
    if (towards <= px) return {px, py};
    return {towards, std::abs(px * across / 2 - py / 2)};
}

double total_density(const double* a) {
    const auto densities = ellipsoid_densities(a, a[3], a[4]);
    return densities[0] + densities[1] + densities[2];
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

double shape_flange_cover(const double* a) { return a[6] - a[5] * total_density(a); }

double shape_spikes(const double* a) {
    return a[5] * (total_density(a) - a[7] * std::exp(-a[6] * radius2(a)));
}

double shape_cross_ellipsoids(const double* a) {
    const auto densities = ellipsoid_densities(a, a[3], a[4]);
    return a[6] - a[5] * *std::max_element(densities.begin(), densities.end());
}

double shape_isect_ellipsoids(const double* a) {
    const auto densities = ellipsoid_densities(a, a[3], a[4]);
    return a[6] - a[5] * *std::min_element(densities.begin(), densities.end());
}

double shape_hex_x(const double* a) { return honeycomb(a[0], a[1])[0]; }
double shape_hex_y(const double* a) { return honeycomb(a[0], a[1])[1]; }

// Threads along x and along z that weave over and under each other: the two nearest of either count.
double shape_mesh1(const double* a) {
    const double step_x = a[3], step_z = a[4], thin = a[5], wave = a[6], thin_y = a[7];
    const double u = a[0] / step_x, v = a[2] / step_z;
    double nearest = std::numeric_limits<double>::infinity();
    for (const int next : {0, 1}) {
        const double column = std::floor(u) + next, row = std::floor(v) + next;
        const double along_x = wave * std::cos(std::numbers::pi * (u + row));
        const double along_z = -wave * std::cos(std::numbers::pi * (v + column));
        nearest = std::min({nearest, std::hypot((v - row) * step_z * thin, (a[1] - along_x) * thin_y),
                            std::hypot((u - column) * step_x * thin, (a[1] - along_z) * thin_y)});
    }
    return nearest;
}

// The density of an electron in a d orbital.
double shape_quantum(const double* a) {
    const double lobes = 2 * sqr(a[1]) - sqr(a[0]) - sqr(a[2]);
    return 1.2 - 1.6 * sqr(lobes) * std::exp(-4 * shape_r(a) / 3);
}

// A tube wound round a torus: a[3] major radius, a[4] windings, a[5] how far each goes on round the small
// circle, a[6] thickness, a[7] threshold, a[8] radius of the small circle, a[9] how fast the tube ends along
// it; grooves in the tube: a[10] across, of steepness a[11], and a[12] along.
double shape_helical_torus(const double* a) {
    const double r = std::hypot(a[0], a[2]), out = r - a[3], far = std::hypot(out, a[1]);
    const double along = r == 0 ? 0 : std::atan2(a[0], a[2]);
    const double round = far == 0 ? 0 : std::atan2(out, a[1]);
    const double off = std::remainder(a[4] * along + a[5] * round - std::numbers::pi, turn), up = far - a[8];
    const double distance = std::min(std::sqrt(up * up + a[9] * off * off), far + a[8]);
    const double groove = std::cos(a[12] * along + a[10] * std::atan2(a[11] * off, up));
    return std::min(distance - a[7] - a[6] * groove, r + a[3] - a[8]);
}

double shape_ph(const double* a) {
    const double ring = std::hypot(a[0], a[2]);
    return ring == 0 && a[1] == 0 ? 0 : std::atan2(ring, a[1]);
}

double shape_th(const double* a) { return a[0] == 0 && a[2] == 0 ? 0 : std::atan2(a[0], a[2]); }

double shape_r(const double* a) { return std::sqrt(radius2(a)); }

// The polynomial's value ends at -5.
double shape_poly4(const double* a) {
    return std::hypot(a[0], a[2]) - std::max(polynomial(a + 3, a[1]), -5.0);
}

// So many lines about y, as far from the axis as the polynomial says; if it is negative, on the other side.
double shape_polytubes(const double* a) {
    if (a[3] == 0) return 10000;
    const double r = std::hypot(a[0], a[2]), away = polynomial(a + 4, a[1]);
    const double direction = r == 0 ? 0 : std::atan2(a[0], a[2]);
    const double angle = std::remainder(away < 0 ? direction + turn / 2 : direction, turn / a[3]);
    return std::hypot(r * std::cos(angle) - std::abs(away), r * std::sin(angle));
}

double shape_rounded_box(const double* a) {
    const auto beyond = [&](int axis) { return std::max(std::abs(a[axis]) - (a[4 + axis] - a[3]), 0.0); };
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
