// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the grammar of grammar/pnr.ebnf and makes random sentences of it.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace pnr::test {

struct Node {
    enum class Kind { sequence, choice, optional, repeated, at_least_once, times, terminal, rule, special };
    Kind kind = Kind::sequence;
    std::string text;           // terminal, rule, special
    int count = 0;              // times
    std::vector<Node> children; // sequence, choice; else at most one
};

struct Grammar {
    std::vector<std::string> order; // of the rules
    std::map<std::string, Node> rules;
};
// Throws std::runtime_error with the place of what is no EBNF.
Grammar read_grammar(std::string_view text);

// What a rule is replaced by, e.g. `float` by a number; and the name that an IDENTIFIER in a rule is, by the rule's
// name: one that is not listed cannot be chosen.
struct Writer {
    std::map<std::string, std::vector<std::string>> literals;
    std::map<std::string, std::string> names;
    std::vector<std::string> directives = {"#if (1) #end", "#ifdef (Nothing) { #else #end",
                                           "#declare Mark = 1;"}; // that stand between some tokens
};

// A random sentence of a rule, its tokens apart by spaces.
std::string sentence(const Grammar& grammar, const Writer& writer, const std::string& rule, std::mt19937& random);

} // namespace pnr::test
