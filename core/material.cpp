// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/material.h"

#include "core/texture_mix.h"

#include "core/light.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Color clamp_albedo(Color c) { return glm::clamp(c, Color(0), Color(1)); }

// POV-Ray adds s cos^n to the light's colour without a cosine; a Phong lobe g (n + 2) / (2 pi) cos^n has the
// same peak for g = 2 s / (n + 2). A half-vector lobe of exponent m looks like a mirror-direction lobe of m
// / 4.
struct GlossyLobe {
    double albedo = 0, exponent = 0;
};

GlossyLobe highlight(const Finish& finish) {
    const auto lobe = [](double strength, double exponent) {
        return GlossyLobe{2 * strength / (exponent + 2), exponent};
    };
    const GlossyLobe phong =
        finish.phong > 0 ? lobe(finish.phong, std::max(0.0, finish.phong_size)) : GlossyLobe{};
    const GlossyLobe specular =
        finish.specular > 0 ? lobe(finish.specular, 0.25 / std::max(finish.roughness, 1e-6)) : GlossyLobe{};
    const double sum = phong.albedo + specular.albedo;
    if (!(sum > 0)) return {};
    return {sum, (phong.albedo * phong.exponent + specular.albedo * specular.exponent) / sum};
}

void orient(Bsdf& bsdf, const Hit& hit, Vec3 outgoing) {
    bsdf.inside = glm::dot(hit.normal, outgoing) < 0;
    bsdf.geometric = bsdf.inside ? -hit.normal : hit.normal;
}

// What the layers of one texture ask for; what they share of the light is settled at the end.
struct Sum {
    Bsdf& bsdf;
    double exponents = 0; // glossy_exponent times the glossy lobe
    Vec3 normal{0};

    void add_layer(const LayerPoint& layer, const Interior& interior, Vec3 outgoing, Color& mirror, float share);
    void add_texture(const Material& material, const Texture& plain, const SurfacePoint& at, Vec3 outgoing,
                     float share);
};

void Sum::add_layer(const LayerPoint& layer, const Interior& interior, Vec3 outgoing, Color& mirror, float share) {
    const Finish& finish = layer.finish;
    const Color rgb = clamp_albedo(layer.color), above = clamp_albedo(layer.above);
    const double cosine = std::clamp(glm::dot(layer.normal, outgoing), 0.0, 1.0);
    // The share that passes as a whole (POV-Ray: filter by the pigment's largest component).
    const float through = std::clamp(max_component(layer.passed), 0.f, 1.f);
    const double fresnel =
        finish.reflection.fresnel
            ? fresnel_dielectric(cosine, bsdf.inside ? interior.ior : 1 / interior.ior)
            : 0;
    const Color reflected = clamp_albedo(reflectance(finish.reflection, rgb, cosine, fresnel));
    const GlossyLobe lobe = highlight(finish);
    const Color glossy = above * static_cast<float>(lobe.albedo) *
                         (finish.metallic > 0 ? metal_tint(rgb, finish.metallic, cosine) : Color(1));
    bsdf.emission += share * above * finish.emission * layer.color;
    bsdf.diffuse += share * above * rgb * static_cast<float>(std::max(0.0, finish.diffuse)) * (1 - through);
    bsdf.glossy += share * glossy;
    bsdf.tint += share * above * rgb * (1 - through);
    bsdf.metal = std::max(bsdf.metal, std::clamp(std::max(finish.metallic, finish.reflection.metallic), 0.0, 1.0));
    exponents += share * max_component(glossy) * lobe.exponent;
    normal += static_cast<double>(share) *
              (static_cast<double>(max_component(above)) * (1.001 - through) + max_component(reflected)) * layer.normal;
    mirror = clamp_albedo(mirror + reflected);
}

void Sum::add_texture(const Material& material, const Texture& plain, const SurfacePoint& at,
                      Vec3 outgoing, float share) {
    Color mirror(0);
    Color lowest(0);
    std::optional<Vec3> top;
    const Color passed = clamp_albedo(for_each_layer(plain, at, [&](const LayerPoint& layer) {
        if (!top) top = layer.normal;
        lowest = clamp_albedo(layer.color);
        add_layer(layer, material.interior, outgoing, mirror, share);
    }));
    const float through = max_component(passed);
    // The interface reflects at least by Fresnel's law where light passes it; an author's reflection may be
    // stronger.
    const double cosine = top ? std::clamp(glm::dot(*top, outgoing), 0.0, 1.0) : 1;
    const Color interface_reflection(through > 0 ? static_cast<float>(fresnel_dielectric(cosine, bsdf.eta)) : 0.f);
    bsdf.mirror += share * glm::max(interface_reflection * through, mirror);
    bsdf.transmit += share * passed * (Color(1) - glm::max(interface_reflection, mirror));
    bsdf.tint += share * through * lowest;
}

