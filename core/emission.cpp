// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/emission.h"

#include "core/area_light.h"
#include "core/material.h"
#include "core/parallel.h"
#include "core/rng.h"
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
    const double reach =
        light.has_extent() ? area_reach(*light.said.area) : 0; // photons start so far beside its position
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

// Which objects throw caustics. An object that only its `specular_probability` makes specular is none: the
// eye knows nothing of it, and its photons are many.
std::vector<char> find_throwers(const World& world) {
    const bool said = world.caustics_apart && said_target(world);
    std::vector<char> throws(world.objects.size(), 0);
    for (const Surface& surface : world.surfaces) {
        if (surface.light >= 0) continue;
        const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
        const bool wanted =
            said ? material.photons.target : world.caustics_apart || !material.photons.specular_probability;
        if (is_specular(material) && wanted) throws[static_cast<std::size_t>(surface.object)] = 1;
    }
    return throws;
}

// The bounding spheres of the objects that throw caustics. Objects without bounds can't be aimed at: they are
// taken from the list.
std::vector<Focus> find_targets(const World& world, std::vector<char>& throws) {
    std::vector<Focus> targets;
    for (std::size_t i = 0; i < world.objects.size(); ++i) {
        const Bounds& b = world.objects[i].bounds;
        if (throws[i] == 0 || is_empty(b)) continue;
        if (is_bounded(b))
            targets.push_back({0.5 * (b.low + b.high), 0.5 * glm::length(b.high - b.low)});
        else
            throws[i] = 0;
    }
    return targets;
}

