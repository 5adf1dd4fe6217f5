// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

PaintWord word_of(const std::string& items, const std::string& around = "") {
    const Scene scene = scene_of(around + " sphere { 0, 1 pigment { rgb 1 } " + items + " }");
    return scene.objects.at(0).npr.value_or(PaintWord{});
}
PaintStyle style_of(const std::string& items, const std::string& around = "") {
    return word_of("npr { " + items + " }", around).style;
}

TEST(ParseNpr, TheWordAlone) {
    EXPECT_TRUE(word_of("npr").on);
    EXPECT_TRUE(word_of("npr on").on);
    EXPECT_FALSE(word_of("npr off").on);
    EXPECT_TRUE(word_of("npr { }").on);
    EXPECT_FALSE(scene_of("sphere { 0, 1 pigment { rgb 1 } }").objects[0].npr);
}

TEST(ParseNpr, AllItems) {
    const PaintStyle s = style_of(R"(
        seeds { seed { <0, 1, 0>, x } seed { <1, 0, 0>, y weight 2 } rbf { kernel triharmonic distance geodesic smooth 0.1 neighbours 4 } }
        field around <1, 2, 3>, y weight 0.4
        interpolation { radius 7 fill random folds on }
        ilic { length 39 cell 6 noise 0.04, 0.03 edge 12 gaussian 21, 11 step 0.25 size 0.7 }
        tone { contrast 1.2 saturation 1.1 warm 0.05 } relief 0.1, 0.02
        mix 0.75)");
    ASSERT_EQ(s.seeds.size(), 2u);
    EXPECT_EQ(s.seeds[1].weight, 2);
    EXPECT_EQ(s.kernel, RbfKernel::triharmonic);
    EXPECT_EQ(s.distance, SeedDistance::geodesic);
    EXPECT_EQ(s.smooth, 0.1);
    EXPECT_EQ(s.neighbours, 4);
    EXPECT_EQ(s.field, FieldSource::around);
    expect_near(s.field_point, {1, 2, 3});
    EXPECT_EQ(s.field_weight, 0.4);
    EXPECT_EQ(s.radius, 7);
    EXPECT_EQ(s.fill, Fill::random);
    EXPECT_TRUE(s.folds);
    EXPECT_EQ(s.length, 39);
    EXPECT_EQ(s.cell, 6);
    EXPECT_EQ(s.noise_lightness, 0.04);
    EXPECT_EQ(s.noise_chroma, 0.03);
    EXPECT_EQ(s.edge, 12);
    EXPECT_EQ(*s.gaussian_second, 11);
    EXPECT_EQ(s.step, 0.25);
    EXPECT_EQ(s.contrast, 1.2);
    EXPECT_EQ(s.bristle, 0.02);
    EXPECT_EQ(s.size, 0.7);
    EXPECT_EQ(s.mix, 0.75);
}

TEST(ParseNpr, ADeclaredBlockComesFirstAndLaterItemsWin) {
    const std::string flowing = "#declare Flowing = npr { ilic { length 39 cell 6 } mix 0.5 }";
    const PaintStyle s = style_of("Flowing ilic { cell 3 }", flowing);
    EXPECT_EQ(s.length, 39);
    EXPECT_EQ(s.cell, 3);
    EXPECT_EQ(s.mix, 0.5);
}

TEST(ParseNpr, DefaultsCountWhereverTheyStand) {
    for (const bool before : {true, false}) {
        const std::string settings =
            "global_settings { npr { ilic { length 12 cell 2 } interpolation { radius 9 } } }";
        const std::string object = "sphere { 0, 1 pigment { rgb 1 } npr { ilic { cell 5 } } }";
        const Scene scene = scene_of(before ? settings + object : object + settings);
        const PaintStyle& s = scene.objects[0].npr->style;
        EXPECT_EQ(s.length, 12);
        EXPECT_EQ(s.cell, 5); // the object's own word
        EXPECT_EQ(s.radius, 9);
        EXPECT_EQ(scene.paint_defaults.cell, 2);
    }
}

TEST(ParseNpr, PaperModeChangesTheBaseAlone) {
    const PaintStyle s = style_of("ilic { length 33 } paper_mode on");
    EXPECT_TRUE(s.paper_mode && s.vectors && s.box_weights);
    EXPECT_EQ(s.length, 33); // said here, though before
    EXPECT_EQ(s.edge, 0);
    EXPECT_EQ(s.cell, 1);
    EXPECT_EQ(s.noise_lightness, 0.2);
    EXPECT_EQ(field_windows(s), Vec2(15, 7)); // along curvature, too
    EXPECT_EQ(style_of("paper_mode on style ilic").edge, 0);
    EXPECT_EQ(s.fill, Fill::random);
    EXPECT_FALSE(s.folds); // the paper knows none
    EXPECT_EQ(style_of("", "global_settings { npr { paper_mode on } }").length, 20);
    EXPECT_EQ(style_of("paper_mode off", "global_settings { npr { paper_mode on } }").length, 26);
}

TEST(ParseNpr, StylesAndLayers) {
    EXPECT_EQ(style_of("style oil").layers.size(), 3u);
    EXPECT_EQ(style_of("style oil style ilic").layers.size(), 0u);
    const PaintStyle s =
        style_of("style oil ilic { layer { length 30 cell 8 } layer { length 12 cell 3 opacity 0.5 } }");
    ASSERT_EQ(s.layers.size(), 2u);
    EXPECT_EQ(s.layers[1].opacity, 0.5);
    EXPECT_TRUE(
        says(diagnostics_of("sphere { 0, 1 npr { style watercolour } }"), "no painting style `watercolour`"));
}

TEST(ParseNpr, TransformsMoveSeedsAndAxes) {
    const PaintStyle s =
        word_of("npr { seeds { seed { x, z } } field along x } scale <2, 1, 1> rotate 90*z").style;
    expect_near(s.seeds[0].position, {0, 2, 0});
    expect_near(s.seeds[0].direction, {0, 0, 1});
    expect_near(s.field_vector, {0, 2, 0});
}

TEST(ParseNpr, WordsOfPaintingAreFreeNames) { // POV-Ray's scenes use them as identifiers
    const PaintStyle s = style_of("ilic { length length }", "#declare length = 17; #declare mix = 3;");
    EXPECT_EQ(s.length, 17);
}

TEST(ParseNpr, SaysWhatIsWrong) {
    const auto wrong = [](const std::string& items) {
        return diagnostics_of("sphere { 0, 1 pigment { rgb 1 } npr { " + items + " } }");
    };
    EXPECT_TRUE(says(wrong("mix 1.5"), "`mix`"));
    EXPECT_TRUE(says(wrong("ilic { lenght 3 }"), "length"));
    EXPECT_TRUE(
        says(wrong("seeds { seed { <0, 0, 0>, <0, 0, 0> } }"), "direction of a seed must not be zero"));
    EXPECT_TRUE(says(wrong("interpolation { radius -1 }"), "`radius` of the interpolation"));
    EXPECT_TRUE(says(wrong("field around 0, 0"), "axis of a field must not be zero"));
}

} // namespace
} // namespace pnr