// What is left for the scattering lobes; they share it when they ask for more.
void conserve_energy(Bsdf& bsdf) {
    const Color left = glm::max(Color(0), Color(1) - bsdf.mirror - bsdf.transmit);
    for (int c = 0; c < 3; ++c) {
        const float asked = bsdf.diffuse[c] + bsdf.glossy[c];
        if (asked <= left[c]) continue;
        bsdf.diffuse[c] *= left[c] / asked;
        bsdf.glossy[c] *= left[c] / asked;
    }
}

} // namespace

Bsdf make_bsdf(const World& world, const Hit& hit, Vec3 outgoing) {
    Bsdf bsdf;
    orient(bsdf, hit, outgoing);
    bsdf.normal = bsdf.geometric;
    const Surface& surface = world.surfaces[hit.surface];
    if (surface.light >= 0) { // emitters are black and shine from one side
        if (!bsdf.inside) bsdf.emission = world.lights[static_cast<std::size_t>(surface.light)].radiance;
        return bsdf;
    }
    const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
    const double ior = material.interior.ior > 0 ? material.interior.ior : 1;
    bsdf.eta = bsdf.inside ? ior : 1 / ior;
    SurfacePoint at = facing_point(hit, -outgoing);
    // A shading normal that looks away from the viewer would make the surface black there.
    if (!(glm::dot(at.normal, outgoing) > 0)) at.normal = bsdf.geometric;
    Sum sum{bsdf};
    const Texture& texture = side_texture(material, bsdf.inside);
    if (is_single(hit, texture))
        sum.add_texture(material, texture, at, outgoing, 1);
    else
        for_each_texture(world, hit, bsdf.inside, at, [&](const Texture& plain, const SurfacePoint& here, double share) {
            sum.add_texture(material, plain, here, outgoing, static_cast<float>(share));
        });
    const double length = glm::length(sum.normal);
    bsdf.normal = length > 0 && glm::dot(sum.normal, outgoing) > 0 ? sum.normal / length : at.normal;
    if (const float glossy = max_component(bsdf.glossy); glossy > 0) bsdf.glossy_exponent = sum.exponents / glossy;
    conserve_energy(bsdf);
    return bsdf;
}

namespace {

bool reflects(const TextureLayer& layer) {
    const Reflection& r = layer.finish.reflection;
    return max_component(r.max) > 0 || max_component(r.min) > 0;
}

bool mirrors(const Texture& texture) {
    if (!is_plain(texture))
        return std::any_of(texture.textures.begin(), texture.textures.end(),
                           [](const auto& entry) { return mirrors(entry.value); });
    return reflects(texture) || std::any_of(texture.upper.begin(), texture.upper.end(), reflects);
}

bool lets_light_through(const Texture& texture) {
    if (!is_plain(texture))
        return std::any_of(texture.textures.begin(), texture.textures.end(),
                           [](const auto& entry) { return lets_light_through(entry.value); });
    return is_see_through(texture.pigment) &&
           std::all_of(texture.upper.begin(), texture.upper.end(),
                       [](const TextureLayer& layer) { return is_see_through(layer.pigment); });
}

} // namespace

bool is_specular(const Material& material) {
    return material.photons.specular_probability.value_or(0) > 0 || lets_light_through(material) ||
           mirrors(material.texture) || (material.interior_texture && mirrors(*material.interior_texture));
}

bool lets_light_through(const Material& material) {
    return lets_light_through(material.texture) ||
           (material.interior_texture && lets_light_through(*material.interior_texture));
}

bool has_diffuse(const Bsdf& bsdf) { return !is_black(bsdf.diffuse) || !is_black(bsdf.glossy); }
bool has_specular(const Bsdf& bsdf) { return !is_black(bsdf.mirror) || !is_black(bsdf.transmit); }

