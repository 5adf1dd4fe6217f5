// SPDX-License-Identifier: GPL-3.0-or-later
// No scene hangs, overflows the stack or exhausts memory: it is read, or refused at a place.
#include "evaluate.h"

#include "parser/expander.h"
#include "parser/parser.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace pnr::test {
namespace {

namespace fs = std::filesystem;

std::string repeated(std::string_view text, int times) {
    std::string all;
    all.reserve(text.size() * static_cast<std::size_t>(times));
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

// Small budgets, so that the tests are quick; the paths are the same.
LoadOptions small() {
    LoadOptions options;
    options.budgets.loop_turns = 20'000;
    options.budgets.macro_calls = 20'000;
    options.budgets.tokens = 2'000'000;
    return options;
}

TEST(Limits, Nesting) {
    const int n = 100'000;
    const std::string deep[] = {
        "sphere " + repeated("{ pigment ", n),
        "union " + repeated("{ union ", n),
        repeated("{", n),
        "#declare A = " + repeated("(", n) + "1" + repeated(")", n) + ";",
        "#declare A = " + repeated("-", n) + "1;",
        "#declare A = " + repeated("1 ? ", n) + "1;",
        "#declare A = " + repeated("<", n) + "1;",
        "#declare A = " + repeated("sin(", n) + "1;",
        "#macro M(X) X #end #declare A = " + repeated("M(", n) + "1;",
    };
    for (const std::string& text : deep) EXPECT_NE(first_error(text), "") << text.substr(0, 40);
    EXPECT_EQ(run(repeated("#if (1) ", n) + repeated("#end ", n)), "");
    EXPECT_EQ(run("#declare A = " + repeated("(", 300) + "7" + repeated(")", 300) + "; #debug str(A, 0, 0)"),
              "7");
}

TEST(Limits, WorkThatNoTokenShows) {
    const std::string texts[] = {
        "#while (1) #declare A = array[100000]; #end",
        "#declare A = array[2] { 1, 1 } #while (1) #declare B = array[2] #declare B[0] = A; "
        "#declare B[1] = A; #declare A = B; #end",
        "#declare S = \"a\"; #for (I, 1, 18) #declare S = concat(S, S); #end #while (1) #declare T = S; #end",
    };
    for (const std::string& text : texts) EXPECT_NE(first_error(text, small()), "") << text;
    LoadOptions options = small();
    options.budgets.bytes = 10'000'000; // copies of declared groups count with all their children
    EXPECT_NE(
        first_error(
            "#declare U = sphere { 0, 1 } #while (1) #declare U = union { object { U } object { U } } #end",
            options)
            .find("needs more than 10 MB"),
        std::string::npos);
}

TEST(Limits, Loops) {
    EXPECT_EQ(first_error("#while (1) #end", small()),
              "test.pnr:1:1: error: the scene's loops turn more than 20000 times");
    EXPECT_EQ(first_error("#for (I, 0, 1e12) #end", small()),
              "test.pnr:1:1: error: the scene's loops turn more than 20000 times");
    EXPECT_EQ(first_error("#declare A = sum(i, 1, 1e9, 1);", small()),
              "test.pnr:1:14: error: the scene's loops turn more than 20000 times");
    EXPECT_NE(first_error("#while (1) sphere { Foo } #end", small()), "");
}

TEST(Limits, Macros) {
    EXPECT_EQ(first_error("#macro M() M() #end M()"),
              "test.pnr:1:12: error: macro `M` is called inside itself or others more than 300 deep");
    EXPECT_NE(first_error("#macro M(X) #local A = M(X + 1); A #end #declare B = M(0);"), "");
    EXPECT_EQ(first_error("#macro M(X) #if (X < 200) M(X + 1) M(X + 1) #end #end M(0)", small()),
              "test.pnr:1:27: error: macros are called more than 20000 times");
}

TEST(Limits, Memory) {
    EXPECT_EQ(first_error("#declare A = array[1e9];"),
              "test.pnr:1:20: error: the array has more than 4000000 elements");
    EXPECT_EQ(first_error("#declare A = array[100000][100000];"),
              "test.pnr:1:28: error: the array has more than 4000000 elements");
    EXPECT_EQ(first_error("#declare S = \"0123456789\"; #while (1) #declare S = concat(S, S); #end"),
              "test.pnr:1:52: error: the string is longer than 1000000 characters");
    EXPECT_EQ(first_error("#declare A = array[1]; #while (1) #declare A[0] = A; #end", small()),
              "test.pnr:1:44: error: arrays in arrays go deeper than 16");
    // what is given up is given back: 1000 arrays of 100,000 elements, one after the other
    EXPECT_EQ(run("#for (I, 1, 1000) #declare A = array[100000]; #end"), "");
}

// What else would hang or fill the machine: each ends at a place.
TEST(Limits, Bombs) {
    LoadOptions options = small();
    options.budgets.bytes = 50'000'000;
    const std::pair<std::string, std::string> bombs[] = {
        {"a macro that doubles",
         "#macro A() sphere { 0, 1 } #end #macro B() A() A() #end #macro C() B() B() C() #end C()"},
        {"files that include themselves",
         "#fopen F \"w\" write #write (F, \"#include \\\"w\\\"\") #fclose F #include \"w\""},
        {"files that grow", "#while (1) #fopen F \"w\" append #write (F, \"#declare Q = 1;\n\") #fclose F #include \"w\" #end"},
        {"a #for that starts again", "#for (I, 0, 10) #declare I = 0; #end"},
        {"streams of random numbers", "#while (1) #declare R = seed(1); #end"},
        {"lights", "#while (1) light_source { 5, rgb 1 } #end"},
        {"extents", "#declare O = union { sphere { 0, 1 } sphere { x, 1 } } #while (1) #declare E = min_extent(O); #end"},
        {"functions that call each other twice",
         "#declare F = function(x) { x }; #while (1) #declare F = function(x) { F(F(x)) }; #end"},
        {"a count that the text cannot hold", "mesh2 { vertex_vectors { 1000000000, <0, 0, 0>, <1, 0, 0> } }"},
        {"patches", "#while (1) bicubic_patch { type 1 u_steps 8 v_steps 8 " + repeated("<1, 2, 3>, ", 16) + "} #end"},
    };
    for (const auto& [name, text] : bombs) EXPECT_NE(first_error(text, options), "") << name;
}

// What is put into itself again and again: deep enough, any recursion over it would leave the stack.
TEST(Limits, ValuesInsideThemselves) {
    const std::pair<std::string, std::string> values[] = {
        {"#declare T = pigment { rgb 1 }", "#declare T = pigment { checker pigment { T } pigment { rgb 1 } }"},
        {"#declare T = pigment { rgb 1 }", "#declare T = pigment { pigment_pattern { T } color_map { [0 rgb 0] [1 rgb 1] } }"},
        {"#declare T = pigment { rgb 1 }", "#declare F = function { pigment { T } } #declare T = pigment { function { F(x, y, z).x } }"},
        {"#declare T = normal { bumps 1 }", "#declare T = normal { gradient x normal_map { [0 T] [1 bumps 1] } }"},
        {"#declare T = texture { pigment { rgb 1 } }", "#declare T = texture { checker texture { T } texture { pigment { rgb 1 } } }"},
        {"#declare T = texture { pigment { rgb 1 } }", "#declare T = texture { gradient x texture_map { [0 T] [1 pigment { rgb 1 }] } }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = union { object { T } }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = difference { object { T } box { 0, 1 } }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = sphere { 0, 1 clipped_by { object { T } } }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = union { light_source { 0, rgb 1 looks_like { T } } }"},
        {"#declare F = function(x) { x };", "#declare F = function(x) { F(x) + 1 };"},
        {"#declare F = function(x) { x };", "#declare F = function(x) { F(x) };"},
    };
    for (const auto& [start, step] : values) {
        const std::string error = first_error(start + " #for (I, 1, 100000) " + step + " #end");
        EXPECT_NE(error.find("nested deeper than 400 levels"), std::string::npos) << step << "\n" << error;
    }
}

// What holds itself twice doubles.
TEST(Limits, ValuesThatDouble) {
    LoadOptions options;
    options.budgets.bytes = 30'000'000;
    const std::pair<std::string, std::string> values[] = {
        {"#declare T = pigment { rgb 1 }", "#declare T = pigment { checker pigment { T } pigment { T } }"},
        {"#declare T = texture { pigment { rgb 1 } }", "#declare T = texture { gradient x texture_map { [0 T] [1 T] } }"},
        {"#declare T = texture { pigment { rgbt 0.5 } }", "#declare T = texture { T } texture { T }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = union { object { T } object { T } }"},
        {"#declare T = sphere { 0, 1 }", "#declare T = union { light_source { 0, rgb 1 looks_like { T } } object { T } }"},
    };
    for (const auto& [start, step] : values) {
        const std::string error = first_error(start + " #for (I, 1, 60) " + step + " #end", options);
        EXPECT_NE(error.find("needs more than 30 MB"), std::string::npos) << step << "\n" << error;
    }
}

// Texts of one kind of token, each of which takes more memory than its letters.
TEST(Limits, TextsThatFillTheMemory) {
    LoadOptions options;
    options.budgets.bytes = 4'000'000;
    for (const char* token : {"1 ", ";", "{", "}", "@$", "\"\" ", "#if (1) ", "#end ", "a "}) {
        const std::string error = first_error(repeated(token, 300'000), options);
        EXPECT_EQ(error.substr(0, 11), "test.pnr:1:") << token;
    }
    EXPECT_NE(first_error(repeated("#declare A = \"\"; ", 60'000), options).find("too much memory"), std::string::npos);
    EXPECT_EQ(first_error(repeated("#declare A = 1; ", 20'000), options), "");
}

TEST(Limits, FunctionsThatTakeLong) {
    const std::string texts[] = {
        "#declare F = function(x, y) { sum(i, 1, 100000, sin(i * x)) }; height_field { function 4000, 4000 { F(x, y) } }",
        "isosurface { function { sum(i, 1, 1000000, sin(i * x)) } contained_by { box { -1, 1 } } }",
        "sphere { 0, 1 pigment { function { sum(i, 1, 1000000, i * x) } } }",
        "#declare F = function(x) { sum(i, 1, x, sin(i)) }; #while (1) #declare A = F(1e5); #end",
        "#declare F = function(n) { n }; #for (I, 1, 9) #declare F = function(n) { sum(i, 1, 1000, F(i)) }; #end",
        "#while (1) #declare A = file_exists(\"nothing\"); #end",
    };
    for (const std::string& text : texts) EXPECT_EQ(first_error(text, small()).substr(0, 11), "test.pnr:1:") << text;
}

// Many breaks in many conditions: each finds its loop at once.
TEST(Limits, ManyBreaks) {
    EXPECT_EQ(first_error("#while (1) " + repeated("#if (0) ", 100'000) + repeated("#break ", 100'000) +
                          repeated("#end ", 100'000) + "#break #end"),
              "");
}

// POV-Ray passes over it.
TEST(Limits, HashesAlone) {
    EXPECT_EQ(run("camera { location <0, 2, 0># } ### sphere { 0, 1 #} #debug \"read\" #"), "read");
    EXPECT_EQ(run("###debug \"read\""), "read");
    const LoadResult result = load_scene_text("camera { location <0, 2, 0># }", "test.pnr", {});
    ASSERT_FALSE(result.diagnostics.empty());
    EXPECT_EQ(result.diagnostics[0].message, "a `#` without the name of a directive means nothing");
}

// A word where a list of numbers was expected is known as one.
TEST(Limits, WordsInListsOfNumbers) {
    EXPECT_EQ(first_error("mesh2 { vertex_vectors { e4, <0, 0, 0>, <1, 0, 0>, <0, 1, 0> } face_indices { 1, <0, 1, 2> } }"),
              "test.pnr:1:26: error: `e4` is not declared");
}

struct Broken {
    const char* text;
    const char* error; // a part of it
};

TEST(Limits, BrokenTexts) {
    const Broken texts[] = {
        {"sphere { 0, 1", "never closed"},
        {"sphere { 0, 1 } }", "unexpected `}`"},
        {"#declare S = \"abc", "never closed"},
        {"/* abc", "never closed"},
        {"#declare A = 0 / 0;", "division by zero"},
        {"#declare A = 1e999;", "too large"},
        {"#declare A = 1e300 * 1e300;", "too large"},
        {"#declare A = <1, 2, 3, 4, 5, 6>;", "at most 5"},
        {"#declare A = <1>;", "at least 2"},
        {"#declare A = array[3] { 1, 2, 3 } #declare B = A[3];", "test.pnr"},
        {"#declare A = array[3] { 1, 2, 3 } #declare B = A[-1];", "test.pnr"},
        {"#declare A = array[3] #declare B = A[1];", "test.pnr"},
        {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 3> } }", "test.pnr"},
        {"mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, -1> } }", "test.pnr"},
        {"mesh2 { vertex_vectors { 1000000000, 0 } face_indices { 1, <0, 1, 2> } }", "test.pnr"},
        {"sphere { \"a\", 1 }", "expected a number or vector"},
        {"sphere { 0, <1, 2, 3> }", "a number is needed"},
        {"sphere { 0, 1 pigment { Nothing } }", "`Nothing`"},
        {"#macro M(A) A #end M(", "test.pnr"},
        {"#while (1)", "never closed"},
        {"#include \"\"", "test.pnr"},
        {"#fopen F \"nothing\" read", "test.pnr"},
        {"#declare F = function(x) { F(x) };", "not declared"},
    };
    for (const auto& [text, error] : texts) {
        const std::string found = first_error(text);
        EXPECT_NE(found.find(error), std::string::npos) << text << "\n" << found;
        EXPECT_EQ(found.substr(0, 11), "test.pnr:1:") << text;
    }
}

TEST(Limits, NearMissesAreNamed) {
    const std::pair<const char*, const char*> words[] = {
        {"sphre { 0, 1 }", "sphere"},
        {"sphere { 0, 1 pigmnet { rgb 1 } }", "pigment"},
        {"sphere { 0, 1 finish { ambiant 1 } }", "ambient"},
        {"sphere { 0, 1 pigment { chekcer rgb 1 rgb 0 } }", "checker"},
        {"sphere { 0, 1 translat x }", "translate"},
        {"camera { locaton -z }", "location"},
        {"light_source { 0, rgb 1 spotligth }", "spotlight"},
        {"global_settings { asumed_gamma 1 }", "assumed_gamma"},
        {"#decalre A = 1;", "declare"},
        {"#if (1) #esle #end", "else"},
        {"#declare A = vnormalise(x);", "vnormalize"},
        {"#declare Colour = 1; #declare B = Coluor;", "Colour"},
        {"sphere { 0, 1 npr { styel oil } }", "style"},
        {"#include \"colours.inc\"", "colors.inc"},
    };
    for (const auto& [text, word] : words) {
        const LoadResult result = load_scene_text(text, "test.pnr", {});
        ASSERT_FALSE(result.diagnostics.empty()) << text;
        const std::string help = result.diagnostics[0].help + result.diagnostics[0].message;
        EXPECT_NE(help.find(word), std::string::npos) << text << "\n" << help;
    }
}

TEST(Limits, TextsOfOtherKinds) {
    using namespace std::string_literals;
    EXPECT_EQ(first_error("\xff\xfes\0p\0h\0"s), "test.pnr:1:1: error: this file is UTF-16: scenes are plain text in UTF-8 or ASCII");
    EXPECT_EQ(first_error("\x89PNG\r\n\x1a\n"s), "test.pnr:1:1: error: this file is no text at all: scenes are plain text in UTF-8 or ASCII");
    EXPECT_NE(first_error("sphere { 0, \0 1 }"s), "");
    const std::string scene = "// a comment\nsphere { 0, 1 }\n#debug \"read\"\n";
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text = "\xef\xbb\xbf";
        for (const char c : scene) text += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(run(text), "read") << (end[1] == 0 ? "one byte" : "two");
    }
    // A place counts lines by any of the three.
    EXPECT_EQ(first_error("// a\r#declare A = ;\r").substr(0, 12), "test.pnr:2:1");
}

TEST(Limits, Includes) {
    const fs::path folder = fs::path(testing::TempDir()) / "pnr_limits";
    fs::create_directories(folder);
    std::ofstream(folder / "self.pnr") << "#include \"self.pnr\"\n";
    const LoadResult result = load_scene(folder / "self.pnr", {});
    ASSERT_FALSE(result.diagnostics.empty());
    EXPECT_EQ(result.diagnostics[0].message, "#include goes deeper than 64 files");
}

TEST(Limits, ReadsOnlyItsFolderAndTheLibrary) {
    const fs::path folder = fs::path(testing::TempDir()) / "pnr_folders";
    fs::create_directories(folder / "scene/sub");
    fs::create_directories(folder / "library");
    std::ofstream(folder / "secret.inc") << "#declare Secret = 1;\n";
    std::ofstream(folder / "scene/sub/in.inc") << "#declare In = 1;\n";
    std::ofstream(folder / "library/lib.inc") << "#declare Lib = 1;\n";
    const auto refused = [&](const std::string& include, const LoadOptions& options = {}) {
        std::ofstream(folder / "scene/a.pnr") << "#include \"" << include << "\"\n";
        const LoadResult result = load_scene(folder / "scene/a.pnr", options);
        return !result.scene.has_value();
    };
    EXPECT_FALSE(refused("sub/in.inc"));
    EXPECT_FALSE(refused("colors.inc")); // embedded
    EXPECT_TRUE(refused("../secret.inc"));
    EXPECT_TRUE(refused("sub/../../secret.inc"));
    EXPECT_TRUE(refused((folder / "secret.inc").string()));
    EXPECT_TRUE(refused("/etc/passwd"));
    EXPECT_TRUE(refused("lib.inc"));
    LoadOptions options;
    options.library = {folder / "library"};
    EXPECT_FALSE(refused("lib.inc", options));
    EXPECT_FALSE(refused((folder / "library/lib.inc").string(), options));
    EXPECT_TRUE(refused("../secret.inc", options));
}

TEST(Limits, Bytes) {
    std::string bytes;
    for (int i = 0; i < 20'000; ++i) bytes += static_cast<char>((i * 7919) % 256);
    EXPECT_NE(first_error(bytes), "");
}

// Every prefix that ends at a token is read or refused, and never without a place.
void try_prefixes(const std::string& text, const std::string& name) {
    Words words;
    std::vector<std::string> strings;
    Sources sources;
    sources.add(name, text);
    for (const StoredToken& token : lex(sources.files[0], words, strings, {})) {
        const std::size_t end = token.begin + token.length;
        const LoadResult result = load_scene_text(text.substr(0, end), name, {});
        EXPECT_EQ(result.scene.has_value(),
                  std::none_of(result.diagnostics.begin(), result.diagnostics.end(),
                               [](const Diagnostic& d) { return d.severity == Severity::error; }))
            << name << " up to byte " << end;
    }
}

TEST(Limits, EveryPrefixIsReadOrRefused) {
    for (const char* folder : {"scenes", "scenes/paper", "tests/parser/errors"}) {
        for (const auto& entry : fs::directory_iterator(fs::path(PNR_SOURCE_DIR) / folder)) {
            if (entry.path().extension() != ".pnr" || entry.file_size() > 4096) continue;
            if (entry.path().stem().string().starts_with("endless"))
                continue; // ends by the budget, each time
            std::ifstream stream(entry.path(), std::ios::binary);
            try_prefixes({std::istreambuf_iterator<char>(stream), {}}, entry.path().string());
        }
    }
}

} // namespace
} // namespace pnr::test
