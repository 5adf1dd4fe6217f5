// SPDX-License-Identifier: GPL-3.0-or-later
// Radiance along a camera ray for pass 3: what render.cpp calls for each sample of a pixel.
#pragma once

#include "core/gbuffer.h"
#include "core/photon_map.h"
#include "core/radiance.h"
#include "core/render.h"
#include "core/world.h"

namespace pnr {

struct GatheredLight; // radiosity.h
struct GatherPlace;

// What all samples of a picture share.
struct Shading {
    const World& world;
    const PhotonMap& map;
    const RenderSettings& settings;
    GatherSettings indirect, caustic; // of the map; count 0: none wanted
    bool parts = false;               // LightParts are wanted
    const RadiositySettings* radiosity = nullptr; // of World illumination radiosity ...
    const GatheredLight* gathered = nullptr;      // ... and what was gathered beforehand
};

// Indirect light at a point of a pixel, to be used again by the pixel's other samples that fall on it.
struct KeptIrradiance {
    std::uint32_t surface = 0;
    Vec3 position{0}, normal{0};
    Color irradiance{0};
};

// The state of one camera sample; `kept` and `scratch` live as long as the pixel.
struct SampleState {
    Rng rng;
    LightPoints points;     // of this sample: its first point and `shadow_samples` - 1 more
    int shadow_samples = 1; // to each emitter
    std::vector<KeptIrradiance>* kept = nullptr;
    std::vector<Neighbour>* scratch = nullptr;
    int bounces = 0;         // diffuse ones so far, of gathered light
    double pixel_width = 0;  // of the camera ray at distance 1; for gathered light
    std::vector<GatherPlace>* unknown = nullptr; // collects the places whose gathered light is not known yet
    bool on_chain = true;    // still on the chain that the G-buffer follows
    bool painted = false;    // the chain led to paint
    Color painted_weight{0}; // of the light left out for it
    std::int64_t rays = 0, gathers = 0;
    std::uint32_t faulty = 0; // the first object whose light was no number, infinite or negative; 0: none
    Color direct{0}, indirect{0}, caustic{0}, specular{0}; // parts of the radiance
};

// Notes where a path's light first is none.
inline void watch(const World& world, const Hit& hit, Color light, SampleState& state) {
    if (light.x >= 0 && light.y >= 0 && light.z >= 0 && std::isfinite(light.x + light.y + light.z)) return;
    if (state.faulty == 0) state.faulty = static_cast<std::uint32_t>(world.surfaces[hit.surface].object);
}

// The radiance against a camera ray, without what is painted (the share `mix` of painted objects seen
// directly or through the chain of gbuffer.h). Raytraced scenes get POV-Ray's formulas, photon-mapped ones
// the BSDF of material.h.
Color shade(const Shading& shading, const Ray& camera_ray, SampleState& state);

} // namespace pnr
