// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, sections "Finish", "Interior" and "Layered Textures"; those it does not print were measured
// against POV-Ray's pictures.
#include "core/povray_finish.h"

#include "core/area_light.h"
#include "core/noise.h"
#include "core/probe.h"
#include "core/radiosity.h"
#include "core/texture_mix.h"

#include <algorithm>
#include <array>

namespace pnr {
namespace {

// The solids with an interior that a ray is in, the one it entered last at the end. POV-Ray refracts between the outermost air
// and these: leaving one of them, wherever it stands in the list, leads into the last of the others.
struct Solids {
    struct Entry {
        int id = 0;
        double ior = 1;
    };
    std::array<Entry, 16> entries{}; // deeper nesting than this is forgotten
    int count = 0;

    double ior() const { return count > 0 ? entries[static_cast<std::size_t>(count - 1)].ior : 1; }
    void enter(Entry entry) {
        if (count < static_cast<int>(entries.size())) entries[static_cast<std::size_t>(count++)] = entry;
    }
    bool leave(int id) {
        for (int i = count - 1; i >= 0; --i)
            if (entries[static_cast<std::size_t>(i)].id == id) {
                std::copy(entries.begin() + i + 1, entries.begin() + count, entries.begin() + i);
                --count;
                return true;
            }
        return false;
    }
};

struct Segment {
    Ray ray;
    RayKind kind = RayKind::camera;
    int level = 0;
    Color throughput{1};
    Solids solids;
    int fogless = 0;       // solids without `hollow` that it is in: there is no fog in them
    double* met = nullptr; // where to say how far it went
};

// A hit with all that POV-Ray's formulas ask of it.
struct Point {
    const World& world;
    const Hit& hit;
    const Material& material;
    const Texture& texture; // of the side that the ray meets
    Vec3 outgoing;          // unit, to the viewer
    bool inside;            // the ray meets the back
    SurfacePoint at;        // its normal is the shading normal on the viewer's side
};

Point make_point(const World& world, const Hit& hit, Vec3 direction) {
    const Material& material = world.materials[static_cast<std::size_t>(world.surfaces[hit.surface].material)];
    const bool inside = glm::dot(hit.normal, direction) > 0;
    return {world,      hit,    material,
            side_texture(material, inside), -direction, inside,
            facing_point(hit, direction)};
}

Color trace(const Shading& shading, const Segment& segment, SampleState& state);

// ---- shadows

// What goes through all layers that a shadow ray meets at a point, with POV-Ray's faked caustics.
Color passed_light(const Point& point) {
    Color sum(0);
    for_each_texture(point.world, point.hit, point.inside, point.at, [&](const Texture& plain, const SurfacePoint& at, double share) {
        std::optional<Vec3> normal;
        Color passed = for_each_layer(plain, at, [&](const LayerPoint& layer) {
            if (!normal) normal = layer.normal;
        });
        if (const double power = point.material.interior.caustics; power > 0)
            passed *= static_cast<float>(1 + std::pow(std::abs(glm::dot(*normal, point.outgoing)), 45 * power));
        sum += passed * static_cast<float>(share);
    });
    return sum;
}

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
        if (world.caustics_apart && material.photons.target && material.photons.refraction)
            return Color{0};
        const Point point = make_point(world, *hit, ray.direction);
        passed *= passed_light(point);
        if (point.inside) passed *= interior_transmittance(material.interior, hit->t);
        if (max_component(passed) < shading.settings.adc_bailout) return Color{0};
        gone += hit->t;
        ray = leave(*hit, ray.direction, whole - gone);
        if (ray.t_max <= 0) return passed;
    }
    return Color{0};
}

// The light as it is seen from another of its points.
LightSample sample_toward(const Light& light, Vec3 position, Vec3 from) {
    LightSample sample = sample_light(light, position, Vec2{0.5});
    sample.point = from;
    sample.distance = glm::length(from - position);
    if (sample.distance > 0) sample.direction = (from - position) / sample.distance;
    return sample;
}

