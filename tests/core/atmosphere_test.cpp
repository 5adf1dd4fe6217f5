// SPDX-License-Identifier: GPL-3.0-or-later
// What POV-Ray 3.7.0.10 shows of one ray, read from its pictures.
#include "core/atmosphere.h"

#include "core/world.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

void expect_color(Color found, Color expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 2e-4);
}

Pigment plain(Color rgb, float filter, float transmit) {
    Pigment pigment;
    pigment.map = {{0, {rgb, filter, transmit}}};
    return pigment;
}

Color seen(const World& world, double distance, Color behind, Vec3 origin = Vec3(0), Vec3 along = {0, 0, 1}) {
    return through_atmosphere(world, {origin, glm::normalize(along), 0, infinity}, distance, behind);
}

TEST(SkyRadiance, LaysPigmentsOverEachOther) {
    World world;
    world.atmosphere.background = {{0.1f, 0.2f, 0.3f}, 0, 0};
    expect_color(sky_radiance(world, {0, 0, 1}), {0.1f, 0.2f, 0.3f});
    world.atmosphere.sky.layers = {plain({1, 0.5f, 0}, 0.25f, 0)};
    expect_color(sky_radiance(world, {0, 0, 1}), {0.775f, 0.4f, 0});
    world.atmosphere.sky.emission = Color(0.5f);
    expect_color(sky_radiance(world, {0, 0, 1}), {0.4f, 0.2125f, 0});
    world.atmosphere.sky = {{plain({1, 0, 0}, 0, 0), plain({0.5f, 0.6f, 0.7f}, 0.3f, 0.2f)}, Color(1)};
    expect_color(sky_radiance(world, {0, 1, 0}), {0.6f, 0.3f, 0.35f});
    world.atmosphere.sky = {};
    world.atmosphere.background = {{0.5f, 0.2f, 0.1f}, 0, 0.6f};
    expect_color(sky_radiance(world, {0, 1, 0}), {0.2f, 0.08f, 0.04f});
}

TEST(Fog, DimsTintsAndAddsUp) {
    World world;
    Fog fog;
    fog.distance = 20;
    fog.color = {{0, 0, 1}, 0, 0};
    const Color wall(0.8f, 0.6f, 0.4f);
    world.atmosphere.fogs = {fog};
    expect_color(seen(world, 10, wall), {0.48522f, 0.36391f, 0.63609f});
    expect_color(seen(world, infinity, Color(0.5f)), {0, 0, 1});
    world.atmosphere.fogs[0].color.transmit = 0.8f;
    expect_color(seen(world, 10, wall), {0.64f, 0.48f, 0.52f});
    world.atmosphere.fogs[0].color = {{0.5f, 0.1f, 1}, 0.3f, 0.7f};
    expect_color(seen(world, 10, wall), {0.626f, 0.3366f, 0.58f});
    Fog second = fog;
    second.distance = 30;
    second.color = {{0, 1, 0}, 0, 0};
    world.atmosphere.fogs = {fog, second};
    expect_color(seen(world, 10, wall), {0.34768f, 0.54423f, 0.56732f});
    world.atmosphere.fogs = {fog};
    world.atmosphere.fogs[0].color = {{1, 0.5f, 0.1f}, 0.2f, 0.3f};
    world.atmosphere.fogs[0].turbulence = Vec3(1);
    world.atmosphere.fogs[0].depth = 1;
    expect_color(seen(world, 10, wall), {0.83572f, 0.53286f, 0.28728f});
}

TEST(Fog, ThinsOutAboveTheGround) {
    World world;
    Fog fog;
    fog.ground = true;
    fog.distance = 20;
    fog.offset = 0.5;
    fog.altitude = 1.5;
    world.atmosphere.fogs = {fog};
    struct Case {
        double height, rise;
        float left;
    };
    for (const Case c : {Case{0, 0, 0.60653f}, {2, 0, 0.77881f}, {1, 4, 0.82922f}, {-3, 8, 0.65045f},
                         {8, -3, 0.96806f}, {1.2, 0.0001, 0.66326f}}) {
        const Color found = seen(world, std::hypot(10.0, c.rise), Color(1), {0, c.height, 0}, {0, c.rise, 10});
        EXPECT_NEAR(found.x, c.left, 2e-4);
    }
    EXPECT_NEAR(seen(world, infinity, Color(1), {0, 1, 0}, {0, 4, 10}).x, 0.77707, 2e-4);
    world.atmosphere.fogs[0].altitude = 0; // nothing above its border
    EXPECT_NEAR(seen(world, std::hypot(10.0, 4.0), Color(1), {0, 1, 0}, {0, 4, 10}).x, 1, 1e-6);
}

TEST(Rainbow, ColoursWhatIsBehindItsBand) {
    World world;
    Rainbow rainbow;
    rainbow.width = 10;
    rainbow.distance = 1000;
    rainbow.map = {{0, {{0.4f, 0.6f, 0.8f}, 0.3f, 0}}};
    world.atmosphere.rainbows = {rainbow};
    expect_color(seen(world, 700, {0.1f, 0.2f, 0.3f}), {0.24652f, 0.39536f, 0.54720f});
    expect_color(seen(world, 700, Color(0.1f), Vec3(0), {1, 0, 1}), Color(0.1f));
    rainbow.map = {{0, {Color(1), 0, 0}}};
    rainbow.angle = 1;
    rainbow.arc_angle = 180, rainbow.falloff_angle = 90;
    rainbow.direction = glm::normalize(Vec3(std::sin(pi / 3) * 0.02, -std::cos(pi / 3) * 0.02, 1));
    world.atmosphere.rainbows = {rainbow};
    EXPECT_NEAR(seen(world, infinity, Color(0.1f)).x, 0.76654, 2e-3);
}

} // namespace
} // namespace pnr
