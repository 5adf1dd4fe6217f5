// SPDX-License-Identifier: GPL-3.0-or-later
// Light that leaves a surface point towards a viewer: direct by shadow rays, indirect and caustic from the
// photon map.
#pragma once

#include "core/material.h"
#include "core/photon_map.h"
#include "core/world.h"

#include <vector>

namespace pnr {

enum class GatherKernel { constant, epanechnikov, cone, gaussian };

struct GatherSettings {
    int count = 100;  // k
    float radius = 0; // cap, world units; > 0
    GatherKernel kernel = GatherKernel::epanechnikov;
    bool direct = false; // also photons of path `direct` (else those are left to shadow rays)
    bool indirect = true, caustic = true;
    int least = 0; // where the cap holds fewer photons it is doubled, twice at most (POV-Ray's gather min)
    bool field = true;  // indirect light from PhotonMap::field where the map has one, instead of its density
    bool sharp = false; // gather rays from the point itself where the field's records lie too far apart
};

// Photon density estimate of the reflected radiance: sum of f_r * flux * kernel. Consistent: when the k-th
// photon ends the search it is left out, and the kernel, normalised over its disc, needs no further factor
// [Garcia et al. 2011]; when the cap ends it all count. Photons from the other side of the surface are
// rejected. `scratch` is reused between calls.
Color gather(const World& world, const PhotonMap& map, const GatherSettings& settings, Vec3 position,
             const Bsdf& bsdf, Vec3 outgoing, std::vector<Neighbour>& scratch);
// The settings that suit a map and a scene when the author gave none.
GatherSettings default_gather(const World& world, const PhotonMap& map, const PhotonSettings& settings);

// Where the shadow rays of one point go: consecutive points of one low-discrepancy sequence, so that the
// samples of a pixel share it (first = number of shadow rays spent before).
struct LightPoints {
    std::uint64_t key = 0;
    std::uint32_t first = 0;
};

// Direct light at a hit by shadow rays, emitters with `samples` rays each. Excludes emission. Light that
// glossy lobes see is found from both sides and weighted by the power heuristic [Veach 1997]. Every surface
// that rays of kind shadow meet blocks, glass too: its light comes as caustic photons.
Color direct_light(const World& world, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing, int samples,
                   LightPoints points);
Color direct_light(const World& world, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing, int samples,
                   Rng& rng);

// Radiance that leaves an emitter's point against `direction`; black from behind or if the surface is no
// emitter.
Color emitted_radiance(const World& world, const Hit& hit, const Bsdf& bsdf);

// All diffuse and glossy light that leaves a stored point (pass 2's "radiance at each source photon"):
// emission, direct by shadow rays, the rest from the map. `position` lies on `surface`, `normal` on the side
// seen.
Color radiance_at(const World& world, const PhotonMap& map, const GatherSettings& settings, Vec3 position,
                  Vec3 normal, std::uint32_t surface, Vec3 toward_viewer, int shadow_samples, Rng& rng,
                  std::vector<Neighbour>& scratch);

} // namespace pnr
