// SPDX-License-Identifier: GPL-3.0-or-later
// How large the brush is on the object: strokes have the size that is asked for where the object is on the
// whole, and that size in space all over it, so that they neither come nor go while the viewer walks round.
#pragma once

#include "core/gbuffer.h"
#include "npr/folds.h"
#include "npr/regions.h"
#include "npr/seats.h"

namespace pnr {

struct BrushScale {
    float usual = 1;    // what a pixel spans at the object's middle, facing the viewer, world units; > 0
    Image<float> spans; // what each pixel of the region's window spans, least over all directions; 0: unknown
};

// `mask`: the region's window.
BrushScale find_brush_scale(const GBuffer& gbuffer, const Seats& seats, const Region& region,
                            const Image<std::uint8_t>& mask);

// What a pixel of the brush spans at a pixel of the window. Only where the object is so deep that the brush
// would there look more than half as large again, or less than two thirds, it gives way.
float brush_pixel(const BrushScale& scale, int x, int y);

} // namespace pnr
