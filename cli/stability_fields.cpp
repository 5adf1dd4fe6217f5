// SPDX-License-Identifier: GPL-3.0-or-later
// Radial basis functions over seeds that lie as no one should set them. Truth: values that the interpolant
// must reproduce in theory (those at the seeds; linear functions, whose terms it has), and systems solved
// again with 50 digits.
#include "cli/stability.h"

#include "core/rng.h"
#include "npr/rbf.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

struct Samples {
    std::vector<Vec3> points;
    std::vector<double> values; // one component
};

Samples random_samples(int count, std::uint64_t seed, Vec3 extent) {
    Samples samples;
    Rng rng = make_rng(seed, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        samples.points.push_back(extent * (2.0 * Vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 1.0));
        samples.values.push_back(2 * rng.uniform() - 1);
    }
    return samples;
}

double value_at(const Rbf& rbf, Vec3 p) {
    std::array<double, 1> value{};
    eval_rbf(rbf, p, value);
    return value[0];
}

// Largest difference from the samples' values at the samples.
double largest_residual(const Samples& samples, RbfKernel kernel) {
    const Rbf rbf = solve_rbf(samples.points, samples.values, 1, kernel, 0);
    double worst = 0;
    for (std::size_t i = 0; i < samples.points.size(); ++i)
        worst = std::max(worst, std::abs(value_at(rbf, samples.points[i]) - samples.values[i]));
    return worst;
}

constexpr std::array<std::pair<RbfKernel, const char*>, 2> kernels{
    {{RbfKernel::biharmonic, "biharmonic"}, {RbfKernel::triharmonic, "triharmonic"}}};

void add_residuals(StabilityCases& cases) {
    const auto add = [&](const std::string& name, const Samples& samples, double bound = 1e-6) {
        for (const auto& [kernel, word] : kernels)
            cases.push_back({"fields", fmt::format("{}, {}", name, word), "residual at the seeds", bound,
                             largest_residual(samples, kernel)});
    };
    for (const int count : {1, 2, 3, 5, 50, 500, 2000})
        add(fmt::format("{} seeds", count), random_samples(count, 1, Vec3(1)));
    add("30 collinear seeds", random_samples(30, 2, {1, 0, 0}));
    add("60 coplanar seeds", random_samples(60, 3, {1, 1, 0}));
    add("60 seeds, 1e-9 from coplanar", random_samples(60, 3, {1, 1, 1e-9}));
    add("seeds in a space of 1e-6", random_samples(40, 4, Vec3(1e-6)));
    add("seeds in a space of 1e6", random_samples(40, 4, Vec3(1e6)));
    Samples far = random_samples(40, 5, Vec3(1));
    for (Vec3& p : far.points) p += Vec3(1e6, -1e6, 1e6);
    add("seeds 1e6 away from the origin", far);
}

// Two seeds closer and closer that say opposite things: the interpolant is as steep as it must be and passes
// through both as long as they are told apart, and their mean when not (rbf.h: within 1e-9).
void add_close_pairs(StabilityCases& cases) {
    for (double gap = 1e-1; gap > 1e-13; gap *= 0.1) {
        Samples samples = random_samples(20, 6, Vec3(1));
        samples.points[1] = samples.points[0] + Vec3(gap, 0, 0);
        samples.values[0] = 1, samples.values[1] = -1;
        const bool merged = gap < 2e-9; // of an extent of about 1.5
        for (const auto& [kernel, word] : kernels) {
            const Rbf rbf = solve_rbf(samples.points, samples.values, 1, kernel, 0);
            const double at = value_at(rbf, samples.points[0]);
            // What elimination may lose; where that is everything, the best answer in doubles is the mean of
            // the two.
            const double bound = merged ? 1e-6 : 1e-6 + std::min(1.0, 16 * 2.2e-16 * rbf.condition);
            cases.push_back({"fields", fmt::format("opposite seeds {:.0e} apart, {}", gap, word),
                             merged ? "difference from their mean" : "residual there", bound,
                             std::abs(at - (merged ? 0 : 1))});
        }
    }
}

