// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path_trace.h"

#include "core/gbuffer.h"
#include "core/radiance.h"

namespace pnr {
namespace {

float mean(Color c) { return (c.x + c.y + c.z) / 3; }

float power_heuristic(double a, double b) { return static_cast<float>(a * a / (a * a + b * b)); }

// Light that comes straight from the lights to a point: one shadow ray each, weighted against finding it by
// the BSDF.
Color next_event(const World& world, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing, double lobe_chance,
                 Rng& rng) {
    Color sum{0};
    for (const Light& light : world.lights) {
        if (!shines_on(light, world.surfaces[hit.surface])) continue;
        const LightSample sample = sample_light(light, hit.position, rng.uniform2());
        if (is_black(sample.irradiance)) continue;
        const double cosine = glm::dot(sample.direction, bsdf.normal);
        if (cosine <= 0 || glm::dot(sample.direction, bsdf.geometric) <= 0) continue;
        Color found =
            eval_bsdf(bsdf, outgoing, sample.direction) * sample.irradiance * static_cast<float>(cosine);
        if (sample.pdf > 0)
            found *=
                power_heuristic(sample.pdf, lobe_chance * sample_bsdf_pdf(bsdf, outgoing, sample.direction));
        if (is_black(found)) continue;
        if (!light.said.shadowless &&
            is_occluded(world, connect(hit, sample.point, sample.error), RayKind::shadow))
            continue;
        sum += found;
    }
    return sum;
}

// Where the path goes on from a hit.
struct Step {
    Vec3 direction{0};
    Color weight{0}; // f cos / pdf over the chance of the lobe
    double pdf = 0;  // solid angle, with that chance; 0: a delta lobe
    ChainBranch branch = ChainBranch::none;
};

struct LobeChances {
    double spread = 0, mirror = 0, transmit = 0; // sum 1, or all 0
};

LobeChances lobe_chances(const Bsdf& bsdf) {
    const double spread = has_diffuse(bsdf) ? mean(bsdf.diffuse) + mean(bsdf.glossy) : 0.0;
    const double mirror = mean(bsdf.mirror), transmit = mean(bsdf.transmit), sum = spread + mirror + transmit;
    if (!(sum > 0)) return {};
    return {spread / sum, mirror / sum, transmit / sum};
}

Step choose_step(const Bsdf& bsdf, Vec3 outgoing, const LobeChances& chances, Rng& rng) {
    const double u = rng.uniform();
    Step step;
    if (u < chances.spread) {
        const Vec2 v = rng.uniform2();
        const BsdfSample sample = sample_bsdf(bsdf, outgoing, {v, rng.uniform()});
        if (sample.pdf <= 0) return step;
        return {sample.incoming, sample.weight / static_cast<float>(chances.spread),
                sample.pdf * chances.spread, ChainBranch::none};
    }
    const bool mirror = u < chances.spread + chances.mirror || chances.transmit == 0;
    step.branch = mirror ? ChainBranch::mirror : ChainBranch::transmit;
    step.direction = branch_direction(bsdf, outgoing, step.branch);
    step.weight =
        branch_weight(bsdf, step.branch) / static_cast<float>(mirror ? chances.mirror : chances.transmit);
    return step;
}

// Light that a hit emits, less the share that next event estimation has found already.
Color found_emission(const World& world, const Hit& hit, const Bsdf& bsdf, Vec3 from, double pdf) {
    const Color emission = emitted_radiance(world, hit, bsdf);
    const int light = world.surfaces[hit.surface].light;
    if (pdf <= 0 || light < 0 || is_black(emission)) return emission;
    return emission * power_heuristic(pdf, sample_light_pdf(world.lights[static_cast<std::size_t>(light)],
                                                            from, hit.position, hit.normal));
}

} // namespace

Color path_radiance(const World& world, const Ray& camera_ray, const RenderSettings& settings,
                    bool leave_out_paint, Rng& rng) {
    Color sum{0}, throughput{1};
    Ray ray = camera_ray;
    Vec3 from = camera_ray.origin;
    double pdf = 0; // of the step that led here; 0: camera or delta
    bool on_chain = leave_out_paint;
    RayKind kind = RayKind::camera;
    for (int level = 0;; ++level) {
        const std::optional<Hit> hit = closest_hit(world, ray, kind);
        if (!hit) return sum + throughput * sky_radiance(world, ray.direction);
        const Vec3 outgoing = -ray.direction;
        const Bsdf bsdf = make_bsdf(world, *hit, outgoing);
        if (level > 0) throughput *= segment_transmittance(world, *hit, bsdf, hit->t);
        const ChainBranch chain = on_chain && level < settings.max_trace_level
                                      ? chain_branch(world, *hit, bsdf)
                                      : ChainBranch::none;
        if (on_chain && chain == ChainBranch::none) {
            throughput *= static_cast<float>(1 - paint_mix(world, *hit));
            if (is_black(throughput)) return sum;
        }
        sum += throughput * found_emission(world, *hit, bsdf, from, pdf);
        const LobeChances chances = lobe_chances(bsdf);
        if (chances.spread + chances.mirror + chances.transmit == 0) return sum;
        if (chances.spread > 0)
            sum += throughput * next_event(world, *hit, bsdf, outgoing, chances.spread, rng);
        const Step step = choose_step(bsdf, outgoing, chances, rng);
        throughput *= step.weight;
        if (level > 3) { // Russian roulette
            const double survival = std::min(0.95, static_cast<double>(max_component(throughput)));
            if (!(rng.uniform() < survival)) return sum;
            throughput /= static_cast<float>(survival);
        }
        if (is_black(throughput)) return sum;
        on_chain = on_chain && chain != ChainBranch::none && step.branch == chain;
        pdf = step.pdf;
        from = hit->position;
        ray = leave(*hit, step.direction);
        kind = RayKind::specular;
    }
}

} // namespace pnr
