// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that POV-Ray builds in, `function { internal(N) }`, which functions.inc names f_sphere,
// f_helix1 ...
#pragma once

#include <span>
#include <string_view>

namespace pnr {

// arguments: x, y, z and the function's own. Pure; the result may be NaN or infinite where it has no value.
using InternalEvaluate = double (*)(const double* arguments);

struct InternalFunction {
    std::string_view name; // as functions.inc has it; empty: there is no function of this number
    int parameters = 3;    // x, y, z included
    InternalEvaluate evaluate = nullptr; // null: see name
};

// By POV-Ray's numbers, 0 to 78.
std::span<const InternalFunction> internal_functions();

} // namespace pnr
