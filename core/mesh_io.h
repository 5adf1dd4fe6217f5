// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes on disk: PLY (ascii and both binary orders), OBJ, OFF and STL (ascii and binary), told apart by
// their contents, not their names. Polygons become fans of triangles; coordinates are taken as they stand.
#pragma once

#include "core/shape.h"

#include <filesystem>
#include <span>
#include <string_view>

namespace pnr {

// Reads a mesh. Throws FileError if the file cannot be opened, and SceneError at `said_at` if it is no mesh:
// truncated, a coordinate that is not finite, an index out of range, a header that promises more than the
// file holds, no triangle.
MeshData read_mesh(const std::filesystem::path& file, const SourceRef& said_at);
// The same from bytes in memory. `name` is for messages, and its ending decides for OBJ, which has no mark of
// its own; `folder` is where an OBJ's materials lie (mesh_materials.h), null: they are not read.
MeshData parse_mesh(std::string_view bytes, const std::string& name, const SourceRef& said_at,
                    const std::filesystem::path* folder = nullptr);

// Unit vertex normals, the mean of the triangles' at each position weighted by area: zero where all are
// degenerate.
std::vector<Vec3f> area_weighted_normals(std::span<const Vec3f> positions,
                                         std::span<const std::array<std::uint32_t, 3>> triangles);

} // namespace pnr
