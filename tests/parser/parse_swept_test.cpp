// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes made of curves as they are said, against POV-Ray.
#include <gtest/gtest.h>

#include "core/probe.h"
#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

// A ray that POV-Ray 3.7 traced to the object, where it met it with which normal, and whether its aim is
// inside().
struct Traced {
    int ray;
    Vec3 hit, normal;
    bool inside;
};
constexpr Vec3 origins[] = {{-3, 0.1, -2}, {2, 3, -2.5}, {0.1, -4, 0.2}, {0.3, 0.55, -4}};
constexpr Vec3 aims[] = {{0.3, 0.15, 0.1}, {0.05, 0.3, -0.1}, {0.3, 0.5, 0.1}, {-0.3, 0.45, 0.1}};

void expect_traced(const std::string& text, const std::vector<Traced>& rows) {
    SCOPED_TRACE(text);
    const Scene scene = scene_of("object { " + text + " pigment { rgb 1 } }", "test.pov");
    ASSERT_EQ(scene.objects.size(), 1u);
    const auto probe = make_probe(scene.objects[0]);
    for (const Traced& row : rows) {
        const auto hit = trace(*probe, origins[row.ray], aims[row.ray] - origins[row.ray]);
        ASSERT_TRUE(hit);
        expect_near(hit->position, row.hit, 1e-6);
        expect_near(hit->normal, row.normal, 1e-5);
        EXPECT_EQ(is_inside(*probe, aims[row.ray]), row.inside) << row.ray;
    }
}

TEST(ParseSwept, IsPovrays) {
    expect_traced(
        "lathe { quadratic_spline 6, <-0.5,-1.2>, <0,-1>, <0.8,-0.5>, <0.4,0.1>, <0.6,0.5>, <0,1> }",
        {
            {0, {-0.28463738, 0.141141858, -0.272041969}, {-0.719114, 0.102485, -0.687293}, true},
            {1, {0.297096282, 0.642133314, -0.404118501}, {0.434881, 0.678942, -0.591537}, true},
            {3, {-0.211506595, 0.464748901, -0.504704937}, {-0.231259, -0.801245, -0.551839}, true},
        });
    expect_traced("lathe { bezier_spline 8 "
                  "<0,-1>,<1.4,-1>,<0.2,0>,<0.6,0.2>,<0.6,0.2>,<1,0.4>,<0.7,0.9>,<0,0.8> sturm }",
                  {
                      {0, {-0.404276473, 0.139329144, -0.348175937}, {-0.661327, -0.488111, -0.569556}, true},
                      {1, {0.350851892, 0.716564158, -0.470279252}, {0.299191, 0.865828, -0.401033}, true},
                      {2, {0.234027412, -0.984383232, 0.132986294}, {0.114299, -0.991321, 0.06495}, true},
                      {3, {-0.174524031, 0.470912662, -0.757419124}, {-0.222663, 0.128885, -0.966338}, true},
                  });
    expect_traced(
        "sor { 6, <0,-1.5>,<0.5,-1>,<0.8,-0.4>,<0.3,0.3>,<0.5,0.9>,<0.7,1.3> open }",
        {
            {0, {-0.299120238, 0.140922421, -0.281258333}, {-0.525593, 0.692468, -0.494207}, true},
            {1, {0.176184881, 0.474717527, -0.255304469}, {0.543901, -0.288077, -0.788152}, true},
            {2, {0.289990114, 0.274777556, 0.105004943}, {0.863393, 0.395997, 0.312633}, true},
            {3, {-0.262684642, 0.456219226, -0.154988279}, {-0.833497, -0.251869, -0.491777}, false},
        });
    expect_traced("prism { conic_sweep cubic_spline 0.2, 1.1, 9 "
                  "<1,-1>,<-0.8,-0.7>,<0,-0.3>,<0.8,-0.7>,<0.7,0.6>,<0,0.8>,<-0.7,0.5>,<-0.8,-0.7>,<0,-1> }",
                  {
                      {1, {0.068391577, 0.32546526, -0.122635787}, {-0.510375, -0.207234, -0.834608}, true},
                      {2, {0.29422558, 0.370075551, 0.10288721}, {0.754976, -0.639981, 0.142955}, true},
                      {3, {-0.254976404, 0.457503933, -0.207661242}, {0.404869, -0.181165, -0.896248}, true},
                  });
    expect_traced("prism { quadratic_spline -0.7, 0.9, 6 "
                  "<1,-1>,<-0.8,-0.7>,<0.7,-0.7>,<0.6,0.6>,<-0.7,0.5>,<-0.8,-0.7> }",
                  {
                      {0, {-0.823259376, 0.132980919, -0.614801421}, {-0.96785, 0, -0.251527}, true},
                      {1, {0.483333333, 0.9, -0.633333333}, {0, 1, 0}, true},
                      {3, {-0.187878842, 0.46868686, -0.666161248}, {-0.023247, 0, -0.99973}, true},
                  });
    expect_traced(
        "sphere_sweep { b_spline 5 <-1,-0.5,0>,0.1 <-0.8,0,0>,0.3 <0,0.9,-0.5>,0.2 <0.7,-0.9,0>,0.4 "
        "<0.9,0.9,0.5>,0.3 tolerance 1e-8 }",
        {
            {0, {-0.426667033, 0.138989893, -0.362424476}, {0.312831, -0.639878, -0.701921}, false},
            {1, {0.244920337, 0.569889698, -0.339901954}, {0.653951, 0.754588, -0.054267}, true},
            {2, {0.264898692, -0.28977944, 0.117550654}, {-0.805565, -0.096193, 0.584647}, false},
            {3, {-0.203819444, 0.466030093, -0.557233798}, {-0.209499, -0.098826, -0.972802}, false},
        });
    expect_traced("sphere_sweep { cubic_spline 5 <-1,-0.5,0>,0.1 <-0.8,0,0>,0.3 <0,0.9,-0.5>,0.2 "
                  "<0.7,-0.9,0>,0.4 <0.9,0.9,0.5>,0.3 tolerance 1e-8 }",
                  {
                      {1, {0.36494946, 0.736083868, -0.487630105}, {0.887922, 0.444058, -0.120026}, false},
                      {3, {-0.233129103, 0.461145149, -0.356951126}, {0.777506, -0.557947, -0.290137}, false},
                  });
    expect_traced("sphere_sweep { linear_spline 3 <-0.8,0,0>,0.3 <0,0.9,-0.5>,0.2 <0.7,-0.9,0>,0.4 }",
                  {
                      {1, {0.330792842, 0.688790089, -0.445591191}, {0.896383, 0.422088, -0.135418}, false},
                  });
}

