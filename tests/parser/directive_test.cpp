// SPDX-License-Identifier: GPL-3.0-or-later
// Directives and macros; what POV-Ray 3.7 prints for the same text.
#include "evaluate.h"

#include <gtest/gtest.h>

namespace pnr::test {
namespace {

TEST(Directive, Branches) {
    EXPECT_EQ(run("#if (1) #debug \"a\" #else #debug \"b\" #end"), "a");
    EXPECT_EQ(run("#if (0) #debug \"a\" #else #debug \"b\" #end"), "b");
    EXPECT_EQ(run("#if (0) #debug \"a\" #elseif (1) #debug \"b\" #else #debug \"c\" #end"), "b");
    EXPECT_EQ(run("#if (0) #debug \"a\" #elseif (0) #debug \"b\" #else #debug \"c\" #end"), "c");
    EXPECT_EQ(run("#if (1) #debug \"a\" #elseif (1) #debug \"b\" #else #debug \"c\" #end #debug \"d\""),
              "ad");
    EXPECT_EQ(run("#if (0) #if (1) #debug \"a\" #end #debug \"b\" #else #debug \"c\" #end"), "c");
    EXPECT_EQ(run("#ifdef (A) #debug \"a\" #end #ifndef (A) #debug \"b\" #end"), "b");
    EXPECT_EQ(run("#declare A = 1; #ifdef (A) #debug \"a\" #end #undef A #ifdef (A) #debug \"b\" #end"), "a");
    EXPECT_EQ(run("#declare A = array[2]; #declare A[1] = 1; #ifdef (A[0]) #debug \"0\" #end #ifdef (A[1]) "
                  "#debug \"1\" #end"),
              "1");
    EXPECT_EQ(run("#if (0) this @ is $ not read ]]] #end #debug \"a\""), "a");
}

TEST(Directive, Switch) {
    const std::string cases =
        " #case (1) #debug \"1\" #case (2) #debug \"2\" #break #range (5, 6) #debug \"r\" "
        "#else #debug \"e\" #end #debug \".\"";
    EXPECT_EQ(run("#switch (1)" + cases), "12.");
    EXPECT_EQ(run("#switch (2)" + cases), "2.");
    EXPECT_EQ(run("#switch (5.5)" + cases), "re."); // POV-Ray falls into #else, too
    EXPECT_EQ(run("#switch (9)" + cases), "e.");
    EXPECT_EQ(run("#switch (9) #case (1) #debug \"1\" #end #debug \".\""), ".");
}

TEST(Directive, Loops) {
    EXPECT_EQ(run("#declare I = 0; #while (I < 3) #debug str(I, 0, 0) #declare I = I + 1; #end"), "012");
    EXPECT_EQ(run("#while (0) #debug \"a\" #end #debug \"b\""), "b");
    EXPECT_EQ(run("#declare I = 0; #while (I < 9) #declare I = I + 1; #if (I = 3) #break #end #end #debug "
                  "str(I, 0, 0)"),
              "3");
    EXPECT_EQ(run("#for (I, 1, 3) #debug str(I, 0, 0) #end #debug str(I, 0, 0)"), "1234");
    EXPECT_EQ(run("#for (I, 1, 0.4, -0.2) #debug str(I, 4, 1) #end"), " 1.0 0.8 0.6 0.4");
    EXPECT_EQ(run("#for (I, 0, 1, 0.1) #debug str(I * 10, 0, 0) #end"), "012345678910");
    EXPECT_EQ(run("#for (I, 2, 1) #debug \"a\" #end #debug \"b\""), "b");
    EXPECT_EQ(
        run("#for (I, 0, 1) #for (J, 0, 1) #if (J = I) #break #end #debug str(10 * I + J, 0, 0) #end #end"),
        "10");
    EXPECT_EQ(run("#for (I, 0, 2) #switch (I) #case (1) #debug \"one\" #break #else #debug \"-\" #end #end"),
              "-one-");
}

TEST(Directive, StandAnywhere) {
    EXPECT_EQ(run("#declare V = <1, #if (1) 2 #else 3 #end, 4>; #debug vstr(3, V, \" \", 0, 0)"), "1 2 4");
    EXPECT_EQ(run("#declare A = array[4] { #for (I, 0, 3) I * I, #end } #debug str(A[3], 0, 0)"), "9");
    EXPECT_EQ(run("sphere { #declare R = 2; 0, R #debug str(R, 0, 0) pigment { rgb 1 } }"), "2");
    EXPECT_EQ(run("#declare A = 1 #declare B = A + 1 #debug str(B, 0, 0)"), "2");
    EXPECT_EQ(run("#declare A = 1 #if (1) + 2 #end; #debug str(A, 0, 0)"), "3");
    EXPECT_EQ(run("#declare I = 0; #while (I < 3) #declare I = I + 1 #end #debug str(I, 0, 0)"), "3");
}

TEST(Directive, Macros) {
    EXPECT_EQ(run("#macro Twice(X) 2 * X #end #debug str(Twice(3) + 1, 0, 0)"), "7");
    EXPECT_EQ(run("#macro Twice(X) (2 * X) #end #declare A = Twice(1 + 2); #debug str(A, 0, 0)"), "6");
    EXPECT_EQ(run("#macro Nothing() #end Nothing() #debug \"a\""), "a");
    EXPECT_EQ(
        run("#macro Fib(N) #if (N < 2) N #else Fib(N - 1) + Fib(N - 2) #end #end #debug str(Fib(15), 0, 0)"),
        "610");
    EXPECT_EQ(run("#macro Fact(N) #if (N < 2) #local R = 1; #else #local R = N * Fact(N - 1); #end R #end "
                  "#debug str(Fact(10), 0, 0)"),
              "3628800");
    EXPECT_EQ(run("#macro Word(S) concat(\"<\", S, \">\") #end #debug Word(\"a\")"), "<a>");
    EXPECT_EQ(run("#macro Ball(R) sphere { 0, R pigment { rgb 1 } } #end Ball(2)"), "");
    EXPECT_EQ(
        run("#macro Look(C) pigment { rgb C } finish { ambient 0 } #end sphere { 0, 1 Look(<1, 0, 0>) }"),
        "");
}

TEST(Directive, MacrosGiveArrays) {
    EXPECT_EQ(run("#macro M(N) #local A = array[N] #for (I, 0, N - 1) #local A[I] = I * I; #end A #end "
                  "#declare B = M(5) #debug str(B[4] + dimension_size(B, 1), 0, 0)"),
              "21");
}

TEST(Directive, MacroArgumentsAreReferences) {
    EXPECT_EQ(run("#macro Set(P) #declare P = 42; #end Set(Q) #debug str(Q, 0, 0)"), "42");
    EXPECT_EQ(run("#macro Set(P) #declare P = 42; #end #declare A = array[2] {1, 2} Set(A[1]) #debug "
                  "str(A[1], 0, 0)"),
              "42");
    EXPECT_EQ(run("#macro Set(P) #declare P = 42; #end #declare Q = 1; Set(Q + 0) #debug str(Q, 0, 0)"), "1");
    EXPECT_EQ(run("#macro Add(P) #local P = P + 1; #end #declare G = 5; Add(G) #debug str(G, 0, 0)"), "6");
    EXPECT_EQ(run("#macro Fill(A) #declare A[0] = 7; #end #declare B = array[1] {1} Fill(B) #debug str(B[0], "
                  "0, 0)"),
              "7");
}

TEST(Directive, Scopes) {
    EXPECT_EQ(run("#declare A = 1; #macro M() #local A = 2; #end M() #debug str(A, 0, 0)"), "1");
    EXPECT_EQ(run("#declare A = 1; #macro M() #declare A = 2; #end M() #debug str(A, 0, 0)"), "2");
    // a macro sees its caller's locals, and #declare writes to them
    EXPECT_EQ(run("#declare H = 1; #macro Inner() #declare H = 4; #end #macro Outer() #local H = 3; Inner() "
                  "#debug str(H, 0, 0) #end Outer() #debug str(H, 0, 0)"),
              "41");
    EXPECT_EQ(run("#macro M() #local L = 1; #end M() #ifdef (L) #debug \"there\" #else #debug \"gone\" #end"),
              "gone");
}

TEST(Directive, LocalsOfMacrosThatAreStillOpen) {
    // The value ends inside the macro, whose own locals go on.
    EXPECT_EQ(run("#macro M() #local Q = 5; Q; #local Z = 7; #end #local Q = M() #debug str(Q, 0, 0)"), "5");
    EXPECT_EQ(run("#macro M() #local Q = 5; Q; #end #macro N() #local Q = M() #local R = Q + M() R; #end "
                  "#declare Q = "
                  "N(); #debug str(Q, 0, 0)"),
              "10");
    EXPECT_EQ(run("#macro M() 5; #end #macro N() #local Q = M() #end N() #ifdef (Q) #debug \"leak\" #end"),
              "");
    EXPECT_EQ(run("#macro T(A) transform { translate A } #end #macro M() #local Matrix = T(x) #local B = 3; "
                  "#declare F "
                  "= function { transform { Matrix } } #end M() #debug str(F(1, 2, 3).x, 0, 0)"),
              "2");
}

TEST(Directive, CommasThatMayBeMissing) {
    EXPECT_EQ(run("#macro M(A B, C) #debug str(A * B + C, 0, 0) #end M(3 4, 5)"), "17");
    EXPECT_NE(first_error("#macro M(A) #end M(3 4)"), "");
}

TEST(Directive, UndefOfElements) {
    EXPECT_EQ(run("#declare A = array[2][2] {{1, 2}, {3, 4}} #undef A[0][1] #ifdef (A[0][1]) #debug \"y\" "
                  "#else #debug "
                  "\"n\" #end #debug str(A[1][1], 0, 0)"),
              "n4");
}

TEST(Directive, Values) {
    EXPECT_EQ(run("#declare F = 5; #declare F = \"text\"; #debug F"), "text");
    EXPECT_EQ(run("#declare S = sphere { 0, 1 pigment { rgb 1 } } #declare T = S; object { T }"), "");
    EXPECT_EQ(run("#declare P = array[2] #declare P[0] = pigment { rgb 1 } sphere { 0, 1 pigment { P[0] } }"),
              "");
    EXPECT_EQ(run("#version 3.5; #debug str(version, 0, 1)"), "3.5");
    EXPECT_EQ(run("#declare length = 2; #debug str(length + 1, 0, 0)"), "3"); // a free word
}

TEST(Directive, StreamsOfOldScenes) { EXPECT_EQ(run("#render \"a\" #statistics \"b\" #debug \"c\""), "abc"); }

TEST(Directive, Files) {
    const std::string write =
        "#fopen F \"a.txt\" write #write (F, 1.5, \",\", <1, -2, 3>, \",\\\"text\\\"\") #fclose F ";
    EXPECT_EQ(run(write +
                  "#fopen F \"a.txt\" read #read (F, A, B, C) #debug concat(str(A, 0, 1), str(B.y, 0, 0), C) "
                  "#ifdef (F) #debug \"open\" #else #debug \"at the end\" #end"),
              "1.5-2textat the end");
    EXPECT_EQ(run("#fopen F \"b.inc\" write #write (F, \"#declare B = \", 1 / 4, \";\") #fclose F "
                  "#fopen F \"b.inc\" append #write (F, \"#declare C = B;\") #fclose F #include \"b.inc\" "
                  "#debug str(C, 0, 2)"),
              "0.25");
    EXPECT_EQ(first_error("#write (F, 1)"), "test.pnr:1:9: error: `F` is no open file");
}

TEST(Directive, DeclaresFromOutside) {
    LoadOptions options;
    options.declares = {{"N", "3"}, {"S", "\"text\""}, {"M", "N * 2"}};
    options.clock = 0.25;
    options.frame_number = 7;
    options.width = 320;
    EXPECT_EQ(run("#debug concat(S, str(N + M, 0, 0))", options), "text9");
    EXPECT_EQ(run("#debug vstr(3, <clock, frame_number, image_width>, \" \", 0, 2)", options),
              "0.25 7.00 320.00");
    options.declares = {{"N", "3 +"}};
    EXPECT_EQ(first_error("", options), "-D N:1:17: error: expected a number or vector, found `;`");
}

} // namespace
} // namespace pnr::test
