// SPDX-License-Identifier: GPL-3.0-or-later
// What the language server says of words and names: completion, hover, definition, outline.
#include "cli/lsp.h"
#include "parser/block_words.h"
#include "parser/manual.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pnr {

namespace {

using Json = nlohmann::json;

// The protocol's numbers.
enum CompletionKind {
    completion_function = 3,
    completion_variable = 6,
    completion_value = 12,
    completion_keyword = 14
};
enum OutlineKind { outline_function = 12, outline_variable = 13, outline_object = 19 };

std::string first_line(std::string_view text) { return std::string(text.substr(0, text.find('\n'))); }

std::string manual_line(std::string_view word) {
    const ManualEntry* entry = find_manual_entry(word);
    return entry == nullptr ? std::string() : first_line(entry->text);
}

std::string said_of(const Declaration& declaration) {
    switch (declaration.how) {
    case DeclaredBy::macro:
        return "macro";
    case DeclaredBy::loop:
        return "counter of a loop";
    case DeclaredBy::parameter:
        return "parameter of a macro";
    default:
        return declaration.value_word.empty() ? std::string("value") : declaration.value_word;
    }
}

struct Items {
    Json list = Json::array();
    std::set<std::string, std::less<>> labels;

    // `rank` orders groups: editors sort by sortText.
    void add(std::string_view label, CompletionKind kind, const std::string& detail, char rank) {
        if (!labels.insert(std::string(label)).second) return;
        list.push_back(
            {{"label", label}, {"kind", kind}, {"detail", detail}, {"sortText", rank + std::string(label)}});
    }
    void add_names(const EditorText& text) {
        for (const Declaration& declaration : text.declarations)
            add(declaration.name,
                declaration.how == DeclaredBy::macro ? completion_function : completion_variable,
                said_of(declaration), '2');
    }
};

// Is a directive's name being written at this byte? `#decl|`
bool in_directive(const EditorText& text, std::uint32_t offset) {
    std::uint32_t at = offset;
    while (at > 0 && std::isalpha(static_cast<unsigned char>(text.source.text[at - 1])) != 0) --at;
    return at > 0 && text.source.text[at - 1] == '#';
}

struct Found {
    const EditorText* text = nullptr;
    const Declaration* declaration = nullptr;
};

// A name's declaration in the document or in what it includes.
Found find_name(const LspDocument& document, std::string_view name, std::uint32_t before) {
    if (const Declaration* own = find_declaration(document.text, name, before)) return {&document.text, own};
    for (const auto& text : document.included)
        if (const Declaration* declaration = find_declaration(*text, name, no_token))
            return {text.get(), declaration};
    return {};
}

// The comment lines right above a declaration, and its own first line.
std::string shown_declaration(const Found& found) {
    const std::string& text = found.text->source.text;
    const auto line_of = [&](std::uint32_t offset) {
        return static_cast<std::size_t>(
            std::upper_bound(found.text->lines.begin(), found.text->lines.end(), offset) -
            found.text->lines.begin() - 1);
    };
    const auto line_text = [&](std::size_t line) {
        return first_line(std::string_view(text).substr(found.text->lines[line]));
    };
    const std::size_t own = line_of(found.declaration->begin);
    std::string shown = line_text(own);
    for (std::size_t line = own; line > 0 && own - line < 6; --line) {
        const std::string above = line_text(line - 1);
        const std::size_t begin = above.find_first_not_of(" \t");
        if (begin == std::string::npos || above.compare(begin, 2, "//") != 0) break;
        shown = above + "\n" + shown;
    }
    return shown;
}

std::string fenced(const std::string& text) {
    return fmt::format("```pnr\n{}{}```", text, text.ends_with('\n') ? "" : "\n");
}

// The name of `#include "name"` if the token is one of its two.
std::string included_name(const EditorText& text, std::uint32_t token) {
    const std::uint32_t directive = directive_name(text, token) == "include" ? token
                                    : token > 0                              ? token - 1
                                                                             : 0;
    if (directive_name(text, directive) != "include" || directive + 1 >= text.tokens.size()) return {};
    const std::string_view written = token_text(text, directive + 1);
    if (written.size() < 2 || written.front() != '"' || written.back() != '"') return {};
    return std::string(written.substr(1, written.size() - 2));
}

bool is_file(const EditorText& text, const std::string& name) {
    const std::string& path = text.source.path;
    if (!path.ends_with(name)) return false;
    return path.size() == name.size() ||
           std::string_view("/:").find(path[path.size() - name.size() - 1]) != std::string_view::npos;
}

Json location(const LspServer& server, const LspDocument& document, const EditorText& text,
              std::uint32_t begin, std::uint32_t end) {
    const std::string uri = &text == &document.text ? document.uri : uri_of_source(text);
    if (uri.empty()) return nullptr;
    return {{"uri", uri}, {"range", lsp_range(server, text, begin, end)}};
}

} // namespace

