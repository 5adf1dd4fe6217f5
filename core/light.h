// SPDX-License-Identifier: GPL-3.0-or-later
// Lights as the passes meet them: POV-Ray's point, spot and parallel lights, and emitters with area.
// Every sample_x has its pdf beside it.
#pragma once

#include "core/rng.h"
#include "core/scene.h"
#include "core/types.h"

namespace pnr {

struct Light {
    LightSource said;       // position, point_at in world space; emitter's radiance resolved below
    Color radiance{0};      // of an emitter, W/(m^2 sr); black for POV-Ray's lights
    double area = 0;        // of an emitter; 0 for POV-Ray's lights
    Color power{0};         // emitted flux in W (emitter: pi * area * radiance); for POV-Ray's lights a weight only
    bool is_emitter() const { return area > 0; }
};

// Resolves radiance or power of an emitter; the light must already be in world space.
Light make_light(const LightSource& said);

// The emitter's surface as shapes for the BVH: sphere, disc, a rectangle as two triangles, a hemisphere as a half sphere.
// (built in world.cpp; here only sampling)

// A point chosen to light `position` from: area samples for emitters (by solid angle where that is cheaper in noise), the
// one point else.
struct LightSample {
    Vec3 point{0};          // on the light; for parallel lights far outside the scene
    Vec3 direction{0};      // unit, from the lit position to the point
    double distance = 0;
    double error = 0;       // of the point, for connect()
    Color irradiance{0};    // radiance * cos-free: multiply by f_r * cos(theta at the surface): contribution / pdf, for POV-Ray's
                            // lights pi c f(d) spot, so that f_r = albedo/pi gives POV-Ray's albedo c cos
    double pdf = 0;         // solid angle at `position`; 0: a delta light
};
// Black when the light does not reach the position (behind a rectangle, outside a spot's cone). u in [0, 1)^2.
LightSample sample_light(const Light& light, Vec3 position, Vec2 u);
// Solid-angle density with which sample_light would have chosen the emitter's point `on_light` (normal there `normal`).
double sample_light_pdf(const Light& light, Vec3 position, Vec3 on_light, Vec3 normal);

// Spot and parallel fall-off times distance fading of a POV-Ray light at a position; 1 for emitters.
double light_attenuation(const Light& light, Vec3 position);

} // namespace pnr
