// SPDX-License-Identifier: GPL-3.0-or-later
// Tokens: made once per file by the lexer, replayed by the expander.
#pragma once

#include "parser/source.h"

#include <cstdint>

namespace pnr {

// An interned word. Keywords come first (keywords.h), identifiers after them.
using Symbol = std::uint32_t;

enum class TokenKind : std::uint8_t {
    end,         // of the input, or of the expression a directive asked for
    number,      // value
    string,      // text: index into the lexer's string table
    word,        // symbol: keyword or identifier
    directive,   // `#name`; symbol is the name's keyword, value the token to jump to. Never leaves the
                 // expander.
    punctuation, // symbol holds the character, or two of them (first | second << 8) for <= >= !=
    numbers, // a long list of plain numbers (number_run.h): the text of the span. Only mesh2's parser meets it.
    invalid, // cannot be read; symbol: index of the message in the string table. Never leaves the expander.
};

struct Token {
    TokenKind kind = TokenKind::end;
    Symbol symbol = 0;
    double value = 0;
    Span span;
    std::uint32_t chain =
        0; // the macro calls and includes it came through: index into the expander's table; 0: none
};

} // namespace pnr
