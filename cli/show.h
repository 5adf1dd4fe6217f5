// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr render --show KIND`: pictures of what cannot be seen.
#pragma once

#include "cli/pipeline.h"

#include <string>
#include <vector>

namespace pnr {

// field: strokes along the orientation field, with the seeds numbered. photons: where they lie, by their
// path. sparse, informative, partial: the maps of the painting pass. ids: each object its colour. normals: x,
// y, z as red, green, blue. error: estimated, relative, as heat. wire: silhouettes, creases and the edges of
// meshes.
enum class Show { field, photons, sparse, informative, partial, ids, normals, error, wire };
const std::vector<std::string>& show_names();
// Throws UsageError for a kind that there is not.
Show show_kind(const std::string& name);

// Which passes the pictures need.
struct ShowNeeds {
    bool photons = false;
    bool sources = false; // and what is made of them but the strokes
    bool strokes = false;
    bool error = false; // progressive passes: all there is
};
ShowNeeds needs_of(const std::vector<Show>& kinds);

// Takes out of a plan what the pictures do not need, and says so.
void plan_for(const ShowNeeds& needs, Plan& plan);
// Runs the passes that the pictures need, of a rendering that plan_rendering has made. Not of those that need
// all light.
void look_behind(const Scene& scene, Rendering& r, const ShowNeeds& needs, const Wishes& wishes, Reuse& reuse,
                 Passes& passes);

// A picture and what its colours or numbers mean, line by line.
struct Shown {
    Image<Color> picture; // linear, of the picture's full size
    std::vector<std::string> legend;
};
Shown show(Show kind, const Rendering& r);

} // namespace pnr
