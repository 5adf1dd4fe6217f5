// SPDX-License-Identifier: GPL-3.0-or-later
// Escape-time fractals in the xy plane.
#include "core/pattern_values.h"

#include <complex>

namespace pnr {

namespace {

using Complex = std::complex<double>;

// Plain products: std::complex's own operator looks for infinities first, and an orbit must not take a
// different path.
Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double square(Complex z) { return z.real() * z.real() + z.imag() * z.imag(); }
Complex over(Complex a, Complex b) {
    const double n = square(b);
    if (n == 0) return {1e10, 1e10};
    return {(a.real() * b.real() + a.imag() * b.imag()) / n, (a.imag() * b.real() - a.real() * b.imag()) / n};
}

struct Orbit {
    Complex z;
    int steps = 0;
    bool escaped = false;
    double nearest2 = 0; // least |z|^2 on the way
};

template <class Step, class Ended>
Orbit follow(Complex start, double nearest2, int iterations, Step step, Ended ended) {
    Orbit orbit{start, 0, false, nearest2};
    for (; orbit.steps < iterations; ++orbit.steps) {
        orbit.z = step(orbit.z);
        const double size2 = square(orbit.z);
        orbit.nearest2 = std::min(orbit.nearest2, size2);
        if (ended(orbit.z, size2)) {
            orbit.escaped = true;
            break;
        }
    }
    return orbit;
}

Orbit mandel_orbit(const FractalPattern& kind, Complex start, Complex c) {
    const auto step = [&](Complex z) {
        Complex power = z;
        for (int i = 1; i < kind.exponent; ++i) power = times(power, z);
        return power + c;
    };
    return follow(start, square(start), kind.iterations, step,
                  [](Complex, double size2) { return size2 > 4; });
}

Orbit magnet_orbit(const FractalPattern& kind, Complex start, Complex c, bool second) {
    const Complex c1 = c - 1.0, c2 = c - 2.0, c12 = times(c1, c2);
    const auto first_step = [&](Complex z) {
        const Complex q = over(times(z, z) + c1, 2.0 * z + c2);
        return times(q, q);
    };
    const auto second_step = [&](Complex z) {
        const Complex z2 = times(z, z);
        const Complex q =
            over(times(z2, z) + 3.0 * times(c1, z) + c12, 3.0 * z2 + 3.0 * times(c2, z) + c12 + 1.0);
        return times(q, q);
    };
    const auto ended = [](Complex z, double size2) { return size2 > 10000 || square(z - 1.0) < 1e-4; };
    return second ? follow(start, 10000, kind.iterations, second_step, ended)
                  : follow(start, 10000, kind.iterations, first_step, ended);
}

Orbit orbit_of(const FractalPattern& kind, Complex p) {
    const Complex c(kind.c.x, kind.c.y);
    switch (kind.kind) {
    case FractalKind::mandel:
        return mandel_orbit(kind, p, p);
    case FractalKind::julia:
        return mandel_orbit(kind, p, c);
    case FractalKind::magnet1_mandel:
        return magnet_orbit(kind, 0, p, false);
    case FractalKind::magnet2_mandel:
        return magnet_orbit(kind, 0, p, true);
    case FractalKind::magnet1_julia:
        return magnet_orbit(kind, p, c, false);
    case FractalKind::magnet2_julia:
        return magnet_orbit(kind, p, c, true);
    }
    return {};
}

double last_point_value(int type, Complex z) {
    switch (type) {
    case 2:
        return z.real();
    case 3:
        return z.imag();
    case 4:
        return z.real() * z.real();
    case 5:
        return z.imag() * z.imag();
    case 6:
        return std::sqrt(square(z));
    default:
        return 1;
    }
}

} // namespace

double value_of(const FractalPattern& kind, const SurfacePoint& at) {
    const Orbit orbit = orbit_of(kind, {at.point.x, at.point.y});
    if (!orbit.escaped) {
        // Inside, POV-Ray's type 6 scales the imaginary part alone.
        if (kind.interior_type == 6)
            return orbit.z.real() * orbit.z.real() + orbit.z.imag() * orbit.z.imag() * kind.interior_factor;
        if (kind.interior_type == 1) return std::sqrt(orbit.nearest2) * kind.interior_factor;
        return last_point_value(kind.interior_type, orbit.z) * kind.interior_factor;
    }
    const double factor = kind.exterior_factor;
    switch (kind.exterior_type) {
    case 1:
        return double(orbit.steps) / kind.iterations; // the factor does not count
    default:
        return last_point_value(kind.exterior_type, orbit.z) * factor;
    }
}

} // namespace pnr
