// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/editor_files.h"

#include "parser/block_words.h"
#include "parser/keywords.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

namespace pnr {

namespace {

using Names = std::vector<std::string_view>;

// The keyword table, each word in one list, sorted.
struct WordLists {
    Names directives, blocks, values, others;
};

bool has(const Names& names, std::string_view word) {
    return std::find(names.begin(), names.end(), word) != names.end();
}

WordLists word_lists() {
    WordLists lists;
    const Names directives = directive_words(), values = value_words();
    for (Symbol symbol = 0; symbol < keyword_count; ++symbol) {
        const std::string_view word = keyword_text(static_cast<Keyword>(symbol));
        if (has(directives, word)) lists.directives.push_back(word);
        if (!block_words(word).empty())
            lists.blocks.push_back(word);
        else if (has(values, word))
            lists.values.push_back(word);
        else if (!has(directives, word))
            lists.others.push_back(word);
    }
    for (Names* names : {&lists.directives, &lists.blocks, &lists.values, &lists.others})
        std::sort(names->begin(), names->end());
    return lists;
}

std::string joined(const Names& names, std::string_view separator) {
    std::string text;
    for (const std::string_view name : names) {
        if (!text.empty()) text += separator;
        text += name;
    }
    return text;
}

// `syntax keyword GROUP ...`, in lines that one can read.
std::string vim_keywords(std::string_view group, const Names& names) {
    constexpr std::size_t width = 100;
    std::string text, line;
    const auto end_line = [&] {
        if (!line.empty()) text += fmt::format("syntax keyword {}{}\n", group, line);
        line.clear();
    };
    for (const std::string_view name : names) {
        if (line.size() + name.size() > width) end_line();
        line += ' ';
        line += name;
    }
    end_line();
    return text;
}

} // namespace

std::string vim_syntax() {
    const WordLists lists = word_lists();
    std::string text = "\" SPDX-License-Identifier: GPL-3.0-or-later\n\" Scenes of pnr. Made from its "
                       "keyword table by `pnr help --editor vim`.\n"
                       "if exists('b:current_syntax')\n    finish\nendif\nsyntax case match\n";
    text += vim_keywords("pnrBlock", lists.blocks) + vim_keywords("pnrValue", lists.values) +
            vim_keywords("pnrItem", lists.others);
    text += fmt::format("syntax match pnrDirective \"#\\s*\\%({})\\>\"\n",
                        joined(lists.directives, "\\|") + "\\");
    text +=
        "syntax match pnrNumber "
        "\"\\<\\d\\+\\%(\\.\\d*\\)\\?\\%([eE][-+]\\?\\d\\+\\)\\?\\|\\.\\d\\+\\%([eE][-+]\\?\\d\\+\\)\\?\"\n"
        "syntax region pnrString start=+\"+ skip=+\\\\\\\\\\|\\\\\"+ end=+\"+\n"
        "syntax match pnrComment \"//.*$\"\n"
        "syntax region pnrComment start=\"/\\*\" end=\"\\*/\" contains=pnrComment\n"
        "highlight default link pnrBlock Type\nhighlight default link pnrValue Function\n"
        "highlight default link pnrItem Statement\nhighlight default link pnrDirective PreProc\n"
        "highlight default link pnrNumber Number\nhighlight default link pnrString String\n"
        "highlight default link pnrComment Comment\n"
        "let b:current_syntax = 'pnr'\n";
    return text;
}

std::string textmate_grammar() {
    using Json = nlohmann::ordered_json;
    const WordLists lists = word_lists();
    const auto words = [](const char* scope, const Names& names) {
        return Json{{"name", scope}, {"match", "\\b(?:" + joined(names, "|") + ")\\b"}};
    };
    const Json grammar = {
        {"$comment", "Made from the keyword table by `pnr help --editor textmate`. SPDX-License-Identifier: "
                     "GPL-3.0-or-later"},
        {"name", "pnr"},
        {"scopeName", "source.pnr"},
        {"fileTypes", {"pnr", "pov", "inc"}},
        {"patterns",
         Json::array(
             {Json{{"include", "#comment"}},
              Json{{"name", "comment.line.double-slash.pnr"}, {"match", "//.*$"}},
              Json{{"name", "string.quoted.double.pnr"},
                   {"begin", "\""},
                   {"end", "\""},
                   {"patterns",
                    Json::array({Json{{"name", "constant.character.escape.pnr"}, {"match", "\\\\."}}})}},
              Json{{"name", "keyword.control.directive.pnr"},
                   {"match", "#\\s*(?:" + joined(lists.directives, "|") + ")\\b"}},
              Json{{"name", "constant.numeric.pnr"},
                   {"match", "(?:\\b\\d+(?:\\.\\d*)?|\\.\\d+)(?:[eE][-+]?\\d+)?"}},
              words("storage.type.block.pnr", lists.blocks), words("support.function.pnr", lists.values),
              words("keyword.other.item.pnr", lists.others)})},
        {"repository",
         {{"comment", Json{{"name", "comment.block.pnr"},
                           {"begin", "/\\*"},
                           {"end", "\\*/"},
                           {"patterns", Json::array({Json{{"include", "#comment"}}})}}}}}};
    return grammar.dump(2) + "\n";
}

std::string editor_file(const std::string& editor) {
    return editor == "vim" ? vim_syntax() : textmate_grammar();
}

} // namespace pnr
