// SPDX-License-Identifier: GPL-3.0-or-later
// What patterns need before they can be evaluated: pictures and density files read, and the scene's own words
// where they say none.
#pragma once

#include "core/density_grid.h"
#include "core/pigment.h"

#include <map>
#include <memory>
#include <string>
#include <tuple>

namespace pnr {

// Each file is read once, however many patterns name it.
struct PatternAssets {
    double assumed_gamma = 1;                      // of the scene, for pictures
    int noise_generator = 2, number_of_waves = 10; // of the scene

    std::map<std::tuple<std::string, bool, double>, std::shared_ptr<const Image<glm::vec4>>> pictures{};
    std::map<std::string, std::shared_ptr<const DensityGrid>> densities{};
};

// Fills in what is missing; what is there stays. Throws FileError for a file that cannot be read and
// SceneError for an empty picture.
void prepare_pattern(Pattern& pattern, PatternAssets& assets);
void prepare_pigment(Pigment& pigment, PatternAssets& assets);

} // namespace pnr
