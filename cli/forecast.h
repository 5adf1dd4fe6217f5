// SPDX-License-Identifier: GPL-3.0-or-later
// What a rendering will take: memory and time of each pass, before it is done.
//
// The scene is rendered for real, but small: fewer pixels and fewer photons through the same passes. What
// that takes is scaled up by laws that were measured (forecast.cpp). So costs that no count of shapes
// foretells are in it: an isosurface's function, glass, a mirror full of paint.
#pragma once

#include "cli/pipeline.h"
#include "cli/structures.h"

#include <string>
#include <vector>

namespace pnr {

struct PassForecast {
    std::string name;       // as in pass_names(), one entry each
    double cpu_s = 0;       // all threads, on this machine
    double share = 0;       // of the sum
    double peak_rss_mb = 0; // of the process so far; 0 if the pass does not run
};

struct Forecast {
    std::vector<PassForecast> passes;
    std::vector<StructureSize> structures;
    int width = 0, height = 0;                   // of the picture foretold ...
    int small_width = 0;                         // ... and of the one that was rendered for that
    std::int64_t photons = 0, small_photons = 0; // emitted, without those aimed at what throws caustics
};

// Of a rendering in one go (no --time, --error or --passes) with all photons traced anew. `world` and
// `times`: of `parse` and `build`, which have been done. Throws SceneError and UsageError as render_scene
// does.
Forecast forecast(World world, const Settings& settings, const Plan& plan,
                  const std::vector<PassTime>& times);

} // namespace pnr