namespace {

// Both directions on the front, for the shading and for the true surface.
bool both_in_front(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming) {
    return glm::dot(bsdf.normal, incoming) > 0 && glm::dot(bsdf.geometric, incoming) > 0 &&
           glm::dot(bsdf.normal, outgoing) > 0 && glm::dot(bsdf.geometric, outgoing) > 0;
}

// The probability that sample_bsdf takes the glossy lobe.
double glossy_share(const Bsdf& bsdf) {
    const double diffuse = max_component(bsdf.diffuse), glossy = max_component(bsdf.glossy);
    return diffuse + glossy > 0 ? glossy / (diffuse + glossy) : 0;
}

double lobe_power(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming) {
    const double cosine = glm::dot(mirror_direction(outgoing, bsdf.normal), incoming);
    return cosine > 0 ? std::pow(std::min(1.0, cosine), bsdf.glossy_exponent) : 0;
}

} // namespace

Color eval_bsdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming) {
    if (!both_in_front(bsdf, outgoing, incoming)) return Color(0);
    Color value = bsdf.diffuse * static_cast<float>(1 / pi);
    if (!is_black(bsdf.glossy)) {
        // The modified Phong lobe: reciprocal, its albedo is `glossy` at normal incidence and less elsewhere
        // [Lafortune and Willems 1994].
        const double scale = (bsdf.glossy_exponent + 2) / (2 * pi) * lobe_power(bsdf, outgoing, incoming);
        value += bsdf.glossy * static_cast<float>(scale);
    }
    return value;
}

double sample_bsdf_pdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 incoming) {
    const double cosine = glm::dot(bsdf.normal, incoming);
    const double share = glossy_share(bsdf);
    double pdf = 0;
    if (share < 1 && cosine > 0) pdf += (1 - share) * cosine / pi;
    if (share > 0) {
        const double n = bsdf.glossy_exponent;
        pdf += share * (n + 1) / (2 * pi) * lobe_power(bsdf, outgoing, incoming);
    }
    return pdf;
}

BsdfSample sample_bsdf(const Bsdf& bsdf, Vec3 outgoing, Vec3 u) {
    BsdfSample sample;
    if (!has_diffuse(bsdf)) return sample;
    if (u.z >= glossy_share(bsdf)) {
        sample.incoming = square_to_cosine({u.x, u.y}, make_frame(bsdf.normal));
    } else {
        // cos^n about the mirror direction: cos = (1 - u)^(1 / (n + 1)).
        const Frame frame = make_frame(mirror_direction(outgoing, bsdf.normal));
        const double z = std::pow(1 - u.x, 1 / (bsdf.glossy_exponent + 1));
        const double r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * pi * u.y;
        sample.incoming =
            glm::normalize(r * std::cos(angle) * frame.x + r * std::sin(angle) * frame.y + z * frame.z);
    }
    sample.pdf = sample_bsdf_pdf(bsdf, outgoing, sample.incoming);
    if (!(sample.pdf > 0)) return sample;
    const double cosine = glm::dot(bsdf.normal, sample.incoming);
    sample.weight = eval_bsdf(bsdf, outgoing, sample.incoming) * static_cast<float>(cosine / sample.pdf);
    return sample;
}

Vec3 mirror_direction(Vec3 outgoing, Vec3 normal) {
    return glm::normalize(2 * glm::dot(outgoing, normal) * normal - outgoing);
}

bool refract_direction(Vec3 outgoing, Vec3 normal, double eta, Vec3& refracted) {
    const double cosine = glm::dot(outgoing, normal);
    const double sin2 = eta * eta * std::max(0.0, 1 - cosine * cosine);
    if (sin2 >= 1) return false;
    refracted = glm::normalize((eta * cosine - std::sqrt(1 - sin2)) * normal - eta * outgoing);
    return true;
}

double fresnel_dielectric(double cos_outgoing, double eta) {
    if (eta == 1) return 0;
    const double sin2 = eta * eta * std::max(0.0, 1 - cos_outgoing * cos_outgoing);
    if (sin2 >= 1) return 1;
    const double cos_inside = std::sqrt(1 - sin2);
    const double parallel = (cos_outgoing - eta * cos_inside) / (cos_outgoing + eta * cos_inside);
    const double perpendicular = (eta * cos_outgoing - cos_inside) / (eta * cos_outgoing + cos_inside);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

Color interior_transmittance(const Interior& interior, double distance) {
    if (!(interior.fade_power > 0) || !(interior.fade_distance > 0) || !(distance > 0)) return Color(1);
    const double depth = distance / interior.fade_distance;
    if (interior.fade_power >= 1000) // Beer and Lambert's law, as POV-Ray has it from this power on
        return glm::exp((interior.fade_color - Color(1)) * static_cast<float>(depth));
    const float passed = static_cast<float>(1 / (1 + std::pow(depth, interior.fade_power)));
    return interior.fade_color + (Color(1) - interior.fade_color) * passed;
}

} // namespace pnr
