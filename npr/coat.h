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

// Lays a coat over what is painted already, canvas pixels row by row.
void paint_coat(RegionWork& work, const PaintLayer& coat, int coat_number, std::vector<Painted>& painted);

// Fine noise drawn out along the strokes, unit variance, on the canvas: what the brush's hairs leave.
Image<float> make_bristles(RegionWork& work);

} // namespace pnr
