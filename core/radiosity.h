// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's `radiosity`: light gathered over the hemisphere about points of raytraced scenes, kept at some of them and
// interpolated between [Ward, Rubinstein, Clear 1988; Ward and Heckbert 1992].
//
// Which points keep it is found beforehand, on coarser grids of pixels first, so that no order of pixels, tiles or threads
// can matter: the records of one grid are computed side by side and serve the next one. Pixels then read them; where none
// is near, a pixel gathers for itself.
#pragma once

#include "core/parallel.h"
#include "core/shade.h"

#include <memory>

namespace pnr {

struct GatheredLight; // radiosity.cpp

// A place whose gathered light is asked for. The normal is unit, on the side that is lit.
struct GatherPlace {
    Vec3 position{0}, normal{0};
    std::uint32_t surface = 0;
    double error = 0; // bound on the position, as of the hit
    double width = 0; // of a pixel there
};

// `shading` without its `gathered`; the whole picture is looked at.
std::shared_ptr<const GatheredLight> make_gathered_light(const Shading& shading, const PictureView& view,
                                                         const Progress& progress = {});
std::int64_t record_count(const GatheredLight& gathered);

// Width of a pixel at distance 1, in world units; at any distance where rays run side by side.
double pixel_width(const PictureView& view, Vec2 pixel);

// What a white matt surface would reflect of the light gathered at a hit, times POV-Ray's brightness: radiance. `normal` is
// unit, on the viewer's side. Surfaces that gather rays meet go on with one ray each, recursion_limit deep.
Color gathered_light(const Shading& shading, const Hit& hit, Vec3 normal, SampleState& state);

} // namespace pnr
