// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/manual.h"

#include "parser/keywords.h"
#include "tests/parser/scene_text.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace pnr {
namespace {

TEST(Manual, EveryWordOfTheLanguageHasOneEntryAndNoEntryIsOfAnotherWord) {
    std::multiset<std::string_view> names;
    for (const ManualEntry& entry : manual_entries()) names.insert(entry.names.begin(), entry.names.end());
    for (Symbol word = 0; word < keyword_count; ++word)
        EXPECT_EQ(names.count(keyword_text(static_cast<Keyword>(word))), 1u) << keyword_text(static_cast<Keyword>(word));
    EXPECT_EQ(names.size(), keyword_count);
}

TEST(Manual, EveryEntryHasATextAndAnExampleOfAtMostThreeLinesThatLoads) {
    for (const ManualEntry& entry : manual_entries()) {
        const std::string name(entry.names[0]);
        EXPECT_FALSE(entry.text.empty()) << name;
        EXPECT_FALSE(entry.part.empty()) << name;
        const auto lines = std::count(entry.example.begin(), entry.example.end(), '\n');
        EXPECT_TRUE(lines >= 1 && lines <= 3) << name;
        const std::string said = diagnostics_of(entry.example);
        if (says(said, "there is no file \"timrom.ttf\"")) continue; // POV-Ray's fonts are not installed
        EXPECT_EQ(said.find("error: "), std::string::npos) << name << ":\n" << said << entry.example;
    }
}

TEST(Manual, TheRuleOfTheGrammarIsQuoted) {
    const std::vector<std::string> torus = grammar_rules("torus");
    ASSERT_EQ(torus.size(), 2u); // of an object, and its own
    EXPECT_TRUE(torus[1].starts_with("torus           = float, COMMA, float ;")) << torus[1];
    EXPECT_TRUE(says(manual_text("length"), "ilic_item"));
    EXPECT_TRUE(says(manual_text("#declare"), "directive"));
    EXPECT_EQ(manual_text("no_such_word"), "");
    EXPECT_TRUE(says(near_manual_word("spehre"), "sphere"));
    EXPECT_EQ(near_manual_word("qqqqqqqq"), "");
}

TEST(Manual, TheMarkdownFileIsWhatTheTextMakes) {
    std::ostringstream text;
    text << std::ifstream(PNR_SOURCE_DIR "/grammar/manual.md").rdbuf();
    EXPECT_EQ(text.str(), manual_markdown()) << "pnr help --manual > grammar/manual.md";
}

} // namespace
} // namespace pnr
