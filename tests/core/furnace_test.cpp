// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere lit from its centre: its wall has one known radiance everywhere, whatever finds it.
#include <gtest/gtest.h>

#include "core/path_trace.h"
#include "core/radiance.h"
#include "core/trace_photons.h"
#include "light_scenes.h"

namespace pnr {
namespace {

constexpr double wall = 3, lamp = 1.5, radiance = 2;
constexpr float albedo = 0.5f;

struct Furnace {
    Settings settings;
    World world;
    PhotonMap map;
    double expected = test::furnace_radiance(wall, lamp, albedo, radiance);

    Furnace() : world(build_world(test::furnace(wall, lamp, albedo, radiance), settings)) {
        settings.photons.count = 200000;
        map = trace_photons(world, settings.photons, 7, 0, false);
        build_photon_tree(map);
    }
};

const Furnace& shared_furnace() {
    static const Furnace furnace;
    return furnace;
}

// Mean of estimate(hit, bsdf, outgoing, rng) over directions from the lamp's side to the wall.
template <class Estimate>
double mean_over_wall(const World& world, int points, const Estimate& estimate) {
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        Rng rng = make_rng(3, Pass::test, static_cast<std::uint64_t>(i));
        const Vec3 direction = square_to_cone(rng.uniform2(), make_frame({0, 0, 1}), 2);
        Ray ray{direction * 2.0 - world.offset, direction};
        const std::optional<Hit> hit = closest_hit(world, ray, RayKind::camera);
        if (!hit) throw std::runtime_error("the furnace leaks");
        const Bsdf bsdf = make_bsdf(world, *hit, -direction);
        sum += estimate(*hit, bsdf, -direction, rng).y;
    }
    return sum / points;
}

TEST(Furnace, PhotonsAloneGiveTheWallsRadianceWithEachKernel) {
    const Furnace& f = shared_furnace();
    for (const GatherKernel kernel :
         {GatherKernel::constant, GatherKernel::epanechnikov, GatherKernel::cone, GatherKernel::gaussian}) {
        // Both ends of a search: by the k-th photon, and by the cap.
        for (const auto& [count, radius] : {std::pair{50, 10.f}, std::pair{100000, 0.4f}}) {
            GatherSettings settings{count, radius, kernel, true, true, true, 0};
            std::vector<Neighbour> scratch;
            const double found =
                mean_over_wall(f.world, 4000, [&](const Hit& hit, const Bsdf& bsdf, Vec3 out, Rng&) {
                    return gather(f.world, f.map, settings, hit.position, bsdf, out, scratch);
                });
            EXPECT_NEAR(found / f.expected, 1, 0.005)
                << "kernel " << static_cast<int>(kernel) << " k " << count;
        }
    }
}

TEST(Furnace, DirectLightAndPhotonsGiveTheWallsRadiance) {
    const Furnace& f = shared_furnace();
    GatherSettings settings = default_gather(f.world, f.map, f.settings.photons);
    settings.direct = false;
    std::vector<Neighbour> scratch;
    const double found =
        mean_over_wall(f.world, 4000, [&](const Hit& hit, const Bsdf& bsdf, Vec3 out, Rng& rng) {
            return direct_light(f.world, hit, bsdf, out, 4, rng) +
                   gather(f.world, f.map, settings, hit.position, bsdf, out, scratch);
        });
    EXPECT_NEAR(found / f.expected, 1, 0.005);
}

TEST(Furnace, PathsGiveTheWallsRadiance) {
    const Furnace& f = shared_furnace();
    const double found = mean_over_wall(f.world, 20000, [&](const Hit& hit, const Bsdf&, Vec3 out, Rng& rng) {
        const Ray ray{hit.position + out, -out};
        return path_radiance(f.world, ray, f.settings.render, false, rng);
    });
    EXPECT_NEAR(found / f.expected, 1, 0.005);
}

} // namespace
} // namespace pnr
