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

TEST(Function, Errors) {
    EXPECT_EQ(first_error("#declare f = function (x) { x } #declare A = f(1, 2);"),
              "test.pnr:1:46: error: `f` takes 1 arguments, 2 are given");
    EXPECT_EQ(first_error("#declare f = function (x) { 1 / x } #declare A = f(0);"),
              "test.pnr:1:50: error: `f` has no finite value here");
    EXPECT_EQ(first_error("#declare f = function { internal(4) } #declare A = f(0, 0, 0);"),
              "test.pnr:1:52: error: internal functions cannot be evaluated here");
    EXPECT_EQ(first_error("#declare f = function (x) { x + Foo }"),
              "test.pnr:1:33: error: `Foo` is not declared");
    std::string doubling = "#declare f = function (x) { x + 1 }";
    for (int i = 0; i < 60; ++i) doubling += "#declare f = function (x) { f(x) + f(x) }";
    EXPECT_NE(first_error(doubling), "");
}

} // namespace
} // namespace pnr::test
