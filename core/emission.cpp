// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/emission.h"

#include "core/area_light.h"
#include "core/material.h"
#include "core/sobol.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

bool is_bounded(const Bounds& b) { return std::isfinite(glm::length(b.high - b.low)); }

bool has_unbounded(const World& world) {
    return std::any_of(world.objects.begin(), world.objects.end(), [](const WorldObject& object) {
        return !is_empty(object.bounds) && !is_bounded(object.bounds);
    });
}

Focus make_focus(const World& world, bool unbounded) {
    Bounds all;
    for (const WorldObject& object : world.objects)
        if (!is_empty(object.bounds) && is_bounded(object.bounds)) all = merge(all, object.bounds);
    if (is_empty(all)) return {Vec3(0), world.radius};
    if (unbounded) all = merge(all, world.camera.location);
    const double radius = 0.5 * glm::length(all.high - all.low);
    return {0.5 * (all.low + all.high), radius > 0 ? radius : world.radius};
}

Aim cone_aim(Vec3 axis, double one_minus_cos) {
    Aim aim;
    aim.axis = axis;
    aim.one_minus_cos = one_minus_cos;
    aim.measure = 2 * pi * one_minus_cos;
    return aim;
}

// The directions from a point to a sphere: all of them from inside it.
Aim aim_at_sphere(Vec3 point, const Focus& sphere) {
    const Vec3 from = point - sphere.center;
    const double radius = sphere.radius, distance = glm::length(from);
    if (distance <= radius) return cone_aim({0, 0, 1}, 2);
    const double sin2 = radius * radius / (distance * distance);
    return cone_aim(-from / distance, sin2 / (1 + std::sqrt(1 - sin2)));
}

Aim point_aim(const Light& light, const Focus& sphere) {
    const Aim scene = aim_at_sphere(light.said.position, sphere);
    double spot = 2; // 1 - cos of what the light itself lights
    if (light.said.spotlight)
        spot = 1 - std::max(0.0, std::cos(light.said.falloff * pi / 180));
    else if (light.said.cylinder)
        spot = 1;
    // The smaller cone; what lies outside the other carries nothing or meets nothing.
    return spot < scene.one_minus_cos && spot > 0 ? cone_aim(light_axis(light), spot) : scene;
}

Aim parallel_aim(const Light& light, const Focus& sphere) {
    Aim aim;
    aim.axis = light_axis(light);
    const Vec3 to_center = sphere.center - light.said.position;
    aim.center = sphere.center - glm::dot(to_center, aim.axis) * aim.axis;
    aim.radius = sphere.radius;
    if (light.said.cylinder && light.said.falloff < sphere.radius) {
        aim.center = light.said.position;
        aim.radius = light.said.falloff;
    }
    aim.measure = pi * aim.radius * aim.radius;
    return aim;
}

std::vector<Aim> make_aims(const Focus& focus, const std::vector<Focus>& targets, const Light& light,
                           bool unbounded) {
    const double reach = light.has_extent() ? area_reach(*light.said.area) : 0; // photons start so far beside its position
    const auto aim = [&](Focus sphere) {
        sphere.radius += reach;
        return is_parallel(light) ? parallel_aim(light, sphere) : point_aim(light, sphere);
    };
    std::vector<Aim> aims;
    for (const Focus& target : targets) aims.push_back(aim(target));
    if (targets.empty()) aims.push_back(aim(focus));
    if (targets.empty() && unbounded) {
        const Aim wide = aim({focus.center, emission_reach * focus.radius});
        if (wide.measure < 1.5 * aims[0].measure) return {wide}; // not worth a second one
        aims.push_back(wide);
    }
    // By measure each target gets the same density; the focus and its surroundings get half each.
    double whole = 0;
    for (const Aim& a : aims) whole += a.measure;
    for (Aim& a : aims)
        a.share = targets.empty() ? 1.0 / static_cast<double>(aims.size()) : a.measure / whole;
    return aims;
}

bool said_target(const World& world) {
    return std::any_of(world.materials.begin(), world.materials.end(),
                       [](const Material& material) { return material.photons.target; });
}

// The bounding spheres of the objects that throw caustics; none if the whole scene is to be aimed at:
// caustics are not all that is wanted, or something unbounded throws them.
std::vector<Focus> find_targets(const World& world) {
    std::vector<Focus> targets;
    if (!world.caustics_apart) return targets;
    const bool said = said_target(world);
    std::vector<char> throws(world.objects.size(), 0);
    for (const Surface& surface : world.surfaces) {
        if (surface.light >= 0) continue;
        const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
        if (is_specular(material) && (!said || material.photons.target))
            throws[static_cast<std::size_t>(surface.object)] = 1;
    }
    for (std::size_t i = 0; i < world.objects.size(); ++i) {
        const Bounds& b = world.objects[i].bounds;
        if (throws[i] == 0 || is_empty(b)) continue;
        if (!is_bounded(b)) return {};
        targets.push_back({0.5 * (b.low + b.high), 0.5 * glm::length(b.high - b.low)});
    }
    return targets;
}

double mean(Color c) { return (static_cast<double>(c.x) + c.y + c.z) / 3; }

