// SPDX-License-Identifier: GPL-3.0-or-later
// A function of space as a straight program: evaluated at single points, at several at once, and over
// intervals, where it tells all values that the function takes [Moore 1966, "Interval Analysis"] and all
// derivatives along a ray.
#pragma once

#include "core/types.h"

#include <boost/container/small_vector.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace pnr {

enum class FieldOp : std::uint8_t {
    constant, // value
    x,
    y,
    z,
    add,
    subtract,
    multiply,
    divide,
    power,
    modulo,
    less,
    greater,
    equal,
    less_equal,
    greater_equal,
    unequal,
    both,
    either,
    minimum,
    maximum,
    arc, // of a and b; arc: atan2
    negate,
    invert,
    abs,
    sqr,
    sqrt,
    exp,
    ln,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    floor,
    ceil,   // of a
    select, // of a, b, c, d: b where a < 0, c where a = 0, d where a > 0
    call,   // of opaque[a], its arguments at arguments[b] and following
};

// The result of step i is number i; a, b, c, d are earlier numbers.
struct FieldStep {
    FieldOp op = FieldOp::constant;
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    double value = 0;
};

// A function that is no program. Its values lie in [low, high], and it changes by at most `lipschitz` times
// the way of its arguments; infinite: not known.
struct OpaqueField {
    std::function<double(const double*)> value;
    std::uint32_t parameters = 3;
    double low = -infinity, high = infinity, lipschitz = infinity;
};

struct FieldProgram {
    std::vector<FieldStep> steps; // the last one is the function's value; never empty when run
    std::vector<OpaqueField> opaque;
    std::vector<std::uint32_t> arguments;
};

// Of numbers at once. Any pass takes less than this many, too.
inline constexpr int field_lanes = 8;

// Whether the program's values over intervals can be told: no call of something without known bounds.
bool has_enclosures(const FieldProgram& program);

// Space for the numbers of a program under way; kept between calls.
using FieldScratch = boost::container::small_vector<double, 1024>;

// May be NaN or infinite where the function has no value.
double field_value(const FieldProgram& program, Vec3 p, FieldScratch& scratch);
struct FieldPoints {
    double x[field_lanes], y[field_lanes], z[field_lanes];
};
void field_values(const FieldProgram& program, const FieldPoints& points, double (&values)[field_lanes],
                  FieldScratch& scratch);

// Boxes [low, high], passed along lines: `along` is how x, y and z change with a line's parameter.
struct FieldBoxes {
    FieldPoints low, high, along;
};
// All values are in [low, high] and, where the function is continuous, their slopes along the line in
// [slope_low, slope_high]. Ends are finite: beyond `field_huge` they mean "any". Where the function has no
// value at some places of the box, `high` is huge: it counts as large there.
struct FieldEnclosure {
    double low[field_lanes], high[field_lanes], slope_low[field_lanes], slope_high[field_lanes];
};
inline constexpr double field_huge = 1e150;
void field_enclosure(const FieldProgram& program, const FieldBoxes& boxes, FieldEnclosure& enclosure,
                     FieldScratch& scratch);

} // namespace pnr
