// SPDX-License-Identifier: GPL-3.0-or-later
// One coat of paint: the cells of its noise convolved along the strokes, each pixel's samples weighted by
// priority so that one cell wins the path [LW10 3.2.4; Wang and Lee 2003].
#pragma once

#include "npr/noise_cells.h"

namespace pnr {

struct Painted { // a canvas pixel
    Color paint{0};
    float height = 0;
};

// The coats that a style asks for, at its strokes' size.
std::vector<PaintLayer> coats_of(const PaintStyle& style);

// Length of a step in canvas pixels: as asked, but never over a pixel of the picture, so that no gap is
// missed.
double canvas_step(const RegionWork& work);

// Where the cells of a coat are, without any if they are pixels; and those of the bristles' marks. For all
// coats they can be found at once.
SiteGrid coat_sites(const RegionWork& work, const PaintLayer& coat, int coat_number);
SiteGrid bristle_sites(const RegionWork& work);

// Lays a coat over what is painted already, canvas pixels row by row.
void paint_coat(RegionWork& work, const PaintLayer& coat, int coat_number, const SiteGrid& sites,
                std::vector<Painted>& painted);

// Fine noise drawn out along the strokes, unit variance, on the canvas: what the brush's hairs leave.
Image<float> make_bristles(RegionWork& work, const SiteGrid& sites);

} // namespace pnr
