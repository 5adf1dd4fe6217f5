// SPDX-License-Identifier: GPL-3.0-or-later
// The values of single kinds of patterns, before frequency, phase and wave; `at` is in the pattern's own
// space. What eval_pattern dispatches to.
//
// Sources: POV-Ray 3.7's manual names what each pattern is; where it does not say a constant or an order of
// operations, that was fitted to the values that POV-Ray 3.7.0.10 prints of `function { pattern { ... } }`
// (the tests hold tables of them).
#pragma once

#include "core/pattern.h"

#include <cmath>

namespace pnr {

inline double fraction(double value) { return value - std::floor(value); }
inline double cycloid(double turns) { return std::sin(2 * pi * fraction(turns)); }
inline double triangle_wave(double value) {
    const double f = fraction(value);
    return f >= 0.5 ? 2 * (1 - f) : 2 * f;
}

// The sources of ripples and waves: points on the unit sphere, each with a frequency.
struct WaveSource {
    Vec3 center;
    double frequency = 1;
};
inline constexpr int most_wave_sources = 64; // parse_settings.cpp takes no more
const std::vector<WaveSource>& wave_sources();

// pattern_plain.cpp
double value_of(const PlainPattern& kind, const Pattern& pattern, const SurfacePoint& at);
double value_of(const AgatePattern& kind, const Pattern& pattern, const SurfacePoint& at);
double value_of(const SpiralPattern& kind, const Pattern& pattern, const SurfacePoint& at);
double value_of(const QuiltedPattern& kind, const SurfacePoint& at);
// pattern_cells.cpp: random things in cells of space
double value_of(const CracklePattern& kind, const Pattern& pattern, const SurfacePoint& at);
double cells_value(Vec3 point);
// pattern_fractal.cpp
double value_of(const FractalPattern& kind, const SurfacePoint& at);
// pattern_lists.cpp
double value_of(const CheckerPattern& kind, const SurfacePoint& at);
double value_of(const HexagonPattern& kind, const SurfacePoint& at);
double value_of(const CubicPattern& kind, const SurfacePoint& at);
double value_of(const SquarePattern& kind, const SurfacePoint& at);
double value_of(const TriangularPattern& kind, const SurfacePoint& at);
double value_of(const BrickPattern& kind, const SurfacePoint& at);
// The centre of the hexagon that holds a point of the xz plane; edge 1, one about the origin with corners on the x axis.
Vec2 nearest_hexagon(double x, double z);
// pattern_tiling.cpp
double value_of(const TilingPattern& kind, const SurfacePoint& at);

} // namespace pnr
