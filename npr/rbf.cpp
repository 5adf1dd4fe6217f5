// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/rbf.h"

#include <Eigen/Dense>

namespace pnr {

namespace {

constexpr double coincidence = 1e-9; // of the extent: closer points are one
constexpr double flatness = 1e-6;    // relative spread below which points count as coplanar or collinear

double kernel_value(RbfKernel kernel, double distance2) {
    switch (kernel) {
    case RbfKernel::biharmonic:
        return -std::sqrt(distance2);
    case RbfKernel::triharmonic:
        return distance2 * std::sqrt(distance2);
    }
    return 0;
}

struct Samples {
    std::vector<Vec3> points; // scaled, distinct
    std::vector<double> values;
};

// Moves and scales the points into the unit box about their mean and merges those that coincide.
Samples normalise(std::span<const Vec3> points, std::span<const double> values, int components, Rbf& rbf) {
    for (const Vec3& p : points) rbf.center += p / static_cast<double>(points.size());
    double extent = 0;
    for (const Vec3& p : points) extent = std::max(extent, glm::distance(p, rbf.center));
    rbf.scale = extent > 0 ? 1 / extent : 1;
    Samples samples;
    std::vector<double> counts;
    const auto width = static_cast<std::size_t>(components);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 p = (points[i] - rbf.center) * rbf.scale;
        std::size_t j = 0;
        while (j < samples.points.size() && glm::distance(samples.points[j], p) > coincidence) ++j;
        if (j == samples.points.size()) {
            samples.points.push_back(p);
            samples.values.insert(samples.values.end(),
                                  values.begin() + static_cast<std::ptrdiff_t>(i * width),
                                  values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
            counts.push_back(1);
            continue;
        }
        ++counts[j];
        for (std::size_t c = 0; c < width; ++c) {
            double& mean = samples.values[j * width + c];
            mean += (values[i * width + c] - mean) / counts[j];
        }
    }
    return samples;
}

// Principal directions along which the points spread, widest first.
std::vector<Vec3> spread_directions(const std::vector<Vec3>& points) {
    Vec3 mean(0);
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vec3& p : points) {
        const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
        covariance += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const double largest = std::sqrt(std::max(0.0, solver.eigenvalues()(2)));
    std::vector<Vec3> directions;
    for (int k = 2; k >= 0; --k) {
        const double spread = std::sqrt(std::max(0.0, solver.eigenvalues()(k)));
        if (!(spread > flatness * largest)) break;
        const Eigen::Vector3d v = solver.eigenvectors().col(k);
        directions.emplace_back(v(0), v(1), v(2));
    }
    return directions;
}

// The saddle-point system of [Carr et al. 2001, eq. 12]: kernel matrix, polynomial terms, and their side
// conditions.
Eigen::MatrixXd assemble(const Rbf& rbf, double smooth) {
    const auto n = static_cast<Eigen::Index>(rbf.centers.size());
    const auto m = static_cast<Eigen::Index>(rbf.directions.size()) + 1;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
    double beside = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Vec3& p = rbf.centers[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < n; ++j) {
            const Vec3 d = p - rbf.centers[static_cast<std::size_t>(j)];
            system(i, j) = kernel_value(rbf.kernel, glm::dot(d, d));
            if (i != j) beside += std::abs(system(i, j));
        }
        system(i, n) = system(n, i) = 1;
        for (Eigen::Index k = 1; k < m; ++k)
            system(i, n + k) = system(n + k, i) =
                glm::dot(p, rbf.directions[static_cast<std::size_t>(k - 1)]);
    }
    if (smooth > 0 && n > 1) {
        beside /= static_cast<double>(n * (n - 1));
        // With these signs (-r, r^3) the kernel matrix is positive on weights that meet the side
        // conditions, so a larger diagonal always smooths.
        for (Eigen::Index i = 0; i < n; ++i) system(i, i) += smooth * beside;
    }
    return system;
}

} // namespace

Rbf solve_rbf(std::span<const Vec3> points, std::span<const double> values, int components, RbfKernel kernel,
              double smooth) {
    Rbf rbf;
    rbf.kernel = kernel;
    rbf.components = components;
    const Samples samples = normalise(points, values, components, rbf);
    rbf.centers = samples.points;
    const auto width = static_cast<Eigen::Index>(components);
    const auto n = static_cast<Eigen::Index>(rbf.centers.size());
    if (n == 1) { // a constant: nothing to solve
        rbf.weights.assign(static_cast<std::size_t>(components), 0);
        rbf.terms = samples.values;
        return rbf;
    }
    const std::vector<Vec3> directions = spread_directions(rbf.centers);
    if (directions.size() == 3 && n >= 4) rbf.directions = directions;
    if (kernel == RbfKernel::triharmonic) rbf.directions = directions;

    const Eigen::MatrixXd system = assemble(rbf, smooth);
    const Eigen::Index size = system.rows();
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size, width);
    right.topRows(n) = Eigen::Map<const Rows>(samples.values.data(), n, width);

    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(system);
    const double reciprocal = lu.rcond();
    rbf.condition = reciprocal > 0 ? 1 / reciprocal : infinity;
    Eigen::MatrixXd solution;
    if (reciprocal > 1e-14) {
        solution = lu.solve(right);
        solution +=
            lu.solve(right - system * solution); // one step of refinement: residuals at rounding level
    } else {
        solution = system.completeOrthogonalDecomposition().solve(right);
    }
    if (!solution.allFinite()) { // values beyond the reach of doubles: the mean is all that can be said
        solution.setZero();
        solution.row(n) = right.topRows(n).colwise().mean();
    }
    rbf.residual = (system * solution - right).topRows(n).cwiseAbs().maxCoeff();
    const Rows stored = solution;
    rbf.weights.assign(stored.data(), stored.data() + n * width);
    rbf.terms.assign(stored.data() + n * width, stored.data() + size * width);
    return rbf;
}

void eval_rbf(const Rbf& rbf, Vec3 point, std::span<double> result) {
    const Vec3 p = (point - rbf.center) * rbf.scale;
    const auto width = static_cast<std::size_t>(rbf.components);
    for (std::size_t c = 0; c < width; ++c) result[c] = rbf.terms[c];
    for (std::size_t k = 0; k < rbf.directions.size(); ++k) {
        const double along = glm::dot(p, rbf.directions[k]);
        for (std::size_t c = 0; c < width; ++c) result[c] += along * rbf.terms[(k + 1) * width + c];
    }
    for (std::size_t i = 0; i < rbf.centers.size(); ++i) {
        const Vec3 d = p - rbf.centers[i];
        const double phi = kernel_value(rbf.kernel, glm::dot(d, d));
        for (std::size_t c = 0; c < width; ++c) result[c] += phi * rbf.weights[i * width + c];
    }
}

} // namespace pnr
