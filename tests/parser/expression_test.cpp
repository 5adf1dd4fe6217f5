// SPDX-License-Identifier: GPL-3.0-or-later
// Values of expressions. The numbers are arithmetic's, or what POV-Ray 3.7 prints for the same text.
#include "evaluate.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace pnr::test {
namespace {

struct Row {
    const char* expression;
    const char* printed;
};

std::string number(const std::string& expression) { return run("#debug str((" + expression + "), 0, 6)"); }
std::string vector(int size, const std::string& expression) {
    return run(fmt::format("#declare V = {}; #debug vstr({}, V, \" \", 0, 4)", expression, size));
}
std::string text(const std::string& expression) { return run("#debug " + expression); }

TEST(Expression, Numbers) {
    const Row rows[] = {
        {"1", "1.000000"},
        {".5e-1", "0.050000"},
        {"1.", "1.000000"},
        {"1e3", "1000.000000"},
        {"2 + 3 * 4 - 6 / 2", "11.000000"},
        {"-2 * 3", "-6.000000"},
        {"- -2", "2.000000"},
        {"+2", "2.000000"},
        {"8 / 2 / 2", "2.000000"},
        {"2 - 3 - 4", "-5.000000"},
        {"2 * (3 + 4)", "14.000000"},
        {"1 < 2", "1.000000"},
        {"2 > 3", "0.000000"},
        {"3 > 2 > 1", "0.000000"},
        {"1 <= 1", "1.000000"},
        {"1 >= 2", "0.000000"},
        {"1 != 2", "1.000000"},
        {"0.1 + 0.2 = 0.3", "1.000000"}, // equal within 1e-10
        {"1 | 0 & 0", "0.000000"},       // & and | bind alike, from the left
        {"0 & 0 | 1", "1.000000"},
        {"!0 + 1", "2.000000"},
        {"!5", "0.000000"},
        {"1 ? 2 : 3", "2.000000"},
        {"0 ? 2 : 1 ? 4 : 5", "4.000000"},
        {"1 = 1 ? 7 : 8", "7.000000"},
        {"\"a\" = \"a\"", "1.000000"},
        {"\"a\" < \"b\"", "1.000000"},
        {"pi", "3.141593"},
        {"tau", "6.283185"},
        {"on + yes + true", "3.000000"},
        {"off + no + false", "0.000000"},
        {"clock", "0.000000"},
        {"version", "3.700000"},
        {"<1, 2, 3>.y", "2.000000"},
        {"(x + 2 * y).y", "2.000000"},
        {"<1, 2, 3>.blue", "3.000000"},
        {"<1, 2, 3, 4, 5>.transmit", "5.000000"},
        {"<1, 2, 3, 4>.filter", "4.000000"},
        {"<1, 2, 3, 4>.t", "4.000000"},
    };
    for (const Row& row : rows) EXPECT_EQ(number(row.expression), row.printed) << row.expression;
}

TEST(Expression, Functions) {
    const Row rows[] = {
        {"abs(-3)", "3.000000"},
        {"acos(-1)", "3.141593"},
        {"acosh(2)", "1.316958"},
        {"asin(1)", "1.570796"},
        {"asinh(1)", "0.881374"},
        {"atan(1)", "0.785398"},
        {"atan2(1, -1)", "2.356194"},
        {"atanh(0.5)", "0.549306"},
        {"ceil(-1.2)", "-1.000000"},
        {"floor(-1.7)", "-2.000000"},
        {"int(-1.7)", "-1.000000"},
        {"cos(0)", "1.000000"},
        {"cosh(1)", "1.543081"},
        {"sin(pi / 6)", "0.500000"},
        {"sinh(1)", "1.175201"},
        {"tan(0.5)", "0.546302"},
        {"tanh(1)", "0.761594"},
        {"exp(1)", "2.718282"},
        {"ln(2)", "0.693147"},
        {"log(1000)", "3.000000"},
        {"sqrt(2)", "1.414214"},
        {"pow(2, -2)", "0.250000"},
        {"pow(-2, 3)", "-8.000000"},
        {"mod(-7, 3)", "-1.000000"},
        {"div(-7, 3)", "-2.000000"},
        {"degrees(pi)", "180.000000"},
        {"radians(180)", "3.141593"},
        {"min(4, 2, 3)", "2.000000"},
        {"max(1, 5, 3)", "5.000000"},
        {"max(2)", "2.000000"},
        {"select(-1, 1, 2)", "1.000000"},
        {"select(0, 1, 2)", "2.000000"},
        {"select(1, 1, 2)", "2.000000"},
        {"select(0, 1, 2, 3)", "2.000000"},
        {"select(1, 1, 2, 3)", "3.000000"},
        {"bitwise_and(12, 10)", "8.000000"},
        {"bitwise_or(12, 10)", "14.000000"},
        {"bitwise_xor(12, 10)", "6.000000"},
        {"vlength(<1, 2, 2>)", "3.000000"},
        {"vlength(<1, 2, 2, 4>)", "5.000000"},
        {"vdot(<1, 2, 3>, <4, 5, 6>)", "32.000000"},
        {"strlen(\"abc\")", "3.000000"},
        {"strcmp(\"a\", \"b\")", "-1.000000"},
        {"strcmp(\"ab\", \"a\")", "98.000000"}, // the code of the first character that differs
        {"strcmp(\"B\", \"a\")", "-31.000000"},
        {"strcmp(\"a\", \"a\")", "0.000000"},
        {"asc(\"a\")", "97.000000"},
        {"asc(chr(1000))", "1000.000000"},
        {"strlen(concat(\"a\", chr(228), \"b\"))", "3.000000"},
        {"val(\" 1.5\")", "1.500000"},
        {"val(\"-1.5e2abc\")", "-150.000000"},
        {"val(\"0x10\")", "16.000000"},
        {"val(\"abc\")", "0.000000"},
        {"defined(Nothing)", "0.000000"},
        {"defined(sphere)", "0.000000"},
        {"file_exists(\"no_such_file.inc\")", "0.000000"},
        {"sum(i, 1, 4, i * i)", "30.000000"},
        {"prod(i, 1, 5, i)", "120.000000"},
    };
    for (const Row& row : rows) EXPECT_EQ(number(row.expression), row.printed) << row.expression;
}

TEST(Expression, Vectors) {
    struct VectorRow {
        int size;
        const char* expression;
        const char* printed;
    };
    const VectorRow rows[] = {
        {3, "<1, 2, 3> + 1", "2.0000 3.0000 4.0000"},
        {3, "2 * <1, 2, 3>", "2.0000 4.0000 6.0000"},
        {3, "<1, 2, 3> * <4, 5, 6>", "4.0000 10.0000 18.0000"},
        {3, "<1, 2, 3> / 2", "0.5000 1.0000 1.5000"},
        {3, "-<1, 2, 3>", "-1.0000 -2.0000 -3.0000"},
        {3, "!<1, 0, 3>", "0.0000 1.0000 0.0000"},
        {5, "<1, 2> + <1, 1, 1, 1>", "2.0000 3.0000 1.0000 1.0000 0.0000"},
        {5, "x + t", "1.0000 0.0000 0.0000 1.0000 0.0000"},
        {5, "u + 1", "2.0000 1.0000 0.0000 0.0000 0.0000"},
        {3, "x + 2 * y + 3 * z", "1.0000 2.0000 3.0000"},
        {3, "<1 + 1, 2 * 2, (3 > 2)>", "2.0000 4.0000 1.0000"},
        {3, "vcross(x, y)", "0.0000 0.0000 1.0000"},
        {3, "vnormalize(<3, 0, 4>)", "0.6000 0.0000 0.8000"},
        {3, "vnormalize(<0, 0, 0>)", "0.0000 0.0000 0.0000"},
        {3, "vrotate(<1, 2, 3>, <30, 40, 50>)", "1.8013 2.5077 2.1135"},
        {3, "vaxis_rotate(<1, 2, 3>, <1, 1, 0>, 30)", "2.1276 0.8724 2.9516"},
        {3, "(1 ? <1, 2, 3> : 4)", "1.0000 2.0000 3.0000"},
        {3, "vturbulence(2, 0.5, 6, <0.1, 0.2, 0.3>)", "-0.0492 -0.2072 -0.5549"},
        {3, "vturbulence(3, 0.4, 1, <5.1, -0.2, 0.3>)", "0.4166 -0.2549 0.0704"},
    };
    for (const VectorRow& row : rows)
        EXPECT_EQ(vector(row.size, row.expression), row.printed) << row.expression;
}

TEST(Expression, Colours) {
    const Row rows[] = {
        {"rgb 0.5", "0.5000 0.5000 0.5000 0.0000 0.0000"},
        {"rgbf 0.5", "0.5000 0.5000 0.5000 0.5000 0.0000"},
        {"rgbt 0.5", "0.5000 0.5000 0.5000 0.0000 0.5000"},
        {"rgbft 0.5", "0.5000 0.5000 0.5000 0.5000 0.5000"},
        {"color 0.5", "0.5000 0.5000 0.5000 0.5000 0.5000"},
        {"color <1, 2>", "1.0000 2.0000 0.0000 0.0000 0.0000"},
        {"colour <1, 2, 3, 4>", "1.0000 2.0000 3.0000 4.0000 0.0000"},
        {"rgbt <1, 2, 3, 4>", "1.0000 2.0000 3.0000 0.0000 4.0000"},
        {"rgb <1, 2, 3, 4, 5>", "1.0000 2.0000 3.0000 4.0000 5.0000"},
        {"rgbt <1, 2, 3, 4, 5>", "1.0000 2.0000 3.0000 0.0000 4.0000"},
        {"rgb rgbft <1, 2, 3, 4, 5>", "1.0000 2.0000 3.0000 4.0000 5.0000"},
        {"rgb <1, 2, 3> * 2", "2.0000 4.0000 6.0000 0.0000 0.0000"},
        {"srgb <0.5, 0.2, 0.04> * 0.5", "0.0509 0.0100 0.0015 0.0000 0.0000"},
        {"rgb <1, 2, 3> filter 0.7", "1.0000 2.0000 3.0000 0.7000 0.0000"},
        {"red 0.3 blue 0.4", "0.3000 0.0000 0.4000 0.0000 0.0000"},
        {"color red 1 green 0.5 transmit 0.25", "1.0000 0.5000 0.0000 0.0000 0.2500"},
        {"color rgb <1, 0, 0> + rgb <0, 1, 0>", "1.0000 1.0000 0.0000 0.0000 0.0000"},
    };
    for (const Row& row : rows) EXPECT_EQ(vector(5, row.expression), row.printed) << row.expression;
}

TEST(Expression, Strings) {
    const Row rows[] = {
        {"\"a\\tb\\\"\\\\\\u0041\"", "a\tb\"\\A"},
        {"concat(\"a\", \"b\", \"c\")", "abc"},
        {"substr(\"ABCDE\", 2, 3)", "BCD"},
        {"strupr(\"aBc\")", "ABC"},
        {"strlwr(\"aBc\")", "abc"},
        {"chr(65)", "A"},
        {"str(1.5, 8, 2)", "    1.50"},
        {"str(1.5, -8, 2)", "00001.50"},
        {"str(-1.5, -8, 2)", "-0001.50"},
        {"str(1.23456789, 0, -1)", "1.234568"},
        {"str(2.5, 0, 0)", "2"},
        {"vstr(3, <1, 2, 3>, \", \", 0, 1)", "1.0, 2.0, 3.0"},
        {"vstr(2, 5, \"|\", 0, 0)", "5|0"},
        {"substr(concat(\"a\", chr(228), \"bc\"), 3, 2)", "bc"},
        {"datetime(0, \"%Y-%m-%d\")", "2000-01-01"},
    };
    for (const Row& row : rows) EXPECT_EQ(text(row.expression), row.printed) << row.expression;
}

TEST(Expression, RandomStreamsArePovRays) { // printed by POV-Ray 3.7
    EXPECT_EQ(run("#declare S = seed(3); #debug vstr(2, <rand(S), rand(S)>, \" \", 0, 12)"),
              "0.265972876983 0.528236225603");
    EXPECT_EQ(run("#declare S = seed(0); #debug str(rand(S), 0, 12)"), "0.000002874294");
    EXPECT_EQ(run("#declare S = seed(-7.9); #debug str(rand(S), 0, 12)"), "0.046072868175");
    EXPECT_EQ(run("#declare S = seed(4294967299); #debug str(rand(S), 0, 12)"), "0.500002874411");
}

TEST(Expression, Arrays) {
    EXPECT_EQ(run("#declare A = array[3] {1, 2, 3} #debug str(A[0] + A[1] * A[2], 0, 0)"), "7");
    EXPECT_EQ(run("#declare A = array[2][2] {{1, 2}, {3, 4}} #debug str(A[1][0], 0, 0)"), "3");
    EXPECT_EQ(run("#declare A = array[2]; #declare A[1] = <1, 2, 3>; #debug str(A[1].z, 0, 0)"), "3");
    EXPECT_EQ(run("#declare A = array[2] {1, 2} #declare B = A; #declare B[0] = 9; #debug str(A[0], 0, 0)"),
              "1");
    EXPECT_EQ(run("#declare A = array[2] {\"a\", \"b\"} #debug concat(A[1], A[0])"), "ba");
    EXPECT_EQ(run("#declare A = array[2]; #declare A[0] = array[2] {5, 6} #debug str(A[0][1], 0, 0)"), "6");
    EXPECT_EQ(run("#declare A = array[2][5]; #debug str(dimensions(A) * 10 + dimension_size(A, 2), 0, 0)"),
              "25");
}

TEST(Expression, ValuesOfArraysNeedNoCommas) {
    EXPECT_EQ(run("#declare A = array[3] {<1, 2> <3, 4>, <-5, 6>} #debug str(A[2].x, 0, 0)"), "-5");
}

TEST(Expression, Givens) { // of a single picture, as POV-Ray has them
    EXPECT_EQ(run("#debug str(clock + clock_delta + clock_on + frame_number + initial_frame + final_frame + "
                  "initial_clock + final_clock, 0, 0)"),
              "0");
    LoadOptions frame;
    frame.clock = 0.25;
    frame.frame_number = 2;
    frame.initial_frame = 1;
    frame.final_frame = 5;
    frame.final_clock = 1;
    EXPECT_EQ(
        run("#debug vstr(5, <clock, clock_delta, clock_on, frame_number, final_clock>, \" \", 0, 2)", frame),
        "0.25 0.25 1.00 2.00 1.00");
    EXPECT_EQ(run("#debug input_file_name"), "test.pnr");
}

TEST(Expression, NumbersBesideVectorsInBlocks) {
    // Outside parentheses `<` starts the next vector, and `-` subtracts, as in POV-Ray.
    EXPECT_EQ(run("box { -1 <1, 1, 1> pigment { rgb 1 } }"), "");
    EXPECT_EQ(run("box { <-1, -1, -1>, 1 pigment { rgb 1 } }"), "");
}

TEST(Expression, ErrorsAreLocated) {
    const Row rows[] = {
        {"#declare A = 1 / 0;", "test.pnr:1:16: error: division by zero"},
        {"#declare A = <1, 2, 3> / <1, 0, 1>;", "test.pnr:1:24: error: division by zero"},
        {"#declare A = mod(1, 0);", "test.pnr:1:14: error: mod(1, 0): division by zero"},
        {"#declare A = sqrt(-1);", "test.pnr:1:14: error: sqrt(-1) has no finite value"},
        {"#declare A = ln(0);", "test.pnr:1:14: error: ln(0) has no finite value"},
        {"#declare A = 1e200 * 1e200;", "test.pnr:1:20: error: the result is too large for a number"},
        {"#declare A = 1e999;", "test.pnr:1:14: error: this number is too large"},
        {"#declare A = pow(-1, 0.5);", "test.pnr:1:14: error: pow(-1, 0.5) has no finite value"},
        {"#declare A = (1 + 2;", "test.pnr:1:20: error: expected `)`, found `;`"},
        {"#declare A = <1, 2, 3;", "test.pnr:1:22: error: expected `,` or `>` in the vector, found `;`"},
        {"#declare A = <1, 2, 3, 4, 5, 6>;", "test.pnr:1:30: error: a vector has at most 5 components"},
        {"#declare A = <1>;", "test.pnr:1:14: error: a vector has at least 2 components"},
        {"#declare A = 1 + ;", "test.pnr:1:18: error: expected a number or vector, found `;`"},
        {"#declare A = Foo;", "test.pnr:1:14: error: `Foo` is not declared"},
        {"#declare A = array[2] {1, 2} #declare B = A[2];",
         "test.pnr:1:45: error: index 2 is outside of `A`, which goes from 0 to 1"},
        {"#declare A = array[2]; #declare B = A[0] + 1;",
         "test.pnr:1:37: error: this element of `A` has no value yet"},
        {"#declare A = <1, 2>.z;", "test.pnr:1:21: error: a vector of 2 components has no `.z`"},
        {"#declare A = \"a\"; #declare B = 1 + A;",
         "test.pnr:1:36: error: a number or vector is needed here, `A` is a string"},
        {"#declare A = sin 3;", "test.pnr:1:14: error: `sin` is a function: it needs `(`"},
        {"#declare A = atan2(1);",
         "test.pnr:1:21: error: `atan2` needs another argument: expected `,`, found `)`"},
        {"#declare A = rand(0);", "test.pnr:1:14: error: 0 is no stream of random numbers"},
        {"#declare A = substr(\"abc\", 2, 3);",
         "test.pnr:1:28: error: substr: characters 2 to 4 of a string that has 3"},
        {"#if (<1, 2>) #end",
         "test.pnr:1:6: error: a number is needed here, this is a vector of 2 components"},
    };
    for (const Row& row : rows) EXPECT_EQ(first_error(row.expression), row.printed) << row.expression;
}

} // namespace
} // namespace pnr::test
