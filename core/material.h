// SPDX-License-Identifier: GPL-3.0-or-later
// One energy-conserving BSDF made of a POV-Ray finish, used alike by photons, the eye and the path tracer in photon-lit
// scenes. Directions point away from the surface, are unit, and live in world space.
//
// Where a texture has several finishes, as layers or as parts of a pattern, their lobes are added, each with its share.
//
// Lobes: Lambertian diffuse (pigment * diffuse), a glossy lobe (specular or phong), a perfect mirror (reflection), and a
// dielectric interface (pigment filter/transmit with interior ior; Fresnel shares light between mirror and refraction).
#pragma once

#include "core/rng.h"
#include "core/world.h"

namespace pnr {

struct Bsdf {
    Vec3 normal{0};           // shading normal, on the side of `outgoing`
    Vec3 geometric{0};        // geometric normal on the same side
    bool inside = false;      // the ray meets the back of the surface (it is leaving a solid)
    Color diffuse{0};         // albedo
    Color glossy{0};          // albedo of the glossy lobe at normal incidence
    double glossy_exponent = 0; // Phong exponent, normalised lobe about the mirror direction
    Color mirror{0};          // reflectance of the perfect mirror for this outgoing direction (Fresnel included)
    Color transmit{0};        // transmittance into the refracted direction (Fresnel included); black at total reflection
    double eta = 1;           // ior of the side of `outgoing` over that of the other side
    Color emission{0};
    Color tint{0};    // the pigment's colour, whatever the finish makes of it
    double metal = 0; // how far highlights and reflections have it, 0..1
};

// `outgoing` points back along the ray that found the hit.
Bsdf make_bsdf(const World& world, const Hit& hit, Vec3 outgoing);

// Whether light may leave the material by mirror, refraction or straight through, somewhere on it.
bool is_specular(const Material& material);
bool lets_light_through(const Material& material); // straight or refracted
bool has_diffuse(const Bsdf& bsdf);  // a gather or a stored photon makes sense here
bool has_specular(const Bsdf& bsdf); // mirror or refraction

// f_r of the non-delta lobes, 1/sr, without the cosine; 0 below the horizon.
Color eval_bsdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming);
// A direction for the non-delta lobes and its solid-angle density.
struct BsdfSample {
    Vec3 incoming{0};
    Color weight{0}; // f_r * cos / pdf
    double pdf = 0;
};
BsdfSample sample_bsdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 u);
double sample_bsdf_pdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming);

Vec3 mirror_direction(Vec3 outgoing, Vec3 normal);
// Refracted direction; false at total internal reflection. eta as in Bsdf.
bool refract_direction(Vec3 outgoing, Vec3 normal, double eta, Vec3& refracted);
// Unpolarised Fresnel reflectance of a dielectric; cos_outgoing > 0.
double fresnel_dielectric(double cos_outgoing, double eta);
// Beer-Lambert transmittance of POV-Ray's interior (fade_distance, fade_power, fade_color) over a path inside.
Color interior_transmittance(const Interior& interior, double distance);

} // namespace pnr
