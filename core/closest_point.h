// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of an object's surface: where seeds snap to.
#pragma once

#include "core/world.h"

namespace pnr {

struct ClosestPoint {
    Vec3 position{0};           // world space, on the surface
    Vec3 normal{0};             // unit, geometric, to the outside as modelled
    double distance = infinity; // from the query; infinity: the object has no surface
};

// The point of any surface of the object (its number in World::objects) nearest to `point`: exact on
// triangles, and to rounding on the analytic shapes. Ties go to the shape that stands first. A mesh's tree is
// built once and kept with the World; safe to call from several threads.
ClosestPoint closest_point_on_object(const World& world, int object, Vec3 point);

} // namespace pnr
