// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of a shape that rays alone can tell of.
#pragma once

#include "core/closest_point.h"

namespace pnr {

// In the shape's own space, by rays from the query that close in on the shortest: the point is on the surface, and no
// point near it is nearer, if the surface is smooth there. Infinitely far if no ray meets the shape.
ClosestPoint closest_point_by_rays(const Shape& shape, Vec3 p);

} // namespace pnr
