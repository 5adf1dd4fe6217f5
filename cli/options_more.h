// SPDX-License-Identifier: GPL-3.0-or-later
// The options of the commands that stand apart from rendering; options.cpp puts them into the program's.
#pragma once

#include "cli/options.h"

namespace CLI {
class App;
}

namespace pnr {

void add_fmt(CLI::App& parent, Options& options);
void add_lsp(CLI::App& parent, Options& options);

} // namespace pnr
