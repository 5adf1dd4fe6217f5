// SPDX-License-Identifier: GPL-3.0-or-later
// What a painter does to the colours before laying the first stroke.
#pragma once

#include "core/settings.h"
#include "npr/maps.h"
#include "npr/regions.h"

namespace pnr {

// To and from the space in which a style mixes its paint: Oklab, in paper_mode the display's encoded RGB.
Color to_paint_space(Color linear, const PaintStyle& style);
Color from_paint_space(Color paint, const PaintStyle& style); // linear, >= 0

// The colours of one region's window in paint space, with the style's contrast, saturation and warmth; 0
// outside.
Image<Color> tone_region(const InformativeMap& informative, const Regions& regions, std::uint32_t label,
                         const Image<std::uint8_t>& mask, const PaintStyle& style);

// How much a painter would care for each place, 0 on plain parts to 1: at lightness edges (the 90th
// percentile of the smoothed gradient is 1) and along the silhouette. Lengths scale with the picture's
// height.
Image<float> find_detail(const Image<Color>& toned, const Image<std::uint8_t>& mask, int height);

} // namespace pnr
