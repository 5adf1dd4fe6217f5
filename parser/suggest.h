// SPDX-License-Identifier: GPL-3.0-or-later
// What an author probably meant: the help behind an error.
#pragma once

#include "parser/parser.h"

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// "did you mean `x`?" for the nearest of the words; empty if none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& candidates);

// For a name without a value where a value is expected: the nearest declared one, or a function if a `(` follows.
std::string help_for_unknown_name(Parser& p, const Token& name);

// For a token that cannot stand in the block `inside`, of whose words `allowed` are some.
std::string help_for_unexpected(Parser& p, const Token& token, std::string_view inside,
                                std::initializer_list<Keyword> allowed);

// For a missing number: how the block's items stand, e.g. "sphere { <centre>, radius ... }"; empty: no hint.
std::string help_for_missing_value(Parser& p, const Token& found);

std::string syntax_of(std::string_view block); // "sphere { <centre>, radius ... }"; the block's word if unknown

// How a declared value of this kind is used: "pigment { Name }"; empty: no hint.
std::string usage_of(const Value& value, std::string_view name);

} // namespace pnr