// About the flux that a light sends into the scene.
double light_weight(const Focus& focus, const Light& light) {
    if (light.is_emitter()) return mean(light.power);
    const double scene = pi * focus.radius * focus.radius; // cross-section
    const double distance = std::max(glm::distance(light.said.position, focus.center), focus.radius);
    double lit = scene;
    if (light.said.cylinder) lit = std::min(scene, pi * light.said.falloff * light.said.falloff);
    if (light.said.spotlight && !is_parallel(light)) {
        const double spot = 2 * pi * (1 - std::max(0.0, std::cos(light.said.falloff * pi / 180)));
        lit = std::min(scene, spot * distance * distance);
    }
    return pi * mean(light.said.color) * lit * light_fading(light, distance);
}

std::int64_t photon_count(const Focus& focus, const PhotonSettings& settings) {
    if (!(settings.spacing > 0)) return std::max<std::int64_t>(0, settings.count);
    const double photons = 4 * pi * focus.radius * focus.radius / (settings.spacing * settings.spacing);
    return static_cast<std::int64_t>(std::clamp(photons, 1.0, 1e9));
}

// Chooses an aim by the first coordinate and stretches what is left of it back to [0, 1).
const Aim& choose_aim(const std::vector<Aim>& aims, double& u) {
    for (std::size_t i = 0; i + 1 < aims.size(); ++i) {
        if (u < aims[i].share) {
            u /= aims[i].share;
            return aims[i];
        }
        u -= aims[i].share;
    }
    u = std::min(u / aims.back().share, 0x1.fffffffffffffp-1);
    return aims.back();
}

bool contains(const Aim& aim, Vec3 direction) {
    // A rounding's width more than the cone, so that its own samples are never outside.
    return 1 - glm::dot(aim.axis, direction) <= aim.one_minus_cos * (1 + 1e-9) + 1e-15;
}

EmittedPhoton emit_point(const Light& light, const LightShare& share, Vec2 u, Vec2 on_area) {
    const Aim& aim = choose_aim(share.aims, u.x);
    EmittedPhoton photon;
    photon.ray.origin = light.said.position;
    photon.ray.direction = square_to_cone(u, make_frame(aim.axis), aim.one_minus_cos);
    double density = 0; // per solid angle, over all aims
    for (const Aim& a : share.aims)
        if (&a == &aim || contains(a, photon.ray.direction)) density += a.share / a.measure;
    photon.flux = light.said.color * static_cast<float>(pi / (density * static_cast<double>(share.count)));
    if (light.has_extent())
        photon.ray.origin = area_point_at(view_area(light, photon.ray.origin + photon.ray.direction, 0), on_area);
    return photon;
}

EmittedPhoton emit_parallel(const Light& light, const LightShare& share, Vec2 u) {
    const Aim& aim = choose_aim(share.aims, u.x);
    const Frame frame = make_frame(aim.axis);
    const Vec2 d = square_to_disc(u) * aim.radius;
    EmittedPhoton photon;
    photon.ray.direction = aim.axis;
    photon.ray.origin = aim.center + d.x * frame.x + d.y * frame.y;
    double density = 0; // per area
    for (const Aim& a : share.aims)
        if (&a == &aim || glm::distance(photon.ray.origin, a.center) <= a.radius)
            density += a.share / a.measure;
    photon.flux = light.said.color * static_cast<float>(pi / (density * static_cast<double>(share.count)));
    return photon;
}

} // namespace

EmissionPlan plan_emission(const World& world, const PhotonSettings& settings) {
    EmissionPlan plan;
    const bool unbounded = has_unbounded(world);
    plan.focus = make_focus(world, unbounded);
    const std::vector<Focus> targets = find_targets(world);
    plan.targeted = world.caustics_apart && said_target(world);
    const std::int64_t wanted = photon_count(plan.focus, settings);
    double total = 0;
    std::vector<double> weights;
    for (const Light& light : world.lights) {
        const double weight = light_weight(plan.focus, light);
        weights.push_back(weight > 0 && std::isfinite(weight) ? weight : 0);
        total += weights.back();
    }
    if (!(total > 0) || wanted == 0) return plan;
    double before = 0; // rounding the running sum keeps the parts' sum at `wanted`
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        const auto part = [&](double weight) {
            return std::llround(static_cast<double>(wanted) * (weight / total));
        };
        LightShare share;
        share.light = static_cast<int>(i);
        share.first = plan.count;
        share.count = std::max<std::int64_t>(1, part(before + weights[i]) - part(before));
        if (!world.lights[i].is_emitter())
            share.aims = make_aims(plan.focus, targets, world.lights[i], unbounded);
        before += weights[i];
        plan.count += share.count;
        plan.shares.push_back(std::move(share));
    }
    return plan;
}

EmittedPhoton emit_photon(const World& world, const LightShare& share, std::uint64_t index,
                          std::uint64_t seed) {
    const Light& light = world.lights[static_cast<std::size_t>(share.light)];
    const Vec2 u = sobol2(index, 0, seed);
    if (!light.is_emitter())
        return is_parallel(light) ? emit_parallel(light, share, u)
                                  : emit_point(light, share, u, sobol2(index, 2, seed));
    const EmissionSample start = sample_emission(light, u, sobol2(index, 2, seed));
    Hit from; // the emitter's own surface, so that the ray leaves it as from any hit
    from.position = start.point;
    from.normal = from.shading_normal = start.normal;
    from.error = start.error;
    return {leave(from, start.direction), light.power / static_cast<float>(share.count)};
}

} // namespace pnr
