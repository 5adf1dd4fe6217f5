// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation of scattered vectors by radial basis functions [Carr et al. 2001].
#pragma once

#include "core/settings.h"
#include "core/types.h"

#include <span>
#include <vector>

namespace pnr {

// s(x) = p(x) + sum_i w_i phi(|x - x_i|) for each of `components` values at once. Polynomial terms p: a
// constant, and linear terms along x, y, z when the centres are at least four and not coplanar. Kernels: r is
// the biharmonic function of space (so `linear` and `biharmonic` are one), needing a constant; r^3 the
// triharmonic, which needs linear terms to be solvable, so that among coplanar or collinear centres it gets
// those of their plane or line. Gaussians as wide as 1.5 mean distances to the nearest centre were tried and left: on known
// fields their error grew with the number of seeds (tests/npr/known_fields_test.cpp). There 128
// seeds leave mean errors, in degrees, of 0.38 (biharmonic) and 0.25 (triharmonic) on a sphere, 2.5 and 0.39 on a torus,
// 0.31 and 0.02 on a cylinder, 0.02 and 0.02 on a saddle.
struct Rbf {
    RbfKernel kernel = RbfKernel::biharmonic;
    int components = 0;
    Vec3 center{0}; // of the centres; coordinates below are (x - center) * scale
    double scale = 1;
    std::vector<Vec3> centers;    // scaled
    std::vector<Vec3> directions; // of the linear terms
    std::vector<double> weights;  // [center][component]
    std::vector<double> terms;    // [constant, then directions][component]
    double condition = 1;         // of the system, 1-norm estimate
    double residual = 0;          // largest difference of a component at a centre (smooth 0)
};

// `values`: [point][component]. Points that coincide (within 1e-9 of their extent) are merged to the mean of
// their values. `smooth` is added to the diagonal in units of the mean size of the entries beside it. Never
// fails: a singular system is solved in the least-squares sense, with the smallest weights. Points must be
// finite; at least one.
Rbf solve_rbf(std::span<const Vec3> points, std::span<const double> values, int components, RbfKernel kernel,
              double smooth);
// result has `components` entries.
void eval_rbf(const Rbf& rbf, Vec3 point, std::span<double> result);

} // namespace pnr