// Share of a light's colour that reaches the hit from all its area. Gathered light is content with one point of it.
Color light_share(const Shading& shading, const Hit& hit, const Light& light, const LightSample& sample,
                  SampleState& state) {
    if (!light.has_extent() || light.is_emitter() || light.said.area->illuminates)
        return light_through(shading, hit, light, sample);
    const AreaView view = view_area(light, hit.position, state.rng.bits());
    const auto from_point = [&](Vec3 from) {
        return light_through(shading, hit, light, sample_toward(light, hit.position, from));
    };
    if (state.bounces > 0) return from_point(area_point_at(view, state.rng.uniform2()));
    return area_mean(view, from_point);
}

// ---- surfaces

// How light bends where the ray goes through a surface, and which solids it is in then.
struct Crossing {
    double eta = 1; // ior of the viewer's side over that of the other one
    Solids solids;
};

Crossing cross(const Point& point, const Solids& before) {
    Crossing crossing{1, before};
    const Material& material = point.material;
    if (material.interior_id == 0) return crossing;
    const double ior = material.interior.ior;
    if (crossing.solids.leave(material.interior_id) || point.inside) {
        crossing.eta = ior / crossing.solids.ior();
    } else {
        crossing.eta = before.ior() / ior;
        crossing.solids.enter({material.interior_id, ior});
    }
    return crossing;
}

// One of the layers at a hit.
struct Look {
    const Point& point;
    const LayerPoint& layer;
    double eta; // ior of the viewer's side over that of the other one
};

// Diffuse light, highlights and thin film of one light source on one layer.
Color lit_from(const Shading& shading, const Look& look, const Light& light, const LightSample& sample,
               SampleState& state) {
    if (is_black(sample.irradiance)) return Color{0};
    const Finish& finish = look.layer.finish;
    LampView view;
    view.normal = look.layer.normal;
    view.outgoing = look.point.outgoing;
    view.toward = sample.direction;
    view.both_sides = look.point.material.double_illuminate;
    view.highlights = !light.said.shadowless;
    if (finish.crand > 0) view.grain = state.rng.uniform();
    const auto lit = [&](const Finish& f) {
        return lamp_light(f, look.layer.color, look.layer.opacity, view, shading.world.irid_wavelength);
    };
    Color sum;
    if (finish.irid.turbulence != 0) {
        Finish here = finish;
        here.irid.thickness *= film_thickness(finish.irid, look.point.hit.position + shading.world.offset);
        sum = lit(here);
    } else {
        sum = lit(finish);
    }
    // A light of colour c gives the irradiance pi c cos: POV-Ray's diffuse is albedo c cos.
    sum *= sample.irradiance / static_cast<float>(pi);
    if (is_black(sum) || light.said.shadowless) return sum;
    return sum * light_share(shading, look.point.hit, light, sample, state);
}

Color lit_by(const Shading& shading, const Look& look, const Light& light, SampleState& state) {
    const Vec3 position = look.point.hit.position;
    if (!light.said.area || !light.said.area->illuminates || !light.has_extent())
        return lit_from(shading, look, light, sample_light(light, position, Vec2{0.5}), state);
    return area_mean(view_area(light, position, state.rng.bits()), [&](Vec3 from) {
        return lit_from(shading, look, light, sample_toward(light, position, from), state);
    });
}

// Which solids the ray of the next segment is in.
struct Within {
    Solids solids;
    int fogless = 0;
};

// Light that the layer sends by itself; with `radiosity` what is gathered about the point stands for the ambient light, as
// POV-Ray has it since 3.7, or beside it before.
Color own_light(const Shading& shading, const Look& look, SampleState& state) {
    const World& world = shading.world;
    const Finish& finish = look.layer.finish;
    Color light = finish.emission;
    if (world.illumination != Illumination::radiosity || world.ambient_glows) light += finish.ambient * world.ambient_light;
    if (world.illumination == Illumination::radiosity && finish.diffuse > 0)
        light += static_cast<float>(finish.diffuse) * gathered_light(shading, look.point.hit, look.layer.normal, state);
    return light;
}

Color follow(const Shading& shading, const Segment& segment, const Hit& hit, Vec3 direction, Color weight,
             RayKind kind, const Within& within, SampleState& state) {
    const Segment next{leave(hit, direction), kind, segment.level + 1, segment.throughput * weight, within.solids,
                       within.fogless};
    if (next.level > shading.settings.max_trace_level) return Color{0};
    if (max_component(next.throughput) < shading.settings.adc_bailout) return Color{0};
    return weight * trace(shading, next, state);
}

