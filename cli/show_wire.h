// SPDX-License-Identifier: GPL-3.0-or-later
// Silhouettes, creases and the edges of meshes.
#pragma once

#include "cli/pipeline.h"

namespace pnr {

// Draws them over `ground`, a picture of the G-buffer's size; edges that other things hide are left out.
Image<Color> draw_wire(Image<Color> ground, const Rendering& r);

} // namespace pnr
