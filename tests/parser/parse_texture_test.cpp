// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

Texture texture_of(const std::string& items) {
    const Scene scene = scene_of("sphere { 0, 1 " + items + " }");
    return scene.objects.at(0).texture.value_or(Texture{});
}
Pigment pigment_of(const std::string& items) { return texture_of("pigment { " + items + " }").pigment; }
Finish finish_of(const std::string& items) {
    return texture_of("finish { " + items + " } pigment { rgb 1 }").finish;
}

TEST(ParsePigment, Colours) {
    EXPECT_EQ(pigment_of("rgb <0.1, 0.2, 0.3>").map[0].color.rgb, Color(0.1f, 0.2f, 0.3f));
    const ColorFT glass = pigment_of("rgbft <1, 1, 1, 0.25, 0.5>").map[0].color;
    EXPECT_EQ(glass.filter, 0.25f);
    EXPECT_EQ(glass.transmit, 0.5f);
}

TEST(ParsePigment, CheckerHasPovRaysDefaults) {
    const Pigment both = pigment_of("checker rgb 0, rgb 1");
    EXPECT_TRUE(std::holds_alternative<CheckerPattern>(both.pattern.kind));
    EXPECT_EQ(both.map[1].color.rgb, Color(1));
    const Pigment none = pigment_of("checker");
    EXPECT_EQ(none.map[0].color.rgb, Color(0, 0, 1));
    EXPECT_EQ(none.map[1].color.rgb, Color(0, 1, 0));
}

TEST(ParsePigment, GradientWithMap) {
    const Pigment p = pigment_of(
        "gradient <0, 2, 0> color_map { [0.25 rgb <1, 0, 0>] [0.5, 0.75 color rgb 0 color rgb 1] } "
        "frequency 3 phase 0.5 scale 2");
    ASSERT_EQ(p.map.size(), 3u);
    EXPECT_EQ(p.map[0].position, 0.25);
    EXPECT_EQ(p.map[2].position, 0.75);
    EXPECT_EQ(p.map[2].color.rgb, Color(1));
    EXPECT_EQ(p.pattern.frequency, 3);
    EXPECT_EQ(p.pattern.phase, 0.5);
    expect_near(transform_point(p.pattern.transform.matrix, Vec3(1)), Vec3(2));
}

TEST(ParsePigment, DeclaredMapsAndPigments) {
    const Scene scene = scene_of(R"(
        #declare Map = color_map { [0 rgb 0] [1 rgb <0, 0, 1>] }
        #declare Stripes = pigment { gradient x color_map { Map } }
        sphere { 0, 1 pigment { Stripes scale 3 } })");
    EXPECT_EQ(scene.objects[0].texture->pigment.map[1].color.rgb, Color(0, 0, 1));
}

TEST(ParseFinish, DefaultsArePovRays) {
    const Finish f = finish_of("");
    EXPECT_EQ(f.ambient, Color(0.1f));
    EXPECT_EQ(f.diffuse, 0.6);
    EXPECT_EQ(f.roughness, 0.05);
}

TEST(ParseFinish, Items) {
    const Finish f =
        finish_of("ambient 0.2 diffuse 0.7 brilliance 2 phong 0.3 phong_size 60 specular 0.4 roughness 0.01 "
                  "metallic emission rgb <1, 0, 0> conserve_energy");
    EXPECT_EQ(f.ambient, Color(0.2f));
    EXPECT_EQ(f.diffuse, 0.7);
    EXPECT_EQ(f.brilliance, 2);
    EXPECT_EQ(f.phong_size, 60);
    EXPECT_EQ(f.roughness, 0.01);
    EXPECT_EQ(f.metallic, 1);
    EXPECT_EQ(f.emission, Color(1, 0, 0));
    EXPECT_TRUE(f.conserve_energy);
}

TEST(ParseFinish, Reflection) {
    EXPECT_EQ(finish_of("reflection 0.3").reflection.min, Color(0.3f));
    EXPECT_EQ(finish_of("reflection 0.3").reflection.max, Color(0.3f));
    const Reflection r =
        finish_of("reflection { 0.1, 0.9 fresnel on falloff 2 exponent 0.5 metallic 0.25 }").reflection;
    EXPECT_EQ(r.min, Color(0.1f));
    EXPECT_EQ(r.max, Color(0.9f));
    EXPECT_TRUE(r.fresnel);
    EXPECT_EQ(r.falloff, 2);
    EXPECT_EQ(r.metallic, 0.25);
}

TEST(ParseFinish, SaysWhatIsWrong) {
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 finish { roughness 0 } }"), "roughness"));
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 finish { difuse 0.5 } }"), "diffuse"));
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 finish { ior 1.5 } }"), "belongs into `interior`"));
}

TEST(ParseTexture, DeclaredTexturesAndMaterials) {
    const Scene scene = scene_of(R"(
        #declare Shiny = texture { pigment { rgb 0.5 } finish { specular 1 } }
        #declare Glass = material { texture { Shiny } interior { ior 1.5 fade_distance 2 fade_power 1 } }
        sphere { 0, 1 texture { Shiny finish { phong 1 } } }
        sphere { 0, 1 material { Glass } })");
    EXPECT_EQ(scene.objects[0].texture->finish.specular, 1);
    EXPECT_EQ(scene.objects[0].texture->finish.phong, 1);
    EXPECT_EQ(scene.objects[1].interior->ior, 1.5);
    EXPECT_EQ(scene.objects[1].texture->finish.specular, 1);
}

TEST(ParseTexture, DeclaredLayersKeepTheLowestUnlessItIsHidden) {
    const Scene scene = scene_of(R"(
        #declare Stained = texture { pigment { rgb <1, 0, 0> } } texture { pigment { rgbt <0, 0, 0, 0.9> } }
        #declare Covered = texture { pigment { rgb <1, 0, 0> } } texture { pigment { rgb <0, 1, 0> } }
        sphere { 0, 1 texture { Stained } }
        sphere { 0, 1 texture { Covered } })");
    EXPECT_EQ(scene.objects[0].texture->pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_EQ(scene.objects[1].texture->pigment.map[0].color.rgb, Color(0, 1, 0));
}

TEST(ParseTexture, EntriesOfTextureMapsTakeWhatTexturesTake) {
    const Scene scene = scene_of(R"(
        #declare Red = pigment { rgb <1, 0, 0> }
        sphere { 0, 1 texture { average texture_map { [pigment { Red } finish { phong 1 } rotate x * 90] [1 pigment { Red }] } } })");
    EXPECT_EQ(scene.objects[0].texture->pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_EQ(scene.objects[0].texture->finish.phong, 1);
}

TEST(ColorsInc, NamesAndMacros) {
    const Scene scene = scene_of(R"(#include "colors.inc"
        sphere { 0, 1 pigment { SteelBlue } }
        sphere { 0, 1 pigment { rgb CHSV2RGB(CRGB2HSV(rgb <0.2, 0.5, 0.7>)) } }
        sphere { 0, 1 pigment { rgb CHSL2RGB(CRGB2HSL(rgb <0.7, 0.1, 0.3>)) } })");
    EXPECT_EQ(scene.objects[0].texture->pigment.map[0].color.rgb, Color(0.137255f, 0.419608f, 0.556863f));
    expect_near(Vec3(scene.objects[1].texture->pigment.map[0].color.rgb), {0.2, 0.5, 0.7}, 1e-6);
    expect_near(Vec3(scene.objects[2].texture->pigment.map[0].color.rgb), {0.7, 0.1, 0.3}, 1e-6);
}

} // namespace
} // namespace pnr