Color caustic_light(const Shading& shading, const Look& look, SampleState& state) {
    if (shading.caustic.count == 0) return Color{0};
    const Point& point = look.point;
    Bsdf matt;
    matt.normal = look.layer.normal;
    matt.geometric = point.inside ? -point.hit.normal : point.hit.normal;
    matt.diffuse = look.layer.color * (look.layer.opacity * static_cast<float>(look.layer.finish.diffuse));
    ++state.gathers;
    return gather(shading.world, shading.map, shading.caustic, point.hit.position, matt, point.outgoing,
                  *state.scratch);
}

// How much of the reflected ray is seen at this angle.
Color mirror_share(const Look& look) {
    const double cosine = std::clamp(glm::dot(look.point.outgoing, look.layer.normal), 0.0, 1.0);
    const Reflection& said = look.layer.finish.reflection;
    const double fresnel = said.fresnel ? fresnel_dielectric(std::max(cosine, 1e-9), look.eta) : 0;
    return reflectance(said, look.layer.color, cosine, fresnel);
}

// Where a mirror with this normal sends the ray. One that looks away from the viewer counts as if it were not bumped, and a ray
// that would go below the surface is turned back up.
Vec3 bounce(const Point& point, Vec3 normal) {
    const Vec3 raw = point.at.normal;
    Vec3 direction = mirror_direction(point.outgoing, glm::dot(normal, point.outgoing) < 0 ? raw : normal);
    if (const double below = glm::dot(direction, raw); below < 0) direction = glm::normalize(direction - 2 * below * raw);
    return direction;
}

Color reflected_light(const Shading& shading, const Segment& segment, const Look& look, Color share, SampleState& state) {
    if (is_black(share)) return Color{0};
    const Color found = follow(shading, segment, look.point.hit, bounce(look.point, look.layer.normal), share,
                               RayKind::specular, {segment.solids, segment.fogless}, state);
    const double exponent = look.layer.finish.reflection.exponent;
    if (exponent == 1) return found;
    const Color seen = found / glm::max(share, Color{1e-12f});
    return share * glm::pow(glm::max(seen, Color{0}), Color{static_cast<float>(1 / exponent)});
}

// Total reflection is not tinted, and stands in place of the finish's own: `total` tells of it.
Color transmitted_light(const Shading& shading, const Segment& segment, const Point& point, const Crossing& crossing,
                        Vec3 normal, Color share, bool& total, SampleState& state) {
    if (is_black(share)) return Color{0};
    Vec3 direction = -point.outgoing;
    const Vec3 facing = glm::dot(normal, point.outgoing) < 0 ? -normal : normal;
    total = std::abs(crossing.eta - 1) > 1e-6 && !refract_direction(point.outgoing, facing, crossing.eta, direction);
    if (!total) {
        Within within{crossing.solids, segment.fogless};
        const Surface& surface = shading.world.surfaces[point.hit.surface];
        if (!surface.hollow && surface.closed) within.fogless = std::max(0, within.fogless + (point.inside ? -1 : 1));
        // What `no_image` and `no_reflection` hide is hidden behind glass as it is before it.
        return follow(shading, segment, point.hit, direction, share, segment.kind, within, state);
    }
    return follow(shading, segment, point.hit, bounce(point, normal), Color{1}, RayKind::specular,
                  {segment.solids, segment.fogless}, state);
}

struct LightParts {
    Color direct{0}, caustic{0}, glow{0}, specular{0};
};

Color sum_of(const LightParts& parts) { return parts.direct + parts.caustic + parts.glow + parts.specular; }

