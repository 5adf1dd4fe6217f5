// SPDX-License-Identifier: GPL-3.0-or-later
// The manual of the language's words: grammar/manual.txt and grammar/pnr.ebnf, embedded by the build.
#pragma once

#include "parser/library.h"

#include <string>
#include <string_view>
#include <vector>

namespace pnr {

const std::vector<EmbeddedFile>& embedded_manual(); // "manual.txt", "pnr.ebnf"; written by the build (embed.cmake)

struct ManualEntry {
    std::vector<std::string_view> names;
    std::string text;    // lines, each with its end
    std::string example; // likewise; a scene that loads
    std::string_view part; // the heading it stands under
};
const std::vector<ManualEntry>& manual_entries(); // in the file's order

// The entry of a word, `#declare` as well as `declare`; null: there is none.
const ManualEntry* find_manual_entry(std::string_view word);

// The rules of the grammar that have this word in quotes or bear its name, as they are written; empty: none.
std::vector<std::string> grammar_rules(std::string_view word);
std::vector<std::string> grammar_rules(); // all of them, in the file's order

// What `pnr help WORD` says, with the lessons of the course that use it; empty for a word that has no entry.
std::string manual_text(std::string_view word);
// "; did you mean `x`?" for a word that has none; empty if no word is near.
std::string near_manual_word(std::string_view word);
std::string manual_markdown(); // the whole, as grammar/manual.md has it

} // namespace pnr
