// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

struct ViewFace {
    std::array<Vec3, 3> corners, normals;
    std::array<Vec2, 3> uvs;
};

// As POV-Ray has it: against the winding.
Vec3 flat_normal(const std::array<Vec3, 3>& p) { return glm::cross(p[2] - p[0], p[1] - p[0]); }

// Cells of the unit square of uv; each lists the faces whose triangle may touch it.
constexpr int cells = 64;

int cell_of(double u) { return std::clamp(static_cast<int>(std::floor(u * cells)), 0, cells - 1); }

// Barycentric coordinates; outside the triangle some are negative. Of a flat one: not finite.
Vec3 barycentric(const std::array<Vec2, 3>& t, Vec2 p) {
    const Vec2 a = t[1] - t[0], b = t[2] - t[0], d = p - t[0];
    const double area = a.x * b.y - a.y * b.x;
    const double v = (d.x * b.y - d.y * b.x) / area, w = (a.x * d.y - a.y * d.x) / area;
    return {1 - v - w, v, w};
}

} // namespace

struct MeshView {
    MeshRays rays = MeshRays::by_index;
    bool smooth = false;
    std::vector<ViewFace> faces;
    std::vector<std::vector<std::uint32_t>> grid; // by_uv
};

namespace {

void add_faces(const MeshViewPart& part, std::vector<ViewFace>& faces) {
    const MeshData& mesh = *part.mesh;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        ViewFace face;
        for (std::size_t k = 0; k < 3; ++k) {
            face.corners[k] = transform_point(part.transform.matrix, Vec3(mesh.positions[mesh.triangles[i][k]]));
            face.uvs[k] = mesh.uv_triangles.empty() ? Vec2(0) : Vec2(mesh.uvs[mesh.uv_triangles[i][k]]);
        }
        const Vec3 flat = flat_normal(face.corners);
        for (std::size_t k = 0; k < 3; ++k)
            face.normals[k] = mesh.normal_triangles.empty()
                                  ? flat
                                  : transform_normal(part.transform, Vec3(mesh.normals[mesh.normal_triangles[i][k]]));
        faces.push_back(face);
    }
}

void fill_grid(MeshView& view) {
    view.grid.resize(std::size_t{cells} * cells);
    for (std::uint32_t i = 0; i < view.faces.size(); ++i) {
        const auto& t = view.faces[i].uvs;
        const Vec2 low = glm::min(t[0], glm::min(t[1], t[2])), high = glm::max(t[0], glm::max(t[1], t[2]));
        for (int y = cell_of(low.y); y <= cell_of(high.y); ++y)
            for (int x = cell_of(low.x); x <= cell_of(high.x); ++x)
                view.grid[static_cast<std::size_t>(y * cells + x)].push_back(i);
    }
}

// The face that a pixel looks from, and where on it.
struct FacePoint {
    const ViewFace* face = nullptr;
    Vec3 weights{1.0 / 3};
};

FacePoint find_face(const MeshView& view, Vec2 pixel, int width, int height) {
    if (view.rays == MeshRays::by_uv) {
        const Vec2 uv{pixel.x / width, 1 - pixel.y / height};
        for (const std::uint32_t i : view.grid[static_cast<std::size_t>(cell_of(uv.y) * cells + cell_of(uv.x))]) {
            const Vec3 w = barycentric(view.faces[i].uvs, uv);
            if (w.x >= 0 && w.y >= 0 && w.z >= 0) return {&view.faces[i], w};
        }
        return {};
    }
    const double index = std::floor(pixel.y) * width + std::floor(pixel.x);
    if (!(index >= 0) || !(index < static_cast<double>(view.faces.size()))) return {};
    return {&view.faces[static_cast<std::size_t>(index)]};
}

} // namespace

std::shared_ptr<const MeshView> make_mesh_view(const std::vector<MeshViewPart>& parts, MeshRays rays, bool smooth) {
    auto view = std::make_shared<MeshView>();
    view->rays = rays;
    view->smooth = smooth;
    for (const MeshViewPart& part : parts) {
        add_faces(part, view->faces);
        if (rays == MeshRays::by_index) break; // the others would see the same pixels again
    }
    if (rays == MeshRays::by_uv) fill_grid(*view);
    return view;
}

Ray mesh_view_ray(const MeshView& view, const Camera& camera, Vec2 pixel, int width, int height) {
    const FacePoint at = find_face(view, pixel, width, height);
    const Ray nothing{{0, 0, 0}, {0, 0, 1}, 0, -1};
    if (!at.face) return nothing;
    const ViewFace& f = *at.face;
    const auto mixed = [&](const std::array<Vec3, 3>& v) {
        return at.weights.x * v[0] + at.weights.y * v[1] + at.weights.z * v[2];
    };
    Vec3 normal = view.smooth ? mixed(f.normals) : flat_normal(f.corners);
    if (!(glm::length(normal) > 0)) return nothing;
    normal = glm::normalize(normal);
    const Vec3 start = mixed(f.corners) + camera.mesh_offset + camera.location.z * normal;
    return {start, camera.direction.z < 0 ? -normal : normal, 0, infinity};
}

} // namespace pnr
