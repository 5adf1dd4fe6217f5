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
    directive,   // `#name`; symbol is the name's keyword, value the token to jump to (lexer.h). Never
                 // leaves the expander.
    punctuation, // symbol holds the character, or two of them (first | second << 8) for <= >= !=
    invalid, // cannot be read; symbol: index of the message in the string table; jump 0: reading ends here; 1: a warning.
             // Never leaves the expander.
    numbers, // a long list of plain numbers and vectors, not cut into tokens yet (number_list.h). Never
             // leaves the expander.
};

// A token as its text keeps it, in 16 bytes: a large scene has tens of millions.
struct StoredToken {
    struct Name {
        Symbol symbol;
        std::uint32_t jump; // of directives; see lexer.h
    };
    union {
        double number; // TokenKind::number
        Name name;     // all others
    };
    std::uint32_t begin = 0;      // first byte in the text
    std::uint32_t kind : 4 = 0;   // TokenKind
    std::uint32_t length : 28 = 0; // in bytes

    StoredToken() : name{0, 0} {}
};
static_assert(sizeof(StoredToken) == 16);

struct Token {
    TokenKind kind = TokenKind::end;
    Symbol symbol = 0;
    double value = 0;
    Span span;
    std::uint32_t chain =
        0; // the macro calls and includes it came through: index into the expander's table; 0: none
};

} // namespace pnr
