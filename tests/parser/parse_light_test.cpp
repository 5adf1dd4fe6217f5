// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/world.h"
#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

LightSource light_of(const std::string& items) {
    const Scene scene = scene_of("light_source { " + items + " }");
    EXPECT_EQ(scene.lights.size(), 1u);
    return scene.lights.empty() ? LightSource{} : scene.lights.front();
}

TEST(ParseLight, PovRaysLights) {
    const LightSource spot =
        light_of("<1, 2, 3>, rgb <1, 0.5, 0> spotlight point_at <0, 0, 0> radius 10 falloff 20 "
                 "tightness 5 fade_distance 4 fade_power 2 translate x");
    expect_near(spot.position, {2, 2, 3});
    expect_near(spot.point_at, {1, 0, 0});
    EXPECT_EQ(spot.color, Color(1, 0.5f, 0));
    EXPECT_TRUE(spot.spotlight);
    EXPECT_EQ(spot.falloff, 20);
    EXPECT_EQ(spot.fade_power, 2);
    EXPECT_TRUE(light_of("y, 1 parallel point_at 0").parallel);
    EXPECT_TRUE(light_of("y, 1 shadowless").shadowless);
}

TEST(ParseLight, Emitters) {
    const LightSource lamp = light_of("<0, 10, 14>, rgb 1 emitter { hemisphere 1.5, -2*y } power 900");
    ASSERT_TRUE(lamp.emitter);
    EXPECT_EQ(lamp.emitter->radius, 1.5);
    expect_near(lamp.emitter->axis, {0, -1, 0});
    EXPECT_EQ(*lamp.emitter->power, 900);
    EXPECT_FALSE(lamp.emitter->radiance);
    const LightSource window = light_of("0, 1 emitter { rectangle 2*x, 3*z } radiance 5 rotate 90*x");
    expect_near(window.emitter->v, {0, -3, 0}); // +90 degrees about x takes z to -y
}

TEST(ParseLight, ScaledEmitters) {
    const LightSource ball = light_of("0, 1 emitter { sphere 2 } radiance 5 scale 3");
    EXPECT_NEAR(ball.emitter->radius, 6, 1e-12);
    EXPECT_TRUE(says(diagnostics_of("light_source { 0, 1 emitter { sphere 2 } radiance 5 scale <1, 2, 1> }"),
                     "warning: an emitter is scaled alike"));
}

TEST(ParseLight, SaysWhatIsWrong) {
    EXPECT_TRUE(says(diagnostics_of("light_source { 0, 1 emitter { sphere 1 } }"), "needs `radiance`"));
    EXPECT_TRUE(
        says(diagnostics_of("light_source { 0, 1 emitter { sphere 1 } radiance 1 power 1 }"), "not both"));
    EXPECT_TRUE(says(diagnostics_of("light_source { 0, 1 power 1 }"), "need an emitter"));
    EXPECT_TRUE(says(diagnostics_of("light_source { 0, 1 emitter { cube 1 } power 1 }"), "error"));
    EXPECT_TRUE(
        says(diagnostics_of("light_source { 0, 1 emitter { rectangle x, 2*x } power 1 }"), "parallel"));
}

TEST(ParseLight, LightsInUnionsAndTheirLooks) {
    const Scene scene = scene_of(R"(
        union { sphere { 0, 1 pigment { rgb 1 } } light_source { y, 1 } translate 2*y }
        light_source { <5, 0, 0>, 1 looks_like { sphere { 0, 0.5 pigment { rgb 1 } } } translate z })");
    ASSERT_EQ(scene.lights.size(), 2u);
    expect_near(scene.lights[0].position, {0, 3, 0});
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_TRUE(scene.objects[1].no_shadow);
    expect_near(transform_point(scene.objects[1].transform->matrix, Vec3(0)), {5, 0, 1});
}

TEST(ParseLight, AGroupsLightsShineOnItsObjectsAlone) {
    const Scene scene = scene_of("light_group { light_source { y, 1 } sphere { 0, 1 pigment { rgb 1 } } global_lights off }"
                                 " sphere { 2 * x, 1 pigment { rgb 1 } } light_source { -y, 1 }");
    const World world = build_world(scene, {});
    ASSERT_EQ(world.lights.size(), 2u);
    int lit[2] = {0, 0};
    for (const Light& light : world.lights)
        for (int i = 0; i < 2; ++i) {
            const auto hit = closest_hit(world, {Vec3(2.0 * i, 0, -5) - world.offset, {0, 0, 1}}, RayKind::camera);
            ASSERT_TRUE(hit);
            if (shines_on(light, world.surfaces[hit->surface])) lit[i] += light.said.group > 0 ? 1 : 10;
        }
    EXPECT_EQ(lit[0], 1) << "the group's object has the group's light";
    EXPECT_EQ(lit[1], 10) << "the other object has the other light";
}

} // namespace
} // namespace pnr
