// SPDX-License-Identifier: GPL-3.0-or-later
// Noise cells: the patches of one colour that the convolution draws out into strokes.
//
// A cell is the Voronoi patch of its site. Sites are source pixels, thinned until none is closer than 0.8
// cell widths to another; everything random about a cell is hashed from its photon, so a stroke stays on its
// place of the surface when the camera moves. Where no source lies near, sites of a jittered grid take over.
#pragma once

#include "core/image.h"
#include "npr/maps.h"
#include "npr/regions.h"

#include <vector>

namespace pnr {

struct CellSite {
    Vec2f at{0};            // in pixels of the picture
    std::uint64_t hash = 0; // all that is random about the cell
    float priority = 0;     // in [0, 1): the highest on a path wins it when `edge` is large
};

// Sites for one region; `cell` in pixels of the picture, > 0. `coat` counts the coats of paint: each has
// other cells.
std::vector<CellSite> make_cell_sites(const SparseMap& sparse, const Regions& regions, std::uint32_t label,
                                      double cell, std::uint64_t seed, int coat);

// A bucket grid over sites, for exact nearest-site queries; ties go to the lower index.
struct SiteGrid {
    float bucket = 1; // side, pixels
    Vec2f origin{0};
    int columns = 0, rows = 0;
    std::vector<std::uint32_t> begin;   // first entry of each bucket; one more than there are buckets
    std::vector<std::uint32_t> entries; // site indices
    std::vector<CellSite> sites;
};
SiteGrid build_site_grid(std::vector<CellSite> sites, PixelRect box, double bucket);
// Undefined when there are no sites.
std::uint32_t nearest_site(const SiteGrid& grid, Vec2f at);

// Three independent normal deviates of a cell, cut at 2.2 standard deviations and rescaled to unit variance:
// a stray cell in a colour nobody asked for is worse than a missing one.
Color cell_deviates(std::uint64_t hash);
// Three independent uniform deviates of unit variance.
Color cell_uniform_deviates(std::uint64_t hash);

} // namespace pnr
