// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's mesh_camera: rays that start on the faces of meshes and go along their normals.
#pragma once

#include "core/camera.h"
#include "core/shape.h"

#include <memory>
#include <vector>

namespace pnr {

// Which face a pixel looks from.
enum class MeshRays {
    by_index, // pixel (x, y) has face y width + x of each mesh in turn ...
    in_a_row, // ... or of all meshes, one after the other
    by_uv     // the face whose texture triangle holds (x / width, 1 - y / height)
};

struct MeshViewPart {
    std::shared_ptr<const MeshData> mesh;
    Transform transform; // to scene space
};

// Lists the faces once. `smooth`: rays go along interpolated normals (by_uv alone).
std::shared_ptr<const MeshView> make_mesh_view(const std::vector<MeshViewPart>& parts, MeshRays rays, bool smooth);

// Moved off the face by the z of the camera's location, along the normal or, where the camera's direction has a negative
// z, against it; the view's points are moved by mesh_offset.
Ray mesh_view_ray(const MeshView& view, const Camera& camera, Vec2 pixel, int width, int height);

} // namespace pnr
