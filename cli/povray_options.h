// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's way of saying options, put into ours before the command line is read.
#pragma once

#include <string>
#include <vector>

namespace pnr {

// anim.ini or anim.ini[section] stands for what the file says (ini_file.h).
// +W640 +H480 +Iscene.pov +Oout.png +Lfolder +Q9 +A0.3 +WT2 ..., and Width=640, Declare=N=V and the like.
// `-D` alone or before another option is POV-Ray's (no display) and dropped, as are those of its options that
// mean nothing here. A command line that starts with such an option means `render`. Throws UsageError for an
// option that POV-Ray has and this program lacks.
std::vector<std::string> from_povray_options(std::vector<std::string> arguments);

} // namespace pnr
