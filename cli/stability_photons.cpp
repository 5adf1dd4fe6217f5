// SPDX-License-Identifier: GPL-3.0-or-later
// Photon maps without extent, of extreme powers, in closed boxes; and sums. Truth: conservation of energy,
// sums written out, what a scene's symmetry makes equal.
#include "cli/stability.h"

#include "core/photon_map.h"
#include "core/progressive.h"
#include "core/radiance.h"
#include "core/rng.h"
#include "core/trace_photons.h"
#include "core/world.h"
#include "npr/paint.h"
#include "parser/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Bsdf white_floor() {
    Bsdf bsdf;
    bsdf.normal = bsdf.geometric = Vec3(0, 1, 0);
    bsdf.diffuse = Color(1);
    return bsdf;
}

// Photons that fall straight down on the plane y = 0, evenly over a disc of this radius.
PhotonMap falling_photons(int count, double radius, float flux) {
    PhotonMap map;
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        const double r = radius * std::sqrt(rng.uniform()), angle = 2 * pi * rng.uniform();
        map.photons.push_back({Vec3f(Vec3(r * std::cos(angle), 0, r * std::sin(angle))), Vec3f(0, -1, 0),
                               Color(flux), photon_tag(1, false, PhotonPath::indirect)});
    }
    build_photon_tree(map);
    return map;
}

float gathered(const PhotonMap& map, int count, float radius,
               GatherKernel kernel = GatherKernel::epanechnikov) {
    GatherSettings settings;
    settings.count = count;
    settings.radius = radius;
    settings.kernel = kernel;
    settings.field = false;
    World world;
    world.surfaces.resize(2);
    world.surfaces[1].object = 1;
    std::vector<Neighbour> scratch;
    return gather(world, map, settings, Vec3(0), white_floor(), Vec3(0, 1, 0), scratch).y;
}

double not_finite(float value) { return std::isfinite(value) && value >= 0 ? 0 : 1; }

void add_gathers(StabilityCases& cases) {
    cases.push_back(
        {"photons", "a map without photons", "radiance", 0, gathered(falling_photons(0, 1, 1), 100, 1)});
    cases.push_back({"photons", "one photon, right here", "estimates that are no number", 0,
                     not_finite(gathered(falling_photons(1, 0, 1), 100, 1))});
    cases.push_back({"photons", "100,000 photons in one point", "estimates that are no number", 0,
                     not_finite(gathered(falling_photons(100000, 0, 1e-5f), 100, 1e-3f))});
    const float plain = gathered(falling_photons(10000, 1, 1), 100, 0.5f);
    for (const float power : {1e-30f, 1e-10f, 1e10f, 1e30f})
        cases.push_back(
            {"photons", fmt::format("photons of {:.0e} W", power), "relative difference from those of 1 W",
             1e-5, std::abs(gathered(falling_photons(10000, 1, power), 100, 0.5f) / power / plain - 1)});
    // All 100 within the disc, each 1 / (pi r^2) of irradiance, a white floor's share 1 / pi of it.
    const double all = 100 / (pi * 4) / pi;
    cases.push_back(
        {"photons", "1,000 wanted of 100", "relative error of the sum", 1e-5,
         std::abs(gathered(falling_photons(100, 1, 1), 1000, 2, GatherKernel::constant) / all - 1)});
}

World world_of(const std::string& text) {
    const LoadResult loaded = load_scene_text(text, "stability.pnr", {});
    if (!loaded.scene) throw SceneError({}, "a scene of the stability suite does not load");
    return build_world(*loaded.scene, loaded.settings);
}

std::string closed_box(double albedo, const std::string& lights) {
    return fmt::format("camera {{ location <0, 0, -0.9> look_at 0 }}\n"
                       "box {{ -1, 1 pigment {{ rgb 1 }} finish {{ diffuse {} }} }}\n{}",
                       albedo, lights);
}

std::string lamp(const char* place, double power) {
    return fmt::format("light_source {{ {}, rgb 1 emitter {{ sphere 0.1 }} power {:.17g} }}\n", place, power);
}

constexpr std::int64_t emitted = 100000;

PhotonMap traced(const World& world) {
    PhotonSettings settings;
    settings.wanted = true;
    settings.count = emitted;
    return trace_photons(world, settings, 1, 0, false);
}

