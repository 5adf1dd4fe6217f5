// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of solids, clips and bounds as they are said, and what a scene may ask of an object. Values of
// inside, trace and the extents are those that POV-Ray 3.7 prints for the same objects.
#include <gtest/gtest.h>

#include "core/world.h"
#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

Object object_of(const std::string& text) {
    const Scene scene = scene_of(text);
    EXPECT_EQ(scene.objects.size(), 1u);
    return scene.objects.empty() ? Object{} : scene.objects.front();
}

TEST(ParseCsg, GroupsSayHowTheyCombine) {
    const std::string parts = " { sphere { 0, 1 } box { 0, 1 } pigment { rgb 1 } }";
    EXPECT_EQ(object_of("union" + parts).combination, Combination::unite);
    EXPECT_EQ(object_of("merge" + parts).combination, Combination::merge);
    EXPECT_EQ(object_of("intersection" + parts).combination, Combination::intersect);
    const Object cut = object_of("difference" + parts);
    EXPECT_EQ(cut.combination, Combination::differ);
    EXPECT_EQ(cut.children.size(), 2u);
    EXPECT_EQ(diagnostics_of("difference" + parts + " camera { location -5*z } light_source { y, rgb 1 }"), "");
}

TEST(ParseCsg, ClipsMoveWithTheirObject) {
    const Object object =
        object_of("sphere { 0, 1 pigment { rgb 1 } clipped_by { plane { y, 0 } box { -1, 1 } translate x }"
                  " bounded_by { clipped_by } translate 2*y scale 3 }");
    ASSERT_EQ(object.clips.size(), 2u);
    ASSERT_EQ(object.bounds.size(), 2u);
    for (const Object& part : {object.clips[0], object.clips[1], object.bounds[1]})
        expect_near(transform_point(part.transform->matrix, Vec3(0)), {3, 6, 0});
    expect_near(transform_point(object.transform->matrix, Vec3(0)), {0, 6, 0});
    EXPECT_EQ(
        object_of("sphere { 0, 1 pigment { rgb 1 } bounded_by { box { -1, 1 } } clipped_by { bounded_by } }")
            .clips.size(),
        1u);
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 clipped_by { 3 } }"), "clipped_by"));
}

TEST(ParseCsg, BoundsEndWhatIsEndless) {
    const Scene scene =
        scene_of("plane { y, 0 pigment { rgb 1 } bounded_by { box { <-1, -1, -1>, <3, 1, 1> } } }");
    const World world = build_world(scene, {});
    EXPECT_NEAR(world.offset.x, 1, 1e-9);
    EXPECT_NEAR(world.radius, std::sqrt(5.0), 1e-9);
    EXPECT_TRUE(closest_hit(world, {{0.5, 1, 0.5}, {0, -1, 0}}, RayKind::camera));
}

// #declare o = TEXT; then an expression of it, as a number or a vector.
Vec3 value_of(const std::string& object, const std::string& expression) {
    const Scene scene =
        scene_of("#declare O = " + object + "\n#declare N = <9, 9, 9>;\n#declare V = " + expression +
                 ";\nsphere { V, 1 pigment { rgb 1 } }");
    return std::get<Sphere>(*scene.objects.at(0).shape).center;
}

TEST(ObjectFunctions, Inside) {
    const auto inside = [](const std::string& object, const std::string& point) {
        return value_of(object, "x * inside(O, " + point + ")").x;
    };
    EXPECT_EQ(inside("sphere { 0, 1 }", "<0.5, 0, 0>"), 1);
    EXPECT_EQ(inside("sphere { 0, 1 }", "<1.5, 0, 0>"), 0);
    EXPECT_EQ(inside("sphere { 0, 1 inverse }", "<0.5, 0, 0>"), 0);
    EXPECT_EQ(inside("sphere { 0, 1 clipped_by { plane { y, 0 } } }", "<0, 0.5, 0>"), 0);
    EXPECT_EQ(inside("sphere { 0, 1 clipped_by { plane { y, 0 } } }", "<0, -0.5, 0>"), 1);
    const std::string cut = "difference { box { -1, 1 } sphere { <1, 0, 0>, 0.5 } }";
    EXPECT_EQ(inside(cut, "<0.9, 0, 0>"), 0);
    EXPECT_EQ(inside(cut, "0"), 1);
    EXPECT_EQ(inside("union { sphere { 0, 1 } box { 2, 3 } }", "2.5"), 1);
    EXPECT_EQ(inside("plane { y, 1 }", "0"), 1);
    EXPECT_TRUE(
        says(diagnostics_of("#declare V = inside(3, x); sphere { 0, 1 }"), "inside needs a declared object"));
}

