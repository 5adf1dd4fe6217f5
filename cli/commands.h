// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of the program, one function each; they return the exit code.
#pragma once

#include "cli/options.h"

#include <string>
#include <vector>

namespace pnr {

// The whole program behind main(): reads the command line, runs the command, turns errors into messages and
// exit codes.
int run_program(const std::vector<std::string>& arguments);

int run_render(const Options& options);
int run_check(const Options& options);
int run_plan(const Options& options);
int run_pick(const Options& options);
int run_ilic(const Options& options);
int run_stability(const Options& options);
int run_converge(const Options& options);
int run_fmt(const Options& options);
int run_init(const Options& options);
int run_lsp(const Options& options);
int run_watch(const Options& options);
int run_show(const Options& options); // render --show

} // namespace pnr
