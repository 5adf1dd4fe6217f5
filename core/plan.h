// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene needs, and what is left out and why (design.md section 6).
#pragma once

#include "core/settings.h"
#include "core/world.h"

#include <string>
#include <vector>

namespace pnr {

struct LeftOut {
    std::string what, why;
};

struct Plan {
    bool photons = false, kdtree = false, normals = false; // pass 1, its tree, normals and ids in photons
    bool paint = false, rbf = false, ilic = false;         // pass 2 and its parts
    bool render_rays = true;                               // pass 3 casts rays
    bool caustic_map = false;
    std::vector<std::string> used;
    std::vector<LeftOut> left_out; // [] with --no-prune
};

// `maps`: --maps was given, so that intermediate data must exist.
Plan make_plan(const World& world, const Settings& settings, bool maps);

} // namespace pnr
