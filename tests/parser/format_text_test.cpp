// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/format_text.h"

#include "parser/lexer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace pnr {
namespace {

std::string formatted(const std::string& text) {
    const FormattedText result = format_text(text);
    EXPECT_EQ(result.problem, "") << text;
    return result.text;
}

// Tokens as they are written, and comments without blanks at the ends of lines, found by a reader of its own.
std::string blackened(const std::string& text) {
    std::string kept;
    int depth = 0;
    for (std::size_t i = 0; i < text.size();) {
        const std::string two = text.substr(i, 2);
        std::size_t end = i + 1;
        if (depth > 0 || two == "/*") {
            depth += two == "/*" ? 1 : two == "*/" ? -1 : 0;
            end = i + (two == "/*" || two == "*/" ? 2 : 1);
        } else if (two == "//") {
            end = std::min(text.find_first_of("\r\n", i), text.size());
        } else if (text[i] == '"') {
            while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
            end = std::min(end + 1, text.size());
        } else if (std::isspace(static_cast<unsigned char>(text[i]))) {
            i = end;
            continue;
        }
        std::string part = text.substr(i, end - i);
        if (two == "//") part.erase(part.find_last_not_of(" \t\f\v") + 1);
        kept += part;
        i = end;
    }
    return kept;
}

std::vector<std::string> token_texts(const std::string& text) {
    const SourceText source{"", text};
    Words words;
    std::vector<std::string> strings, texts;
    LexRange range;
    range.keep_numbers = false;
    for (const StoredToken& token : lex(source, words, strings, range))
        texts.push_back(text.substr(token.begin, token.length));
    return texts;
}

TEST(FormatText, IndentsByBracesAndDirectivesAndSetsSpaces) {
    EXPECT_EQ(formatted("\n\n#for(I ,1,3)\nsphere{<I,0, 0>  ,1\n//  a ball  \n\n\n\n   pigment{rgb 1}}\n#end\n\n"),
              "#for(I, 1, 3)\n    sphere { <I, 0, 0>, 1\n        //  a ball\n\n        pigment { rgb 1 } }\n#end\n");
    EXPECT_EQ(formatted("#if (A)\nunion {\n#else\nmerge {\n#end\nball\n}"),
              "#if (A)\n    union {\n#else\n    merge {\n#end\n    ball\n}\n");
    EXPECT_EQ(formatted("#declare A =\nunion {\nball\n}"), "#declare A =\nunion {\n    ball\n}\n");
    EXPECT_EQ(formatted("#declare A=f( x )[ 2 ]*\r\n2;  // two\r\n"), "#declare A=f(x)[2]*\n    2;  // two\n");
}

TEST(FormatText, KeepsWhatWouldMeanSomethingElse) {
    EXPECT_EQ(formatted("a / / b"), "a / / b\n");
    EXPECT_EQ(formatted("3 .x"), "3 .x\n");
    EXPECT_EQ(formatted("a < = b"), "a < = b\n");
    EXPECT_EQ(formatted("\"a  b\"\"c\""), "\"a  b\" \"c\"\n");
    EXPECT_EQ(formatted("a/* b /* c */ */d"), "a /* b /* c */ */ d\n");
    EXPECT_EQ(formatted(""), "");
}

TEST(FormatText, SaysWhatItCannotRead) {
    const FormattedText result = format_text("sphere {\n/* open");
    EXPECT_NE(result.problem.find("never closed"), std::string::npos);
    EXPECT_EQ(result.at, 9u);
    EXPECT_NE(format_text("#if (1) a").problem, "");
}

TEST(FormatText, EverySceneKeepsItsTokensAndCommentsAndASecondTimeChangesNothing) {
    int scenes = 0;
    for (const char* folder : {"/scenes", "/tests"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(PNR_SOURCE_DIR) + folder)) {
            const std::string ending = entry.path().extension().string();
            if (ending != ".pnr" && ending != ".pov" && ending != ".inc") continue;
            std::ostringstream file;
            file << std::ifstream(entry.path(), std::ios::binary).rdbuf();
            const FormattedText once = format_text(file.str());
            if (!once.problem.empty()) { // scenes with errors on purpose stand among the tests alone
                EXPECT_STREQ(folder, "/tests") << entry.path() << ": " << once.problem;
                continue;
            }
            ++scenes;
            EXPECT_EQ(token_texts(once.text), token_texts(file.str())) << entry.path();
            EXPECT_EQ(blackened(once.text), blackened(file.str())) << entry.path();
            EXPECT_EQ(formatted(once.text), once.text) << entry.path();
        }
    EXPECT_GE(scenes, 20);
}

} // namespace
} // namespace pnr