// Light of a plain texture. What upper layers let pass tints everything below them but reflections.
LightParts layered_light(const Shading& shading, const Segment& segment, const Point& point,
                         const Texture& plain, const SurfacePoint& at, SampleState& state) {
    const World& world = shading.world;
    LightParts parts;
    Color kept{1};
    bool mirrors = false, total = false;
    const Crossing crossing = cross(point, segment.solids);
    const double eta = crossing.eta;
    std::optional<Vec3> normal; // of the uppermost layer
    const Color passed = for_each_layer(plain, at, [&](const LayerPoint& layer) {
        const Look look{point, layer, eta};
        if (!normal) normal = layer.normal;
        Color lit{0};
        for (const Light& light : world.lights)
            if (shines_on(light, world.surfaces[point.hit.surface])) lit += lit_by(shading, look, light, state);
        parts.direct += layer.above * lit;
        parts.caustic += layer.above * caustic_light(shading, look, state);
        parts.glow += layer.above * layer.color * layer.opacity * own_light(shading, look, state);
        const Color mirror = mirror_share(look);
        mirrors |= !is_black(mirror);
        if (layer.finish.conserve_energy) kept *= glm::max(Color{0}, Color{1} - mirror);
    });
    if (normal) parts.specular = transmitted_light(shading, segment, point, crossing, *normal, passed * kept, total, state);
    if (mirrors && !total)
        for_each_layer(plain, at, [&](const LayerPoint& layer) {
            const Look look{point, layer, eta};
            parts.specular += reflected_light(shading, segment, look, mirror_share(look), state);
        });
    return parts;
}

LightParts surface_light(const Shading& shading, const Segment& segment, const Point& point, SampleState& state) {
    if (is_single(point.hit, point.texture))
        return layered_light(shading, segment, point, point.texture, point.at, state);
    LightParts sum;
    for_each_texture(point.world, point.hit, point.inside, point.at, [&](const Texture& plain, const SurfacePoint& at, double share) {
        const auto weight = static_cast<float>(share);
        Segment part = segment;
        part.throughput *= weight;
        const LightParts parts = layered_light(shading, part, point, plain, at, state);
        sum.direct += weight * parts.direct, sum.caustic += weight * parts.caustic;
        sum.glow += weight * parts.glow, sum.specular += weight * parts.specular;
    });
    return sum;
}

Color trace(const Shading& shading, const Segment& segment, SampleState& state) {
    ++state.rays;
    const World& world = shading.world;
    const std::optional<Hit> hit = closest_hit(world, segment.ray, segment.kind);
    if (segment.met) *segment.met = hit ? hit->t : infinity;
    const auto in_air = [&](Color seen) {
        return segment.fogless > 0 ? seen
                                   : through_atmosphere(world, segment.ray, hit ? hit->t : infinity, seen);
    };
    if (!hit) return in_air(sky_radiance(world, segment.ray.direction));
    const int emitter = world.surfaces[hit->surface].light;
    const Point point = make_point(world, *hit, segment.ray.direction);
    if (emitter >= 0)
        return point.inside ? Color{0} : world.lights[static_cast<std::size_t>(emitter)].radiance;
    const LightParts parts = surface_light(shading, segment, point, state);
    if (segment.level == 0) {
        state.direct += parts.direct;
        state.caustic += parts.caustic;
        state.specular += parts.specular;
    }
    watch(world, *hit, glm::max(sum_of(parts), Color{0}), state);
    return in_air(sum_of(parts) * (point.inside ? interior_transmittance(point.material.interior, hit->t) : Color{1}));
}

} // namespace

double film_thickness(const Iridescence& irid, Vec3 point) {
    Turbulence octaves;
    octaves.octaves = 5;
    return 1 + irid.turbulence * (2 * turbulence(point, octaves, 2) - 1);
}

Color povray_radiance(const Shading& shading, const Ray& camera_ray, SampleState& state) {
    Segment segment;
    segment.ray = camera_ray;
    segment.fogless = shading.world.camera_solids;
    return glm::max(trace(shading, segment, state), Color{0}); // crand and dark lights may take more than there is
}

Color povray_gather_ray(const Shading& shading, const Ray& ray, Color weight, double& distance, SampleState& state) {
    Segment segment;
    segment.ray = ray;
    segment.kind = RayKind::gather;
    segment.level = 1;
    segment.throughput = weight;
    segment.fogless = shading.world.camera_solids;
    segment.met = &distance;
    return glm::max(trace(shading, segment, state), Color{0});
}

} // namespace pnr
