// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles joined to a surface.
#pragma once

#include "core/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pnr {

// Triangles that share corners. No more is asked of them: they may have borders, meet three at an edge, or lie
// in pieces.
struct SurfaceMesh {
    std::vector<Vec3> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> piece; // of each corner: the same where a way along the surface leads
};

// Corners closer than a millionth of the extent become one; `triangles` keeps its order and length, and such
// a triangle may have lost its area.
SurfaceMesh join_triangles(std::span<const std::array<Vec3, 3>> triangles);

} // namespace pnr
