// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pnr {

namespace {

constexpr double joining = 1e-6; // of the extent

double extent_of(std::span<const std::array<Vec3, 3>> triangles) {
    Vec3 low(infinity), high(-infinity);
    for (const auto& triangle : triangles)
        for (const Vec3& p : triangle) low = glm::min(low, p), high = glm::max(high, p);
    return glm::distance(low, high);
}

// Points are looked through in their order along a direction in which no plane of a model is likely to lie.
const Vec3 askew(0.6137, 0.5319, 0.5834);

// Numbers of the joined corners, three a triangle: each point takes the first one met that is as near as
// that.
std::vector<std::uint32_t> join_corners(std::span<const std::array<Vec3, 3>> triangles,
                                        std::vector<Vec3>& corners) {
    const double reach = joining * extent_of(triangles);
    std::vector<std::pair<double, std::uint32_t>> order(3 * triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = {glm::dot(triangles[i / 3][i % 3], askew), i};
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> joined(order.size());
    std::vector<double> along; // of each corner
    std::size_t begin = 0;
    for (const auto& [place, i] : order) {
        const Vec3 p = triangles[i / 3][i % 3];
        while (begin < corners.size() && along[begin] < place - reach) ++begin;
        std::size_t k = begin;
        while (k < corners.size() && glm::distance(corners[k], p) > reach) ++k;
        if (k == corners.size()) {
            corners.push_back(p);
            along.push_back(place);
        }
        joined[i] = static_cast<std::uint32_t>(k);
    }
    return joined;
}

void find_pieces(SurfaceMesh& mesh) {
    mesh.piece.resize(mesh.corners.size());
    std::iota(mesh.piece.begin(), mesh.piece.end(), 0u);
    const auto root = [&](std::uint32_t c) {
        while (mesh.piece[c] != c) c = mesh.piece[c] = mesh.piece[mesh.piece[c]];
        return c;
    };
    for (const auto& [a, b, c] : mesh.triangles)
        for (const std::uint32_t other : {b, c}) {
            const std::uint32_t p = root(a), q = root(other);
            mesh.piece[std::max(p, q)] = std::min(p, q);
        }
    for (std::uint32_t c = 0; c < mesh.corners.size(); ++c) mesh.piece[c] = root(c);
}

} // namespace

SurfaceMesh join_triangles(std::span<const std::array<Vec3, 3>> triangles) {
    SurfaceMesh mesh;
    const std::vector<std::uint32_t> joined = join_corners(triangles, mesh.corners);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        mesh.triangles.push_back({joined[3 * t], joined[3 * t + 1], joined[3 * t + 2]});
    find_pieces(mesh);
    return mesh;
}

} // namespace pnr
