// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene may use up, so that none can hang the program or exhaust the machine. Beyond: an error that says
// where, and how to allow more.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pnr {

struct Budgets {
    std::int64_t loop_turns = 20'000'000; // of #while and #for together
    std::int64_t macro_calls = 10'000'000;
    std::int64_t macro_depth = 300;
    std::int64_t include_depth = 64;
    std::int64_t nesting = 400;           // braces and parentheses; more need more stack
    std::int64_t tokens = 100'000'000;    // read after expansion, and work that is counted like them
    std::int64_t bytes = 900'000'000;     // of texts, tokens, objects, meshes, arrays and strings
    std::int64_t array_elements = 4'000'000; // of one array
    std::int64_t string_length = 1'000'000;
    std::int64_t file_bytes = 500'000'000; // of one text
    std::int64_t debug_output = 16'000'000; // bytes of #debug text that are kept
    std::int64_t errors = 50, warnings = 200; // reported in one run
    std::int64_t failures = 20'000; // places that could not be read, also those that are not reported again
    std::int64_t pixels = 100'000'000;
    std::int64_t photons = 50'000'000; // emitted in a pass
};

// A budget as the command line knows it: `--limit NAME=VALUE`.
struct Limit {
    std::string_view name, text;
    std::int64_t Budgets::*value;
};
std::span<const Limit> limits();

// `NAME=VALUE`, the value with k, M or G behind it or not. What is wrong with it, or "".
std::string set_limit(Budgets& budgets, std::string_view said);
std::string limits_help(const Budgets& budgets); // a table, for `--limit help`
// The hint of an error about this budget: "--limit loop-turns=40000000 allows more".
std::string limit_help(const Budgets& budgets, std::int64_t Budgets::*value);

} // namespace pnr
