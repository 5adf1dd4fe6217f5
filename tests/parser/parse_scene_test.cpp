// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

TEST(ParseSettings, GlobalSettings) {
    const LoadResult result = load_text(R"(global_settings {
        assumed_gamma 2.2 max_trace_level 7 adc_bailout 0.01 ambient_light rgb 0.5 radiosity { count 100 error_bound 1.8 }
        photons { count 12345 gather 10, 50 radius 0.5 global off autostop 0 jitter .4 }
        view shoulder })");
    ASSERT_TRUE(result.scene);
    EXPECT_EQ(result.scene->assumed_gamma, 2.2);
    EXPECT_EQ(result.settings.render.max_trace_level, 7);
    EXPECT_EQ(result.settings.render.adc_bailout, 0.01);
    EXPECT_EQ(result.scene->ambient_light, Color(0.5f));
    EXPECT_TRUE(result.scene->radiosity);
    EXPECT_TRUE(result.settings.photons.wanted && result.settings.photons.count_given);
    EXPECT_EQ(result.settings.photons.count, 12345);
    EXPECT_EQ(result.settings.photons.gather_min, 10);
    EXPECT_EQ(result.settings.photons.gather_max, 50);
    EXPECT_EQ(result.settings.photons.radius, 0.5);
    EXPECT_EQ(*result.settings.photons.global, false);
    EXPECT_EQ(result.settings.render.view, View::shoulder);
}

// What povray 3.7.0.10 writes for a glowing 0.5: 188 with gamma 1, 128 with 2.2, with srgb and without the
// word.
TEST(ParseSettings, GammaByTheKindOfFile) {
    EXPECT_EQ(scene_of("background { rgb 0.5 }", "a.pnr").assumed_gamma, 1);
    EXPECT_EQ(scene_of("background { rgb 0.5 }", "a.pov").assumed_gamma, 0);
    EXPECT_EQ(scene_of("global_settings { assumed_gamma 1 }", "a.pov").assumed_gamma, 1);
    EXPECT_EQ(scene_of("global_settings { assumed_gamma srgb }", "a.pov").assumed_gamma, 0);
    EXPECT_TRUE(scene_of("", "a.pov").povray);
    EXPECT_EQ(load_text("", "a.pov").settings.render.max_trace_level, 5);
}

TEST(ParseScene, WarnsOfWhatIsMissing) {
    const std::string all = diagnostics_of("sphere { 0, 1 pigment { rgb 1 } }");
    EXPECT_TRUE(says(all, "warning: the scene has no camera"));
    EXPECT_TRUE(says(all, "warning: the scene has no light"));
    EXPECT_EQ(diagnostics_of("sphere { 0, 1 pigment { rgb 1 } } camera { location -5 * z } light_source { 2 * y, 1 }"), "");
}

TEST(ParseScene, SeveralErrorsInOneRun) {
    const std::string all = diagnostics_of(R"(
        sphere { 0, 1 pigmnt { rgb 1 } }
        camera { locatoin 0 }
        box { 0, 1 pigment { rgb 1 } finish { shiny 1 } })");
    EXPECT_TRUE(says(all, "pigment"));
    EXPECT_TRUE(says(all, "location"));
    EXPECT_TRUE(says(all, "shiny"));
}

TEST(ParseScene, TheDefaultSceneIsFreeOfWarnings) {
    EXPECT_EQ(diagnostics_of(default_scene_text(), "default.pnr"), "");
    const Scene scene = scene_of(default_scene_text(), "default.pnr");
    EXPECT_EQ(scene.objects.size(), 3u);
    EXPECT_TRUE(scene.objects[1].npr->on);
}

TEST(ParseScene, DirectivesMayStandInTheMiddleOfABlock) {
    const Scene scene = scene_of(R"(union {
        #for (I, 1, 5) sphere { I * x, #if (I = 3) 2 #else 1 #end } #end
        pigment { rgb 1 } })");
    ASSERT_EQ(scene.objects.at(0).children.size(), 5u);
    EXPECT_EQ(std::get<Sphere>(*scene.objects[0].children[2].shape).radius, 2);
}

} // namespace
} // namespace pnr
