// SPDX-License-Identifier: GPL-3.0-or-later
// Scene functions as programs without calls and stack, which can be run over intervals.
#pragma once

#include "core/field_program.h"
#include "parser/function.h"

namespace pnr {

// Arguments are x, y, z of the field; a function of fewer ignores the rest. The function must not be
// unsupported. Equal steps are done once, constant ones now.
FieldProgram field_program(const std::shared_ptr<const Function>& function);

} // namespace pnr
