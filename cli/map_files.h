// SPDX-License-Identifier: GPL-3.0-or-later
// The files of --maps: photons.ply, gbuffer.exr, sparse.exr, informative.exr, partial.exr, photoreal.exr,
// orientation.png.
#pragma once

#include "cli/pipeline.h"

#include <filesystem>

namespace pnr {

// Makes the folder if it is not there; writes what exists, all of it unless the rendering was stopped. Throws
// FileError.
void write_maps(const Rendering& r, const std::filesystem::path& folder);

// The direction field as short strokes, dark on light, one on each square of a few pixels that is painted.
Image<Color> draw_orientation(const Rendering& r);

} // namespace pnr
