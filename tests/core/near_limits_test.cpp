// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/near_limits.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

// A painted ball of radius 1 in the middle, lit by two balls of radius 0.1.
World plain_world(double first_power = 100, double second_power = 100) {
    World world;
    world.radius = 10;
    world.illumination = Illumination::photon_mapped;
    world.objects.resize(2);
    world.objects[1].name = "sphere";
    world.objects[1].said_at = {"s.pnr", 3, 1};
    world.objects[1].npr = true;
    world.objects[1].bounds = {Vec3(-1), Vec3(1)};
    world.objects[1].paint.seeds.resize(2);
    world.objects[1].paint.seeds[0].position = Vec3(0, 1, 0);
    world.objects[1].paint.seeds[1].position = Vec3(0, -1, 0);
    for (const double power : {first_power, second_power}) {
        LightSource said;
        said.said_at = {"s.pnr", 8 + static_cast<int>(world.lights.size()), 1};
        said.position = Vec3(3, 5, -4);
        said.emitter = Emitter{};
        said.emitter->shape = EmitterShape::sphere;
        said.emitter->radius = 0.1;
        said.emitter->power = power;
        world.lights.push_back(make_light(said));
    }
    return world;
}

TEST(NearLimits, SayNothingOfAPlainWorld) {
    Settings settings;
    EXPECT_TRUE(near_limits(plain_world(), settings, true).empty());
    settings.photons.radius = 0.01;
    EXPECT_TRUE(near_limits(plain_world(), settings, true).empty());
    EXPECT_TRUE(near_limits(plain_world(100, 10), settings, true).empty());
}

TEST(NearLimits, KnowTheRadiusThatFloatsAllow) {
    Settings settings;
    settings.photons.radius = 1e-6; // floats about 1 lie 1.2e-7 apart
    ASSERT_EQ(near_limits(plain_world(), settings, true).size(), 1u);
    EXPECT_TRUE(near_limits(plain_world(), settings, false).empty());
}

TEST(NearLimits, KnowTheSmallThingFarAway) {
    World world = plain_world();
    world.objects[1].bounds = {Vec3(1e6), Vec3(1e6 + 2)}; // floats about 1e6 lie 0.06 apart
    const std::vector<std::string> notes = near_limits(world, Settings{}, true);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes[0].starts_with("s.pnr:3:1: ")) << notes[0];
    world.objects[1].bounds = {Vec3(0), Vec3(2e-9)}; // about the middle floats are as fine as the thing
    EXPECT_TRUE(near_limits(world, Settings{}, true).empty());
}

TEST(NearLimits, KnowSeedsAtOnePlace) {
    World world = plain_world();
    world.objects[1].paint.seeds[1].position = Vec3(0, 1, 1e-7);
    world.objects[1].paint.seeds[1].said_at = {"s.pnr", 5, 9};
    const std::vector<std::string> notes = near_limits(world, Settings{}, false);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes[0].starts_with("s.pnr:5:9: ")) << notes[0];
    EXPECT_NE(notes[0].find("1 and 2"), std::string::npos);
}

TEST(NearLimits, SayTheWorstOfManyAndHowManyMore) {
    World world = plain_world();
    world.objects[1].paint.seeds.assign(5, Seed{}); // ten pairs
    const std::vector<std::string> notes = near_limits(world, Settings{}, false);
    ASSERT_EQ(notes.size(), 3u);
    EXPECT_NE(notes[2].find("7 more"), std::string::npos) << notes[2];
}

TEST(NearLimits, KnowTheLightThatOthersOutshine) {
    const std::vector<std::string> notes = near_limits(plain_world(1e8, 1), Settings{}, true);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes[0].starts_with("s.pnr:9:1: ")) << notes[0];
}

} // namespace
} // namespace pnr
