// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/limits.h"

#include "parser/diagnostic.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <vector>

namespace pnr {

namespace {

constexpr Limit all_limits[] = {
    {"loop-turns", "turns of #while and #for together, and of sum() and prod()", &Budgets::loop_turns},
    {"macro-calls", "calls of macros", &Budgets::macro_calls},
    {"macro-depth", "macros inside macros; very deep ones need a larger stack", &Budgets::macro_depth},
    {"include-depth", "files that include files", &Budgets::include_depth},
    {"nesting", "braces and parentheses inside each other; very deep ones need a larger stack",
     &Budgets::nesting},
    {"tokens", "words, numbers and signs read, loops and macros counted each time they run", &Budgets::tokens},
    {"memory", "bytes of the scene's texts, objects, meshes, arrays and strings", &Budgets::bytes},
    {"array", "elements of an array", &Budgets::array_elements},
    {"string", "characters of a string", &Budgets::string_length},
    {"file", "bytes of one text", &Budgets::file_bytes},
    {"debug", "bytes of #debug text that are shown", &Budgets::debug_output},
    {"errors", "errors that are reported", &Budgets::errors},
    {"warnings", "warnings that are reported", &Budgets::warnings},
    {"failures", "places that cannot be read, repeated ones too", &Budgets::failures},
    {"pixels", "pixels of a picture", &Budgets::pixels},
    {"photons", "photons emitted in a pass", &Budgets::photons},
};

} // namespace

std::span<const Limit> limits() { return all_limits; }

std::string set_limit(Budgets& budgets, std::string_view said) {
    const std::size_t equals = said.find('=');
    if (equals == std::string_view::npos) return "a limit is said as NAME=VALUE";
    const std::string_view name = said.substr(0, equals);
    std::vector<std::string_view> names;
    for (const Limit& limit : all_limits) {
        names.push_back(limit.name);
        if (limit.name != name) continue;
        const std::string text(said.substr(equals + 1));
        char* end = nullptr;
        double value = std::strtod(text.c_str(), &end);
        const std::string_view unit(end);
        if (unit == "k" || unit == "K") value *= 1e3;
        if (unit == "M") value *= 1e6;
        if (unit == "G") value *= 1e9;
        const bool unit_known = unit.empty() || unit == "k" || unit == "K" || unit == "M" || unit == "G";
        if (end == text.c_str() || !unit_known || !(value >= 1 && value <= 1e15))
            return "a value from 1 to 1e15 is expected, e.g. 5000, 2e6 or 3G";
        budgets.*limit.value = static_cast<std::int64_t>(value);
        return {};
    }
    const std::string_view nearest = nearest_word(name, names);
    return fmt::format("there is no limit `{}`; {}", name,
                       nearest.empty() ? "`--limit help` lists them" : fmt::format("did you mean `{}`?", nearest));
}

std::string limits_help(const Budgets& budgets) {
    std::string text = "What a scene may use up; --limit NAME=VALUE changes one (5000, 2e6, 500k, 3G):\n";
    for (const Limit& limit : all_limits)
        text += fmt::format("  {:<14} {:>10}  {}\n", limit.name, budgets.*limit.value, limit.text);
    return text;
}

std::string limit_help(const Budgets& budgets, std::int64_t Budgets::*value) {
    for (const Limit& limit : all_limits)
        if (limit.value == value)
            return fmt::format("`--limit {}={}` allows more", limit.name, 2 * (budgets.*value));
    return {};
}

} // namespace pnr
