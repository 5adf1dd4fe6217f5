// SPDX-License-Identifier: GPL-3.0-or-later
// The patterns that were made to turn normals: each adds a vector of its own.
#pragma once

#include "core/normal.h"

namespace pnr {

bool has_bump_vector(const Normal& normal);
// n (in pattern space) with the bumps at a point of that space; not normalised. Only if has_bump_vector.
Vec3 bumped(const Normal& normal, const SurfacePoint& here, Vec3 n);

} // namespace pnr
