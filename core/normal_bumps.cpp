// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/normal_bumps.h"

namespace pnr {

bool has_bump_vector(const Normal&) { return false; }

Vec3 bumped(const Normal&, const SurfacePoint&, Vec3 n) { return n; }

} // namespace pnr
