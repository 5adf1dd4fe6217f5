// SPDX-License-Identifier: GPL-3.0-or-later
// Warps: maps of space that bend a pattern, as POV-Ray's `warp { ... }`.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace pnr {

struct Turbulence { // moves a point by `amount` times a sum of noise
    Vec3 amount{0};
    int octaves = 6; // 1..10
    double omega = 0.5, lambda = 2;
};
struct RepeatWarp { // the slab 0 <= coordinate < width again and again along one axis
    int axis = 0;
    double width = 1;
    Vec3 flip{1};   // -1: mirrored in every other slab
    Vec3 offset{0}; // added once for each slab
};
struct BlackHoleWarp {
    Vec3 center{0};
    double radius = 1;
    double strength = 1, falloff = 2;
    bool inverse = false; // pushes instead of pulling
    bool repeat = false;  // one in every cell of the size repeat_size
    Vec3 repeat_size{0};
    Vec3 turbulence{0}; // of the centres of the repeated ones
};
enum class MapShape { spherical, cylindrical, toroidal, planar, cubic };
struct MapWarp { // lays the xy plane round a shape
    MapShape shape = MapShape::spherical;
    Vec3 orientation{0, 0, 1}; // unit
    double dist_exp = 0;
    double major_radius = 1; // of the torus
    double distance = 0;     // of the plane from the origin
};
struct TransformWarp {
    Transform transform;
};
using Warp = std::variant<Turbulence, RepeatWarp, BlackHoleWarp, MapWarp, TransformWarp>;

// Where the warp takes its value from: the point in the pattern's space for one outside.
Vec3 warp_point(const Warp& warp, Vec3 point);

} // namespace pnr