Json lsp_completion(const LspServer&, const LspDocument& document, std::uint32_t offset) {
    Items items;
    if (in_directive(document.text, offset)) {
        for (const std::string_view word : directive_words())
            items.add(word, completion_keyword, manual_line(word), '0');
        return items.list;
    }
    const std::string_view block = block_at(document.text, offset);
    for (const std::string_view word : block_words(block))
        items.add(word, completion_keyword, manual_line(word), '0');
    items.add_names(document.text);
    for (const auto& text : document.included) items.add_names(*text);
    for (const std::string_view word : value_words())
        items.add(word, completion_value, manual_line(word), '4');
    return items.list;
}

Json lsp_hover(const LspServer& server, const LspDocument& document, std::uint32_t offset) {
    const EditorText& text = document.text;
    const std::uint32_t token = token_at(text, offset);
    if (token == no_token) return nullptr;
    const std::string_view directive = directive_name(text, token);
    const std::string_view word = directive.empty() ? token_text(text, token) : directive;
    std::string shown;
    const bool is_word = static_cast<TokenKind>(text.tokens[token].kind) == TokenKind::word;
    if (is_word)
        if (const Found found = find_name(document, word, offset); found.declaration != nullptr)
            shown = fenced(shown_declaration(found));
    if (shown.empty() && (is_word || !directive.empty()))
        if (const std::string said = manual_text(word); !said.empty()) shown = fenced(said);
    if (shown.empty()) return nullptr;
    const std::uint32_t begin = text.tokens[token].begin;
    return {{"contents", {{"kind", "markdown"}, {"value", shown}}},
            {"range", lsp_range(server, text, begin, begin + text.tokens[token].length)}};
}

Json lsp_definition(const LspServer& server, const LspDocument& document, std::uint32_t offset) {
    const EditorText& text = document.text;
    const std::uint32_t token = token_at(text, offset);
    if (token == no_token) return nullptr;
    if (const std::string name = included_name(text, token); !name.empty()) {
        for (const auto& included : document.included)
            if (is_file(*included, name)) return location(server, document, *included, 0, 0);
        return nullptr;
    }
    if (static_cast<TokenKind>(text.tokens[token].kind) != TokenKind::word) return nullptr;
    const Found found = find_name(document, token_text(text, token), offset);
    if (found.declaration == nullptr) return nullptr;
    const StoredToken& name = found.text->tokens[found.declaration->token];
    return location(server, document, *found.text, name.begin, name.begin + name.length);
}

Json lsp_symbols(const LspServer& server, const LspDocument& document) {
    const EditorText& text = document.text;
    std::vector<std::pair<std::uint32_t, Json>> found; // by first byte
    const auto add = [&](const std::string& name, const std::string& detail, OutlineKind kind,
                         std::uint32_t begin, std::uint32_t end, std::uint32_t token) {
        const StoredToken& at = text.tokens[token];
        found.emplace_back(
            begin, Json{{"name", name},
                        {"detail", detail},
                        {"kind", kind},
                        {"range", lsp_range(server, text, begin, std::max(end, at.begin + at.length))},
                        {"selectionRange", lsp_range(server, text, at.begin, at.begin + at.length)}});
    };
    for (const Declaration& d : text.declarations) {
        if (d.how == DeclaredBy::declare || d.how == DeclaredBy::local)
            add(d.name, d.value_word, outline_variable, d.begin, d.end, d.token);
        if (d.how == DeclaredBy::macro) add(d.name, "macro", outline_function, d.begin, d.end, d.token);
    }
    for (const Statement& statement : statements(text)) {
        const std::uint32_t begin = text.tokens[statement.token].begin;
        const std::string_view inside =
            std::string_view(text.source.text).substr(begin, statement.end - begin);
        add(std::string(token_text(text, statement.token)), first_line(inside), outline_object, begin,
            statement.end, statement.token);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json list = Json::array();
    for (auto& [begin, symbol] : found) list.push_back(std::move(symbol));
    return list;
}

} // namespace pnr
