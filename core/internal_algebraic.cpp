// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that are zeros of a polynomial. The polynomials are those of POV-Ray's functions, found by fitting
// values that it prints; many are named after the curves and surfaces in [Lawrence 1972].
#include "core/internal_functions_impl.h"

#include <algorithm>

namespace pnr {

namespace {

// Far from the surface POV-Ray lets the values end at 10, so that gradients stay small.
double limited(double value) { return std::clamp(value, -10.0, 10.0); }

// A torus of which `height` bends the third square: +z^2 gives the round one. All are squares, but the
// height.
double bent_torus(double x2, double y2, double height, double factor, double major, double minor) {
    return -sqr(x2 + y2 + height) + factor * (major + minor) * (x2 + height) + factor * (minor - major) * y2 -
           sqr(major - minor);
}

} // namespace

double algebraic_bicorn(const double* a) {
    const double y = a[1], ring = sqr(a[0]) + sqr(a[2]), p = a[4];
    return limited(a[3] * (y * y * (p * p - ring) - sqr(ring + 2 * p * y - p * p)));
}

double algebraic_bifolia(const double* a) {
    const double ring = sqr(a[0]) + sqr(a[2]);
    return limited(a[3] * (a[4] * ring * a[1] - sqr(ring + sqr(a[1]))));
}

// Boy's surface after F. Apery.
double algebraic_boy_surface(const double* a) {
    constexpr double root2 = 1.4142135623730951;
    const double x = a[0], y = a[1], z = a[2];
    const double x2 = x * x, y2 = y * y, z2 = z * z, ring = x2 + y2;
    const double w = 1 - z;
    const double value =
        64 * cube(w) * cube(z) - 48 * sqr(w) * z2 * (3 * ring + 2 * z2) +
        12 * w * z * (27 * ring * ring - 24 * z2 * ring + 36 * root2 * y * z * (y2 - 3 * x2) + 4 * z2 * z2) +
        (9 * ring - 2 * z2) *
            (-81 * ring * ring - 72 * z2 * ring + 108 * root2 * x * z * (x2 - 3 * y2) + 4 * z2 * z2);
    return limited(a[3] * a[4] * value);
}

double algebraic_crossed_trough(const double* a) { return limited(a[3] * (sqr(a[0] * a[2]) - a[1])); }

double algebraic_cubic_saddle(const double* a) { return limited(a[3] * (cube(a[1]) - cube(a[0]) + a[2])); }

double algebraic_cushion(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z = a[2], z2 = z * z;
    return limited(a[3] * (x2 * z2 - z2 * z2 - 2 * x2 * z + 2 * z2 * z + x2 - z2 - sqr(x2 - z) - y2 * y2 -
                           2 * x2 * y2 - y2 * z2 + 2 * y2 * z + y2));
}

double algebraic_devils_curve(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(a[3] * (y2 * (y2 - 0.25) - sqr(x2 + z2) + 0.36 * x2));
}

// A torus turned inside out in a sphere.
double algebraic_dupin_cyclid(const double* a) {
    const double x = a[0], y = a[1], z = a[2];
    const double major2 = sqr(a[4]), minor2 = sqr(a[5]), along = a[6], up = a[7], inversion2 = sqr(a[8]);
    const double far2 = x * x + y * y + z * z;
    const double px = x * inversion2 - along * far2, pz = z * inversion2;
    // |p|^2 / |q|^2; where it meets the radii POV-Ray counts `up` the other way round
    const double even = sqr(inversion2) - 2 * inversion2 * along * x + (sqr(along) + sqr(up)) * far2;
    const double odd = 2 * inversion2 * up * y, radii = (major2 - minor2) * far2;
    return limited(
        -a[3] * (sqr(even - odd) + 2 * radii * (even + odd) + sqr(radii) - 4 * major2 * (px * px + pz * pz)));
}

// POV-Ray's own variant of Enneper's surface: near z = 0 it stays as it is at 0.2.
double algebraic_enneper(const double* a) {
    const double z = std::abs(a[2]) < 0.2 ? 0.2 : a[2];
    const double bend = (sqr(a[1]) - sqr(a[0])) / z;
    return limited(-a[3] * (cube(bend / 2 + 2 * sqr(a[2]) / 9) - 6 * sqr(bend / 4)));
}

double algebraic_folium_surface(const double* a) {
    const double x = a[0], ring = sqr(a[1]) + sqr(a[2]);
    return limited(a[3] * (ring * (1 + x * (a[5] - 4 * a[4])) + x * x * (1 + a[5])));
}

double algebraic_glob(const double* a) {
    const double x4 = sqr(sqr(a[0]));
    return limited(a[3] * (0.5 * x4 * a[0] + 0.5 * x4 - sqr(a[1]) - sqr(a[2])));
}

double algebraic_heart(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]), z3 = z2 * a[2];
    return limited(-a[3] * (cube(2 * x2 + y2 + z2 - 1) - 0.1 * x2 * z3 - y2 * z3));
}

