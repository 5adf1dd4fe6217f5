// SPDX-License-Identifier: GPL-3.0-or-later
// The options of the commands that stand apart from rendering; options.cpp puts them into the program's.
#pragma once

#include "cli/options.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pnr {

// --tev, whose place may be left out; finish_tev sets what was meant, and gives `scene` what is no place.
void add_tev(CLI::App& app, std::optional<std::string>& place);
void finish_tev(Options& options, const std::optional<std::string>& place, std::string& scene);
// --no-cache, of commands that render.
void add_cache(CLI::App& app, Options& options);

// --html of `render`.
void add_render_page(CLI::App& app, Options& options);
void add_fmt(CLI::App& parent, Options& options);
void add_init(CLI::App& parent, Options& options);
void add_lsp(CLI::App& parent, Options& options);

// `completions` and `man`: texts about the command line itself. `shell` is what was asked for.
void add_shell_files(CLI::App& parent, std::string& shell);
// The text of one of them; empty: the command is another one. From an app that has parsed nothing.
std::string shell_file(const CLI::App& app, const std::string& command, const std::string& shell);

} // namespace pnr
