// SPDX-License-Identifier: GPL-3.0-or-later
// How different two pictures look when one flips between them: FLIP [Andersson, Nilsson, Akenine-Moeller,
// Oskarsson, Astrom and Fairchild 2020], for pictures as displayed.
#pragma once

#include "core/image.h"
#include "core/types.h"

namespace pnr {

// Pixels a degree of the eye's field: 0.7 m before a screen 0.7 m and 3840 pixels wide [sec. 4].
inline constexpr double flip_pixels_per_degree = 67;

// Linear light, taken as displayed with sRGB's primaries: clipped to [0, 1]. From 0, the same, to 1 in each
// pixel; symmetric. Throws std::invalid_argument if the sizes differ.
Image<float> flip(const Image<Color>& reference, const Image<Color>& test,
                  double pixels_per_degree = flip_pixels_per_degree);

} // namespace pnr
