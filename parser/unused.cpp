// SPDX-License-Identifier: GPL-3.0-or-later
// What the author's own file declares and never names again.
#include "parser/blocks.h"

#include <fmt/format.h>

#include <unordered_map>

namespace pnr {

namespace {

struct Declared {
    std::uint32_t token = 0; // of the name, the first time
    bool is_macro = false;
};

bool is_word(const StoredToken& token, Keyword keyword) {
    return kind_of(token) == TokenKind::word && token.name.symbol == static_cast<Symbol>(keyword);
}

// The index of the name that a directive declares; 0: it declares none.
std::uint32_t declared_name(const std::vector<StoredToken>& tokens, std::uint32_t directive) {
    if (kind_of(tokens[directive]) != TokenKind::directive) return 0;
    switch (static_cast<Keyword>(tokens[directive].name.symbol)) {
    case "declare"_kw:
    case "local"_kw:
    case "macro"_kw:
        break;
    default:
        return 0;
    }
    std::uint32_t at = directive + 1;
    if (is_word(tokens[at], "deprecated"_kw)) ++at;
    if (is_word(tokens[at], "once"_kw)) ++at;
    if (kind_of(tokens[at]) == TokenKind::string) ++at;
    return kind_of(tokens[at]) == TokenKind::word ? at : 0;
}

} // namespace

void warn_unused(Parser& p) {
    constexpr std::size_t too_long = 2'000'000; // made by a program: nobody reads its warnings
    if (p.in.errors > 0 || p.in.texts.empty() || p.scene.file.ends_with(".inc")) return;
    const std::uint32_t main = p.in.main_source;
    const std::vector<StoredToken>& tokens = p.in.texts[main];
    if (tokens.size() > too_long) return;
    std::unordered_map<Symbol, Declared> declared;
    std::unordered_map<Symbol, int> others;
    std::vector<bool> is_declaration(tokens.size());
    for (std::uint32_t i = 0; i + 1 < tokens.size(); ++i) {
        const std::uint32_t name = declared_name(tokens, i);
        if (name == 0) continue;
        is_declaration[name] = true;
        // An element of an array, or a macro: both are the name's use as well when it was declared before.
        declared.try_emplace(tokens[name].name.symbol,
                             Declared{name, static_cast<Keyword>(tokens[i].name.symbol) == "macro"_kw});
    }
    for (const auto& text : p.in.texts)
        for (std::size_t i = 0; i < text.size(); ++i)
            if (kind_of(text[i]) == TokenKind::word && !(&text == &tokens && is_declaration[i]))
                ++others[text[i].name.symbol];
    for (std::uint32_t i = 0; i < tokens.size(); ++i) {
        if (!is_declaration[i]) continue;
        const Symbol symbol = tokens[i].name.symbol;
        const Declared& name = declared[symbol];
        if (name.token != i || others.contains(symbol)) continue;
        warn(p, unpack(tokens[i], main, 0),
             name.is_macro ? fmt::format("macro `{}` is never called", p.in.words.text(symbol))
                           : fmt::format("`{}` is declared but never used", p.in.words.text(symbol)));
    }
}

} // namespace pnr
