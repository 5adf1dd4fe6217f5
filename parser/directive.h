// SPDX-License-Identifier: GPL-3.0-or-later
// The directives' vocabulary, shared by directive.cpp (flow) and directive_declare.cpp (names).
#pragma once

#include "parser/parser.h"

namespace pnr {

// Sets the hold for an expression that starts at the frame's position; gives the old one back.
struct HoldScope {
    Expander& in;
    Hold before;
    explicit HoldScope(Parser& p) : in(p.in), before(p.in.hold) {
        in.hold = {in.frames.size(), in.frames.back().position};
    }
    ~HoldScope() { in.hold = before; }
    HoldScope(const HoldScope&) = delete;
    HoldScope& operator=(const HoldScope&) = delete;
};

// The directive as messages show it: "#while".
std::string directive_name(Parser& p, const Token& directive);
Token expect_raw(Parser& p, char punctuation, const Token& directive);
void accept_semicolon(Parser& p); // without running what stands behind

void declare_directive(Parser& p, const Token& directive, bool local);
void undef_directive(Parser& p, const Token& directive);
void macro_directive(Parser& p, const Token& directive);
void fopen_directive(Parser& p, const Token& directive); // directive_file.cpp
void fclose_directive(Parser& p, const Token& directive);
void read_directive(Parser& p, const Token& directive);
void write_directive(Parser& p, const Token& directive);
bool ifdef_condition(Parser& p, const Token& directive); // `(NAME)` or `(NAME[i])`

} // namespace pnr
