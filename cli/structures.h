// SPDX-License-Identifier: GPL-3.0-or-later
// What the structures of a rendering weigh.
#pragma once

#include "cli/pipeline.h"

#include <string>
#include <vector>

namespace pnr {

struct StructureSize {
    std::string name; // bvh photons kdtree field gbuffer paint picture: one entry each, in this order
    double bytes = 0;
};
// Of the data that the rendering holds when its passes are done; what passes take for a while and give back
// is not counted. `paint` is the sparse and informative maps, the photons' directions and the painted layer;
// `picture` the photoreal layer, its parts, and both layers together.
std::vector<StructureSize> structure_sizes(const Rendering& r);

} // namespace pnr
