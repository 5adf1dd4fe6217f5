// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 2: the NPR pass [LW10 3.2], four steps in order, each a function of values.
#pragma once

#include "core/image.h"
#include "core/settings.h"
#include "npr/maps.h"
#include "npr/orientation.h"
#include "npr/seats.h"

#include <functional>
#include <span>

namespace pnr {

// Step 1 and 2 [LW10 3.2.2]: project painted photons, keep the nearest visible one a pixel, and light it.
SparseMap make_sparse_map(const World& world, const GBuffer& gbuffer, const PhotonMap& map,
                          const Settings& settings, const Progress& progress = {});
// Step 3: the 3D field at each source photon, projected to the picture.
void orient_strokes(SparseMap& sparse, const World& world, const GBuffer& gbuffer, const PhotonMap& map,
                    std::span<const Vec3f> oriented);
// [LW10 3.2.3]: inverse-square weights within R over sources of the same object and via; never across a
// silhouette.
InformativeMap make_informative_map(const SparseMap& sparse, const World& world, const GBuffer& gbuffer,
                                    std::uint64_t seed, const Progress& progress = {});
// [LW10 3.2.4; Wang and Lee 2003]: noise, smoothing, impressionistic line integral convolution. Premultiplied
// by coverage, mix and the chain's weight.
Layer convolve(const InformativeMap& informative, const Seats& seats, const World& world,
               const GBuffer& gbuffer, std::uint64_t seed, const Progress& progress = {});

// Radius of the informative disc of an object in pixels of this picture.
double scaled(double pixels_at_512, int height);

struct PaintResult {
    OrientationFields fields;
    std::vector<Vec3f> oriented; // T per photon
    SparseMap sparse;
    InformativeMap informative;
    Layer layer;
};

} // namespace pnr
