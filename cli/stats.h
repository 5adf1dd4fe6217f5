// SPDX-License-Identifier: GPL-3.0-or-later
// What --stats writes (design: the file contract): every key always there.
#pragma once

#include "cli/forecast.h"
#include "cli/pipeline.h"

#include <string>
#include <vector>

namespace pnr {

// JSON text, ending in a newline.
std::string stats_json(const Scene& scene, const Rendering& r, const std::vector<PassTime>& times,
                       const std::vector<std::string>& warnings);

// `used` and `left_out` of a plan and what is foretold, as text or as JSON.
std::string plan_text(const Plan& plan, const Forecast& forecast);
std::string plan_json(const Plan& plan, const Forecast& forecast);

} // namespace pnr
