// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth indirect light: final gathering at sites chosen among the photons, interpolated with gradients.
//
// The sites are a property of the photon map alone, not of a view or of the order in which pixels ask, so any
// crop, thread or pass finds the same light. They lie in levels, each a Poisson-disc set of half the spacing
// of the one before; a record is computed when a point first asks for its site, so that only what is seen is
// paid for. A point takes the coarsest level whose records may be trusted there [Ward, Rubinstein, Clear
// 1988; Ward and Heckbert 1992]. Rays of a final gather end at irradiances that were computed beforehand from
// the photons [Christensen 1999].
#pragma once

#include "core/photon_map.h"
#include "core/world.h"

#include <memory>
#include <vector>

namespace pnr {

struct IrradianceField; // irradiance_field.cpp

struct FieldSettings {
    // In (0, 1]: the share of a first pass's widths that this one blurs over, in area. Progressive passes make it smaller, so
    // that their mean has ever less bias.
    double shrink = 1;
    // Rays that a record is worth: -1 fewest, in drafts; 0 few, where pictures are averaged; 1; or 2 many.
    int effort = 1;
};

// Lists the sites and computes the irradiances that gather rays end at. `map` must have its trees. A field
// belongs to the world and the map it was made from.
std::shared_ptr<const IrradianceField> make_irradiance_field(const World& world, const PhotonMap& map,
                                                             const FieldSettings& settings = {},
                                                             const Progress& progress = {});

// Irradiance by indirect light (neither straight from a light nor through specular surfaces alone) at a
// point; `normal` is unit, on the side that is lit. `trust` tells how much the records know about the point:
// 1 enough, 0 nothing; what is between should be blended with another estimate. May be called from any
// thread; it fills records, which changes no result.
struct FieldIrradiance {
    Color irradiance{0};
    float trust = 0;
    // 1: records are close enough for what surrounds the point; less in narrow corners, where light changes
    // faster than they tell and gathered_irradiance knows better.
    float sure = 0;
};
FieldIrradiance field_irradiance(const IrradianceField& field, const World& world, const PhotonMap& map,
                                 Vec3 position, Vec3 normal, std::vector<Neighbour>& scratch);

// The same irradiance by rays from the point itself: about a third of a record's cost.
Color gathered_irradiance(const IrradianceField& field, const World& world, const PhotonMap& map,
                          Vec3 position, Vec3 normal, std::vector<Neighbour>& scratch);

// How many records have been computed so far, for statistics.
std::int64_t record_count(const IrradianceField& field);
// What it weighs, in bytes; records count whether they have been computed or not.
std::int64_t field_bytes(const IrradianceField& field);

} // namespace pnr
