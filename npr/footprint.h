// SPDX-License-Identifier: GPL-3.0-or-later
// What a pixel covers of the surface it sees, from the differentials of its ray [Igehy 1999].
#pragma once

#include "core/gbuffer.h"

#include <optional>

namespace pnr {

// How far the seen point moves with a pixel: least and most over all directions in the picture, world units.
struct Footprint {
    float least = 0, most = 0;
};
Footprint footprint_of(const Seen& seen);

// An offset from the seen point in steps of its footprint: least squares over the tangent plane. Nothing if
// the footprint is degenerate.
std::optional<Vec2> footprint_offset(const Seen& seen, Vec3 offset);

} // namespace pnr
