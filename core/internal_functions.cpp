// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/internal_functions.h"

#include <array>

namespace pnr {

namespace {

constexpr std::array<InternalFunction, 79> table{};

} // namespace

std::span<const InternalFunction> internal_functions() { return table; }

} // namespace pnr
