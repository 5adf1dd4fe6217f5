// SPDX-License-Identifier: GPL-3.0-or-later
// Paint that stands off the canvas: its height lit from the top left.
#pragma once

#include "core/image.h"

namespace pnr {

// What to add to the Oklab lightness: `strength` times the slope of the paint against the light, cut at 0.12
// either way. Heights are in strokes (a stroke is 0..1 high), blurred by half a pixel of a 512-high picture
// first; slopes are per such a pixel. `pixel` is the size of one in pixels of the image. Outside the mask: 0;
// slopes do not look across it.
Image<float> light_relief(Image<float> height, const Image<std::uint8_t>& mask, double strength,
                          double pixel);

} // namespace pnr