// The balance is exact in expectation; a photon's own is off by about itself, so the mean by 1 / sqrt(N).
void add_energy(StabilityCases& cases) {
    for (const double albedo : {0.0, 0.5, 0.9, 0.99}) {
        const PhotonMap map = traced(world_of(closed_box(albedo, lamp("0", 10))));
        const PowerBalance& b = map.balance;
        const double stored_per_photon =
            static_cast<double>(map.photons.size()) / static_cast<double>(emitted);
        cases.push_back(
            {"photons", fmt::format("closed box of albedo {}", albedo), "(absorbed + escaped) / emitted - 1",
             4 * std::sqrt(std::max(1.0, stored_per_photon)) / std::sqrt(static_cast<double>(emitted)),
             std::abs((b.absorbed.y + b.escaped.y) / b.emitted.y - 1)});
        cases.push_back({"photons", fmt::format("closed box of albedo {}", albedo), "escaped / emitted", 1e-4,
                         b.escaped.y / b.emitted.y});
        if (albedo == 0)
            cases.push_back({"photons", "black box", "photons of indirect light", 0,
                             static_cast<double>(
                                 std::count_if(map.photons.begin(), map.photons.end(), [](const Photon& p) {
                                     return p.path() != PhotonPath::direct;
                                 }))});
    }
    for (const double ratio : {1e3, 1e9, 1e20}) {
        const PhotonMap map =
            traced(world_of(closed_box(0.5, lamp("<0.5, 0, 0>", 10) + lamp("<-0.5, 0, 0>", 10 * ratio))));
        cases.push_back({"photons", fmt::format("two lamps, 1 to {:.0e}", ratio),
                         "relative error of the power sent", 1e-5,
                         std::abs(map.balance.emitted.y / (10 + 10 * ratio) - 1)});
    }
}

// Inverse-square weights: at no distance a source is the value, and next to it nothing is heard of the
// others.
void add_weights(StabilityCases& cases) {
    World world;
    world.objects.resize(2);
    world.objects[1].npr = true;
    world.objects[1].paint = default_style();
    GBuffer g;
    g.view.width = g.view.height = 16;
    g.window = {0, 0, 16, 16};
    g.seen = Image<Seen>(16, 16);
    g.coverage = Image<float>(16, 16, 1.0f);
    for (Seen& seen : g.seen.pixels) seen.object = 1, seen.npr = true, seen.z = 1;
    for (const float away : {0.0f, 1e-20f, 1e-6f}) {
        SparseMap sparse(16, 16);
        const auto put = [&](int x, std::int32_t number, Color radiance, float beside) {
            SourcePixel& s = sparse.at(x, 8);
            s.photon = number;
            s.radiance = radiance;
            s.direction = Vec2f(1, 0);
            s.at = Vec2f(static_cast<float>(x) + 0.5f + beside, 8.5f);
            s.object = 1;
            s.z = 1;
        };
        put(8, 0, Color(1, 0, 0), away);
        put(9, 1, Color(0, 0, 1e6f), 0);
        const InformativeMap map = make_informative_map(sparse, world, g, 1);
        const Color at = map.at(8, 8).radiance;
        cases.push_back({"sums", fmt::format("inverse-square weight at a distance of {:.0e}", away),
                         "difference from the source", 1e-5, std::abs(at.x - 1) + at.z});
    }
}

// A mean that runs over a million passes; each rounds once, so that it strays like a random walk: 4 standard
// deviations.
void add_running_mean(StabilityCases& cases) {
    constexpr int passes = 1000000;
    ProgressiveSum sum;
    double truth = 0;
    Rng rng = make_rng(2, Pass::test, 0);
    for (int i = 0; i < passes; ++i) {
        RenderResult pass;
        const auto value = static_cast<float>(rng.uniform());
        pass.layer = {Image<Color>(1, 1, Color(value)), Image<float>(1, 1, 1.0f)};
        truth += value;
        ProgressiveStep step;
        step.begins_batch = i % 4 == 0;
        step.batch = i / 4;
        add_pass(sum, step, std::move(pass));
    }
    truth /= passes;
    constexpr double half_unit = 6e-8;
    cases.push_back({"sums", "running mean of a million passes", "relative error",
                     4 * half_unit * std::sqrt(passes / 3.0),
                     std::abs(sum.mean.color.at(0, 0).y / truth - 1)});
}

// 1e8 photons' worth of flux into one sum.
void add_power_sums(StabilityCases& cases) {
    PowerBalance balance;
    constexpr int terms = 100000000;
    for (int i = 0; i < terms; ++i) balance.emitted += glm::dvec3(0.1);
    constexpr double eps = 1.1e-16;
    cases.push_back({"sums", "1e8 terms of 0.1 in a power balance", "relative error", terms * eps,
                     std::abs(balance.emitted.x / (0.1 * terms) - 1)});
}

} // namespace

StabilityCases photon_cases() {
    StabilityCases cases;
    add_gathers(cases);
    add_energy(cases);
    return cases;
}

StabilityCases sum_cases() {
    StabilityCases cases;
    add_weights(cases);
    add_running_mean(cases);
    add_power_sums(cases);
    return cases;
}

} // namespace pnr
