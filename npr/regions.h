// SPDX-License-Identifier: GPL-3.0-or-later
// The picture cut into what strokes never cross: one region for each painted object and each mirror or glass
// it is seen in. Each is smoothed, cut into cells and painted on its own.
#pragma once

#include "core/image.h"
#include "npr/maps.h"

#include <vector>

namespace pnr {

struct Region {
    std::uint32_t object = 0, via = 0;
    PixelRect box;           // the smallest that holds all its pixels
    std::int64_t pixels = 0; // how many
};

struct Regions {
    Image<std::uint32_t> label; // 0: not painted; n: regions[n - 1]
    std::vector<Region> regions;
};

// Numbered in the order in which a scan from the top left meets them.
Regions find_regions(const InformativeMap& informative);

// A window of the picture that belongs to one region: `inside` is 1 at its pixels. Values of a window are
// rows of box.x1 - box.x0.
Image<std::uint8_t> region_mask(const Regions& regions, std::uint32_t label);

} // namespace pnr