double algebraic_hunt_surface(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (4 * cube(x2 + y2 + z2 - 13) + 27 * sqr(3 * x2 + y2 - 4 * z2 - 12)));
}

double algebraic_hyperbolic_torus(const double* a) {
    return limited(a[3] * bent_torus(sqr(a[0]), sqr(a[1]), -sqr(a[2]), 2, sqr(a[4]), sqr(a[5])));
}

double algebraic_kampyle_of_eudoxus(const double* a) {
    const double x2 = sqr(a[0]);
    return limited(a[3] * (sqr(a[5]) * (x2 * x2 - sqr(a[4]) * x2) - sqr(a[1]) - sqr(a[2])));
}

double algebraic_klein_bottle(const double* a) {
    const double x = a[0], y = a[1], z = a[2], r2 = x * x + y * y + z * z;
    return limited(-a[3] *
                   ((r2 + 2 * y - 1) * (sqr(r2 - 2 * y - 1) - 8 * z * z) + 16 * x * z * (r2 - 2 * y - 1)));
}

double algebraic_kummer_surface_v1(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (x2 * x2 + y2 * y2 + z2 * z2 - x2 - y2 - z2 - x2 * y2 - y2 * z2 - z2 * x2 + 1));
}

double algebraic_kummer_surface_v2(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (x2 * x2 + y2 * y2 + z2 * z2 - 1 + a[4] * (x2 + y2 + z2) +
                            a[5] * (x2 * y2 + x2 * z2 + y2 * z2) + a[6] * a[0] * a[1] * a[2]));
}

double algebraic_lemniscate_of_gerono(const double* a) {
    const double x2 = sqr(a[0]);
    return limited(a[3] * (x2 - x2 * x2 - sqr(a[1]) - sqr(a[2])));
}

double algebraic_mitre(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (4 * x2 * (x2 + y2 + z2) - y2 * (1 - y2 - z2)));
}

double algebraic_nodal_cubic(const double* a) {
    return limited(a[3] * (6 * a[1] * a[2] - cube(a[1]) - cube(a[2])));
}

double algebraic_ovals_of_cassini(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]), p = sqr(a[4]);
    return limited(-a[3] * (sqr(x2 + y2 + z2 + p) - a[6] * p * (x2 + z2) - sqr(a[5])));
}

double algebraic_paraboloid(const double* a) { return limited(a[3] * (a[1] - sqr(a[0]) - sqr(a[2]))); }

double algebraic_parabolic_torus(const double* a) {
    return limited(a[3] * bent_torus(sqr(a[0]), sqr(a[1]), -a[2], 1, sqr(a[4]), sqr(a[5])));
}

double algebraic_pillow(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(a[3] * (x2 * (x2 - 1) + y2 * (y2 - 1) + z2 * (z2 - 1)));
}

double algebraic_piriform(const double* a) {
    const double x3 = cube(a[0]);
    return limited(a[3] * (x3 * a[0] - x3 + sqr(a[1]) + sqr(a[2])));
}

double algebraic_quartic_paraboloid(const double* a) {
    return limited(a[3] * (a[1] - sqr(sqr(a[0])) - sqr(sqr(a[2]))));
}

double algebraic_quartic_saddle(const double* a) {
    return limited(a[3] * (a[1] - sqr(sqr(a[0])) + sqr(sqr(a[2]))));
}

double algebraic_quartic_cylinder(const double* a) {
    const double y2 = sqr(a[1]), ring = sqr(a[0]) + sqr(a[2]);
    return limited(a[3] * (sqr(a[5]) * (sqr(a[4]) - ring) - ring * y2));
}

double algebraic_steiners_roman(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (x2 * y2 + y2 * z2 + z2 * x2 + a[0] * a[1] * a[2]));
}

double algebraic_strophoid(const double* a) {
    const double x = a[0], ring = sqr(a[1]) + sqr(a[2]);
    return limited(a[3] * (ring * (x - a[5]) + sqr(a[6]) * x * x * (x + a[4])));
}

double algebraic_torus2(const double* a) {
    return limited(a[3] * bent_torus(sqr(a[0]), sqr(a[1]), sqr(a[2]), 2, sqr(a[4]), sqr(a[5])));
}

double algebraic_torus_gumdrop(const double* a) {
    const double x2 = sqr(a[0]), y2 = sqr(a[1]), z2 = sqr(a[2]);
    return limited(-a[3] * (4 * (x2 * x2 + sqr(y2 + z2)) + 17 * x2 * (y2 + z2) - 20 * (x2 + y2 + z2) + 17));
}

double algebraic_umbrella(const double* a) { return limited(-a[3] * (sqr(a[0]) - a[1] * sqr(a[2]))); }

double algebraic_witch_of_agnesi(const double* a) {
    return limited(a[3] * (a[4] * (1 - a[1]) - a[1] * (sqr(a[0]) + sqr(a[2]))));
}

} // namespace pnr
