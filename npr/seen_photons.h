// SPDX-License-Identifier: GPL-3.0-or-later
// Which painted photons the picture shows, and where [LW10 3.2.2, step 1].
#pragma once

#include "core/gbuffer.h"
#include "core/photon_map.h"

#include <vector>

namespace pnr {

// A photon whose object its pixel shows there, directly or through a specular chain.
struct SeenPhoton {
    std::int32_t x, y;    // the pixel
    std::uint32_t photon; // index into PhotonMap::photons
    double z;             // as in gbuffer.exr
    Vec2f at;             // where in the picture, in pixels
};

// In the order of the photons, in chunks. Needs PhotonMap::normals.
std::vector<std::vector<SeenPhoton>> see_photons(const World& world, const GBuffer& gbuffer,
                                                 const PhotonMap& map);

} // namespace pnr
