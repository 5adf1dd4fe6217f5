// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/geodesic_field.h"

#include "core/geometry.h"

#include <Eigen/Sparse>

namespace pnr {

namespace {

using Triangle = std::array<Vec3, 3>;

// The object's triangles, as index_surface has them; false if it has other shapes beside or instead.
bool collect_triangles(const World& world, int object, std::vector<Triangle>& triangles,
                       std::vector<std::uint32_t>& first_triangle) {
    if (!world.geometry) return false;
    const auto items = geometry_items(*world.geometry);
    first_triangle.assign(items.size(), 0);
    for (std::uint32_t i = 0; i < items.size() && i < world.surfaces.size(); ++i) {
        if (world.surfaces[i].object != object || world.surfaces[i].light >= 0) continue;
        const Shape* shape = std::get_if<Shape>(&items[i].form);
        if (!shape || items[i].hidden_from == hidden_from_all) continue;
        const auto* mesh = std::get_if<Mesh>(shape);
        if (!mesh || !mesh->data || is_part_of_solid(*world.geometry, i)) return false;
        first_triangle[i] = static_cast<std::uint32_t>(triangles.size());
        for (const auto& corners : mesh->data->triangles) {
            Triangle& triangle = triangles.emplace_back();
            for (std::size_t c = 0; c < 3; ++c)
                triangle[c] = Vec3(
                    Vec3f(transform_point(items[i].to_world.matrix, Vec3(mesh->data->positions[corners[c]]))));
        }
    }
    return !triangles.empty();
}

struct Anchor { // a place of the mesh
    std::uint32_t triangle = 0;
    Vec3 position{0}, weights{0};
};

Anchor anchor_at(const GeodesicField& field, Vec3 position) {
    const ClosestPoint on = closest_point(*field.surface, position);
    return {field.first_triangle[on.surface] + on.triangle, on.position, on.weights};
}

std::uint32_t piece_of(const GeodesicField& field, const Anchor& anchor) {
    return field.mesh.piece[field.mesh.triangles[anchor.triangle][0]];
}

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;
using Index = Eigen::Index;

constexpr double largest_cotangent = 1e4; // of slivers

// The Laplacian over the square roots of the corners' areas, so that |S u|^2 is the integral of its square. In
// units of the mesh's mean area a corner: nothing of it hangs on the model's size.
Sparse make_laplacian(const SurfaceMesh& mesh) {
    const auto count = static_cast<Index>(mesh.corners.size());
    std::vector<double> areas(mesh.corners.size(), 0);
    Entries entries;
    double whole = 0;
    for (const auto& triangle : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t at = triangle[i], a = triangle[(i + 1) % 3], b = triangle[(i + 2) % 3];
            const Vec3 u = mesh.corners[a] - mesh.corners[at], v = mesh.corners[b] - mesh.corners[at];
            const double twice = glm::length(glm::cross(u, v));
            areas[at] += twice / 6;
            whole += twice / 6;
            if (!(twice > 0) || a == b) continue;
            const double half =
                0.5 * std::clamp(glm::dot(u, v) / twice, -largest_cotangent, largest_cotangent);
            for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, a}}) {
                entries.emplace_back(static_cast<int>(p), static_cast<int>(p), half);
                entries.emplace_back(static_cast<int>(p), static_cast<int>(q), -half);
            }
        }
    }
    Sparse laplacian(count, count);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    const double mean = whole / static_cast<double>(count);
    Eigen::VectorXd scale(count);
    for (Index i = 0; i < count; ++i)
        scale(i) = 1 / std::sqrt(std::max(1e-3, areas[static_cast<std::size_t>(i)] / mean));
    return scale.asDiagonal() * laplacian;
}

// Corners' shares in the seeds' values.
Sparse make_shares(const GeodesicField& field, std::span<const Anchor> anchors) {
    Entries entries;
    for (std::size_t i = 0; i < anchors.size(); ++i)
        for (int c = 0; c < 3; ++c)
            entries.emplace_back(
                static_cast<int>(i),
                static_cast<int>(field.mesh.triangles[anchors[i].triangle][static_cast<std::size_t>(c)]),
                anchors[i].weights[c]);
    Sparse shares(static_cast<Index>(anchors.size()), static_cast<Index>(field.mesh.corners.size()));
    shares.setFromTriplets(entries.begin(), entries.end());
    return shares;
}

// Minimises |S u|^2 + pull |B u - v|^2, then raises the pull by multipliers until B u = v [Hestenes 1969],
// which one factorisation serves.
Eigen::MatrixXd find_smoothest(const Sparse& laplacian, const Sparse& shares, const Eigen::MatrixXd& wanted,
                               double smooth) {
    Sparse energy = Sparse(laplacian.transpose()) * laplacian;
    const double usual = energy.diagonal().mean();
    const double pull = smooth > 0 ? usual / smooth : 1e3 * usual;
    Sparse anchor(energy.rows(), energy.cols()); // holds what no seed does: pieces without any
    anchor.setIdentity();
    energy += pull * Sparse(shares.transpose() * shares) + 1e-12 * usual * anchor;
    const Eigen::SimplicialLDLT<Sparse> solver(energy);
    Eigen::MatrixXd asked = wanted, found = Eigen::MatrixXd::Zero(energy.rows(), wanted.cols());
    if (solver.info() != Eigen::Success) return found;
    constexpr int rounds = 30;
    for (int i = 0; i < rounds; ++i) {
        found = solver.solve(pull * (shares.transpose() * asked));
        const Eigen::MatrixXd missing = wanted - shares * found;
        if (smooth > 0 || missing.cwiseAbs().maxCoeff() < 1e-10) break;
        asked += missing;
    }
    return found;
}

} // namespace

std::shared_ptr<const GeodesicField> make_geodesic_field(const World& world, int object,
                                                         std::span<const Vec3> seeds,
                                                         std::span<const double> values, int components,
                                                         double smooth) {
    auto field = std::make_shared<GeodesicField>();
    std::vector<Triangle> triangles;
    if (!collect_triangles(world, object, triangles, field->first_triangle)) return nullptr;
    field->mesh = join_triangles(triangles);
    field->surface = index_surface(world, object);
    field->components = components;
    field->reached.assign(field->mesh.corners.size(), 0);
    std::vector<Anchor> anchors;
    for (const Vec3& seed : seeds) {
        anchors.push_back(anchor_at(*field, seed));
        field->reached[piece_of(*field, anchors.back())] = 1;
    }
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Rows wanted = Eigen::Map<const Rows>(values.data(), static_cast<Index>(seeds.size()), components);
    const Rows found =
        find_smoothest(make_laplacian(field->mesh), make_shares(*field, anchors), wanted, smooth);
    if (!found.allFinite()) return nullptr;
    field->values.assign(found.data(), found.data() + found.size());
    return field;
}

bool eval_geodesic_field(const GeodesicField& field, Vec3 position, std::span<double> result) {
    const Anchor at = anchor_at(field, position);
    if (field.reached[piece_of(field, at)] == 0) return false;
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t c = 0; c < width; ++c) {
        result[c] = 0;
        for (int k = 0; k < 3; ++k)
            result[c] += at.weights[k] *
                         field.values[field.mesh.triangles[at.triangle][static_cast<std::size_t>(k)] * width + c];
    }
    return true;
}

} // namespace pnr
