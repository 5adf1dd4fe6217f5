// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/linear_flow.h"

#include <boost/numeric/odeint.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pnr {

namespace {

namespace odeint = boost::numeric::odeint;
using State = boost::numeric::ublas::vector<double>;
using Matrix = boost::numeric::ublas::matrix<double>;

Point2 direction(const LinearFlow& flow, Point2 p) {
    return {flow.m[0] * p[0] + flow.m[1] * p[1] + flow.c[0], flow.m[2] * p[0] + flow.m[3] * p[1] + flow.c[1]};
}

} // namespace

Point2 unit_direction(const LinearFlow& flow, Point2 p) {
    const Point2 f = direction(flow, p);
    const double length = std::hypot(f[0], f[1]);
    return length > 0 ? Point2{f[0] / length, f[1] / length} : Point2{1, 0};
}

// (1 - n n^T) m / |f|
std::array<double, 4> unit_direction_slope(const LinearFlow& flow, Point2 p) {
    const Point2 f = direction(flow, p), n = unit_direction(flow, p);
    const double length = std::max(std::hypot(f[0], f[1]), 1e-300);
    std::array<double, 4> slope{};
    for (std::size_t row = 0; row < 2; ++row)
        for (std::size_t column = 0; column < 2; ++column)
            for (std::size_t k = 0; k < 2; ++k)
                slope[2 * row + column] +=
                    ((row == k ? 1 : 0) - n[row] * n[k]) * flow.m[2 * k + column] / length;
    return slope;
}

std::vector<Point2> follow_flow(const LinearFlow& flow, Point2 start, int count, double step) {
    const auto rates = [&](const State& p, State& d, double) {
        const Point2 n = unit_direction(flow, {p[0], p[1]});
        d[0] = n[0], d[1] = n[1];
    };
    const auto slopes = [&](const State& p, Matrix& j, double, State& by_time) {
        const auto s = unit_direction_slope(flow, {p[0], p[1]});
        for (std::size_t i = 0; i < 4; ++i) j(i / 2, i % 2) = s[i];
        by_time[0] = by_time[1] = 0;
    };
    State p(2);
    p[0] = start[0], p[1] = start[1];
    std::vector<Point2> path;
    for (int k = 0; k < count; ++k) {
        odeint::integrate_adaptive(odeint::make_controlled<odeint::rosenbrock4<double>>(1e-10, 1e-10),
                                   std::make_pair(rates, slopes), p, k * step, (k + 1) * step, step * 1e-3);
        path.push_back({p[0], p[1]});
    }
    return path;
}

} // namespace pnr
