// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene may ask to be done to a mesh before it is rendered: mended, subdivided, simplified, by CGAL's
// Polygon_mesh_processing. CGAL's headers and its compiler flags (-frounding-math) stay in mesh_repair.cpp.
#pragma once

#include "core/shape.h"

#include <string>
#include <vector>

namespace pnr {

// Does what `said.repair`, `said.subdivide` and `said.simplify` ask, in that order, and adds to `notes` a
// line that tells what came of it.
// - repair: equal vertices become one, repeated and degenerate triangles go, edges with more than two
// triangles
//   are cut apart and borders that coincide are sewn, windings agree, every hole is closed (an open surface
//   gets a lid), and closed pieces bound a volume: their outside is outside, that of cavities inside.
// - subdivide: so many rounds of Loop's scheme [Loop 1987], each with four times the triangles.
// - simplify: edges collapse [Lindstrom and Turk 1998] until so many triangles are left, or none can go.
// Vertices are joined and cut apart, so the result has neither normals nor uvs. Throws SceneError at
// `said.said_at` if there would be more than 2^26 triangles, or if CGAL gives up. Coordinates must be finite.
MeshData work_on_mesh(const MeshData& data, const Mesh& said, std::vector<std::string>& notes);

} // namespace pnr
