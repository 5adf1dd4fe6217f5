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

TEST(ParsePigment, ChannelsFollowANamedColour) {
    const auto color_of = [](const std::string& items) {
        const Scene scene = scene_of("#declare W = color rgb <0.9, 0.5, 0.7>; sphere { 0, 1 pigment { " + items + " } }");
        return scene.objects.at(0).texture->pigment.map[0].color;
    };
    for (const std::string item : {"W filter 0.5", "color W filter 0.5", "rgb <0.9, 0.5, 0.7> filter 0.5"}) {
        EXPECT_EQ(color_of(item).rgb, Color(0.9f, 0.5f, 0.7f)) << item;
        EXPECT_EQ(color_of(item).filter, 0.5f) << item;
    }
    EXPECT_EQ(color_of("W red 0.2 transmit 1").rgb, Color(0.2f, 0.5f, 0.7f));
    EXPECT_EQ(color_of("W red 0.2 transmit 1").transmit, 1);
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
    expect_near(transform_point(p.pattern.transform->matrix, Vec3(1)), Vec3(2));
}

// Colours that POV-Ray shows where the pattern has these values.
TEST(ParsePigment, PatternsWithoutAMapHaveTheirOwnColours) {
    const auto seen = [](const std::string& pattern, double value) {
        Pigment pigment = pigment_of(pattern);
        set_kind(pigment.pattern, GradientPattern{{1, 0, 0}});
        SurfacePoint at;
        at.point = {value, 0, 0};
        return Vec3(eval_pigment(pigment, at).rgb);
    };
    expect_near(seen("agate", 0.2281), {0.977, 0.886, 0.772}, 1e-3);
    expect_near(seen("agate", 0.5742), {0.9, 0.7, 0.426}, 1e-3);
    expect_near(seen("agate", 0.8097), {0.79, 0.49, 0.19}, 1e-3);
    expect_near(seen("bozo", 0.5), {0, 1, 0}, 1e-3);
    expect_near(seen("mandel 20", 0.0065), {0.5, 1, 0.5}, 1e-3);
    expect_near(seen("marble", 0.4916), {0.9, 0.407, 0.407}, 1e-3);
    expect_near(seen("radial", 0.7478), {0.755, 0.245, 1}, 3e-3);
    expect_near(seen("wood", 0.7), {0.4, 0.133, 0.066}, 1e-3);
    expect_near(seen("spotted", 0.3), Vec3(0.3), 1e-3);
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

TEST(ParseTexture, DeclaredLayersLieOnEachOther) {
    const Scene scene = scene_of(R"(
        #declare Stained = texture { pigment { rgb <1, 0, 0> } } texture { pigment { rgbt <0, 0, 0, 0.9> } }
        #declare Covered = texture { pigment { rgb <1, 0, 0> } } texture { pigment { rgb <0, 1, 0> } }
        sphere { 0, 1 texture { Stained } }
        sphere { 0, 1 texture { Covered } })");
    for (const Object& object : scene.objects) {
        EXPECT_EQ(object.texture->pigment.map[0].color.rgb, Color(1, 0, 0));
        ASSERT_EQ(object.texture->upper.size(), 1u);
    }
    EXPECT_EQ(scene.objects[0].texture->upper[0].pigment.map[0].color.transmit, 0.9f);
    EXPECT_EQ(scene.objects[1].texture->upper[0].pigment.map[0].color.rgb, Color(0, 1, 0));
}

TEST(ParseTexture, AnObjectsSecondTextureLiesOnTheFirst) {
    const Scene scene = scene_of(R"(
        #declare Ball = sphere { 0, 1 pigment { rgb 1 } }
        object { Ball texture { pigment { rgbt <0, 0, 1, 0.5> } } texture { pigment { rgbt <0, 1, 0, 0.7> } finish { phong 1 } } finish { phong 0.5 } }
        object { Ball pigment { rgb <1, 0, 0> } })");
    const Texture& layered = *scene.objects[0].texture;
    EXPECT_EQ(layered.pigment.map[0].color.rgb, Color(1));
    ASSERT_EQ(layered.upper.size(), 2u);
    EXPECT_EQ(layered.upper[0].pigment.map[0].color.rgb, Color(0, 0, 1));
    EXPECT_EQ(layered.upper[1].finish.phong, 0.5); // the object's own words change the uppermost
    EXPECT_TRUE(scene.objects[1].texture->upper.empty());
    EXPECT_EQ(scene.objects[1].texture->pigment.map[0].color.rgb, Color(1, 0, 0));
}

TEST(ParseTexture, PatternsOfTextures) {
    const Texture squares = texture_of("texture { checker texture { pigment { rgb <1, 0, 0> } } texture { pigment { rgb <0, 1, 0> } } scale 2 }");
    ASSERT_EQ(squares.textures.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<CheckerPattern>(squares.pattern->kind));
    EXPECT_EQ(squares.textures[1].value.pigment.map[0].color.rgb, Color(0, 1, 0));
    expect_near(transform_point(squares.pattern->transform->matrix, Vec3(1)), Vec3(2));
    // tiles { A tile2 B } has B in the cell at the origin, as POV-Ray shows it.
    const Texture tiles = texture_of("texture { tiles { texture { pigment { rgb <1, 0, 0> } } tile2 texture { pigment { rgb <0, 1, 0> } } } }");
    ASSERT_EQ(tiles.textures.size(), 2u);
    EXPECT_EQ(tiles.textures[0].value.pigment.map[0].color.rgb, Color(0, 1, 0));
    const Scene scene = scene_of(R"(
        #declare Map = texture_map { [0.7 pigment { rgb 1 }] [0.2 pigment { rgb 0 } finish { phong 1 }] }
        sphere { 0, 1 texture { gradient x texture_map { Map } } })");
    const Texture& mapped = *scene.objects[0].texture;
    ASSERT_EQ(mapped.textures.size(), 2u);
    EXPECT_EQ(mapped.textures[0].position, 0.2);
    EXPECT_EQ(mapped.textures[0].value.finish.phong, 1);
}

TEST(ParseTexture, InteriorTextureAndMaterial) {
    const Scene scene = scene_of(R"(
        sphere { 0, 1 pigment { rgb 1 } interior_texture { pigment { rgb <1, 0, 0> } } double_illuminate }
        sphere { 0, 1 material { texture { pigment { rgb 1 } } interior_texture { pigment { gradient x } } scale 3 } })");
    EXPECT_EQ(scene.objects[0].interior_texture->pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_TRUE(scene.objects[0].double_illuminate);
    expect_near(transform_point(scene.objects[1].interior_texture->pigment.pattern.transform->matrix, Vec3(1)), Vec3(3));
}

// Of a surface's own coordinates transforms within the block are made, but not those of the object.
TEST(ParseTexture, UvMappingLeavesTheObjectsTransformsOut) {
    const auto expect_scaled = [](const std::string& items) {
        const Pattern pattern = texture_of(items + " scale 7").pigment.pattern;
        EXPECT_TRUE(pattern.uv_mapping) << items;
        expect_near(transform_point(pattern.transform->matrix, Vec3(1)), Vec3(0.1));
    };
    expect_scaled("pigment { uv_mapping checker rgb 0, rgb 1 scale 0.1 }");
    expect_scaled("texture { uv_mapping pigment { checker rgb 0, rgb 1 } scale 0.1 }");
    expect_scaled("uv_mapping pigment { checker rgb 0, rgb 1 scale 0.1 }");
    EXPECT_FALSE(texture_of("pigment { checker rgb 0, rgb 1 }").pigment.pattern.uv_mapping);
}

TEST(ParseNormal, KindsAndTheirAmounts) {
    const auto normal_of = [](const std::string& items) {
        return texture_of("pigment { rgb 1 } normal { " + items + " }").normal.value_or(Normal{});
    };
    EXPECT_EQ(normal_of("bumps").size, 0.5);
    EXPECT_EQ(normal_of("bumps 0.3 scale 2").size, 0.3);
    EXPECT_EQ(normal_of("gradient x, 0.3").size, 0.3);
    const Normal n = normal_of("granite 0.3 bump_size 0.7 accuracy 0.01 no_bump_scale");
    EXPECT_EQ(n.size, 0.7);
    EXPECT_EQ(n.accuracy, 0.01);
    EXPECT_FALSE(n.scale_bumps);
    const Normal slopes = normal_of("gradient x slope_map { [0.5 <1, 0>] [0 <0, 2>] }");
    ASSERT_EQ(slopes.slopes.size(), 2u);
    EXPECT_EQ(slopes.slopes[0].slope, 2);
    EXPECT_EQ(slopes.slopes[1].height, 1);
    const Normal mapped = normal_of("gradient y normal_map { [0.2 bumps 0.4 scale 2] [0.9 ripples 0.6 frequency 3] }");
    ASSERT_EQ(mapped.normals.size(), 2u);
    EXPECT_EQ(mapped.normals[0].value.size, 0.4);
    EXPECT_EQ(mapped.normals[1].value.pattern.frequency, 3);
    EXPECT_EQ(normal_of("checker normal { bumps 1 } normal { dents 2 }").normals[1].value.size, 2);
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 normal { bumpy 1 } }"), "bumps"));
}

TEST(ParseNormal, StandsInTexturesDefaultsAndDeclarations) {
    const Scene scene = scene_of(R"(
        #declare Rough = normal { bumps 0.8 }
        #declare Paint = texture { pigment { rgb 1 } normal { Rough scale 3 } }
        sphere { 0, 1 texture { Paint } scale 2 }
        #default { normal { dents 0.2 } }
        sphere { 0, 1 pigment { rgb 1 } }
        sphere { 0, 1 pigment { rgb 1 } normal { gradient x normal_map { [0 bumps] [1 ripples 0.4] } } })");
    ASSERT_TRUE(scene.objects[0].texture->normal);
    expect_near(transform_point(scene.objects[0].texture->normal->pattern.transform->matrix, Vec3(1)), Vec3(6));
    ASSERT_TRUE(scene.objects[1].texture->normal);
    EXPECT_EQ(scene.objects[1].texture->normal->size, 0.2);
    EXPECT_EQ(scene.objects[2].texture->normal->normals.at(0).value.size, 0.2); // entries of maps start from it too
}

// The shares that POV-Ray's pictures show: with `albedo` the highlight's peak grows with its sharpness.
TEST(ParseFinish, AlbedosBecomePeaks) {
    EXPECT_NEAR(finish_of("diffuse albedo 0.2 brilliance 5").diffuse, 0.6, 1e-12);
    EXPECT_NEAR(finish_of("brilliance 5 diffuse albedo 0.2, 0.1").diffuse_back, 0.3, 1e-12);
    EXPECT_NEAR(finish_of("phong albedo 0.05 phong_size 20").phong, 0.525, 1e-12);
    EXPECT_NEAR(finish_of("specular albedo 0.1 roughness 0.1").specular, 0.1524, 1e-4);
    EXPECT_NEAR(finish_of("specular albedo 0.1 roughness 1").specular, 0.0580, 1e-4);
    EXPECT_EQ(finish_of("specular 0.1 roughness 0.1").specular, 0.1);
}

TEST(ParseFinish, GrainFilmAndBackSide) {
    const Finish f = finish_of("diffuse 0.3, 0.7 crand 0.1 irid { 0.35 thickness 0.5 turbulence 0.2 }");
    EXPECT_EQ(f.diffuse_back, 0.7);
    EXPECT_EQ(f.crand, 0.1);
    EXPECT_EQ(f.irid.amount, 0.35);
    EXPECT_EQ(f.irid.thickness, 0.5);
    EXPECT_EQ(f.irid.turbulence, 0.2);
}

TEST(ParseTexture, EntriesOfTextureMapsTakeWhatTexturesTake) {
    const Scene scene = scene_of(R"(
        #declare Red = pigment { rgb <1, 0, 0> }
        sphere { 0, 1 texture { average texture_map { [pigment { Red } finish { phong 1 } rotate x * 90] [1 pigment { Red }] } } })");
    ASSERT_EQ(scene.objects[0].texture->textures.size(), 2u);
    EXPECT_EQ(scene.objects[0].texture->textures[0].value.pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_EQ(scene.objects[0].texture->textures[0].value.finish.phong, 1);
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