TEST(ObjectFunctions, Trace) {
    const auto expect_trace = [](const std::string& object, const std::string& ray, Vec3 place, Vec3 normal) {
        expect_near(value_of(object, "trace(O, " + ray + ")"), place, 1e-6);
        expect_near(value_of(object, "0 * trace(O, " + ray + ", N) + N"), normal, 1e-6);
    };
    expect_trace("sphere { 0, 1 }", "<-3, 0, 0>, x", {-1, 0, 0}, {-1, 0, 0});
    expect_trace("sphere { 0, 1 }", "<-3, 0, 0>, 2*x", {-1, 0, 0}, {-1, 0, 0});
    expect_trace("sphere { 0, 1 }", "0, x", {1, 0, 0}, {1, 0, 0});
    expect_trace("sphere { 0, 1 }", "<-3, 3, 0>, x", {0, 0, 0}, {0, 0, 0});
    expect_trace("sphere { 0, 1 }", "<-3, 0, 0>, 0", {0, 0, 0}, {0, 0, 0});
    expect_trace("difference { box { -1, 1 } sphere { <1, 0, 0>, 0.5 } }", "<3, 0.1, 0>, -x",
                 {0.510102, 0.1, 0}, {0.979796, -0.2, 0});
    expect_trace("sphere { 0, 1 inverse }", "<-3, 0, 0>, x", {-1, 0, 0}, {1, 0, 0});
    expect_trace("plane { y, 1 }", "<0, -5, 0>, y", {0, 1, 0}, {0, 1, 0});
    expect_trace("sphere { <1, 2, 3>, 1 scale <1, 2, 1> rotate 30*z }", "<-5, 3, 3>, x", {-1.686048, 3, 3},
                 {-0.784996, -0.619501, 0});
    expect_trace("mesh { triangle { <0, 0, 0>, <1, 0, 0>, <0, 1, 0> } }", "<0.2, 0.2, -1>, z", {0.2, 0.2, 0},
                 {0, 0, -1});
    EXPECT_TRUE(
        says(diagnostics_of("#declare O = sphere { 0, 1 } #declare V = trace(O, x, y, M); sphere { 0, 1 }"),
             "trace needs a declared vector"));
}

TEST(ObjectFunctions, Extents) {
    const auto expect_extent = [](const std::string& object, Vec3 low, Vec3 high) {
        expect_near(value_of(object, "min_extent(O)"), low, 1e-6);
        expect_near(value_of(object, "max_extent(O)"), high, 1e-6);
    };
    expect_extent("sphere { <1, 2, 3>, 1 scale <1, 2, 1> rotate 30*z }", {-3, 1.732051, 2},
                  {0.732051, 6.196153, 4});
    expect_extent("difference { box { -1, 1 } sphere { <1, 0, 0>, 0.5 } }", Vec3(-1), Vec3(1));
    expect_extent("intersection { sphere { 0, 1 } plane { y, 0.5 } }", Vec3(-1), {1, 0.5, 1});
    expect_extent("intersection { plane { x, 1 } plane { -x, 1 } plane { y, 1 } plane { -y, 1 } plane { z, 1 "
                  "} plane { -z, 1 } }",
                  Vec3(-1), Vec3(1));
    expect_extent("union { sphere { 0, 1 } box { 2, 3 } }", Vec3(-1), Vec3(3));
    expect_extent("sphere { 0, 1 clipped_by { plane { y, 0 } } }", Vec3(-1), Vec3(1));
    expect_extent("box { -1, 1 rotate 45*y }", {-1.414214, -1, -1.414214}, {1.414214, 1, 1.414214});
    expect_near(value_of("plane { y, 1 }", "min_extent(O) / 1e10"), Vec3(-1));
}

} // namespace
} // namespace pnr
