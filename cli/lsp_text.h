// SPDX-License-Identifier: GPL-3.0-or-later
// A scene text as an editor asks about it: its tokens, the names that it declares, its blocks.
#pragma once

#include "parser/lexer.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

inline constexpr std::uint32_t no_token = ~std::uint32_t{0};

enum class DeclaredBy { declare, local, macro, loop, parameter }; // a parameter of the macro before it

struct Declaration {
    std::string name;
    DeclaredBy how;
    std::uint32_t token = 0; // of the name
    std::uint32_t begin = 0; // bytes: all that belongs to it, from its # ...
    std::uint32_t end = 0;   // ... to the end of its value or body
    std::string value_word;  // "sphere" of #declare Ball = sphere { ... }; may be empty
};

// Reading it never fails, whatever the text: what cannot be read is passed over.
struct EditorText {
    SourceText source; // its path as the parser shows it
    Words words;
    std::vector<std::string> strings;
    std::vector<StoredToken> tokens;     // the last one is `end`
    std::vector<std::uint32_t> partners; // by token: of a brace its other one, or no_token
    std::vector<std::uint32_t> lines;    // first byte of each
    std::vector<Declaration> declarations;
};
EditorText read_editor_text(std::string path, std::string text);

std::string_view token_text(const EditorText& text, std::uint32_t token);
// The token that holds this byte, or ends right before it if it is a word; no_token: none.
std::uint32_t token_at(const EditorText& text, std::uint32_t offset);
// The word before the innermost brace that is open at this byte: "sphere"; "": none is open.
std::string_view block_at(const EditorText& text, std::uint32_t offset);
// "declare" of `#declare`; empty if the token is no directive. Also of one that never ends.
std::string_view directive_name(const EditorText& text, std::uint32_t token);
// The last declaration of the name before this byte, else the first behind it; null: none.
const Declaration* find_declaration(const EditorText& text, std::string_view name, std::uint32_t before);

// A statement of the scene that is an object, a light and the like, outside of declarations.
struct Statement {
    std::uint32_t token = 0, end = 0; // its word; the byte behind its closing brace
};
std::vector<Statement> statements(const EditorText& text);

// A colour whose numbers are written out: `rgb <1, 0.5, 0>`, `srgbt <...>`, `rgb 1`.
struct WrittenColor {
    std::uint32_t begin = 0, end = 0; // bytes
    std::string_view word;            // "rgb"
    std::vector<double> numbers;      // one or as many as the word wants, or fewer
};
std::vector<WrittenColor> written_colors(const EditorText& text);

} // namespace pnr
