// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 3: the rendering pass [LW10 3.3].
#pragma once

#include "core/gbuffer.h"
#include "core/image.h"
#include "core/photon_map.h"
#include "core/world.h"

#include <optional>

namespace pnr {

// Per-pixel sample counts of what went wrong; reported, never hidden (design.md: "No NaN, no infinity reaches
// an image").
struct SampleFaults {
    std::int64_t nan = 0, inf = 0, negative = 0;
    std::int64_t sum() const { return nan + inf + negative; }
    SampleFaults& operator+=(const SampleFaults& more) {
        nan += more.nan, inf += more.inf, negative += more.negative;
        return *this;
    }
};

// A pixel with such samples.
struct FaultPlace {
    int x = 0, y = 0;
    std::uint32_t object = 0; // where the first of them went wrong: the deepest hit of its path; 0: nowhere
    SampleFaults faults;
};
// Adds what another pass found, so that each pixel stands once, in the order of rows.
void merge_faults(std::vector<FaultPlace>& places, std::vector<FaultPlace> more);

// AOVs of the photoreal light, filled when asked for (empty images else); radiance of the pixel.
struct LightParts {
    bool wanted = false;
    Image<Color> direct, indirect, caustic, specular;
    Image<float> photon_density;
};

// The camera samples that one progressive pass takes of each pixel: `count` of its sequence, from `first` on;
// both times the pixel's share, where shares are given.
struct SampleRange {
    int first = 0, count = 1;
    const Image<std::uint8_t>* shares = nullptr;

    int share(int x, int y) const { return shares ? shares->at(x, y) : 1; }
};

struct RenderResult {
    Layer layer;
    SampleFaults faults;
    std::vector<FaultPlace> fault_places;
    LightParts parts;
    std::int64_t camera_rays = 0, gathers = 0;
    bool stopped = false; // progress said stop: pixels hold what they had got by then
};

// Renders `window` of the picture; `gbuffer` must hold it and one pixel more all round (image.h: grow). Its
// pixels have the bits they have in the full picture. With Integrator::path every pixel gets samples_max
// paths and the map is not looked at. Pixels wholly painted (coverage 1, seen directly, mix 1) get no rays;
// of border pixels only the share that is not painted is rendered; behind mirrors and glass the branch that
// leads to paint is left out. `map` may be empty (raytraced scenes). With `samples` every pixel gets just
// these, whatever the settings say, so that passes add up (core/progressive.h). When progress says stop, the
// unfinished picture is returned, not thrown away.
RenderResult render(const World& world, const GBuffer& gbuffer, const PhotonMap& map,
                    const Settings& settings, PixelRect window, bool want_parts,
                    const Progress& progress = {}, std::optional<SampleRange> samples = {});

} // namespace pnr
