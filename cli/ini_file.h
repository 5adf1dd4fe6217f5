// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's .ini files.
#pragma once

#include <string>
#include <vector>

namespace pnr {

bool is_ini(const std::string& argument); // anim.ini or anim.ini[section]

// The settings `Name=Value` and switches `+W640` of the file, in their order: those before the first section, and
// those of the section named. A switch's line may hold several. Throws FileError, and UsageError for a section that
// the file lacks.
std::vector<std::string> read_ini(const std::string& argument);

} // namespace pnr
