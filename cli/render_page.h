// SPDX-License-Identifier: GPL-3.0-or-later
// One rendering as a page that needs nothing else: what `pnr render --html` writes.
#pragma once

#include "cli/pipeline.h"

#include <string>
#include <vector>

namespace pnr {

// The picture; each pass' time and memory and what the structures weigh; maps of what lies behind it, as far
// as the scene needed them; the error's estimate of a progressive run; the plan; the warnings. Throws
// FileError where the image library is missing.
std::string render_page(const Scene& scene, const Rendering& r, const std::vector<PassTime>& times,
                        const std::vector<std::string>& warnings);

} // namespace pnr
