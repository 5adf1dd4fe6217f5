// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/lsp_text.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace pnr {

namespace {

TokenKind kind_of(const StoredToken& token) { return static_cast<TokenKind>(token.kind); }

bool is_sign(const StoredToken& token, char sign) {
    return kind_of(token) == TokenKind::punctuation && token.name.symbol == static_cast<Symbol>(sign);
}
bool is_word(const StoredToken& token) { return kind_of(token) == TokenKind::word; }
std::uint32_t end_of(const StoredToken& token) { return token.begin + token.length; }

std::vector<std::uint32_t> pair_braces(const std::vector<StoredToken>& tokens) {
    std::vector<std::uint32_t> partners(tokens.size(), no_token), open;
    for (std::uint32_t i = 0; i < tokens.size(); ++i) {
        if (is_sign(tokens[i], '{')) open.push_back(i);
        if (!is_sign(tokens[i], '}') || open.empty()) continue;
        partners[i] = open.back();
        partners[open.back()] = i;
        open.pop_back();
    }
    return partners;
}

// The byte behind the value of `#declare Name = ...`, whose name is the token `name`.
std::uint32_t end_of_value(const EditorText& text, std::uint32_t name) {
    std::uint32_t i = name + 1;
    while (i < text.tokens.size()) {
        const StoredToken& token = text.tokens[i];
        if (is_sign(token, '{')) {
            const std::uint32_t partner = text.partners[i];
            if (partner == no_token) break;
            if (!is_sign(text.tokens[partner + 1], ';')) return end_of(text.tokens[partner]);
            return end_of(text.tokens[partner + 1]);
        }
        if (is_sign(token, ';')) return end_of(token);
        if (kind_of(token) == TokenKind::end || !directive_name(text, i).empty()) break;
        ++i;
    }
    return end_of(text.tokens[i - 1]);
}

void add_declaration(EditorText& text, DeclaredBy how, std::uint32_t directive, std::uint32_t name,
                     std::uint32_t end) {
    const std::string_view written = token_text(text, name);
    std::string_view value;
    if (how == DeclaredBy::declare || how == DeclaredBy::local)
        if (name + 2 < text.tokens.size() && is_sign(text.tokens[name + 1], '=') &&
            is_word(text.tokens[name + 2]))
            value = token_text(text, name + 2);
    text.declarations.push_back(
        {std::string(written), how, name, text.tokens[directive].begin, end, std::string(value)});
}

// #macro Name(A, B): the name and the parameters.
void add_macro(EditorText& text, std::uint32_t directive) {
    const std::uint32_t name = directive + 1;
    std::uint32_t end = end_of(text.tokens[name]);
    const StoredToken& opener = text.tokens[directive];
    if (kind_of(opener) == TokenKind::directive && opener.name.jump < text.tokens.size())
        end = end_of(text.tokens[opener.name.jump]);
    add_declaration(text, DeclaredBy::macro, directive, name, end);
    if (!is_sign(text.tokens[name + 1], '(')) return;
    for (std::uint32_t i = name + 2; i < text.tokens.size(); ++i) {
        if (is_word(text.tokens[i]))
            add_declaration(text, DeclaredBy::parameter, i, i, end_of(text.tokens[i]));
        else if (!is_sign(text.tokens[i], ','))
            return;
    }
}

void find_declarations(EditorText& text) {
    for (std::uint32_t i = 0; i + 1 < text.tokens.size(); ++i) {
        const std::string_view directive = directive_name(text, i);
        if (directive.empty()) continue;
        if (directive == "for") {
            if (i + 2 < text.tokens.size() && is_word(text.tokens[i + 2]))
                add_declaration(text, DeclaredBy::loop, i, i + 2, end_of(text.tokens[i + 2]));
        } else if (is_word(text.tokens[i + 1])) {
            if (directive == "declare")
                add_declaration(text, DeclaredBy::declare, i, i + 1, end_of_value(text, i + 1));
            if (directive == "local")
                add_declaration(text, DeclaredBy::local, i, i + 1, end_of_value(text, i + 1));
            if (directive == "macro") add_macro(text, i);
        }
    }
}

} // namespace

EditorText read_editor_text(std::string path, std::string written) {
    EditorText text;
    text.source.path = std::move(path);
    text.source.text = std::move(written);
    LexRange range;
    range.keep_numbers = false;
    text.tokens = lex(text.source, text.words, text.strings, range);
    if (text.tokens.empty() || kind_of(text.tokens.back()) != TokenKind::end) {
        StoredToken end;
        end.begin = static_cast<std::uint32_t>(text.source.text.size());
        text.tokens.push_back(end);
    }
    text.partners = pair_braces(text.tokens);
    text.lines.push_back(0);
    for (std::uint32_t i = 0; i < text.source.text.size(); ++i)
        if (text.source.text[i] == '\n') text.lines.push_back(i + 1);
    find_declarations(text);
    return text;
}

