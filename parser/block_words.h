// SPDX-License-Identifier: GPL-3.0-or-later
// Which words may stand where, read from grammar/pnr.ebnf: what an editor offers.
#pragma once

#include <string_view>
#include <vector>

namespace pnr {

// The words that may stand directly in the block that this word opens, in the grammar's order; empty: no such
// block.
// "" is the scene itself. Of blocks that bear one name in several places, the words of all.
std::vector<std::string_view> block_words(std::string_view block);

std::vector<std::string_view> value_words();     // functions and constants of expressions
std::vector<std::string_view> directive_words(); // without their #

} // namespace pnr
