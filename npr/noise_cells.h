// SPDX-License-Identifier: GPL-3.0-or-later
// The noise that the convolution draws out [LW10 3.2.4]: what is fixed for the painting of one region, and
// its cut into cells of one colour, priority and height each.
#pragma once

#include "core/parallel.h"
#include "core/settings.h"
#include "npr/brush_scale.h"
#include "npr/cells.h"
#include "npr/maps.h"
#include "npr/regions.h"
#include "npr/seats.h"
#include "npr/streamline.h"

#include <vector>

namespace pnr {

// All that is fixed for the painting of one region; only the cells of the canvas change from coat to coat.
struct RegionWork {
    const Region& region;
    const PaintStyle& style;
    const GBuffer& gbuffer;
    const Seats& seats;
    Image<std::uint8_t> mask;
    BrushScale brush;
    Image<Vec2f> axes;
    Image<Color> toned;
    Image<float> detail; // empty when no coat asks for it
    Canvas canvas;
    int scale = 1; // canvas pixels a picture pixel
    int picture_height = 512;
    std::uint64_t seed = 0;
};

// What a cell is, whatever made it.
struct CellRecord {
    Color base{0};     // paint space
    Color deviates{0}; // unit variance
    float height = 0;  // of the paint, 0..1
    float priority = 0;
    double weight = 1; // exp(edge (priority - 1))
};

// Calls body(canvas x, canvas y, chunk), both without the rim, for every canvas pixel of the region, rows in
// parallel.
template <class Body>
inline void for_each_canvas_row(const RegionWork& work, Body&& body) {
    parallel_for(work.mask.height * work.scale, 8,
                 [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
                     for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                         for (int x = 0; x < work.mask.width * work.scale; ++x)
                             if (work.mask.at(x / work.scale, y / work.scale) != 0) body(x, y, chunk);
                 });
}

// Cells for one coat; base: the colours they take, in paint space. They write each cell's number, an index
// into the result, to the canvas. `coat_number` makes coats differ. `cell`: their width in pixels of the
// picture.
//
// [LW10]: noise a pixel of a 512-high picture, each on the pixel's own colour.
std::vector<CellRecord> make_pixel_cells(RegionWork& work, const PaintLayer& coat, const Image<Color>& base,
                                         double cell, int coat_number);
// Cells about seats (cells.h), of the colour at their site.
SiteGrid make_sites(const RegionWork& work, double cell, int coat_number);
std::vector<CellRecord> make_site_cells(RegionWork& work, const PaintLayer& coat, const Image<Color>& base,
                                        const SiteGrid& sites);

} // namespace pnr
