// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, section "Finish"; those it does not print were measured against POV-Ray's pictures.
#include "core/finish.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// How far a metal's tint has faded at this angle: 0 facing, 1 grazing; POV-Ray's fit to a metal's Fresnel curve, over the angle
// from the normal in right angles.
double metal_fade(double cosine) {
    const double x = std::acos(std::clamp(cosine, 0.0, 1.0)) / (pi / 2);
    return std::clamp(0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903, 0.0, 1.0);
}

float diffuse_light(const Finish& finish, float opacity, double cosine, const LampView& view) {
    const double strength = cosine < 0 && !view.both_sides ? finish.diffuse_back : finish.diffuse;
    if (strength == 0) return 0;
    const double facing = std::abs(cosine);
    const double share = finish.brilliance == 1 ? facing : std::pow(facing, finish.brilliance);
    return static_cast<float>(strength * share * opacity - view.grain * finish.crand);
}

float highlight(const Finish& finish, const LampView& view) {
    double sum = 0;
    if (finish.phong > 0) {
        const Vec3 mirrored = 2 * glm::dot(view.outgoing, view.normal) * view.normal - view.outgoing;
        const double aligned = glm::dot(mirrored, view.toward);
        if (aligned > 0) sum += finish.phong * std::pow(aligned, finish.phong_size);
    }
    if (finish.specular > 0 && finish.roughness > 0) {
        const Vec3 half = view.outgoing + view.toward;
        const double length = glm::length(half);
        const double aligned = length > 0 ? glm::dot(half, view.normal) / length : 0;
        if (aligned > 0) sum += finish.specular * std::pow(aligned, 1 / finish.roughness);
    }
    return static_cast<float>(sum);
}

Color film(const Iridescence& irid, double cosines, Color wavelength) {
    const glm::dvec3 phase = 2 * pi * irid.thickness * cosines / glm::max(glm::dvec3(wavelength), glm::dvec3(1e-9));
    return Color(glm::dvec3(1) + irid.amount * glm::cos(phase));
}

} // namespace

Color metal_tint(Color pigment, double metallic, double cosine) {
    return Color(1) + static_cast<float>(metallic * (1 - metal_fade(cosine))) * (pigment - Color(1));
}

Color reflectance(const Reflection& reflection, Color pigment, double cosine, double fresnel) {
    if (is_black(reflection.max) && is_black(reflection.min)) return Color(0);
    const double share = reflection.fresnel ? fresnel : std::pow(std::max(0.0, 1 - cosine), reflection.falloff);
    Color value = reflection.min + static_cast<float>(share) * (reflection.max - reflection.min);
    if (reflection.metallic > 0) value *= metal_tint(pigment, reflection.metallic, cosine);
    return value;
}

Color lamp_light(const Finish& finish, Color pigment, float opacity, const LampView& view, Color irid_wavelength) {
    const double cosine = glm::dot(view.toward, view.normal);
    Color sum = pigment * diffuse_light(finish, opacity, cosine, view);
    if (cosine <= 0 && !view.both_sides) return sum;
    if (view.highlights && (finish.phong > 0 || finish.specular > 0)) {
        const Color tint = finish.metallic > 0 ? metal_tint(pigment, finish.metallic, cosine) : Color(1);
        sum += tint * highlight(finish, view);
    }
    if (finish.irid.amount > 0) sum *= film(finish.irid, cosine + glm::dot(view.outgoing, view.normal), irid_wavelength);
    return sum;
}

} // namespace pnr
