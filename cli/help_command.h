// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr help WORD`: the language's words, beside the commands.
#pragma once

#include <string>

namespace pnr {

// What the manual says of the word. Throws UsageError with a hint if it has none; `commands` is that hint for the
// commands, "; did you mean `x`?" or empty.
std::string help_for_word(const std::string& word, const std::string& commands);

// `pnr help --manual`: the whole manual as Markdown.
std::string whole_manual();

} // namespace pnr
