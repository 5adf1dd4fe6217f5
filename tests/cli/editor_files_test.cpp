// SPDX-License-Identifier: GPL-3.0-or-later
// grammar/editors against the keyword table.
#include <gtest/gtest.h>

#include "cli/editor_files.h"
#include "cli/options.h"
#include "parser/keywords.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <regex>
#include <sstream>

namespace pnr {
namespace {

using Json = nlohmann::json;

std::string file(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(std::string(PNR_SOURCE_DIR) + "/grammar/editors/" + name).rdbuf();
    return text.str();
}

TEST(EditorFiles, AreThoseOfTheKeywordTable) {
    EXPECT_TRUE(file("vim/syntax/pnr.vim") == editor_file("vim")) << "pnr help --editor vim makes it anew";
    EXPECT_TRUE(file("vscode/syntaxes/pnr.tmLanguage.json") == editor_file("textmate"))
        << "pnr help --editor textmate makes it anew";
}

TEST(EditorFiles, EveryKeywordIsColoured) {
    const Json grammar = Json::parse(textmate_grammar());
    std::vector<std::regex> patterns;
    for (const Json& pattern : grammar["patterns"])
        if (pattern.contains("match")) patterns.emplace_back(pattern["match"].get<std::string>());
    const std::string vim = vim_syntax();
    for (Symbol symbol = 0; symbol < keyword_count; ++symbol) {
        const std::string word(keyword_text(static_cast<Keyword>(symbol)));
        const bool matched = std::any_of(patterns.begin(), patterns.end(), [&](const std::regex& pattern) {
            return std::regex_match(word, pattern) || std::regex_match("#" + word, pattern);
        });
        EXPECT_TRUE(matched) << word;
        EXPECT_TRUE(std::regex_search(vim, std::regex("[ (|]" + word + "[ \n\\\\]"))) << word;
    }
}

TEST(EditorFiles, TheExtensionsFilesAreThere) {
    const Json package = Json::parse(file("vscode/package.json"));
    for (const Json& path :
         {package["main"], package["contributes"]["languages"][0]["configuration"],
          package["contributes"]["grammars"][0]["path"], package["contributes"]["snippets"][0]["path"]})
        EXPECT_FALSE(file("vscode/" + path.get<std::string>()).empty()) << path;
    EXPECT_EQ(package["version"], version());
    EXPECT_TRUE(Json::accept(file("vscode/snippets.json")));
    EXPECT_TRUE(Json::accept(file("vscode/language-configuration.json")));
}

} // namespace
} // namespace pnr
