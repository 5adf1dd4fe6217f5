// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/faults.h"

#include <fmt/format.h>

#include <algorithm>

namespace pnr {

std::vector<ObjectFaults> faults_by_object(const Rendering& r) {
    std::vector<ObjectFaults> all;
    for (const FaultPlace& place : r.fault_places) {
        auto known = std::find_if(all.begin(), all.end(),
                                  [&](const ObjectFaults& o) { return o.object == place.object; });
        if (known == all.end()) known = all.insert(all.end(), {place.object, {}, place.x, place.y});
        known->faults += place.faults;
    }
    std::stable_sort(all.begin(), all.end(), [](const ObjectFaults& a, const ObjectFaults& b) {
        return a.faults.sum() > b.faults.sum();
    });
    return all;
}

std::vector<std::string> fault_warnings(const Rendering& r) {
    const SampleFaults& faults = r.faults;
    if (faults.sum() == 0) return {};
    std::vector<std::string> lines{fmt::format(
        "samples that no picture can show were left out: {} not a number, {} infinite, {} negative; "
        "`--aov numbers` shows where",
        faults.nan, faults.inf, faults.negative)};
    constexpr std::size_t most_said = 3;
    const std::vector<ObjectFaults> all = faults_by_object(r);
    for (std::size_t i = 0; i < std::min(most_said, all.size()); ++i) {
        const WorldObject& object = r.world.objects[all[i].object];
        const std::string where =
            all[i].object == 0 ? std::string("no object")
                               : fmt::format("object {}, `{}` at {}:{}:{}", all[i].object, object.name,
                                             object.said_at.file, object.said_at.line, object.said_at.column);
        lines.push_back(fmt::format("{} of them on {}, first at pixel {},{}", all[i].faults.sum(), where,
                                    all[i].x, all[i].y));
    }
    return lines;
}

} // namespace pnr
