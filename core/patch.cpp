// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"
#include "core/mesh_io.h"

#include <algorithm>

namespace pnr {

MeshData tessellate(const BicubicPatch& patch) {
    const int rows = 1 << std::clamp(patch.v_steps, 0, 10), columns = 1 << std::clamp(patch.u_steps, 0, 10);
    const auto basis = [](double t, double(&b)[4], double(&d)[4]) {
        const double s = 1 - t;
        b[0] = s * s * s, b[1] = 3 * s * s * t, b[2] = 3 * s * t * t, b[3] = t * t * t;
        d[0] = -3 * s * s, d[1] = 3 * s * s - 6 * s * t, d[2] = 6 * s * t - 3 * t * t, d[3] = 3 * t * t;
    };
    MeshData mesh;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            double bu[4], du[4], bv[4], dv[4];
            basis(static_cast<double>(column) / columns, bu, du);
            basis(static_cast<double>(row) / rows, bv, dv);
            Vec3 p(0), along_u(0), along_v(0);
            for (std::size_t r = 0; r < 4; ++r)
                for (std::size_t c = 0; c < 4; ++c) {
                    const Vec3& q = patch.points[r * 4 + c];
                    p += bu[c] * bv[r] * q;
                    along_u += du[c] * bv[r] * q;
                    along_v += bu[c] * dv[r] * q;
                }
            const Vec3 n = glm::cross(along_u, along_v);
            mesh.positions.emplace_back(p);
            mesh.normals.emplace_back(n == Vec3(0) ? Vec3(0) : glm::normalize(n));
            const double u = static_cast<double>(column) / columns, v = static_cast<double>(row) / rows;
            const auto& corner = patch.corner_uv;
            mesh.uvs.emplace_back((1 - v) * ((1 - u) * corner[0] + u * corner[1]) +
                                  v * ((1 - u) * corner[3] + u * corner[2]));
        }
    }
    const auto at = [&](int row, int column) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
            mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
        }
    // Where an edge of the patch has shrunk to a point its normal comes from the triangles around that point.
    const std::vector<Vec3f> around = area_weighted_normals(mesh.positions, mesh.triangles);
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const std::uint32_t i = at(row, column);
            if (mesh.normals[i] != Vec3f(0)) continue;
            Vec3f sum(0);
            const auto add = [&](std::uint32_t k) {
                if (mesh.positions[k] == mesh.positions[i]) sum += around[k];
            };
            for (int k = 0; k <= columns; ++k) add(at(row, k));
            for (int k = 0; k <= rows; ++k) add(at(k, column));
            if (sum != Vec3f(0)) mesh.normals[i] = glm::normalize(sum);
        }
    mesh.normal_triangles = mesh.triangles;
    mesh.uv_triangles = mesh.triangles;
    return mesh;
}

} // namespace pnr
