// SPDX-License-Identifier: GPL-3.0-or-later
// What each pixel's centre sees, followed through mirrors and glass; traced once, read by passes 2 and 3.
#pragma once

#include "core/image.h"
#include "core/material.h"
#include "core/parallel.h"
#include "core/world.h"

namespace pnr {

// World space. At glass the branch of larger weight is followed while that is >= 0.5, up to max_trace_level.
struct Seen {
    Vec3f position{0};
    Vec3f normal{0};        // geometric shading normal, unit, facing the viewer
    Vec3f toward_viewer{0}; // unit, back along the last segment
    float z = 0;            // length of the path from the camera; 0: nothing seen
    float z_specular = 0;   // length of the path up to the last specular hit; 0 if seen directly
    Vec3f last_specular{0}; // that hit's position
    std::uint32_t object = 0,
                  via = 0;     // numbers; via: the first specular object on the way, 0 if seen directly
    std::uint32_t surface = 0; // index into World::surfaces of the seen point
    Color weight{1};           // of the chain: what reaches the camera of the radiance leaving the seen point
    Vec3f dpdx{0}, dpdy{0};    // how the seen point moves per pixel to the right and down (through the chain)
    bool npr = false;          // the seen object is painted and its mix > 0
};

struct GBuffer {
    PictureView view; // world space camera and the picture's full size
    PixelRect window; // pixels that were traced (a crop plus its apron, or all); others are all zero
    Image<Seen> seen;
    Image<float> coverage; // share of the pixel under painted objects, 0..1, by supersampling at borders
};

// The picture's size comes from `view`; `window` is clipped to it. The pixels of a window have the bits they
// have when the whole picture is traced.
GBuffer make_gbuffer(const World& world, const PictureView& view, PixelRect window,
                     const RenderSettings& settings, const Progress& progress = {});

// Where sample `i` of pixel (x, y) lies in the picture: a low-discrepancy sequence of the pixel's own, so
// that every power of two of first samples is stratified. Coverage and pass 3 share it: what the one counts
// as painted the other leaves out.
Vec2 pixel_sample(std::uint64_t seed, int x, int y, int i);

// The specular branch that a chain follows at a surface: mirror or refraction, whichever weighs more (mean
// over RGB), if that is at least half; else the chain ends there. A painted surface always ends it: its paint
// is what is seen.
enum class ChainBranch { none, mirror, transmit };
ChainBranch chain_branch(const World& world, const Hit& hit, const Bsdf& bsdf);
// Whether the object that a hit belongs to is painted with mix > 0; and its mix (0 if not painted).
double paint_mix(const World& world, const Hit& hit);
// Direction a chain leaves the hit in; `branch` is not none. At total reflection `transmit` is never the
// larger branch.
Vec3 branch_direction(const Bsdf& bsdf, Vec3 outgoing, ChainBranch branch);
// Share of the radiance from that direction that leaves the surface towards the viewer. Radiance is larger by
// the square of the ratio in the denser medium [Veach 1997, 5.2]; on the way in and out again that cancels.
Color branch_weight(const Bsdf& bsdf, ChainBranch branch);
// What the medium leaves of light over the segment that found the hit (interiors absorb only inside).
Color segment_transmittance(const World& world, const Hit& hit, const Bsdf& bsdf, double distance);

} // namespace pnr
