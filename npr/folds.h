// SPDX-License-Identifier: GPL-3.0-or-later
// Folds: where one object hides a part of itself or turns sharply between two pixels. Neither strokes nor
// colours cross them.
#pragma once

#include "core/gbuffer.h"
#include "core/image.h"

namespace pnr {

// For each pixel one bit for each of its eight neighbours, set where a fold lies between; 0 where nothing
// painted is seen. Bits go round from the right neighbour through the one below it to the one below (y down),
// the left and the upper ones.
struct Folds {
    Image<std::uint8_t> walls;
    bool any = false;
};
Folds find_folds(const GBuffer& gbuffer);

// Whether a fold lies between two points of one surface, with their unit normals, that are seen a pixel or so
// apart; `pixel`: the width of a pixel there, facing the viewer. Each must lie off the other's tangent plane by
// more than three such widths, or the normals be more than 60 degrees apart.
bool is_fold(Vec3f a, Vec3f normal_a, Vec3f b, Vec3f normal_b, float pixel);

// The bit of a step of -1, 0 or 1 each way, not both 0.
inline std::uint8_t wall_bit(int dx, int dy) {
    constexpr std::uint8_t bits[9] = {1u << 5, 1u << 6, 1u << 7, 1u << 4, 0,
                                      1u << 0, 1u << 3, 1u << 2, 1u << 1};
    return bits[(dy + 1) * 3 + dx + 1];
}

// Whether a fold lies between two pixels, on the way of pixels that is nearest to the line between them.
bool is_folded_between(const Folds& folds, int x0, int y0, int x1, int y1);

} // namespace pnr
