// SPDX-License-Identifier: GPL-3.0-or-later
// What each pixel's centre sees, followed through mirrors and glass; traced once, read by passes 2 and 3.
#pragma once

#include "core/image.h"
#include "core/parallel.h"
#include "core/world.h"

namespace pnr {

// World space. At glass the branch of larger weight is followed while that is >= 0.5, up to max_trace_level.
struct Seen {
    Vec3f position{0};
    Vec3f normal{0};       // geometric shading normal, unit, facing the viewer
    Vec3f toward_viewer{0};// unit, back along the last segment
    float z = 0;           // length of the path from the camera; 0: nothing seen
    float z_specular = 0;  // length of the path up to the last specular hit; 0 if seen directly
    Vec3f last_specular{0};// that hit's position
    std::uint32_t object = 0, via = 0; // numbers; via: the first specular object on the way, 0 if seen directly
    std::uint32_t surface = 0;         // index into World::surfaces of the seen point
    Color weight{1};       // of the chain: what reaches the camera of the radiance leaving the seen point
    Vec3f dpdx{0}, dpdy{0};// how the seen point moves per pixel to the right and down (through the chain)
    bool npr = false;      // the seen object is painted and its mix > 0
};

struct GBuffer {
    PictureView view;        // world space camera and the picture's full size
    PixelRect window;        // pixels that were traced (a crop plus its apron, or all); others are all zero
    Image<Seen> seen;
    Image<float> coverage;   // share of the pixel under painted objects, 0..1, by supersampling at borders
};

GBuffer make_gbuffer(const World& world, const PictureView& view, PixelRect window, const RenderSettings& settings,
                     const Progress& progress = {});

} // namespace pnr
