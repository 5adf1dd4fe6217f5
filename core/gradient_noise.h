// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/types.h"

namespace pnr {

// The gradient noise of [Perlin 1985] with POV-Ray's tables, the sum behind noise generator 3; within about
// 0.63 of 0.
double gradient_noise(Vec3 point);

} // namespace pnr
