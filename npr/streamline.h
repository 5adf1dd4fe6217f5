// SPDX-License-Identifier: GPL-3.0-or-later
// Paths along a field of axes: the lines over which the convolution integrates [Cabral and Leedom 1993].
#pragma once

#include "core/types.h"

#include <cstdint>
#include <vector>

namespace pnr {

inline constexpr std::uint32_t no_cell = 0xffffffffu;

// What a path reads at a place of its canvas: the unit direction of the stroke (sign arbitrary) and the noise
// cell; no_cell outside the region.
struct CanvasPoint {
    Vec2f direction{0};
    std::uint32_t cell = no_cell;
};

// The window of one region at the painter's resolution, with a rim of no_cell so wide that a step from inside
// stays on it.
struct Canvas {
    int width = 0, height = 0; // with the rim
    int rim = 0;
    std::vector<CanvasPoint> points;

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

// Walks from `start` along `heading` for `count` steps by the midpoint rule and calls sample(k, cell) with
// the cell at a place inside the k-th step, `within(k)` in [0, 1) of its way along: one stratified sample a
// step. Stops where the path leaves the region.
template <class Within, class Sample>
inline void walk_path(const Canvas& canvas, Vec2f start, Vec2f heading, int count, float step,
                      Within&& within, Sample&& sample) {
    Vec2f p = start;
    for (int k = 0; k < count; ++k) {
        const Vec2f first = follow(canvas, p, heading);
        const Vec2f middle = follow(canvas, p + first * (0.5f * step), first);
        const std::uint32_t cell = canvas.at(p + middle * (within(k) * step)).cell;
        if (cell == no_cell) return;
        sample(k, cell);
        p += middle * step;
        heading = middle;
        if (canvas.at(p).cell == no_cell) return;
    }
}

} // namespace pnr
