// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"
#include "cli/html_page.h"
#include "cli/report.h"
#include "cli/stability.h"
#include "core/atomic_file.h"
#include "core/parallel.h"
#include "parser/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pnr {

namespace {

using Group = std::pair<const char*, StabilityCases (*)()>;
constexpr std::array<Group, 7> groups{{{"paths", path_cases},
                                       {"fields", field_cases},
                                       {"roots", root_cases},
                                       {"rays", ray_cases},
                                       {"photons", photon_cases},
                                       {"sums", sum_cases},
                                       {"pictures", picture_cases}}};

void check_group(const std::string& word) {
    std::vector<std::string_view> names;
    std::string list;
    for (const Group& group : groups) {
        if (word == group.first) return;
        names.emplace_back(group.first);
        list += (list.empty() ? "" : ", ") + std::string(group.first);
    }
    const std::string_view near = nearest_word(word, names);
    throw UsageError(fmt::format("--group: there is no group `{}`{}; there are {}", word,
                                 near.empty() ? "" : fmt::format(" (did you mean `{}`?)", near), list));
}

StabilityCases run_groups(const std::vector<std::string>& wanted) {
    for (const std::string& word : wanted) check_group(word);
    StabilityCases all;
    for (const auto& [name, cases] : groups) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
        const StabilityCases found = cases();
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

HtmlTable as_table(const StabilityCases& cases) {
    HtmlTable table{{"group", "case", "what is measured", "bound", "measured", "verdict"}, {}, {}};
    for (const StabilityCase& c : cases) {
        table.rows.push_back({c.group, c.name, c.measured, fmt::format("{:.2g}", c.bound),
                              fmt::format("{:.2g}", c.value), holds(c) ? "holds" : "FAILS"});
        table.bad.push_back(!holds(c));
    }
    return table;
}

} // namespace

int run_stability(const Options& options) {
    const ThreadLimit limit(options.threads);
    const StabilityCases cases = run_groups(options.groups);
    const HtmlTable table = as_table(cases);
    const auto failed =
        std::count_if(cases.begin(), cases.end(), [](const StabilityCase& c) { return !holds(c); });
    const std::string sum =
        fmt::format("{} of {} cases hold\n", cases.size() - static_cast<std::size_t>(failed), cases.size());
    print_answer(table_text(table) + sum);
    if (!options.html.empty())
        write_file_atomically(options.html, html_page("pnr: stiff and extreme cases",
                                                      "<p>" + html_text(sum) + "</p>" + html_table(table)));
    return failed == 0 ? exit_done : exit_missed;
}

} // namespace pnr
