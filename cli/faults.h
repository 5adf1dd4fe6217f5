// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that no picture can show, told to the author of the scene.
#pragma once

#include "cli/pipeline.h"

#include <string>
#include <vector>

namespace pnr {

// What went wrong on one object; number 0: on none, as in the sky.
struct ObjectFaults {
    std::uint32_t object = 0;
    SampleFaults faults;
    int x = 0, y = 0; // the first pixel of them in the order of rows
};
// The object with the most first.
std::vector<ObjectFaults> faults_by_object(const Rendering& r);

// Nothing if all went well; else how many of each kind there are, and a line each for the three worst objects
// with their place in the scene's text.
std::vector<std::string> fault_warnings(const Rendering& r);

} // namespace pnr
