// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene's author may not have meant: places inside solids.
#pragma once

#include "core/scene.h"

#include <vector>

namespace pnr {

// The solids without `hollow` that hold a point, whatever their textures; children of unions by themselves.
// What has no inside (triangles, discs, meshes without inside_vector) or is still to be read from a file
// holds nothing.
std::vector<const Object*> solids_about(const std::vector<Object>& objects, Vec3 point);

// Whether nothing of what the object is made of lets light through or leaves it without a shadow.
bool is_opaque(const Object& object);

} // namespace pnr
