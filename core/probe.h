// SPDX-License-Identifier: GPL-3.0-or-later
// One object by itself: what a scene's text asks of it while it is still being read (inside, trace,
// min_extent, max_extent). Points and directions are in scene space.
#pragma once

#include "core/scene.h"

#include <memory>
#include <optional>

namespace pnr {

struct Probe; // probe.cpp

// Builds the object's geometry; its textures, lights and paint do not matter. Throws as build_world does.
std::shared_ptr<const Probe> make_probe(const Object& object);

bool is_inside(const Probe& probe, Vec3 point);

struct ProbeHit {
    Vec3 position{0};
    Vec3 normal{0}; // unit, POV-Ray's: outside as modelled, smooth on smooth meshes; of flat triangles
                    // against the winding
};
// The first hit of the ray; none for a direction of no length. Hits nearer than POV-Ray's 1e-6 do not count.
std::optional<ProbeHit> trace(const Probe& probe, Vec3 origin, Vec3 direction);

// A box about the object as POV-Ray makes it: neither clips nor what a difference takes away make it smaller.
// Infinite where the object, or a mesh that is not read yet, has no known end.
Bounds object_bounds(const Object& object);

} // namespace pnr
