// SPDX-License-Identifier: GPL-3.0-or-later
// Splines give what POV-Ray 3.7 prints for them.
#include "evaluate.h"

#include <gtest/gtest.h>

namespace pnr::test {
namespace {

const std::string knots = " -0.25, <3, 1> 0, <1, 1> 0.4, <2, 1> 1, <-1, 1> 1.3, <4, 1> 2, <0, 1> ";

// The first component at -1, 0.2, 0.5, 1.2, 1.6 and 2.5.
std::string values(const std::string& points) {
    return run(
        "#declare S = spline { " + points +
        " } #for (I, 0, 5) #declare A = array[6] {-1, 0.2, 0.5, 1.2, 1.6, 2.5} #debug concat(str(S(A[I]).x, "
        "0, 5), \" \") #end");
}

TEST(Spline, KindsGiveWhatPovRayPrints) {
    EXPECT_EQ(values("linear_spline" + knots), "3.00000 1.50000 1.50000 2.33333 2.28571 0.00000 ");
    EXPECT_EQ(values("quadratic_spline" + knots), "3.00000 0.85385 1.87500 1.85185 4.97143 0.00000 ");
    EXPECT_EQ(values("cubic_spline" + knots), "1.00000 1.42500 1.60995 2.58995 4.00000 4.00000 ");
    EXPECT_EQ(values("natural_spline" + knots), "3.00000 1.49457 1.49566 2.31196 4.91079 0.00000 ");
    EXPECT_EQ(values(knots), values("linear_spline" + knots));
}

TEST(Spline, OfFewPoints) {
    EXPECT_EQ(values("cubic_spline 1, <3, 0>"), "3.00000 3.00000 3.00000 3.00000 3.00000 3.00000 ");
    EXPECT_EQ(values("cubic_spline 0, <3, 0> 1, <1, 0>"), "2.00000 2.00000 2.00000 2.00000 2.00000 2.00000 ");
    EXPECT_EQ(values("natural_spline 0, <3, 0> 2, <1, 0>"),
              "3.00000 2.80000 2.50000 1.80000 1.40000 1.00000 ");
    EXPECT_EQ(values("quadratic_spline 0, <0, 0> 1, <1, 0> 2, <4, 0>"),
              "0.00000 0.04000 0.25000 1.44000 2.56000 4.00000 ");
}

TEST(Spline, PointsComeInAnyOrderAndReplaceEachOther) {
    EXPECT_EQ(run("#declare S = spline { 2, <1, 2, 3>, 1, <3, 4, 5>, 0, <1, 1, 1>, 1, <5, 5, 5> } #debug "
                  "vstr(3, S(0.5), "
                  "\" \", 0, 2)"),
              "3.00 3.00 3.00");
}

TEST(Spline, IsAValue) {
    const std::string line = "#declare S = spline { 0, <1, 2, 3> 1, <3, 4, 5> } ";
    EXPECT_EQ(run(line + "#declare T = S; #debug vstr(3, T(0.5), \" \", 0, 1)"), "2.0 3.0 4.0");
    EXPECT_EQ(run(line + "#declare T = spline { S 2, <5, 6, 7> } #debug str(T(2).y + S(2).y, 0, 0)"), "10");
    EXPECT_EQ(run(line + "#declare A = array[2]; #declare A[0] = S; #debug str(A[0](0.5).x, 0, 1)"), "2.0");
    EXPECT_EQ(run(line + "#macro M(P) #debug str(P(0.5).z * 2, 0, 1) #end M(S)"), "8.0");
    EXPECT_EQ(run(line +
                  "#declare f = function { spline { S } } #declare g = function (a) { f(a).y + 1 } #debug "
                  "str(g(0.25) + f(0.5).x, 0, 2)"),
              "5.50");
    EXPECT_EQ(
        run("#declare S = spline { cubic_spline 0, <0, 0> 1, <2, 0> 2, <0, 0> 3, <1, 0> } #debug str(S(1.5, "
            "linear_spline).x, 0, 2)"),
        "1.00");
    EXPECT_EQ(run("#declare S = spline { 0, 1 1, 5 } #debug vstr(2, S(0.5), \" \", 0, 1)"), "3.0 3.0");
}

TEST(Spline, Errors) {
    EXPECT_EQ(first_error("#declare S = spline { linear_spline }"),
              "test.pnr:1:21: error: a spline needs at least one point");
    EXPECT_EQ(first_error("#declare S = spline { 0, <1, 2> } #declare A = S(0.5, 3);"),
              "test.pnr:1:55: error: expected linear_spline, quadratic_spline, cubic_spline or "
              "natural_spline behind "
              "the comma");
}

} // namespace
} // namespace pnr::test
