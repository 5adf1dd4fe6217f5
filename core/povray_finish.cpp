// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, section "Finish"; those it does not print were measured against POV-Ray's
// pictures.
#include "core/povray_finish.h"

#include "core/area_light.h"
#include "core/probe.h"

namespace pnr {
namespace {

struct Segment {
    Ray ray;
    RayKind kind = RayKind::camera;
    int level = 0;
    Color throughput{1};
    int solids = 0; // without `hollow` about the ray: there is no fog in them
};

// A hit with all that POV-Ray's formulas ask of it.
struct Point {
    const Hit& hit;
    const Material& material;
    Vec3 normal;        // shading normal, on the viewer's side
    Vec3 outgoing;      // unit, to the viewer
    bool inside;        // the ray meets the back
    Color color;        // the pigment's rgb
    Color transparency; // filter * rgb + transmit
    float opacity;      // 1 - filter - transmit, at least 0
};

Point make_point(const World& world, const Hit& hit, Vec3 direction) {
    const Surface& surface = world.surfaces[hit.surface];
    const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
    const ColorFT c = eval_pigment(material.pigment, surface_point(hit, direction));
    const bool inside = glm::dot(hit.normal, direction) > 0;
    return {hit,
            material,
            inside ? -hit.shading_normal : hit.shading_normal,
            -direction,
            inside,
            c.rgb,
            c.rgb * c.filter + Color{c.transmit},
            std::max(0.0f, 1 - c.filter - c.transmit)};
}

Color trace(const Shading& shading, const Segment& segment, SampleState& state);

// Share of a light that reaches the hit: what lies between tints it by its pigment, opaque things stop it.
// With a caustic map the light through refracting photon targets comes from there.
Color light_through(const Shading& shading, const Hit& from, const Light& light, const LightSample& sample) {
    const World& world = shading.world;
    Color passed{1};
    Ray ray = connect(from, sample.point, sample.error);
    if (light.window) { // what stands between the light and its window throws no shadow
        const auto window = trace(*light.window, sample.point + light.offset, -sample.direction);
        if (!window) return Color{0};
        const double way = sample.distance - glm::distance(window->position, sample.point + light.offset);
        if (way <= 0) return Color{0};
        ray.t_max = std::min(ray.t_max, way);
    }
    if (is_occluded(world, ray, RayKind::blocker)) return Color{0};
    if (light.said.media_attenuation) passed = fog_transmittance(world, ray, ray.t_max);
    if (!world.tinted_shadows) return passed;
    const double whole = ray.t_max;
    double gone = 0;
    for (int surfaces = 0; surfaces < 4 * shading.settings.max_trace_level + 16; ++surfaces) {
        const std::optional<Hit> hit = closest_hit(world, ray, RayKind::shadow);
        if (!hit) return passed;
        const Surface& surface = world.surfaces[hit->surface];
        if (surface.light >= 0) return Color{0};
        const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
        if (world.illumination == Illumination::caustics && material.photons.target &&
            material.photons.refraction)
            return Color{0};
        const Point point = make_point(world, *hit, ray.direction);
        passed *= point.transparency;
        if (point.inside) passed *= interior_transmittance(material.interior, hit->t);
        if (max_component(passed) < shading.settings.adc_bailout) return Color{0};
        gone += hit->t;
        ray = leave(*hit, ray.direction, whole - gone);
        if (ray.t_max <= 0) return passed;
    }
    return Color{0};
}

// The same from another point of the light.
LightSample sample_toward(const Light& light, Vec3 position, Vec3 from) {
    LightSample sample = sample_light(light, position, Vec2{0.5});
    sample.point = from;
    sample.distance = glm::length(from - position);
    if (sample.distance > 0) sample.direction = (from - position) / sample.distance;
    return sample;
}

// Share of a light's colour that reaches the hit, over all its area and through its window.
Color light_share(const Shading& shading, const Hit& hit, const Light& light, const LightSample& sample,
                  SampleState& state) {
    if (!light.has_extent() || light.said.area->illuminates) return light_through(shading, hit, light, sample);
    return area_mean(view_area(light, hit.position, state.rng.bits()), [&](Vec3 from) {
        return light_through(shading, hit, light, sample_toward(light, hit.position, from));
    });
}

// POV-Ray's Fresnel-like curve by which metallic highlights and reflections lose their tint at grazing light;
// x is the angle from the normal over 90 degrees.
float metallic_tint_loss(double cosine) {
    const double x = std::acos(std::clamp(cosine, 0.0, 1.0)) * 2 / pi;
    const double f = 0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903;
    return static_cast<float>(std::clamp(f, 0.0, 1.0));
}

Color metallic_tint(Color color, double metallic, double cosine) {
    const float share = static_cast<float>(metallic) * (1 - metallic_tint_loss(cosine));
    return Color{1} + share * (color - Color{1});
}

// Diffuse, phong and specular light of one light source.
Color lit_from(const Shading& shading, const Point& point, const Light& light, const LightSample& sample,
               SampleState& state) {
    if (is_black(sample.irradiance)) return Color{0};
    const double cosine = glm::dot(sample.direction, point.normal);
    if (cosine <= 0) return Color{0};
    const Finish& finish = point.material.finish;
    Color sum = point.color *
                (point.opacity * static_cast<float>(finish.diffuse * std::pow(cosine, finish.brilliance)));
    if (!light.said.shadowless) {
        const Color tint = metallic_tint(point.color, finish.metallic, cosine);
        if (finish.phong > 0) {
            const double aligned = glm::dot(mirror_direction(point.outgoing, point.normal), sample.direction);
            if (aligned > 0)
                sum += tint * static_cast<float>(finish.phong * std::pow(aligned, finish.phong_size));
        }
        if (finish.specular > 0 && finish.roughness > 0) {
            const double aligned = glm::dot(glm::normalize(point.outgoing + sample.direction), point.normal);
            if (aligned > 0)
                sum += tint * static_cast<float>(finish.specular * std::pow(aligned, 1 / finish.roughness));
        }
    }
    // A light of colour c gives the irradiance pi c cos: POV-Ray's diffuse is albedo c cos.
    sum *= sample.irradiance / static_cast<float>(pi);
    if (is_black(sum) || light.said.shadowless) return sum;
    return sum * light_share(shading, point.hit, light, sample, state);
}

Color lit_by(const Shading& shading, const Point& point, const Light& light, SampleState& state) {
    if (!light.said.area || !light.said.area->illuminates || !light.has_extent())
        return lit_from(shading, point, light, sample_light(light, point.hit.position, Vec2{0.5}), state);
    return area_mean(view_area(light, point.hit.position, state.rng.bits()), [&](Vec3 from) {
        return lit_from(shading, point, light, sample_toward(light, point.hit.position, from), state);
    });
}

// How much of the reflected ray is seen at this angle.
Color reflectance(const Point& point) {
    const Reflection& said = point.material.finish.reflection;
    const double cosine = std::clamp(glm::dot(point.outgoing, point.normal), 0.0, 1.0);
    double share = 0; // 0: min, 1: max
    if (said.fresnel) {
        const double ior = point.material.interior.ior;
        share = fresnel_dielectric(std::max(cosine, 1e-9), point.inside ? ior : 1 / ior);
    } else {
        share = std::pow(1 - cosine, said.falloff);
    }
    Color r = said.min + static_cast<float>(share) * (said.max - said.min);
    if (said.metallic > 0) r *= metallic_tint(point.color, said.metallic, cosine);
    return r;
}

Color follow(const Shading& shading, const Segment& segment, const Hit& hit, Vec3 direction, Color weight,
             int solids, SampleState& state) {
    const Segment next{leave(hit, direction), RayKind::specular, segment.level + 1,
                       segment.throughput * weight, solids};
    if (next.level > shading.settings.max_trace_level) return Color{0};
    if (max_component(next.throughput) < shading.settings.adc_bailout) return Color{0};
    return weight * trace(shading, next, state);
}

Color caustic_light(const Shading& shading, const Point& point, SampleState& state) {
    if (shading.caustic.count == 0) return Color{0};
    Bsdf matt;
    matt.normal = point.normal;
    matt.geometric = point.inside ? -point.hit.normal : point.hit.normal;
    matt.diffuse = point.color * (point.opacity * static_cast<float>(point.material.finish.diffuse));
    ++state.gathers;
    return gather(shading.world, shading.map, shading.caustic, point.hit.position, matt, point.outgoing,
                  *state.scratch);
}

Color reflected_light(const Shading& shading, const Segment& segment, const Point& point, Color share,
                      SampleState& state) {
    if (is_black(share)) return Color{0};
    Color found =
        follow(shading, segment, point.hit, mirror_direction(point.outgoing, point.normal), share, segment.solids,
               state);
    const double exponent = point.material.finish.reflection.exponent;
    if (exponent != 1) {
        const Color seen = found / glm::max(share, Color{1e-12f});
        found = share * glm::pow(glm::max(seen, Color{0}), Color{static_cast<float>(exponent)});
    }
    return found;
}

Color transmitted_light(const Shading& shading, const Segment& segment, const Point& point, Color share,
                        SampleState& state) {
    if (is_black(share)) return Color{0};
    Vec3 direction = -point.outgoing;
    const double ior = point.material.interior.ior;
    const bool inward = ior == 1 || refract_direction(point.outgoing, point.normal, point.inside ? ior : 1 / ior, direction);
    if (!inward) direction = mirror_direction(point.outgoing, point.normal);
    const Surface& surface = shading.world.surfaces[point.hit.surface];
    const int step = !inward || surface.hollow || !surface.closed ? 0 : point.inside ? -1 : 1;
    return follow(shading, segment, point.hit, direction, share, std::max(0, segment.solids + step), state);
}

Color trace(const Shading& shading, const Segment& segment, SampleState& state) {
    ++state.rays;
    const World& world = shading.world;
    const std::optional<Hit> hit = closest_hit(world, segment.ray, segment.kind);
    if (!hit)
        return segment.solids > 0 ? sky_radiance(world, segment.ray.direction)
                                  : through_atmosphere(world, segment.ray, infinity,
                                                       sky_radiance(world, segment.ray.direction));
    const int emitter = world.surfaces[hit->surface].light;
    const Point point = make_point(world, *hit, segment.ray.direction);
    if (emitter >= 0)
        return point.inside ? Color{0} : world.lights[static_cast<std::size_t>(emitter)].radiance;
    const Finish& finish = point.material.finish;

    Color direct{0};
    for (const Light& light : world.lights)
        if (shines_on(light, world.surfaces[hit->surface])) direct += lit_by(shading, point, light, state);
    const Color caustic = caustic_light(shading, point, state);
    const Color glow = point.color * point.opacity * (finish.ambient * world.ambient_light + finish.emission);
    const Color mirror = reflectance(point);
    Color through = point.transparency;
    const Color surface = direct + glow + caustic;
    if (finish.conserve_energy) through *= glm::max(Color{0}, Color{1} - mirror);
    const Color specular = reflected_light(shading, segment, point, mirror, state) +
                           transmitted_light(shading, segment, point, through, state);
    if (segment.level == 0) {
        state.direct += direct;
        state.caustic += caustic;
        state.specular += specular;
    }
    const bool medium = segment.level > 0 && point.inside;
    const Color seen =
        (surface + specular) * (medium ? interior_transmittance(point.material.interior, hit->t) : Color{1});
    return segment.solids > 0 ? seen : through_atmosphere(world, segment.ray, hit->t, seen);
}

} // namespace

Color povray_radiance(const Shading& shading, const Ray& camera_ray, SampleState& state) {
    Segment segment;
    segment.ray = camera_ray;
    segment.solids = shading.world.camera_solids;
    return trace(shading, segment, state);
}

} // namespace pnr