// Caustics alone: none if something without bounds throws them, so that the whole scene is aimed at.
std::vector<Focus> caustic_scene_targets(const World& world) {
    if (!world.caustics_apart) return {};
    std::vector<char> throws = find_throwers(world);
    const auto count = std::count(throws.begin(), throws.end(), 1);
    std::vector<Focus> targets = find_targets(world, throws);
    return std::count(throws.begin(), throws.end(), 1) == count ? targets : std::vector<Focus>{};
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

// About the share of a light's flux that goes to the targets.
double target_share(const Focus& focus, const std::vector<Focus>& targets, const Light& light) {
    double share = 0;
    for (const Focus& target : targets) {
        const double r2 = target.radius * target.radius;
        const double distance = glm::distance(light.said.position, target.center);
        share +=
            is_parallel(light) ? r2 / (focus.radius * focus.radius) : r2 / std::max(r2, distance * distance);
    }
    return std::min(1.0, share);
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

// A point of the emitter, and a direction from there to one of the targets, evenly over the cones to them.
EmittedPhoton emit_toward(const Light& light, const LightShare& share, const std::vector<Focus>& targets,
                          Vec2 u, Vec2 on_emitter) {
    const EmissionSample start = sample_emission(light, on_emitter, u);
    std::vector<Aim> aims;
    double whole = 0;
    for (const Focus& target : targets) {
        Aim aim = aim_at_sphere(start.point, target);
        if (aim.one_minus_cos >= 2) aim = cone_aim(start.normal, 1); // from within: all that it emits
        whole += aim.measure;
        aims.push_back(aim);
    }
    for (Aim& aim : aims) aim.share = aim.measure / whole;
    const Aim& aim = choose_aim(aims, u.x);
    const Vec3 direction = square_to_cone(u, make_frame(aim.axis), aim.one_minus_cos);
    const auto cones = std::count_if(aims.begin(), aims.end(),
                                     [&](const Aim& a) { return &a == &aim || contains(a, direction); });
    const double cosine = glm::dot(start.normal, direction);
    if (!(cosine > 0)) return {};
    Hit from;
    from.position = start.point;
    from.normal = from.shading_normal = start.normal;
    from.error = start.error;
    // Radiance times cosine over the density, by area and solid angle.
    const double weight =
        cosine * light.area * whole / (static_cast<double>(cones) * static_cast<double>(share.count));
    return {leave(from, direction), light.radiance * static_cast<float>(weight)};
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
        photon.ray.origin =
            area_point_at(view_area(light, photon.ray.origin + photon.ray.direction, 0), on_area);
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

namespace {

// Shares `wanted` photons out by the weights of the lights.
void share_out(EmissionPlan& plan, std::int64_t wanted, const std::vector<double>& weights,
               const LightShare& of_all) {
    double total = 0, before = 0; // rounding the running sum keeps the parts' sum at `wanted`
    for (const double weight : weights) total += weight;
    if (!(total > 0) || wanted == 0) return;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        const auto part = [&](double weight) {
            return std::llround(static_cast<double>(wanted) * (weight / total));
        };
        LightShare share = of_all;
        share.light = static_cast<int>(i);
        share.first = plan.count;
        share.count = std::max<std::int64_t>(1, part(before + weights[i]) - part(before));
        before += weights[i];
        plan.count += share.count;
        plan.shares.push_back(std::move(share));
    }
}

} // namespace

EmissionPlan plan_emission(const World& world, const PhotonSettings& settings) {
    EmissionPlan plan;
    const bool unbounded = has_unbounded(world);
    plan.focus = make_focus(world, unbounded);
    plan.targeted = world.caustics_apart && said_target(world);
    const std::int64_t wanted = photon_count(plan.focus, settings);
    std::vector<double> weights;
    for (const Light& light : world.lights) {
        const double weight = light_weight(plan.focus, light);
        weights.push_back(weight > 0 && std::isfinite(weight) ? weight : 0);
    }
    share_out(plan, wanted, weights, {});
    plan.everywhere = plan.count;
    if (!world.caustics_apart) {
        plan.aimed_at = find_throwers(world);
        plan.targets = find_targets(world, plan.aimed_at);
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] *= target_share(plan.focus, plan.targets, world.lights[i]);
        LightShare caustics;
        caustics.caustics = true;
        if (!plan.targets.empty()) share_out(plan, wanted, weights, caustics);
        if (plan.count == plan.everywhere) plan.aimed_at.clear();
    }
    const std::vector<Focus> alone = caustic_scene_targets(world);
    for (LightShare& share : plan.shares) {
        const Light& light = world.lights[static_cast<std::size_t>(share.light)];
        if (!light.is_emitter())
            share.aims = make_aims(plan.focus, share.caustics ? plan.targets : alone, light, unbounded);
    }
    return plan;
}

namespace {

// The grid of a projection map, and the rays that look through each of its cells.
constexpr int grid = 64, looks = 4;

// Moves a point of the square into the cells and returns the share of the square that they are.
float into_cells(const LightShare& share, Vec2& u) {
    if (share.cells.empty()) return 1;
    const auto count = static_cast<double>(share.cells.size());
    const double place = u.x * count;
    const auto which = std::min(share.cells.size() - 1, static_cast<std::size_t>(place));
    const int cell = share.cells[which];
    u = Vec2(cell % grid + (place - static_cast<double>(which)), cell / grid + u.y) /
        static_cast<double>(grid);
    u = glm::min(u, Vec2(0x1.fffffffffffffp-1));
    return static_cast<float>(count / (grid * grid));
}

// The photon that starts with these coordinates.
EmittedPhoton start_photon(const World& world, const EmissionPlan& plan, const LightShare& share, Vec2 u,
                           Vec2 on_light) {
    const Light& light = world.lights[static_cast<std::size_t>(share.light)];
    if (!light.is_emitter())
        return is_parallel(light) ? emit_parallel(light, share, u) : emit_point(light, share, u, on_light);
    if (share.caustics) return emit_toward(light, share, plan.targets, u, on_light);
    const EmissionSample start = sample_emission(light, u, on_light);
    Hit from; // the emitter's own surface, so that the ray leaves it as from any hit
    from.position = start.point;
    from.normal = from.shading_normal = start.normal;
    from.error = start.error;
    return {leave(from, start.direction), light.power / static_cast<float>(share.count)};
}

bool leads_to_target(const World& world, const EmissionPlan& plan, const LightShare& share, Vec2 u,
                     Vec2 on_light) {
    const EmittedPhoton photon = start_photon(world, plan, share, u, on_light);
    if (is_black(photon.flux)) return false;
    const std::optional<Hit> hit = closest_hit(world, photon.ray, RayKind::photon);
    return hit && plan.aimed_at[static_cast<std::size_t>(world.surfaces[hit->surface].object)] != 0;
}

} // namespace

void find_cells(const World& world, EmissionPlan& plan, std::uint64_t seed) {
    for (LightShare& share : plan.shares) {
        if (!share.caustics || share.count < looks * grid * grid) continue;
        std::vector<char> found(grid * grid, 0);
        parallel_for(grid, 1, [&](std::int64_t row, std::int64_t, std::int64_t) {
            for (std::int64_t cell = row * grid; cell < (row + 1) * grid; ++cell) {
                Rng rng = make_rng(seed, Pass::photons,
                                   static_cast<std::uint64_t>(share.light * grid * grid + cell));
                for (int i = 0; i < looks && found[static_cast<std::size_t>(cell)] == 0; ++i) {
                    const Vec2 u =
                        (Vec2(static_cast<double>(cell % grid), static_cast<double>(row)) + rng.uniform2()) /
                        static_cast<double>(grid);
                    found[static_cast<std::size_t>(cell)] =
                        leads_to_target(world, plan, share, u, rng.uniform2());
                }
            }
        });
        for (int y = 0; y < grid; ++y) // and those beside them, where the rays may have missed what is there
            for (int x = 0; x < grid; ++x) {
                bool near = false;
                for (int v = std::max(0, y - 1); v <= std::min(grid - 1, y + 1); ++v)
                    for (int w = std::max(0, x - 1); w <= std::min(grid - 1, x + 1); ++w)
                        near = near || found[static_cast<std::size_t>(v * grid + w)] != 0;
                if (near) share.cells.push_back(static_cast<std::uint16_t>(y * grid + x));
            }
    }
}

EmittedPhoton emit_photon(const World& world, const EmissionPlan& plan, const LightShare& share,
                          std::uint64_t index, std::uint64_t seed) {
    Vec2 u = sobol2(index, 0, seed);
    const float left = into_cells(share, u);
    EmittedPhoton photon = start_photon(world, plan, share, u, sobol2(index, 2, seed));
    photon.flux *= left;
    return photon;
}

} // namespace pnr
