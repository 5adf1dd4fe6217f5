// SPDX-License-Identifier: GPL-3.0-or-later
// Truth for the paths of `pnr stability`. Kept apart, and free of C++20, since Boost's uBLAS, which the stiff
// solver is made of, is not ready for it.
#pragma once

#include <array>
#include <vector>

namespace pnr {

using Point2 = std::array<double, 2>;

// The field f(p) = m p + c, m by rows, that is followed at unit speed.
struct LinearFlow {
    std::array<double, 4> m{};
    Point2 c{};
};

// f(p) / |f(p)|; (1, 0) where f is zero.
Point2 unit_direction(const LinearFlow& flow, Point2 p);
// The derivative of that with p, by rows.
std::array<double, 4> unit_direction_slope(const LinearFlow& flow, Point2 p);
// Where a point that follows the field is after 1, 2, ... `count` steps of length `step`, each within about
// 1e-9 times the way, by Boost.Odeint's Rosenbrock method of order 4, which stiffness does not trouble.
std::vector<Point2> follow_flow(const LinearFlow& flow, Point2 start, int count, double step);

} // namespace pnr
