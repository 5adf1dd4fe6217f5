// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/radiance.h"

#include "light_scenes.h"

namespace pnr {
namespace {

// Irradiance on the floor (y = 0, albedo 0.5) at a point, by shadow rays.
double floor_irradiance(LightSource light, Vec3 at, int samples) {
    Scene scene;
    scene.objects.push_back(test::matt(Plane{{0, 1, 0}, 0}, Color{0.5f}));
    scene.lights.push_back(std::move(light));
    scene.camera = test::look({0, 5, -5}, {0, 0, 0});
    const World world = build_world(scene, Settings{});
    const Ray ray{at + Vec3{0, 1, 0} - world.offset, {0, -1, 0}, 0, infinity};
    Ray shifted = ray;
    shifted.origin.y = 0.5 - world.offset.y;
    const std::optional<Hit> hit = closest_hit(world, shifted, RayKind::camera);
    EXPECT_TRUE(hit.has_value());
    const Bsdf bsdf = make_bsdf(world, *hit, {0, 1, 0});
    Rng rng = make_rng(1, Pass::test, 0);
    return direct_light(world, *hit, bsdf, {0, 1, 0}, samples, rng).y / 0.5 * pi;
}

TEST(DirectLight, DiscAboveAPoint) { // E = pi L a^2 / (a^2 + h^2)
    const LightSource light = test::emitter(EmitterShape::disc, {0, 3, 0}, 1.5, 2);
    EXPECT_NEAR(floor_irradiance(light, {0, 0, 0}, 4096) / (pi * 2 * 2.25 / (2.25 + 9)), 1, 0.005);
}

TEST(DirectLight, SphereAbovePlane) { // E = pi L (r / d)^2 cos
    const LightSource light = test::emitter(EmitterShape::sphere, {0, 3, 0}, 1, 2);
    const double d2 = 9 + 4;
    EXPECT_NEAR(floor_irradiance(light, {2, 0, 0}, 4096) / (pi * 2 / d2 * 3 / std::sqrt(d2)), 1, 0.005);
}

TEST(DirectLight, RectangleWithItsCornerAboveAPoint) {
    // Form factor of a rectangle a x b parallel to the receiver at height h, one corner above it.
    const double a = 2, b = 3, h = 1.5;
    const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
    const double factor = (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2 * pi);
    const LightSource light = test::ceiling_lamp({a / 2, h, b / 2}, a / 2, b / 2, 2);
    EXPECT_NEAR(floor_irradiance(light, {0, 0, 0}, 4096) / (pi * 2 * factor), 1, 0.005);
}

TEST(DirectLight, HemisphereThatBulgesDown) { // a full sphere's light while its lid is not in the way
    const LightSource light = test::emitter(EmitterShape::hemisphere, {0, 3, 0}, 1, 2);
    EXPECT_NEAR(floor_irradiance(light, {0, 0, 0}, 4096) / (pi * 2 / 9), 1, 0.005);
}

TEST(DirectLight, PointLightLikePovRay) { // irradiance pi c cos at any distance
    LightSource light;
    light.position = {4, 3, 0};
    light.color = Color{0.5f};
    EXPECT_NEAR(floor_irradiance(light, {0, 0, 0}, 1) / (pi * 0.5 * 3 / 5), 1, 1e-5);
}

// ---- gathers
// ------------------------------------------------------------------------------------------------------

Bsdf white_floor() {
    Bsdf bsdf;
    bsdf.normal = bsdf.geometric = {0, 1, 0};
    bsdf.diffuse = Color{1};
    return bsdf;
}

// Photons that fall straight down on the unit square's tenfold, each of 1 W, `density` a unit area.
PhotonMap rain(int count, std::uint64_t seed, Vec3f direction = {0, -1, 0}) {
    PhotonMap map;
    Rng rng = make_rng(seed, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        const Vec2 u = rng.uniform2();
        map.photons.push_back(
            {Vec3f(u.x * 10, 0, u.y * 10), direction, Color{1}, photon_tag(1, false, PhotonPath::indirect)});
    }
    std::vector<Vec3f> points;
    for (const Photon& p : map.photons) points.push_back(p.position);
    map.tree = build_kdtree(points);
    map.emitted = count;
    return map;
}

TEST(Gather, EveryKernelFindsTheDensityOfEvenPhotonsAlsoFromAFew) {
    // 100 photons a unit area and 1 W each: irradiance 100, radiance of a white floor 100 / pi. A naive
    // estimate from k = 6 would be 20 % too bright.
    const World world;
    for (const GatherKernel kernel :
         {GatherKernel::constant, GatherKernel::epanechnikov, GatherKernel::cone, GatherKernel::gaussian}) {
        for (const auto& [count, radius] : {std::pair{6, 5.f}, std::pair{50, 5.f}, std::pair{1000, 0.5f}}) {
            double sum = 0;
            int points = 0;
            std::vector<Neighbour> scratch;
            for (int run = 0; run < 4; ++run) {
                const PhotonMap map = rain(10000, 11 + static_cast<std::uint64_t>(run));
                GatherSettings settings{count, radius, kernel, false, true, true, 0};
                for (double x = 2; x <= 8; x += 0.15)
                    for (double z = 2; z <= 8; z += 0.15, ++points)
                        sum += gather(world, map, settings, {x, 0, z}, white_floor(), {0, 1, 0}, scratch).y;
            }
            EXPECT_NEAR(sum / points * pi / 100, 1, 0.015) << static_cast<int>(kernel) << " k " << count;
        }
    }
}

TEST(Gather, PhotonsFromTheOtherSideDoNotCount) {
    const World world;
    const PhotonMap map = rain(1000, 5, {0, 1, 0});
    std::vector<Neighbour> scratch;
    GatherSettings settings{50, 5, GatherKernel::constant, false, true, true, 0};
    EXPECT_EQ(gather(world, map, settings, {5, 0, 5}, white_floor(), {0, 1, 0}, scratch), Color{0});
}

TEST(Gather, PathsThatAreNotWantedDoNotCount) {
    const World world;
    const PhotonMap map = rain(1000, 5);
    std::vector<Neighbour> scratch;
    GatherSettings settings{50, 5, GatherKernel::constant, true, false, true, 0};
    EXPECT_EQ(gather(world, map, settings, {5, 0, 5}, white_floor(), {0, 1, 0}, scratch), Color{0});
}

TEST(Gather, AnEmptyMapIsDark) {
    std::vector<Neighbour> scratch;
    EXPECT_EQ(
        gather(World{}, PhotonMap{}, GatherSettings{50, 5}, {5, 0, 5}, white_floor(), {0, 1, 0}, scratch),
        Color{0});
}

} // namespace
} // namespace pnr
