// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomials and the like as they are said, against POV-Ray.
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

TEST(ParseAlgebraic, IsPovrays) {
    expect_traced("quadric { <1,2,3>,<0.4,-0.3,0.2>,<0.1,-0.2,0.3>,-1 }",
                  {
                      {0, {-0.711829015, 0.134669257, -0.543891191}, {-0.376446, -0.018653, -0.926251}, true},
                      {1, {0.260247866, 0.591112429, -0.358766604}, {0.320789, 0.730591, -0.602769}, true},
                      {2, {0.249838958, -0.628623456, 0.125080521}, {0.113269, -0.94403, 0.309801}, true},
                      {3, {-0.203953172, 0.466007805, -0.556319991}, {0.014021, 0.454425, -0.890675}, true},
                  });
    expect_traced("cubic { <1,0,0.3,0, 0,0,0.2,0,0,-0.5, 0.7,0,0,0.1,0,-0.2,0,1,0,-0.4> }",
                  {
                      {0, {0.814243049, 0.157791561, 0.427245576}, {0.850948, 0.01643, 0.524994}, true},
                      {1, {0.404490389, 0.790832846, -0.536295863}, {0.011419, 0.740952, -0.671461}, true},
                      {2, {0.321098654, 0.974719723, 0.089450673}, {0.011467, 0.992554, 0.121267}, true},
                      {3, {-0.200036874, 0.466660521, -0.583081364}, {-0.172857, 0.200521, -0.964319}, true},
                  });
    expect_traced("quartic { <1,0,0,0.2,2,0,0,2,0,-2.32, 0,0,0.1,0,0,0,0,0,0,0, 1,0,0,2,0,1.68, 0,0,0.3,0, "
                  "1,0,-2.32,0,0.7056> }",
                  {
                      {0, {-1.18368524, 0.127519921, -0.844163337}, {-0.734653, 0.241237, -0.634105}, false},
                  });
    expect_traced("poly { 5, <1,0,0,0.2,2,0,0,2,0,-2.32, 0,0,0.1,0,0,0,0,0,0,0, 1,0,0,2,0,1.68, 0,0,0.3,0, "
                  "1,0,-2.32,0,0.7056, 0.5,0,0.3,0,0,0,0,0,0,0.1,1,0,0,0,1,0.2,0,0,-0.3,0,-1> }",
                  {
                      {0, {1.24629804, 0.164337849, 0.702189663}, {0.825273, 0.43446, 0.360789}, true},
                      {1, {0.272378853, 0.607909181, -0.37369705}, {0.337036, 0.931062, 0.13975}, true},
                      {2, {0.302503572, 0.556330367, 0.098748214}, {0.362839, 0.931118, -0.036977}, true},
                      {3, {-0.00162993, 0.499728345, -1.93886214}, {0.465974, 0.883736, 0.043349}, true},
                  });
    expect_traced("polynomial { 3, xyz(2,1,0): 1.5, xyz(0,0,3): -2, xyz(1,1,1): 0.7, xyz(1,0,0): 0.4, "
                  "xyz(0,0,0): -0.2 }",
                  {
                      {0, {-0.733178979, 0.134345773, -0.557477532}, {0.023441, 0.491756, -0.870417}, true},
                      {1, {0.248599442, 0.574983842, -0.344430082}, {0.74789, 0.035504, -0.662872}, true},
                      {2, {0.300911029, 0.520498152, 0.099544486}, {0.983895, 0.170243, 0.054488}, true},
                      {3, {-0.215213392, 0.464131101, -0.479375152}, {-0.038036, 0.09727, -0.994531}, true},
                  });
    expect_traced("superellipsoid { <0.3, 1.6> }",
                  {
                      {0, {-0.645047842, 0.135681093, -0.501394081}, {-0.728998, 0.000106, -0.684516}, true},
                      {1, {0.33345331, 0.692473814, -0.448865613}, {0.011806, 0.742186, -0.67009}, true},
                      {2, {0.236183681, -0.93586718, 0.13190816}, {0.000349, -0.85265, 0.522482}, true},
                      {3, {-0.186585839, 0.46890236, -0.674996767}, {-0.003636, 0.673585, -0.739101}, true},
                  });
}

TEST(ParseShapes, WithoutSizeAreTakenAsInPovray) {
    for (const std::string text :
         {"sphere { 0, 0 pigment { rgb 1 } }", "cone { 0, 0, y, 0 pigment { rgb 1 } }",
          "torus { 1, 0 pigment { rgb 1 } }", "disc { 0, y, 1, 2 pigment { rgb 1 } }"}) {
        EXPECT_TRUE(says(diagnostics_of(text), "nothing is seen of it")) << text;
        const auto probe = make_probe(scene_of(text).objects.at(0));
        EXPECT_FALSE(trace(*probe, {0.3, 5, 0.2}, {0, -1, 0}));
        EXPECT_FALSE(trace(*probe, {-5, 0.1, 0.2}, {1, 0, 0}));
    }
    const Bounds disc = object_bounds(scene_of("disc { 0, y, 1 pigment { rgb 1 } }").objects.at(0));
    EXPECT_NEAR(disc.high.x, 1, 1e-3); // POV-Ray: 1.000, 0.001, 1.000
    EXPECT_NEAR(disc.high.y, 0, 2e-3);
}

TEST(ParseAlgebraic, SaysWhatIsWrong) {
    EXPECT_TRUE(says(diagnostics_of("cubic { <1, 2, 3> }"), "has 20 coefficients, here are 3"));
    EXPECT_TRUE(says(diagnostics_of("poly { 16, <1> }"), "order"));
    EXPECT_TRUE(says(diagnostics_of("polynomial { 3, xyz(2, 2, 0): 1 }"), "add up to more"));
    EXPECT_TRUE(says(diagnostics_of("superellipsoid { <0, 1> }"), "greater than 0"));
    EXPECT_TRUE(says(diagnostics_of("ovus { 1, 3 pigment { rgb 1 } }"), "this ovus is a sphere"));
    EXPECT_TRUE(says(diagnostics_of("ovus { -1, 3 }"), "greater than 0"));
    EXPECT_FALSE(says(diagnostics_of("quartic { <" + std::string("1,") +
                                     "0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,0, "
                                     "1,0,0,0,0,0,0,0,0,0, 1,0,0,0,-1> sturm pigment { rgb 1 } }"),
                      "error"));
}

} // namespace
} // namespace pnr
