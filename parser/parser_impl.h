// SPDX-License-Identifier: GPL-3.0-or-later
// The inline half of parser.h: what is called for every token, and the templates. Include parser.h, not this.
#pragma once

#include "parser/expander.h"
#include "parser/parser.h"

namespace pnr {

inline const Token& peek(Parser& p) {
    if (!p.in.buffered) fill_buffer(p);
    return p.in.buffer;
}

inline Token next(Parser& p) {
    const Token token = peek(p);
    if (token.kind == TokenKind::end) return token; // the end is never taken
    p.in.buffered = false;
    ++p.in.tokens_taken;
    if (token.kind == TokenKind::word)
        tell(p.in, p.in.words.hashes[token.symbol]);
    else if (token.kind != TokenKind::number && token.kind != TokenKind::string) // their values are told
        tell(p.in, std::uint64_t{token.symbol} << 8 | static_cast<unsigned>(token.kind));
    if (token.kind == TokenKind::punctuation) {
        if (token.symbol == '{')
            ++p.in.brace_depth;
        else if (token.symbol == '}')
            --p.in.brace_depth;
    }
    return token;
}

inline bool is(const Token& token, char punctuation) {
    return token.kind == TokenKind::punctuation && token.symbol == static_cast<Symbol>(punctuation);
}
inline bool is(const Token& token, Keyword keyword) {
    return token.kind == TokenKind::word && token.symbol == static_cast<Symbol>(keyword);
}
// For `switch (keyword_of(token))`: the word's keyword; for any other token a number that no keyword has.
inline Keyword keyword_of(const Token& token) {
    return token.kind == TokenKind::word ? static_cast<Keyword>(token.symbol)
                                         : static_cast<Keyword>(~Symbol{0});
}
inline bool at(Parser& p, Keyword keyword) { return is(peek(p), keyword); }
inline bool at(Parser& p, char punctuation) { return is(peek(p), punctuation); }
inline bool at_end(Parser& p) { return peek(p).kind == TokenKind::end; }
inline bool accept(Parser& p, Keyword keyword) { return at(p, keyword) && (next(p), true); }
inline bool accept(Parser& p, char punctuation) { return at(p, punctuation) && (next(p), true); }

template <class F>
void block(Parser& p, std::string_view what, F item) {
    open_block(p, what);
    const std::size_t level = open_blocks(p);
    try {
        while (!close_block(p)) {
            const auto taken = p.in.tokens_taken;
            item();
            if (p.in.tokens_taken == taken) unexpected(p, what, {});
        }
    } catch (const ParseFailure&) {
        recover_block(p, level);
    }
}

template <class T>
const T* accept_declared(Parser& p) {
    const Token& token = peek(p);
    if (token.kind != TokenKind::word) return nullptr;
    const Value* value = lookup(p.in, token.symbol);
    if (!value) return nullptr;
    if (const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value->data)) {
        const DeclaredBlock* sample = first_block(**array);
        if (!sample || !std::holds_alternative<T>(*sample)) return nullptr;
        const Token name = token;
        const Value& element = take_variable(p);
        const auto* held = std::get_if<std::shared_ptr<const DeclaredBlock>>(&element.data);
        const T* content = held ? std::get_if<T>(held->get()) : nullptr;
        if (!content) fail(p, name, std::string("this element is ") + article_name(element));
        tell_thing(p.in, held->get());
        return content;
    }
    const auto* held = std::get_if<std::shared_ptr<const DeclaredBlock>>(&value->data);
    const T* content = held ? std::get_if<T>(held->get()) : nullptr;
    if (!content) return nullptr;
    next(p);
    tell_thing(p.in, held->get());
    return content;
}

} // namespace pnr