TEST(ParseSwept, SaysWhatIsWrong) {
    EXPECT_TRUE(says(diagnostics_of("lathe { linear_spline 3, <1, 0>, <1, 1> }"), "says 3 but there are 2"));
    EXPECT_TRUE(
        says(diagnostics_of("lathe { cubic_spline 3, <1, 0>, <1, 1>, <1, 2> }"), "at least 4 points"));
    EXPECT_TRUE(says(diagnostics_of("lathe { bezier_spline 6, 0, 0, 0, 0, 0, 0 }"), "four points"));
    EXPECT_TRUE(says(diagnostics_of("sor { 4, <1, 0>, <1, 1>, <1, 0.5>, <1, 3> }"), "must grow"));
    EXPECT_TRUE(says(diagnostics_of("prism { 0, 1, 3, <0, 0>, <1, 0>, <1, 1> pigment { rgb 1 } }"),
                     "closed by a straight line"));
    EXPECT_TRUE(says(diagnostics_of("sphere_sweep { 3, <0, 0, 0>, 1 }"), "in sphere_sweep"));
    EXPECT_TRUE(says(diagnostics_of("sphere_sweep { b_spline 2, <0, 0, 0>, 1, <1, 0, 0>, 1 }"),
                     "at least 4 spheres"));
    EXPECT_TRUE(says(diagnostics_of("polygon { 3, <0, 0>, <1, 1>, <2, 2> }"), "one line"));
}

