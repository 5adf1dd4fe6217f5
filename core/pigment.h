// SPDX-License-Identifier: GPL-3.0-or-later
// Colour that varies over a surface, as POV-Ray's `pigment` says it: a pattern and the colours it picks.
#pragma once

#include "core/image.h"
#include "core/pattern.h"
#include "core/types.h"

#include <vector>

namespace pnr {

// A colour with POV-Ray's two kinds of transparency. filter: light that passes is tinted by rgb; transmit: it is not.
struct ColorFT {
    Color rgb{0};
    float filter = 0;
    float transmit = 0;
};

struct ColorStop {
    double position = 0; // in [0, 1]
    ColorFT color;
};

struct Pigment {
    Pattern pattern;
    std::vector<ColorStop> map{{0, {}}}; // color_map, or the pattern's list of colours at positions 0, 1, 2 ...; never empty
    BlendMap<Pigment> pigments;          // pigment_map, or a list of pigments: counts instead of `map` if not empty
};

// The colour at a point (in the space of pigment.pattern.transform's result).
ColorFT eval_pigment(const Pigment& pigment, const SurfacePoint& at);

// Whether it may let light through somewhere (filter or transmit above 0).
bool is_see_through(const Pigment& pigment);

// The pigment follows its object, whose every point is moved by `by` (scene space -> world space in build_world).
void transform_pigment(Pigment& pigment, const Transform& by);
void transform_pattern(Pattern& pattern, const Transform& by);

} // namespace pnr
