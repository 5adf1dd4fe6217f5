// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/help_command.h"

#include "cli/options.h"
#include "parser/manual.h"

#include <fmt/format.h>

namespace pnr {

std::string help_for_word(const std::string& word, const std::string& commands) {
    std::string text = manual_text(word);
    if (!text.empty()) return text;
    const std::string hint = commands.empty() ? near_manual_word(word) : commands;
    throw UsageError(fmt::format("`{}` is neither a command nor a word of the language{}", word, hint));
}

std::string whole_manual() { return manual_markdown(); }

} // namespace pnr