TEST(ParseSwept, OpenShapesHaveNoLids) {
    const Scene scene = scene_of("prism { 0, 1, 4, <0, 0>, <1, 0>, <1, 1>, <0, 0> open pigment { rgb 1 } }"
                                 "sor { 4, <1, 0>, <1, 1>, <1, 2>, <1, 3> pigment { rgb 1 } }");
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_TRUE(std::get<Prism>(*scene.objects[0].shape).open);
    EXPECT_FALSE(std::get<Sor>(*scene.objects[1].shape).open);
}

TEST(ParseSwept, TextNeedsItsFont) {
    EXPECT_TRUE(says(diagnostics_of("text { ttf \"no_such_font.ttf\", \"A\", 1, 0 }"),
                     "there is no file \"no_such_font.ttf\""));
    EXPECT_TRUE(says(diagnostics_of("text { \"timrom.ttf\" }"), "`ttf`"));
}

// Extents along x that POV-Ray 3.7 prints, less the thousandths of a per cent that it adds.
TEST(ParseSwept, TextIsSetAsInPovray) {
    if (says(diagnostics_of("text { ttf \"timrom.ttf\", \"A\", 1, 0 pigment { rgb 1 } }"),
             "there is no file"))
        GTEST_SKIP() << "skipped: no timrom.ttf";
    const auto width = [](const std::string& font, const std::string& text, const std::string& offset) {
        const Scene scene =
            scene_of("text { ttf \"" + font + "\" \"" + text + "\" 0.5, " + offset + " pigment { rgb 1 } }");
        const Bounds box = object_bounds(scene.objects.at(0));
        EXPECT_NEAR(box.low.z, 0, 1e-12);
        EXPECT_NEAR(box.high.z, 0.5, 1e-12);
        return box.high.x;
    };
    EXPECT_NEAR(width("timrom.ttf", "A", "0"), 0.736, 1e-4);
    EXPECT_NEAR(width("timrom.ttf", "AV", "0"), 1.278, 1e-4) << "with kerning";
    EXPECT_NEAR(width("timrom.ttf", "AVAT", "0"), 2.384, 1e-4);
    EXPECT_NEAR(width("timrom.ttf", "A A", "0"), 1.74, 1e-4);
    EXPECT_NEAR(width("timrom.ttf", "AA", "<0.1, 0.2>"), 1.586, 1e-4);
    EXPECT_NEAR(width("cyrvetic", "Hel", "<0, 0, 0>"), 1.329, 1e-4) << "without the ending of its name";
    EXPECT_NEAR(width("cyrvetic.ttf", "llll", "0"), 0.78, 1e-4);
    EXPECT_NEAR(width("crystal.ttf", "Hello World", "0"), 5.561, 1e-4);
    EXPECT_NEAR(width("povlogo.ttf", "P", "0"), 0.66992, 1e-4);
}

TEST(ParseSwept, LettersHaveTheirHoles) {
    if (says(diagnostics_of("text { ttf \"timrom.ttf\", \"A\", 1, 0 pigment { rgb 1 } }"),
             "there is no file"))
        GTEST_SKIP() << "skipped: no timrom.ttf";
    const Scene scene = scene_of("text { internal 1, \"O\", 1, 0 pigment { rgb 1 } }");
    const auto probe = make_probe(scene.objects.at(0));
    const Bounds box = object_bounds(scene.objects[0]);
    const Vec3 middle = 0.5 * (box.low + box.high);
    EXPECT_FALSE(is_inside(*probe, middle));
    EXPECT_TRUE(is_inside(*probe, {box.low.x + 0.05, middle.y, 0.5}));
    EXPECT_FALSE(is_inside(*probe, {box.low.x + 0.05, middle.y, 1.5}));
    EXPECT_FALSE(trace(*probe, middle - Vec3(0, 0, 5), {0, 0, 1}));
    const auto hit = trace(*probe, {box.low.x + 0.05, middle.y, -5}, {0, 0, 1});
    ASSERT_TRUE(hit);
    expect_near(hit->normal, {0, 0, -1}, 1e-9);
    EXPECT_NEAR(hit->position.z, 0, 1e-9);
}

} // namespace
} // namespace pnr
