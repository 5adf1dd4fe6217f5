// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_text.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

TEST(ParseAtmosphere, ReadsFogSkyAndRainbow) {
    const Scene scene = scene_of(R"(
        #declare Mist = fog { fog_type 2 distance 30 rgbft <1, 0.5, 0.2, 0.3, 0.1> fog_alt 2 fog_offset 1 up <0, 3, 0> }
        fog { Mist turbulence 0.5 turb_depth 0.2 octaves 3 omega 0.4 lambda 2.5 rotate 90 * x }
        #declare Sky = sky_sphere { pigment { rgb 0.5 } pigment { rgbt <1, 0, 0, 0.5> } emission 2 }
        sky_sphere { Sky rotate y * 30 }
        rainbow { direction <0, 0, 2> angle 42 width 5 distance 1e6 jitter 0.1 arc_angle 120 falloff_angle 60
                  color_map { [0 rgbt 0.9] [1 rgb 1] } }
        background { rgbt <0.1, 0.2, 0.3, 0.4> })");
    ASSERT_EQ(scene.atmosphere.fogs.size(), 1u);
    const Fog& fog = scene.atmosphere.fogs[0];
    EXPECT_TRUE(fog.ground);
    EXPECT_EQ(fog.distance, 30);
    EXPECT_EQ(fog.altitude, 2);
    EXPECT_EQ(fog.octaves, 3);
    EXPECT_FLOAT_EQ(fog.color.filter, 0.3f);
    expect_near(fog.up, {0, 0, 1});
    EXPECT_EQ(scene.atmosphere.sky.layers.size(), 2u);
    EXPECT_EQ(scene.atmosphere.sky.emission, Color(2));
    ASSERT_EQ(scene.atmosphere.rainbows.size(), 1u);
    EXPECT_EQ(scene.atmosphere.rainbows[0].arc_angle, 120);
    EXPECT_EQ(scene.atmosphere.rainbows[0].map.size(), 2u);
    EXPECT_FLOAT_EQ(scene.atmosphere.background.transmit, 0.4f);
}

TEST(ParseLight, ReadsAreaLightsAndLightGroups) {
    const Scene scene = scene_of(R"(
        light_source { 10, 1 area_light 4 * x, 2 * z, 5, 3 adaptive 1 jitter circular orient rotate 90 * y }
        light_group { light_source { 0, rgb <1, 0, 0> } sphere { 5, 1 pigment { rgb 1 } } global_lights on }
        light_group { light_source { 0, rgb <0, 1, 0> } sphere { 9, 1 pigment { rgb 1 } } })");
    ASSERT_EQ(scene.lights.size(), 3u);
    ASSERT_TRUE(scene.lights[0].area);
    const AreaGrid& area = *scene.lights[0].area;
    EXPECT_EQ(area.columns, 5);
    EXPECT_EQ(area.rows, 3);
    EXPECT_EQ(area.adaptive, 1);
    EXPECT_TRUE(area.jitter && area.circular && area.orient);
    expect_near(area.u, {0, 0, -4});
    EXPECT_EQ(scene.lights[0].group, 0);
    EXPECT_NE(scene.lights[1].group, scene.lights[2].group);
    EXPECT_EQ(scene.objects[0].light_group, scene.lights[1].group);
    EXPECT_TRUE(scene.objects[0].global_lights);
    EXPECT_FALSE(scene.objects[1].global_lights);
}

TEST(ParseRadiosity, TakesAllOfItsWords) {
    const LoadResult result = load_text(R"(
        global_settings { radiosity { pretrace_start 0.08 pretrace_end 0.04 count 50, 1000 nearest_count 10, 5
            error_bound 0.5 recursion_limit 3 low_error_factor 0.5 gray_threshold 0.2 minimum_reuse 0.015
            maximum_reuse 0.1 brightness 1.5 adc_bailout 0.005 normal on always_sample off media on max_sample 1 } }
        camera { location -9 * z })", "a.pov");
    ASSERT_TRUE(result.scene);
    EXPECT_TRUE(result.diagnostics.empty());
    EXPECT_TRUE(result.scene->radiosity);
    EXPECT_EQ(result.settings.radiosity.recursion_limit, 3);
    EXPECT_EQ(result.settings.radiosity.brightness, 1.5);
    EXPECT_TRUE(result.settings.radiosity.normal);
}

TEST(ParseScene, WarnsOfWhatIsInsideSolids) {
    const auto text = [](const char* scene) { return diagnostics_of(scene, "a.pov"); };
    EXPECT_TRUE(says(
        text("camera { location 0 look_at z } sphere { 0, 2 pigment { rgb 1 } } light_source { -9 * z, 1 }"),
        "the camera is inside `sphere` of line 1"));
    EXPECT_EQ(text("camera { location 0 look_at z } sphere { 0, 2 hollow pigment { rgb 1 } }"
                   " light_source { -9 * z, 1 }"),
              "");
    EXPECT_TRUE(says(
        text("camera { location -9 * z look_at z } sphere { 0, 2 pigment { rgb 1 } } light_source { 0, 1 }"),
        "the light of line 1 is inside `sphere`"));
    EXPECT_TRUE(says(text("camera { location -9 * y look_at y sky y } light_source { 0, 1 }"),
                     "looks along its `sky`"));
}

} // namespace
} // namespace pnr
