// SPDX-License-Identifier: GPL-3.0-or-later
// Text to tokens, once per text: words interned, numbers converted, directives paired with their #else and
// #end, so that running them later is a matter of indices.
#pragma once

#include "parser/diagnostic.h"
#include "parser/keywords.h"
#include "parser/token.h"

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// The interned words: keywords first, under their own numbers.
struct Words {
    std::deque<std::string> texts;    // by symbol
    std::vector<std::uint64_t> hashes; // of the texts; the same in every run
    std::vector<std::uint32_t> table; // open addressing, symbol + 1; 0: free. A power of two long.

    Words();
    Symbol intern(std::string_view word);
    std::string_view text(Symbol symbol) const { return texts[symbol]; }
};

// Directive tokens carry in `jump` the index of a token in the same text:
//  #if #ifdef #ifndef #elseif #switch #case #range #else: the next branch or the #end of the same construct;
//  #while #for #macro: their #end;   #break: the #end of the loop or switch around it;   #end: its opener.
// `no_jump`: there is none (an error when the directive runs).
inline constexpr std::uint32_t no_jump = ~std::uint32_t{0};
bool is_opener(Keyword directive); // needs an #end

// The tokens of a text, or of its bytes from `begin` to `end`, closed by an `end` token; those that
// the memory of `most` tokens holds, then an `invalid` one says so and ends them. Strings go to `strings`, without quotes and with escapes undone. What
// cannot be read becomes an `invalid` token, an error only if it is reached. `keep_numbers`: lists of numbers may
// become one `numbers` token.
struct LexRange {
    std::uint32_t begin = 0, end = ~std::uint32_t{0};
    bool keep_numbers = true;
    std::int64_t most = std::int64_t{1} << 31;
};
std::vector<StoredToken> lex(const SourceText& source, Words& words, std::vector<std::string>& strings,
                             const LexRange& range);

std::string utf8(unsigned code); // of a character below 65536

} // namespace pnr
