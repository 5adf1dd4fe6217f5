// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shade.h"

#include "core/povray_finish.h"

namespace pnr {
namespace {

float mean(Color c) { return (c.x + c.y + c.z) / 3; }

// Levels at which both specular branches are followed; deeper, one of them is chosen by its weight.
constexpr int split_levels = 3;

struct Segment {
    Ray ray;
    RayKind kind = RayKind::camera;
    int level = 0;
    Color throughput{1}; // of what the segment finds, to the camera
    bool on_chain = true;
};

Color trace(const Shading& shading, const Segment& segment, SampleState& state);

// ---- light at a diffuse surface
// ---------------------------------------------------------------------------------

// A Lambertian surface whose reflected radiance is the irradiance itself.
Bsdf irradiance_meter(const Bsdf& bsdf) {
    Bsdf meter;
    meter.normal = bsdf.normal;
    meter.geometric = bsdf.geometric;
    meter.diffuse = Color{static_cast<float>(pi)};
    return meter;
}

// Indirect irradiance, looked up once for all samples of the pixel that see about the same point: it varies
// over the gather disc's width at most, which is many pixels.
Color indirect_irradiance(const Shading& shading, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing,
                          SampleState& state) {
    const double near = 0.1 * shading.indirect.radius;
    for (const KeptIrradiance& kept : *state.kept) {
        const Vec3 apart = kept.position - hit.position;
        if (kept.surface == hit.surface && glm::dot(apart, apart) < near * near &&
            glm::dot(kept.normal, bsdf.normal) > 0.99)
            return kept.irradiance;
    }
    const Color irradiance = gather(shading.world, shading.map, shading.indirect, hit.position,
                                    irradiance_meter(bsdf), outgoing, *state.scratch);
    ++state.gathers;
    state.kept->push_back({hit.surface, hit.position, bsdf.normal, irradiance});
    return irradiance;
}

Color indirect_light(const Shading& shading, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing,
                     SampleState& state) {
    if (shading.indirect.count == 0) return Color{0};
    if (is_black(bsdf.glossy))
        return bsdf.diffuse / static_cast<float>(pi) *
               indirect_irradiance(shading, hit, bsdf, outgoing, state);
    ++state.gathers;
    return gather(shading.world, shading.map, shading.indirect, hit.position, bsdf, outgoing, *state.scratch);
}

Color caustic_light(const Shading& shading, const Hit& hit, const Bsdf& bsdf, Vec3 outgoing,
                    SampleState& state) {
    if (shading.caustic.count == 0) return Color{0};
    ++state.gathers;
    return gather(shading.world, shading.map, shading.caustic, hit.position, bsdf, outgoing, *state.scratch);
}

// Shadow rays that a point is worth: fewer where little of its light reaches the camera.
int shadow_samples(const SampleState& state, Color throughput) {
    const double share = std::min(1.0f, max_component(throughput)) * static_cast<float>(state.shadow_samples);
    return std::max(1, static_cast<int>(std::ceil(share)));
}

Color surface_light(const Shading& shading, const Segment& segment, const Hit& hit, const Bsdf& bsdf,
                    SampleState& state) {
    const Vec3 outgoing = -segment.ray.direction;
    const Color emitted = emitted_radiance(shading.world, hit, bsdf);
    if (!has_diffuse(bsdf)) return emitted;
    const int samples = shadow_samples(state, segment.throughput);
    LightPoints points = state.points;
    points.key = hash_words(points.key, static_cast<std::uint64_t>(segment.level));
    const Color direct = direct_light(shading.world, hit, bsdf, outgoing, samples, points);
    const Color indirect = indirect_light(shading, hit, bsdf, outgoing, state);
    const Color caustic = caustic_light(shading, hit, bsdf, outgoing, state);
    if (segment.level == 0) {
        state.direct += direct;
        state.indirect += indirect;
        state.caustic += caustic;
    }
    return emitted + direct + indirect + caustic;
}

// ---- specular branches
// --------------------------------------------------------------------------------------------

Color trace_branch(const Shading& shading, const Segment& segment, const Hit& hit, const Bsdf& bsdf,
                   ChainBranch branch, bool on_chain, float factor, SampleState& state) {
    const Color weight = branch_weight(bsdf, branch) * factor;
    Segment next{leave(hit, branch_direction(bsdf, -segment.ray.direction, branch)), RayKind::specular,
                 segment.level + 1, segment.throughput * weight, on_chain};
    if (max_component(next.throughput) < shading.settings.adc_bailout) return Color{0};
    return weight * trace(shading, next, state);
}

Color specular_light(const Shading& shading, const Segment& segment, const Hit& hit, const Bsdf& bsdf,
                     ChainBranch chain, SampleState& state) {
    if (segment.level >= shading.settings.max_trace_level) return Color{0};
    const float mirror = mean(bsdf.mirror), transmit = mean(bsdf.transmit);
    if (chain != ChainBranch::none || segment.level < split_levels || mirror == 0 || transmit == 0) {
        Color sum{0};
        for (const ChainBranch branch : {ChainBranch::mirror, ChainBranch::transmit})
            if ((branch == ChainBranch::mirror ? mirror : transmit) > 0)
                sum += trace_branch(shading, segment, hit, bsdf, branch, branch == chain, 1, state);
        return sum;
    }
    const float chance = mirror / (mirror + transmit);
    const bool reflect = state.rng.uniform() < chance;
    return trace_branch(shading, segment, hit, bsdf, reflect ? ChainBranch::mirror : ChainBranch::transmit,
                        false, 1 / (reflect ? chance : 1 - chance), state);
}

// ---- rays
// -----------------------------------------------------------------------------------------------------------

Color trace(const Shading& shading, const Segment& segment, SampleState& state) {
    ++state.rays;
    const World& world = shading.world;
    const std::optional<Hit> hit = closest_hit(world, segment.ray, segment.kind);
    if (!hit) return through_atmosphere(world, segment.ray, infinity, sky_radiance(world, segment.ray.direction));
    const Vec3 outgoing = -segment.ray.direction;
    const Bsdf bsdf = make_bsdf(world, *hit, outgoing);
    const Color passed = segment.level > 0 ? segment_transmittance(world, *hit, bsdf, hit->t) : Color{1};
    float keep = 1;
    ChainBranch chain = ChainBranch::none;
    if (segment.on_chain) {
        const double mix = paint_mix(world, *hit);
        if (mix > 0) {
            state.painted = true;
            state.painted_weight = segment.throughput * passed * static_cast<float>(mix);
            keep = static_cast<float>(1 - mix);
            if (keep <= 0) return Color{0};
        } else if (segment.level < shading.settings.max_trace_level) {
            chain = chain_branch(world, *hit, bsdf);
        }
    }
    Segment here = segment;
    here.throughput *= passed * keep;
    const Color surface = surface_light(shading, here, *hit, bsdf, state);
    const Color specular =
        has_specular(bsdf) ? specular_light(shading, here, *hit, bsdf, chain, state) : Color{0};
    if (segment.level == 0) state.specular += specular;
    const Color seen = keep * (surface + specular);
    watch(world, *hit, seen, state);
    return passed * (bsdf.inside ? seen : through_atmosphere(world, segment.ray, hit->t, seen));
}

} // namespace

Color shade(const Shading& shading, const Ray& camera_ray, SampleState& state) {
    if (shading.world.illumination == Illumination::photon_mapped) {
        Segment segment;
        segment.ray = camera_ray;
        segment.on_chain = state.on_chain;
        return trace(shading, segment, state);
    }
    return povray_radiance(shading, camera_ray, state);
}

} // namespace pnr
