// SPDX-License-Identifier: GPL-3.0-or-later
// A number at each point of space: what a scene's `function`, a pattern or a density file means to isosurfaces, height
// fields and patterns.
#pragma once

#include "core/types.h"

#include <functional>

namespace pnr {

// Pure and safe to call from many threads at once. May return NaN or infinity where it has no value.
using ScalarField = std::function<double(Vec3)>;

} // namespace pnr
