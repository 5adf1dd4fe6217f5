// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of the scene's own, and that each gives what the same expression gives.
#include "evaluate.h"

#include <gtest/gtest.h>

namespace pnr::test {
namespace {

std::string value(const std::string& function, const std::string& call) {
    return run("#declare f = " + function + "; #debug str(" + call + ", 0, 4)");
}

TEST(Function, Values) {
    EXPECT_EQ(value("function { x * x + y - z / 2 }", "f(3, 4, 2)"), "12.0000");
    EXPECT_EQ(value("function { u + v }", "f(1, 2, 0)"), "3.0000");
    EXPECT_EQ(value("function (a, b) { atan2(a, b) + pow(a, 2) }", "f(2, 1)"), "5.1071");
    EXPECT_EQ(value("function (x) { -x^2 }", "f(3)"), "-9.0000");
    EXPECT_EQ(value("function (x) { 2 - 3 - x * 2 / 4 }", "f(2)"), "-2.0000");
    EXPECT_EQ(value("function (x) { min(x, 2, 1) + max(x, 7) }", "f(3)"), "8.0000");
    EXPECT_EQ(value("function (x) { select(x, 1, 2, 3) + select(x, 10, 20) }", "f(-1)"), "11.0000");
    EXPECT_EQ(value("function (x) { select(x, 1, 2, 3) + select(x, 10, 20) }", "f(0)"), "22.0000");
    EXPECT_EQ(value("function (x) { select(x, 1, 2, 3) + select(x, 10, 20) }", "f(1)"), "23.0000");
    EXPECT_EQ(value("function (x) { (x > 1) & (x < 3) | !x }", "f(2)"), "1.0000");
    EXPECT_EQ(value("function { x + y + z }", "f(<1, 2, 3>)"), "6.0000"); // a vector is its components
    EXPECT_EQ(
        run("#declare K = 3; #declare f = function (x) { K * x } #declare K = 0; #debug str(f(2), 0, 0)"),
        "6");
    EXPECT_EQ(run("#declare f = function (x) { x + 1 } #declare g = function (x) { f(f(x)) * 2 } #debug "
                  "str(g(1) + 1, 0, 0)"),
              "7");
    EXPECT_EQ(run("#declare f = function (x) { sin(radians(x)) } #declare g = f; #debug str(g(30), 0, 2)"),
              "0.50");
}

TEST(Function, ComparesExactly) { // unlike expressions, as POV-Ray's do
    EXPECT_EQ(value("function (x) { (x = 3) * 10 + (x != 3) }", "f(3 + 1e-12)"), "1.0000");
    EXPECT_EQ(value("function (x) { x & 2 }", "f(1e-12)"), "1.0000");
    EXPECT_EQ(value("function (x) { div(x, 2) * 10 + mod(x, 2) }", "f(-7)"), "-31.0000");
}

TEST(Function, Series) {
    EXPECT_EQ(value("function (x) { sum(i, 1, 4, i * x) }", "f(2)"), "20.0000");
    EXPECT_EQ(value("function (x) { prod(i, 1, 4, i * x) }", "f(2)"), "384.0000");
    EXPECT_EQ(value("function (x, y) { sum(i, 1, 3, prod(j, 1, i, j * x + y)) }", "f(2, 1)"), "123.0000");
    EXPECT_EQ(value("function { sum(i, 1, 2, u + v * i) }", "f(1, 2, 0)"), "8.0000");
}

TEST(Function, GivesVectors) {
    const std::string move = "#declare f = function { transform { translate 2 * x scale 3 } } ";
    EXPECT_EQ(run(move + "#debug vstr(3, f(1, 2, 3), \" \", 0, 1)"), "9.0 6.0 9.0");
    EXPECT_EQ(run(move + "#declare g = function (a, b) { f(a, b, 1).y * 2 } #debug str(g(1, 2), 0, 1)"),
              "12.0");
    const std::string pigment = "#declare f = function { pigment { gradient x color_map { [0 rgb 0] [1 rgbft "
                                "<1, 0.5, 0.25, 0.2, 0.1>] } } } ";
    EXPECT_EQ(run(pigment + "#debug vstr(5, f(0.5, 0, 0), \" \", 0, 4)"),
              "0.5000 0.2500 0.1250 0.1000 0.0500");
    EXPECT_EQ(run(pigment + "#declare g = function { f(x, 0, 0).gray } #debug str(g(0.25, 0, 0), 0, 4)"),
              "0.1550");
    EXPECT_EQ(run(pigment + "#debug str(f(0.25, 0, 0).gray, 0, 4)"), "0.1550");
    EXPECT_EQ(first_error(move + "#declare g = function { f(x, y, z) }"),
              "test.pnr:1:89: error: `f` gives a vector; take one component with .x, .y, .z, .red ...");
}

TEST(Function, Internal) {
    EXPECT_EQ(value("function { internal(61) }", "f(1, 2, 2, 1)"), "2.0000");
    EXPECT_EQ(
        run("#declare S = function { internal(61) } #declare f = function { S(x, y, z, 1) * 2 + 1 } #debug "
            "str(f(0, 3, 4), 0, 2)"),
        "9.00");
    EXPECT_EQ(value("function { internal(76) }", "f(0.3, 0.4, 0.5)"), "0.4759"); // printed by POV-Ray
    EXPECT_EQ(first_error("#declare f = function { internal(77) }"),
              "test.pnr:1:34: error: there is no internal function 77");
    EXPECT_EQ(first_error("#declare f = function { internal(61) } #declare A = f(1, 2, 3);"),
              "test.pnr:1:53: error: `f` takes 4 arguments, 3 are given");
}

TEST(Function, InArraysAndMacros) {
    EXPECT_EQ(run("#declare A = array[2]; #declare A[0] = function (x) { x + 1 } #debug str(A[0](3), 0, 0)"),
              "4");
    EXPECT_EQ(run("#macro M(F) #local g = function (x) { F(x) * 2 } g(3) #end #declare f = function (x) { x "
                  "+ 1 } #debug "
                  "str(M(f), 0, 0)"),
              "8");
    EXPECT_EQ(run("#macro M(A) function (x) { x * A } #end #declare f = M(3) #debug str(f(2), 0, 0)"), "6");
}

TEST(Function, Errors) {
    EXPECT_EQ(first_error("#declare f = function (x) { x } #declare A = f(1, 2);"),
              "test.pnr:1:46: error: `f` takes 1 arguments, 2 are given");
    EXPECT_EQ(first_error("#declare f = function (x) { 1 / x } #declare A = f(0);"),
              "test.pnr:1:50: error: `f` has no finite value here");
    EXPECT_EQ(first_error("#declare f = function (x) { x + Foo }"),
              "test.pnr:1:33: error: `Foo` is not declared");
    std::string doubling = "#declare f = function (x) { x + 1 }";
    for (int i = 0; i < 60; ++i) doubling += "#declare f = function (x) { f(x) + f(x) }";
    EXPECT_NE(first_error(doubling), "");
}

} // namespace
} // namespace pnr::test
