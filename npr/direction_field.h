// SPDX-License-Identifier: GPL-3.0-or-later
// The directions of the informative map, smoothed for the convolution [LW10 3.2.4].
#pragma once

#include "core/settings.h"
#include "npr/maps.h"
#include "npr/regions.h"

namespace pnr {

// The axes (cos 2t, sin 2t) times a coherence in [0, 1] of one region's window, smoothed twice by Gaussians
// that see the region alone; zero outside. In paper_mode (`vectors`) plain vectors are smoothed, as the paper
// does, and then doubled. `height` is the picture's, by which the style's windows scale.
Image<Vec2f> smooth_directions(const InformativeMap& informative, const Regions& regions, std::uint32_t label,
                               const Image<std::uint8_t>& mask, const PaintStyle& style, int height);

// The axis at a place of the window (pixels from its corner), bilinear among the four pixel centres around
// that lie in the region; made a unit vector along the stroke, sign arbitrary. Where all cancel: the x axis.
Vec2f direction_at(const Image<Vec2f>& axes, const Image<std::uint8_t>& mask, Vec2f at);

} // namespace pnr
