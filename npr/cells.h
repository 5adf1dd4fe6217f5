// SPDX-License-Identifier: GPL-3.0-or-later
// Noise cells: the patches of one colour that the convolution draws out into strokes.
//
// A cell is what lies nearer to its site than to any other, on the surface. Sites are seats (seats.h) about
// 0.8 cell widths apart; where too few photons fell, points of a lattice in space are seats too. Everything
// random about a cell is hashed from its place on the object, so a stroke stays there when the camera moves;
// and when the camera comes nearer, cells that find room grow out of nothing: the partition is a power
// diagram [Aurenhammer 1987].
#pragma once

#include "core/gbuffer.h"
#include "core/image.h"
#include "npr/brush_scale.h"
#include "npr/regions.h"
#include "npr/seats.h"

#include <vector>

namespace pnr {

struct CellSite {
    Vec2f at{0};            // in pixels of the picture
    Vec3f position{0};      // world space
    float radius2 = 0;      // its squared distances to places count as less by this
    std::uint64_t hash = 0; // all that is random about the cell
    float priority = 0;     // in [0, 1): the highest on a path wins it when `edge` is large
};

// What decides the sites of one coat of one region.
struct CellPlan {
    const GBuffer& gbuffer;
    const Seats& seats;
    const Region& region;
    const Image<std::uint8_t>& mask; // the region's window
    const BrushScale& scale;
    double cell = 1; // width in pixels of the picture, > 0
    std::uint64_t seed = 0;
    int coat = 0; // each coat of paint has other cells
};
// At least one.
std::vector<CellSite> make_cell_sites(const CellPlan& plan);

// A bucket grid over sites, for exact nearest-site queries; ties go to the lower index.
struct SiteGrid {
    float bucket = 1; // side, pixels
    Vec2f origin{0};
    int columns = 0, rows = 0;
    std::vector<std::uint32_t> begin;   // first entry of each bucket; one more than there are buckets
    std::vector<std::uint32_t> entries; // site indices
    std::vector<CellSite> sites;
    float largest_radius2 = 0;
};
SiteGrid build_site_grid(std::vector<CellSite> sites, PixelRect box, double bucket);
// The nearest in space to a place seen at `at`, distances taken as said above. `pixel`: what a pixel spans
// there, facing the viewer; sites that are seen too far off to be the nearest are not looked at. Undefined
// when there are no sites.
std::uint32_t nearest_site(const SiteGrid& grid, Vec2f at, Vec3f place, float pixel);

// Three independent normal deviates of a cell, cut at 2.2 standard deviations and rescaled to unit variance:
// a stray cell in a colour nobody asked for is worse than a missing one.
Color cell_deviates(std::uint64_t hash);
// Three independent uniform deviates of unit variance.
Color cell_uniform_deviates(std::uint64_t hash);

} // namespace pnr
