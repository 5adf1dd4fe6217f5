// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar as it is written down and the parser agree: it takes every sentence of the one. What a grammar cannot
// say (as many entries as a number tells, files that exist) is excluded by what stands in place of some rules; what
// means nothing (a sphere without size) is no matter of syntax and may be an error.
#include "ebnf.h"
#include "evaluate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace pnr::test {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

const Grammar& grammar() {
    static const Grammar read_once = read_grammar(read(fs::path(PNR_SOURCE_DIR) / "grammar/pnr.ebnf"));
    return read_once;
}

// The names that sentences use.
constexpr std::string_view prelude = R"(
#declare V = 2; #declare A_object = sphere { 0, 1 pigment { rgb 1 } };
#declare A_texture = texture { pigment { rgb 1 } } #declare A_pigment = pigment { rgb 1 };
#declare A_finish = finish { phong 1 }; #declare An_interior = interior { ior 1.2 };
#declare A_material = material { texture { A_texture } }; #declare A_map = color_map { [0 rgb 0] [1 rgb 1] };
#declare A_light = light_source { 5, rgb 1 }; #declare A_camera = camera { location -z };
#declare A_transform = transform { rotate x }; #declare Paint = npr { style oil };
)";

Writer blocks() {
    Writer w;
    w.literals = {
        {"COMMA", {","}},
        {"float", {"0.5", "1", "(1 / 4)", "V", "sqrt(V)", "0.1 + 0.2"}},
        {"int", {"3", "V"}},
        {"bool", {"on", "off", "1"}},
        {"optional_bool", {"", "on", "no"}},
        {"vector", {"<1, 2, 3>", "<0.5, 1, -1> * 2", "vnormalize(<1, 2, 3>)"}},
        {"uv", {"<0.25, 0.5>"}},
        {"color", {"rgb <1, 0.5, 0>", "color rgbt 0.5", "srgb <0.1, 0.2, 0.3>", "red 1 green 0.5"}},
        {"expression", {"0.5"}},
        {"string", {"\"text\"", "concat(\"a\", \"b\")"}},
        {"NUMBER", {"0", "1"}},
        {"vector_4", {"<0.1, 0.2, 0.3, 0.4>"}},
        {"skipped_block", {"{ }"}},
        // Counts, and what must exist.
        {"isosurface.function", {"function { x * x + y - z }"}},
        {"parametric.function", {"function { u + v }"}},
        {"mesh", {"triangle { 0, x, y } triangle { 0, y, z }"}},
        {"mesh2", {"vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> }"}},
        {"texture_list", {"{ 1, texture { A_texture } }"}},
        {"coefficients", {"<1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1>"}},
        {"quartic", {"<1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, "
                     "1, 1, 1, 1>"}},
        {"poly", {"3, <1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1>"}},
        {"polynomial", {"2, xyz(2, 0, 0): 1, xyz(0, 0, 0): -1"}},
        {"points", {"5, <0, 0>, <2, 0>, <3, 2>, <1, 3>, <0, 0>"}},
        {"prism", {"linear_sweep linear_spline 0, 1, 5, <0, 0>, <2, 0>, <3, 2>, <1, 3>, <0, 0>"}},
        {"lathe", {"linear_spline 3, <0, 0>, <2, 1>, <1, 3>"}},
        {"sor", {"4, <1, 0>, <2, 1>, <2, 2>, <1, 3>"}},
        {"sphere_sweep", {"linear_spline 2, 0, 1, x, 1"}},
        {"polygon", {"5, 0, x, x + y, y, 0"}},
        {"height_field", {"function 4, 4 { x }"}},
        {"text", {"internal 1, \"A\", 1, 0"}},
        {"image_map", {"{ }"}},
        {"julia_item", {"max_iteration 5", "precision 10", "quaternion", "sqr"}},
    };
    w.names = {{"object", "A_object"},        {"object_reference", "A_object"}, {"group_child", "A_object"},
               {"limit", "A_object"},         {"texture_item", "A_texture"},    {"texture", "A_texture"},
               {"corner_textures", "A_texture"}, {"material", "A_material"},    {"pigment", "A_pigment"},
               {"color_map", "A_map"},        {"finish", "A_finish"},           {"interior", "An_interior"},
               {"light_source", "A_light"},   {"light_item", "A_object"},       {"camera", "A_camera"},
               {"npr_item", "Paint"},         {"transform", "A_transform"},     {"variable", "V"}};
    return w;
}

