// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr plan --graph FILE.svg`: the passes and structures of a rendering as a drawing.
#pragma once

#include "cli/forecast.h"

#include <string>

namespace pnr {

// An SVG picture: a box for each pass and structure, with what it is foretold to take, and arrows to those
// that need it. What the plan leaves out is grey and dashed and says why.
std::string plan_graph(const Plan& plan, const Forecast& forecast);

} // namespace pnr
