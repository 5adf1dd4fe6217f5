// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface answers to light, and what fills it, as POV-Ray's `finish` and `interior` say it.
#pragma once

#include "core/types.h"

namespace pnr {

// POV-Ray's `reflection`: between min (facing) and max (grazing).
struct Reflection {
    Color min{0}, max{0};
    double falloff = 1;
    double exponent = 1;   // what is seen in the mirror, to the power 1 / exponent
    double metallic = 0;   // 0..1: how far the pigment tints it
    bool fresnel = false;
};

// `irid`: a thin film, whose thickness is in the unit of global_settings { irid_wavelength }.
struct Iridescence {
    double amount = 0;
    double thickness = 0;
    double turbulence = 0;
};

struct Finish { // defaults are POV-Ray 3.7's
    Color ambient{0.1f};
    Color emission{0};
    double diffuse = 0.6;
    double diffuse_back = 0; // for light that falls on the side away from the viewer
    double brilliance = 1;
    double crand = 0;        // graininess: what diffuse light may lose at random
    double phong = 0, phong_size = 40;
    double specular = 0, roughness = 0.05;
    double metallic = 0;     // of the highlights
    Iridescence irid;
    Reflection reflection;
    bool conserve_energy = false; // what is reflected does not pass through
};

struct Interior {
    double ior = 1;
    double fade_distance = 0, fade_power = 0;
    Color fade_color{0};
    double caustics = 0;     // fakes: shadows are brightened by this power of the cosine between normal and light
};

// ---- POV-Ray's formulas. Directions are unit and point away from the surface.

// Tint of a metal's highlights and reflections: the pigment's colour where light falls straight in, white at grazing light.
// `cosine` is between normal and light (or viewer).
Color metal_tint(Color pigment, double metallic, double cosine);

// The mirror's reflectance at this cosine between normal and viewer; `fresnel` is that of the interface, used if the finish
// asks for it.
Color reflectance(const Reflection& reflection, Color pigment, double cosine, double fresnel);

// What a surface is lit by.
struct LampView {
    Vec3 normal, outgoing, toward; // `toward` the lamp
    bool both_sides = false;       // double_illuminate: light from behind counts like light from the front
    bool highlights = true;        // not of shadowless lamps
    double grain = 0;              // random number in [0, 1) for crand
};
// The colour that a lamp of colour 1 gives: diffuse, highlights, thin film. `opacity` is the share of light that the pigment
// does not let through.
Color lamp_light(const Finish& finish, Color pigment, float opacity, const LampView& view, Color irid_wavelength);

} // namespace pnr