// Linear functions are among the interpolant's terms: they come out exactly, also far from the seeds.
void add_linear_functions(StabilityCases& cases) {
    for (const auto& [kernel, word] : kernels) {
        Samples samples = random_samples(40, 7, Vec3(1));
        const auto linear = [](Vec3 p) { return 0.3 + p.x - 2 * p.y + 0.5 * p.z; };
        for (std::size_t i = 0; i < samples.points.size(); ++i) samples.values[i] = linear(samples.points[i]);
        const Rbf rbf = solve_rbf(samples.points, samples.values, 1, kernel, 0);
        double worst = 0;
        for (const Vec3 p : random_samples(100, 8, Vec3(10)).points)
            worst = std::max(worst, std::abs(value_at(rbf, p) - linear(p)));
        cases.push_back({"fields", fmt::format("a linear function, {}", word),
                         "error at ten times the extent", 1e-8, worst});
    }
}

// The biharmonic interpolant with linear terms by Gaussian elimination with 50 digits.
Exact exact_value(const Samples& samples, Vec3 at) {
    const std::size_t n = samples.points.size(), size = n + 4;
    std::vector<std::vector<Exact>> a(size, std::vector<Exact>(size + 1, Exact(0)));
    const auto coordinate = [](Vec3 p, std::size_t k) {
        return k == 0 ? Exact(1) : Exact(p[static_cast<int>(k) - 1]);
    };
    const auto distance = [](Vec3 p, Vec3 q) {
        Exact sum = 0;
        for (int k = 0; k < 3; ++k) sum += (Exact(p[k]) - Exact(q[k])) * (Exact(p[k]) - Exact(q[k]));
        return Exact(sqrt(sum));
    };
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) a[i][j] = distance(samples.points[i], samples.points[j]);
        for (std::size_t k = 0; k < 4; ++k) a[i][n + k] = a[n + k][i] = coordinate(samples.points[i], k);
        a[i][size] = samples.values[i];
    }
    for (std::size_t c = 0; c < size; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < size; ++r)
            if (abs(a[r][c]) > abs(a[pivot][c])) pivot = r;
        std::swap(a[c], a[pivot]);
        for (std::size_t r = 0; r < size; ++r) {
            if (r == c) continue;
            const Exact factor = a[r][c] / a[c][c];
            for (std::size_t k = c; k <= size; ++k) a[r][k] -= factor * a[c][k];
        }
    }
    Exact value = 0;
    for (std::size_t i = 0; i < n; ++i) value += a[i][size] / a[i][i] * distance(samples.points[i], at);
    for (std::size_t k = 0; k < 4; ++k) value += a[n + k][size] / a[n + k][n + k] * coordinate(at, k);
    return value;
}

void add_exact_systems(StabilityCases& cases) {
    for (const double gap : {1.0, 1e-4, 1e-8}) {
        Samples samples = random_samples(16, 9, Vec3(1));
        samples.points[1] = samples.points[0] + gap * Vec3(0.3, -0.2, 0.1);
        const Rbf rbf = solve_rbf(samples.points, samples.values, 1, RbfKernel::biharmonic, 0);
        double worst = 0;
        for (const Vec3 p : random_samples(20, 10, Vec3(1)).points)
            worst =
                std::max(worst, std::abs(value_at(rbf, p) - static_cast<double>(exact_value(samples, p))));
        // Backward stable elimination: relative error of the weights, which are as large as 2 / gap at most.
        const double bound = 1e2 * 2.2e-16 * rbf.condition * (1 + 2 / gap);
        cases.push_back({"fields", fmt::format("16 seeds, two {:.0e} apart", gap),
                         "difference from 50 digits", std::clamp(bound, 1e-12, 1e-2), worst});
    }
}

} // namespace

StabilityCases field_cases() {
    StabilityCases cases;
    add_residuals(cases);
    add_close_pairs(cases);
    add_linear_functions(cases);
    add_exact_systems(cases);
    return cases;
}

} // namespace pnr
