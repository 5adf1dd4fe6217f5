// SPDX-License-Identifier: GPL-3.0-or-later
// Paths along a field of axes: the lines over which the convolution integrates [Cabral and Leedom 1993].
#pragma once

#include "core/image.h"
#include "npr/folds.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace pnr {

inline constexpr std::uint32_t no_cell = 0xffffffffu;

// What a path reads at a place of its canvas: the unit direction of the stroke (sign arbitrary), the noise
// cell (no_cell outside the region), and how many pixels of the brush a pixel's step along the stroke is on
// the surface: below zero where a fold may lie less than a pixel away.
struct CanvasPoint {
    Vec2f direction{0};
    std::uint32_t cell = no_cell;
    float stretch = 1;
};

// The window of one region at the painter's resolution, with a rim of no_cell so wide that two steps from
// inside stay on it.
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

inline constexpr int longest_way = 2; // steps of a path by those it has where a pixel is one of the brush

// Paths are walked side by side, since each alone would wait for its reads.
inline constexpr int lanes = 8;

struct Walk {       // how far and how finely to walk to each side
    int count = 0;  // steps of the brush
    float step = 1; // canvas pixels
};

// What one side of some paths meets, a row a step: the cell, in which step of the brush, and how much of the
// way on the surface; 0 of it ends a path.
struct MetRow {
    std::array<std::uint32_t, lanes> cell;
    std::array<std::int32_t, lanes> place;
    std::array<float, lanes> way;
};

// Where paths begin; lanes beyond the last path begin where it does.
struct Starts {
    std::array<int, lanes> x{}, y{};
    std::array<std::uint32_t, lanes> turn{}; // where in the first step the sample lies, in 2^-32
};

// The first step's turn to a side, what each step adds, and where in its step a sample of some turn lies, in
// [0, 1).
inline constexpr std::uint32_t next_turn = 2654435769u; // by the golden ratio
inline std::uint32_t first_turn(std::uint32_t turn, int side) {
    return side == 0 ? turn : turn * 747796405u + 2891336453u;
}
inline float sample_share(std::uint32_t turn) {
    return static_cast<float>(static_cast<std::int32_t>(turn >> 8)) * 0x1p-24f;
}

// Walks from the centre of each lane's canvas pixel along its direction (side 0) or against it (1), until the
// way on the surface is `count` steps of the brush long, the path leaves the region, or it comes to a fold.
// Every step reads the canvas once, at a place inside it that goes round by the golden ratio: there lies its
// stratified sample of the noise, and from there it has its direction. In the mean over the steps that is the
// midpoint, and so the path strays as little as by the midpoint rule for half the reads: with directions kept
// twice a pixel each way and steps of half a pixel, after 13 pixels of path by 0.002 (rings) to 0.015 pixels
// (rough fields) in the mean of all but the worst tenth, where the midpoint rule strays by 0.004 to 0.023,
// Euler's by 0.04 to 0.11, Runge and Kutta's fourth order on the same readings by 0.002 to 0.013 with four
// times the reads, and in steps of 3.25 pixels by 0.006 to 0.027. Only with directions blended at every read
// do adaptive steps come closer than any eye (0.0002 to 0.002 with 11 to 21 reads), and these reads cost four
// times as much (tests/bench/bench_paths.cpp). Gaps narrower than two steps may be missed.
// `met` grows to 2 count + 1 rows.
void walk_paths(const Canvas& canvas, const Walk& walk, const Starts& starts, int side,
                std::vector<MetRow>& met);

} // namespace pnr