std::string_view token_text(const EditorText& text, std::uint32_t token) {
    const StoredToken& stored = text.tokens[token];
    return std::string_view(text.source.text).substr(stored.begin, stored.length);
}

std::uint32_t token_at(const EditorText& text, std::uint32_t offset) {
    const auto behind =
        std::upper_bound(text.tokens.begin(), text.tokens.end(), offset,
                         [](std::uint32_t at, const StoredToken& token) { return at < token.begin; });
    if (behind == text.tokens.begin()) return no_token;
    const auto token = static_cast<std::uint32_t>(behind - text.tokens.begin() - 1);
    const auto ends_in = [&](std::uint32_t i) {
        return end_of(text.tokens[i]) == offset &&
               (is_word(text.tokens[i]) || !directive_name(text, i).empty());
    };
    if (offset < end_of(text.tokens[token]) || ends_in(token)) return token;
    return token > 0 && ends_in(token - 1) ? token - 1 : no_token;
}

std::string_view block_at(const EditorText& text, std::uint32_t offset) {
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < text.tokens.size() && text.tokens[i].begin < offset; ++i) {
        if (is_sign(text.tokens[i], '{')) open.push_back(i);
        if (is_sign(text.tokens[i], '}') && !open.empty()) open.pop_back();
    }
    if (open.empty() || open.back() == 0 || !is_word(text.tokens[open.back() - 1])) return {};
    return token_text(text, open.back() - 1);
}

std::string_view directive_name(const EditorText& text, std::uint32_t token) {
    const TokenKind kind = kind_of(text.tokens[token]);
    if (kind != TokenKind::directive && kind != TokenKind::invalid) return {};
    std::string_view written = token_text(text, token);
    if (written.empty() || written[0] != '#') return {};
    const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    written.remove_prefix(1);
    written.remove_prefix(
        static_cast<std::size_t>(std::find_if(written.begin(), written.end(), letter) - written.begin()));
    return written.substr(0, static_cast<std::size_t>(
                                 std::find_if_not(written.begin(), written.end(), letter) - written.begin()));
}

const Declaration* find_declaration(const EditorText& text, std::string_view name, std::uint32_t before) {
    const Declaration* found = nullptr;
    for (const Declaration& declaration : text.declarations) {
        if (declaration.name != name) continue;
        if (found != nullptr && text.tokens[declaration.token].begin > before) break;
        found = &declaration;
    }
    return found;
}

std::vector<Statement> statements(const EditorText& text) {
    std::vector<Statement> found;
    std::size_t declaration = 0;
    for (std::uint32_t i = 0; i + 1 < text.tokens.size(); ++i) {
        const StoredToken& token = text.tokens[i];
        while (declaration < text.declarations.size() && text.declarations[declaration].end <= token.begin)
            ++declaration;
        const bool declared =
            declaration < text.declarations.size() && text.declarations[declaration].begin <= token.begin;
        if (!is_sign(text.tokens[i + 1], '{') || !is_word(token)) {
            if (is_sign(token, '{') && text.partners[i] != no_token) i = text.partners[i];
            continue;
        }
        const std::uint32_t partner = text.partners[i + 1];
        const StoredToken& last =
            partner == no_token ? text.tokens[text.tokens.size() - 1] : text.tokens[partner];
        if (!declared) found.push_back({i, end_of(last)});
        if (partner == no_token) break;
        i = partner;
    }
    return found;
}

std::vector<WrittenColor> written_colors(const EditorText& text) {
    static constexpr std::string_view words[] = {"rgb",  "rgbf",  "rgbt",  "rgbft",
                                                 "srgb", "srgbf", "srgbt", "srgbft"};
    std::vector<WrittenColor> found;
    const auto number = [&](std::uint32_t i) { return kind_of(text.tokens[i]) == TokenKind::number; };
    for (std::uint32_t i = 0; i + 1 < text.tokens.size(); ++i) {
        if (!is_word(text.tokens[i])) continue;
        const std::string_view word = token_text(text, i);
        if (std::find(std::begin(words), std::end(words), word) == std::end(words)) continue;
        WrittenColor color{text.tokens[i].begin, 0, word, {}};
        std::uint32_t at = i + 1;
        if (number(at)) {
            color.numbers.push_back(text.tokens[at].number);
            // Not the first operand of a sum.
            const StoredToken& next = text.tokens[at + 1];
            if (kind_of(next) == TokenKind::punctuation &&
                std::string_view("+-*/").find(static_cast<char>(next.name.symbol)) != std::string_view::npos)
                continue;
            color.end = end_of(text.tokens[at]);
        } else if (is_sign(text.tokens[at], '<')) {
            for (++at; number(at); ++at) {
                color.numbers.push_back(text.tokens[at].number);
                if (is_sign(text.tokens[at + 1], ',')) ++at;
            }
            if (!is_sign(text.tokens[at], '>') || color.numbers.size() < 3 || color.numbers.size() > 5)
                continue;
            color.end = end_of(text.tokens[at]);
        } else {
            continue;
        }
        found.push_back(std::move(color));
    }
    return found;
}

} // namespace pnr
