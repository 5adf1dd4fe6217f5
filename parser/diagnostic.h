// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that teach: what is wrong, where, and what was probably meant.
#pragma once

#include "parser/source.h"

#include <string>
#include <string_view>
#include <vector>

namespace pnr {

enum class Severity { error, warning, note };

struct Note {
    Span span;
    std::string text; // "`{` opened here", "in macro `Tree`, called here"
};

struct Diagnostic {
    Severity severity = Severity::error;
    Span span;
    std::string message; // lower case, no full stop, stands alone; code in backticks
    std::vector<Note> notes;
    std::string help; // e.g. "did you mean `sphere`?"; may be empty
};

// `path:line:col: error: text`, the source line, a caret and underline, then notes and help in the same form.
// ANSI colour only when asked for.
std::string format(const Diagnostic& diagnostic, const Sources& sources, bool color);
std::string format_json(const std::vector<Diagnostic>& diagnostics, const Sources& sources);

// The nearest of the candidates by edit distance (at most a third of the word's length), or "".
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& candidates);

} // namespace pnr
