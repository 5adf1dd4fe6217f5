// SPDX-License-Identifier: GPL-3.0-or-later
// Long lists of plain numbers, as in the text of a mesh, are read straight from the text: the lexer keeps them as
// one `numbers` token. A reader that knows what it wants takes that token's text; for all others the expander cuts
// it into tokens, so that nobody need know.
#pragma once

#include "core/types.h"
#include "parser/parser.h"

#include <optional>
#include <string_view>

namespace pnr {

// The text of the list if a `numbers` token is next; nothing is taken.
std::optional<std::string_view> peek_number_list(Parser& p);
void take_number_list(Parser& p); // passes the token that peek_number_list saw

// Reads a list's text from its front. Every function gives false where the text is anything but what it asks for,
// also if a number is too large: then the list is to be read token by token, which says what is wrong.
struct NumberCursor {
    const char* at;
    const char* end;
    explicit NumberCursor(std::string_view text) : at(text.data()), end(text.data() + text.size()) {}
};
bool read_number(NumberCursor& cursor, double& number);   // with a sign or not
bool read_vector(NumberCursor& cursor, int size, double* numbers); // <a, b ...>, commas asked for
void skip_comma(NumberCursor& cursor);                    // if there is one
bool at_list_end(NumberCursor& cursor);                   // behind spaces

} // namespace pnr
