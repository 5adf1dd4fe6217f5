// SPDX-License-Identifier: GPL-3.0-or-later
// Lights as the passes meet them: POV-Ray's point, spot and parallel lights, and emitters with area.
// Every sample_x has its pdf beside it.
#pragma once

#include "core/rng.h"
#include "core/scene.h"
#include "core/types.h"

#include <memory>

namespace pnr {

struct Probe; // probe.h

struct Light {
    LightSource said;  // position, point_at in world space; emitter's radiance resolved below
    Color radiance{0}; // of an emitter, W/(m^2 sr); black for POV-Ray's lights
    double area = 0;   // of an emitter; 0 for POV-Ray's lights
    Color power{0}; // emitted flux in W (emitter: pi * area * radiance); for POV-Ray's lights a weight only
    std::shared_ptr<const Probe> window; // projected_through, in scene space ...
    Vec3 offset{0};                      // ... which is world space plus this
    bool is_emitter() const { return area > 0; }
    // Whether its light comes from many points: sample_light's u chooses one.
    bool has_extent() const { return is_emitter() || (said.area && !said.parallel && !said.cylinder); }
};

// Resolves radiance or power of an emitter (with neither: radiance 1); the light must already be in world
// space. Throws SceneError for an emitter without area, or with a radiance or power that is negative or not
// finite.
Light make_light(const LightSource& said);

// The emitter's surface as shapes for the BVH: sphere, disc, a rectangle as two triangles, a hemisphere as a
// half sphere. (built in world.cpp; here only sampling)

// A point chosen to light `position` from: area samples for emitters (by solid angle where that is cheaper in
// noise), a point of the area of POV-Ray's area lights, the one point else.
struct LightSample {
    Vec3 point{0};     // on the light; for parallel lights on the plane through its position
    Vec3 direction{0}; // unit, from the lit position to the point
    double distance = 0;
    double error = 0; // of the point, for connect()
    Color irradiance{
        0}; // radiance * cos-free: multiply by f_r * cos(theta at the surface): contribution / pdf, for
            // POV-Ray's lights pi c f(d) spot, so that f_r = albedo/pi gives POV-Ray's albedo c cos
    double pdf = 0; // solid angle at `position`; 0: a delta light
};
// Black when the light does not reach the position (behind a rectangle, outside a spot's cone). u in [0,
// 1)^2. Spheres are sampled by solid angle, and so are hemispheres from near, where points of the missing
// half come back black with their pdf; from afar by the area seen. Rectangles by solid angle [Urena et al.
// 2013], discs by area.
LightSample sample_light(const Light& light, Vec3 position, Vec2 u);
// Solid-angle density with which sample_light would have chosen the emitter's point `on_light` (normal there
// `normal`).
double sample_light_pdf(const Light& light, Vec3 position, Vec3 on_light, Vec3 normal);

// Spot and parallel fall-off times distance fading of a POV-Ray light at a position; 1 for emitters.
double light_attenuation(const Light& light, Vec3 position);
// The two factors: the fall-off of spot and cylinder at a position, and 2 / (1 + (d /
// fade_distance)^fade_power).
double light_falloff(const Light& light, Vec3 position);
double light_fading(const Light& light, double distance);
// Unit direction from the light's position to point_at; zero if they coincide.
Vec3 light_axis(const Light& light);
// Whether its rays all go along its axis: POV-Ray's parallel lights and also its cylinder lights.
bool is_parallel(const Light& light);

// A point of an emitter by area and a direction by cosine: what its photons start with. Every such pair
// carries the same power.
struct EmissionSample {
    Vec3 point{0};
    Vec3 normal{0};    // unit, the side that emits
    Vec3 direction{0}; // unit
    double error = 0;  // bound on the distance of point to the true surface
};
EmissionSample sample_emission(const Light& light, Vec2 u_point, Vec2 u_direction);

// ---- maps from the unit square, measure preserving
// --------------------------------------------------------------

Vec2 square_to_disc(Vec2 u);                       // unit disc by area [Shirley and Chiu 1997]
Vec3 square_to_cosine(Vec2 u, const Frame& frame); // hemisphere about frame.z, density cos / pi
// Directions within the cone 1 - cos <= one_minus_cos about frame.z, uniform; one_minus_cos in (0, 2].
Vec3 square_to_cone(Vec2 u, const Frame& frame, double one_minus_cos);

} // namespace pnr
