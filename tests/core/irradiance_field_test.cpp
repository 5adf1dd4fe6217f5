// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/irradiance_field.h"

#include "core/path_trace.h"
#include "core/radiance.h"
#include "core/trace_photons.h"
#include "light_scenes.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

struct Lit {
    World world;
    PhotonMap map;
};

Lit light_up(const Scene& scene, std::int64_t photons) {
    Settings settings;
    settings.photons.count = photons;
    Lit lit{build_world(scene, settings), {}};
    lit.map = trace_photons(lit.world, settings.photons, 5, 0, false);
    build_photon_tree(lit.map);
    lit.map.field = make_irradiance_field(lit.world, lit.map);
    return lit;
}

// In the furnace every point has the irradiance pi L / rho; what the lamp sends itself is pi Le q of it.
TEST(IrradianceField, FindsTheFurnacesIndirectLight) {
    constexpr double wall = 3, lamp = 1.5, radiance = 2, albedo = 0.5;
    const Lit lit = light_up(test::furnace(wall, lamp, albedo, radiance), 50000);
    const double all = pi * test::furnace_radiance(wall, lamp, albedo, radiance) / albedo;
    const double direct = pi * radiance * lamp * lamp / (wall * wall);
    std::vector<Neighbour> scratch;
    double sum = 0;
    constexpr int points = 300;
    for (int i = 0; i < points; ++i) {
        Rng rng = make_rng(9, Pass::test, static_cast<std::uint64_t>(i));
        const Vec3 out = square_to_cone(rng.uniform2(), make_frame({0, 0, 1}), 2);
        const FieldIrradiance found = field_irradiance(*lit.map.field, lit.world, lit.map,
                                                       out * wall - lit.world.offset, -out, scratch);
        EXPECT_EQ(found.trust, 1);
        EXPECT_NEAR(found.irradiance.y / (all - direct), 1, 0.1);
        sum += found.irradiance.y;
    }
    EXPECT_NEAR(sum / points / (all - direct), 1, 0.01);
}

// Indirect irradiance at a point of a surface by many paths: the mean over cosine directions of what they
// bring, emitters left out, times pi.
Color indirect_by_paths(const World& world, const Hit& hit, Vec3 normal, int paths) {
    Color sum{0};
    const Frame frame = make_frame(normal);
    for (int i = 0; i < paths; ++i) {
        Rng rng = make_rng(4, Pass::test, static_cast<std::uint64_t>(i));
        const Vec3 direction = square_to_cosine(rng.uniform2(), frame);
        const Ray ray = leave(hit, direction);
        const std::optional<Hit> met = closest_hit(world, ray, RayKind::specular);
        if (!met || world.surfaces[met->surface].light >= 0) continue;
        sum += path_radiance(world, ray, RenderSettings{}, false, rng);
    }
    return sum * static_cast<float>(pi / paths);
}

TEST(IrradianceField, AgreesWithPathsInTheBox) {
    Scene scene = test::paper_box();
    scene.objects.push_back(test::matt(Sphere{{-2, 2, 12}, 2}, Color{0.6f}));
    const Lit lit = light_up(scene, 200000);
    // A wall, the floor in the ball's shadow, near a corner, on the ball.
    for (const auto& [from, to] : {std::pair{Vec3{0, 5, 5}, Vec3{5, 4, 9}},
                                   {Vec3{0, 5, 6}, Vec3{-2, 0, 10.2}},
                                   {Vec3{0, 5, 6}, Vec3{4.6, 0, 15}},
                                   {Vec3{0, 3, 6}, Vec3{-1.5, 2, 12}}}) {
        const Vec3 direction = glm::normalize(to - from);
        const std::optional<Hit> hit =
            closest_hit(lit.world, {from - lit.world.offset, direction}, RayKind::camera);
        ASSERT_TRUE(hit.has_value());
        const Vec3 normal = make_bsdf(lit.world, *hit, -direction).normal;
        std::vector<Neighbour> scratch;
        const FieldIrradiance found =
            field_irradiance(*lit.map.field, lit.world, lit.map, hit->position, normal, scratch);
        const Color truth = indirect_by_paths(lit.world, *hit, normal, 20000);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.irradiance[c] / truth[c], 1, 0.07) << to.x << ' ' << to.z;
    }
}

TEST(IrradianceField, AnEmptyMapIsNotTrusted) {
    const World world;
    const PhotonMap map;
    const auto field = make_irradiance_field(world, map);
    std::vector<Neighbour> scratch;
    EXPECT_EQ(field_irradiance(*field, world, map, {0, 0, 0}, {0, 1, 0}, scratch).trust, 0);
}

} // namespace
} // namespace pnr
