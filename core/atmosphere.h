// SPDX-License-Identifier: GPL-3.0-or-later
// What fills the space between and beyond the objects: POV-Ray's background, sky_sphere, fog and rainbow.
#pragma once

#include "core/pigment.h"
#include "core/types.h"

#include <vector>

namespace pnr {

struct World;

// Pigments over the unit sphere of directions, each over the ones before.
struct SkySphere {
    std::vector<Pigment> layers;
    Color emission{1}; // factor of the light that it sends
};

// Mist of POV-Ray's kinds: `ground` thins out above `offset` along `up`, to a quarter at `altitude` above it.
struct Fog {
    bool ground = false;
    double distance = 0;  // at which a share 1/e is left; 0: there is no fog
    ColorFT color;        // filter: how far it tints what is seen through it; transmit: how much is always seen
    Vec3 up{0, 1, 0};
    double offset = 0, altitude = 0;
    Vec3 turbulence{0}; // 0: even
    int octaves = 6;
    double lambda = 2, omega = 0.5, depth = 0.5; // depth: POV-Ray's turb_depth
};

// Colours over the angle from `direction`; what is near hides them: 1/e of them is left at `distance`.
struct Rainbow {
    Vec3 direction{0, 0, 1}, up{0, 1, 0}; // to the arc's centre; where its middle is
    double angle = 0, width = 0;          // degrees from the direction; of the band
    double distance = 1e7, jitter = 0;
    double arc_angle = 360, falloff_angle = 360; // degrees: nothing is beyond the one, all within the other
    std::vector<ColorStop> map;
};

struct Atmosphere {
    ColorFT background; // transmit: share of the background that lets through whatever stands behind the picture
    SkySphere sky;      // without layers: the background alone
    std::vector<Fog> fogs;
    std::vector<Rainbow> rainbows;
};

// Radiance that comes from beyond all objects against the unit `direction`.
Color sky_radiance(const World& world, Vec3 direction);
bool has_sky_light(const World& world); // whether that may be anything but black

// What is seen of `behind` from the ray's origin through fogs and rainbows, `distance` away (infinity: beyond all objects).
// The direction is unit.
Color through_atmosphere(const World& world, const Ray& ray, double distance, Color behind);

// The share of light that fogs leave of what goes `distance` along the ray.
Color fog_transmittance(const World& world, const Ray& ray, double distance);

} // namespace pnr
