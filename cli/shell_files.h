// SPDX-License-Identifier: GPL-3.0-or-later
// What a system wants to know of a command line: completions for shells, the manual page. Made from the
// command line's own description, so that they cannot say anything else.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace pnr {

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);
std::string man_page(const CLI::App& app, const std::string& version); // troff, for man(1)

} // namespace pnr
