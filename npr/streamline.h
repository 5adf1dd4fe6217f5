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
    int shift = 0;             // a pixel is 2^shift canvas pixels wide

    // Whether a fold lies between two places less than a pixel apart.
    bool is_walled(Vec2f from, Vec2f to) const {
        if (walls.empty()) return false;
        const auto pixel = [&](float v) { return (static_cast<int>(v) - rim) >> shift; };
        const int x = pixel(from.x), y = pixel(from.y), dx = pixel(to.x) - x, dy = pixel(to.y) - y;
        if ((dx | dy) == 0 || !walls.contains(x, y)) return false;
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

// Steps of a path by those it has where a pixel is one of the brush, at most.
inline constexpr int longest_way = 2;

// A path under way.
struct Path {
    Vec2f p{0}, heading{0};
    float way = 0; // so far on the surface, in steps of the brush
    bool going = true;
};

// Of the rules the midpoint's is kept. A field that is read from the pixel around a place has steps, and they
// leave higher orders nothing to win: ends of paths 20 pixels long are off by, on circles, a saddle and waves of
// 50 pixels (bench_ilic --steps; root mean square, pixels, and places read), 0.020, 0.023, 0.15 by steps of 0.5
// (80 places); by Runge and Kutta's fourth order 0.027, 0.024, 0.17 in steps of 1 (80); by Euler's 0.107, 0.078,
// 0.36 (40); by Bogacki and Shampine's adaptive pair, tolerance 0.01 a step, 0.035, 0.033, 0.17 (23, 22, 79),
// but each step must read a cell beside, so that long ones save nothing. Blended between four pixels, at four
// times the reads, the same steps are off by 0.0001, 0.0003, 0.028.
//
// One step by the midpoint rule: calls sample(before, stretch, cell) with the cell at a place inside it,
// `share` in [0, 1) of its way along. `before`: the way up to that place. The path stops where it leaves the
// region, comes to a fold or has come `whole` steps of the brush.
template <class Sample>
inline void step_path(const Canvas& canvas, Path& path, float step, float share, float whole,
                      Sample&& sample) {
    const Vec2f p = path.p;
    const Vec2f first = follow(canvas, p, path.heading);
    const Vec2f middle = follow(canvas, p + first * (0.5f * step), first);
    const Vec2f next = p + middle * step;
    const CanvasPoint& met = canvas.at(p + middle * (share * step));
    const float before = path.way + share * met.stretch;
    if (canvas.is_walled(p, next) || met.cell == no_cell || before >= whole) {
        path.going = false;
        return;
    }
    sample(before, met.stretch, met.cell);
    path.way += met.stretch;
    path.p = next;
    path.heading = middle;
    path.going = canvas.at(next).cell != no_cell;
}

} // namespace pnr
