// SPDX-License-Identifier: GPL-3.0-or-later
// Paths along a field of axes: the lines over which the convolution integrates [Cabral and Leedom 1993].
#pragma once

#include "core/image.h"
#include "npr/folds.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pnr {

inline constexpr std::uint32_t no_cell = 0xffffffffu;

// What a path reads at a place of its canvas: the unit direction of the stroke (sign arbitrary), the noise
// cell (no_cell outside the region), and how many pixels of the brush a pixel's step along the stroke is on
// the surface.
struct CanvasPoint {
    Vec2f direction{0};
    std::uint32_t cell = no_cell;
    float stretch = 1;
};

// The window of one region at the painter's resolution, with a rim of no_cell so wide that a step from inside
// stays on it.
struct Canvas {
    int width = 0, height = 0; // with the rim
    int rim = 0;
    std::vector<CanvasPoint> points;
    Image<std::uint8_t> walls; // folds of the region's pixels (folds.h), without the rim; empty: none
    int scale = 1;             // canvas pixels a pixel

    // Whether a fold lies between two places less than a pixel apart.
    bool is_walled(Vec2f from, Vec2f to) const {
        if (walls.empty()) return false;
        const auto pixel = [&](float v) { return (static_cast<int>(v) - rim + scale) / scale - 1; };
        const int x = pixel(from.x), y = pixel(from.y), dx = pixel(to.x) - x, dy = pixel(to.y) - y;
        if ((dx == 0 && dy == 0) || !walls.contains(x, y)) return false;
        return (walls.at(x, y) & wall_bit(std::clamp(dx, -1, 1), std::clamp(dy, -1, 1))) != 0;
    }

    const CanvasPoint& at(Vec2f p) const { return at(static_cast<int>(p.x), static_cast<int>(p.y)); }
    const CanvasPoint& at(int x, int y) const {
        return points[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    CanvasPoint& at(int x, int y) {
        return points[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

// The axis read at a place, turned to go on from `heading`; heading itself where there is none.
inline Vec2f follow(const Canvas& canvas, Vec2f at, Vec2f heading) {
    const Vec2f d = canvas.at(at).direction;
    const float along = d.x * heading.x + d.y * heading.y;
    if (along > 0) return d;
    return along < 0 ? -d : heading;
}

inline constexpr int longest_way = 2; // steps of a path by those it has where a pixel is one of the brush

// Walks from `start` along `heading` by the midpoint rule until the way on the surface is `count` steps of
// the brush long, and calls sample(before, stretch, cell) with the cell at a place inside each step,
// `within(k)` in [0, 1) of the k-th's way along: one stratified sample a step. `before`: the way up to that
// place, in steps. Stops where the path leaves the region or comes to a fold.
template <class Within, class Sample>
inline void walk_path(const Canvas& canvas, Vec2f start, Vec2f heading, int count, float step,
                      Within&& within, Sample&& sample) {
    Vec2f p = start;
    float way = 0;
    const auto whole = static_cast<float>(count);
    for (int k = 0; k < longest_way * count; ++k) {
        const Vec2f first = follow(canvas, p, heading);
        const Vec2f middle = follow(canvas, p + first * (0.5f * step), first);
        const Vec2f next = p + middle * step;
        if (canvas.is_walled(p, next)) return;
        const float share = within(k);
        const CanvasPoint& met = canvas.at(p + middle * (share * step));
        if (met.cell == no_cell) return;
        const float before = way + share * met.stretch;
        if (before >= whole) return;
        sample(before, met.stretch, met.cell);
        way += met.stretch;
        p = next;
        heading = middle;
        if (canvas.at(p).cell == no_cell) return;
    }
}

} // namespace pnr
