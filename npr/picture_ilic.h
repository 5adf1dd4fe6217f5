// SPDX-License-Identifier: GPL-3.0-or-later
// Painting a flat picture by itself: two-dimensional ILIC [Wang and Lee 2003], what the paper compares with in its
// Figs. 6 and 12.
#pragma once

#include "core/parallel.h"
#include "npr/maps.h"

#include <cstdint>

namespace pnr {

// Strokes along the picture's edges: at each pixel the axis across the gradient of its lightness (Sobel), blended over
// neighbourhoods of several sizes by the gradient's strength, so that plain places follow the edges about them. Where there
// is no edge at all the axis is horizontal. Every pixel is of object 1.
InformativeMap inform_by_gradient(const Image<Color>& picture);

// The picture (linear light, not negative) painted in a style; its `seeds`, field and radius do nothing. Lengths are pixels
// at 512 and scale with the height. Throws Interrupted when progress says stop.
Image<Color> paint_picture(const Image<Color>& picture, const PaintStyle& style, std::uint64_t seed,
                           const Progress& progress = {});
// The same on the part of the picture where the mask, of its size, is not 0; black elsewhere.
Image<Color> paint_picture(const Image<Color>& picture, const Image<std::uint8_t>& mask, const PaintStyle& style,
                           std::uint64_t seed, const Progress& progress = {});

} // namespace pnr