bool is_syntax(const std::string& message) {
    for (const char* start : {"unexpected ", "unknown word", "expected "})
        if (message.starts_with(start)) return true;
    return message.find("never closed") != message.npos || message.find("cannot stand in") != message.npos ||
           message.find("has no meaning") != message.npos || message.find("is not declared") != message.npos;
}

// The object that a name in a shape's block stands for may be of another kind, without this shape's own words.
bool of_another_kind(const std::string& message) {
    return message.starts_with("unexpected `open`") || message.starts_with("unexpected `tolerance`");
}

struct Verdict {
    bool taken = false;    // no error at all
    std::string complaint; // about syntax; what follows other errors may be their doing
};

Verdict judge(const std::string& text) {
    const LoadResult result = load_scene_text(text, "sentence.pnr", {});
    Verdict verdict{true, {}};
    for (const Diagnostic& d : result.diagnostics) {
        if (d.severity != Severity::error) continue;
        verdict.taken = false;
        if (is_syntax(d.message) && !of_another_kind(d.message))
            verdict.complaint = format(d, result.sources, false) + "in:\n" + text.substr(text.find('\n', prelude.size()) + 1);
        break;
    }
    return verdict;
}

TEST(Grammar, IsRead) {
    EXPECT_GT(grammar().order.size(), 100u);
    EXPECT_THROW(read_grammar("a = \"b\""), std::runtime_error);
    const Grammar g = read_grammar("a = 2 * ( \"x\", [ b ] ) ; (* not more *) b = { \"y\" }- | ? z ? ;");
    EXPECT_EQ(g.order, (std::vector<std::string>{"a", "b"}));
    std::mt19937 random(1);
    const std::string s = sentence(g, {}, "a", random);
    EXPECT_NE(s.find("x"), s.npos);
}

TEST(Grammar, TheParserTakesEverySentence) {
    std::mt19937 random(20101);
    const Writer writer = blocks();
    constexpr int sentences = 4000;
    int refused = 0, taken = 0;
    for (int i = 0; i < sentences && refused < 5; ++i) {
        const Verdict verdict = judge(std::string(prelude) + "\n" + sentence(grammar(), writer, "scene", random));
        taken += verdict.taken;
        if (verdict.complaint.empty()) continue;
        ++refused;
        ADD_FAILURE() << verdict.complaint;
    }
    EXPECT_GT(taken, sentences / 3); // also in what they mean
}

TEST(Grammar, TheEvaluatorTakesEveryExpression) {
    Writer writer;
    writer.literals = {{"COMMA", {","}},
                       {"NUMBER", {"0.25", "1", "3", "1e1"}},
                       {"vector_literal", {"<1, 2, 3>"}},
                       {"color", {"(rgb <1, 0.5, 0>)"}}, // `rgb` takes all operators behind it
                       {"function", {"sin(1)", "max(1, 2, V)", "vlength(<1, 2, 3>)", "pow(2, 3)", "vcross(x, y)"}},
                       {"string", {"\"a\"", "\"b\""}},
                       {"component", {"x", "y"}}};
    writer.names = {{"variable", "V"}};
    writer.directives.pop_back(); // would end the expression of the #declare it stands in
    std::mt19937 random(1);
    constexpr int sentences = 4000;
    int refused = 0, taken = 0;
    for (int i = 0; i < sentences && refused < 5; ++i) {
        const Verdict verdict = judge(std::string(prelude) + "\n#declare Result = (" +
                                      sentence(grammar(), writer, "condition", random) + ");");
        taken += verdict.taken;
        if (verdict.complaint.empty()) continue;
        ++refused;
        ADD_FAILURE() << verdict.complaint;
    }
    EXPECT_GT(taken, sentences / 10); // also in what they mean
}

// A block's rule bears the name of the function that reads it.
TEST(Grammar, RulesAreFunctions) {
    std::string sources;
    for (const auto& entry : fs::directory_iterator(fs::path(PNR_SOURCE_DIR) / "parser"))
        sources += read(entry.path());
    std::set<std::string> blocks_of_words; // rules that stand behind their own word: "texture", texture
    const std::string text = read(fs::path(PNR_SOURCE_DIR) / "grammar/pnr.ebnf");
    for (const std::string& rule : grammar().order)
        if (text.find("\"" + rule + "\", " + rule) != text.npos) blocks_of_words.insert(rule);
    EXPECT_GT(blocks_of_words.size(), 20u);
    for (const std::string& rule : blocks_of_words)
        EXPECT_NE(sources.find("parse_" + rule + "("), sources.npos) << rule;
}

} // namespace
} // namespace pnr::test
