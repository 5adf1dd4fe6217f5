// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's `spline`: a curve through points of 2 to 5 components, asked by parameter.
#pragma once

#include "parser/value.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace pnr {

struct Parser;
struct Token;

enum class SplineKind : std::uint8_t { linear, quadratic, cubic, natural };

struct SplineKnot {
    double parameter = 0;
    std::array<double, 5> point{};
    std::array<double, 5> bend{}; // second derivative of the natural spline here
};

struct Spline {
    SplineKind kind = SplineKind::linear;
    int components = 2;
    std::vector<SplineKnot> knots; // by rising parameter, all different; never empty
};

// The bends of the natural spline from the parameters and points [Press et al. 2007, section 3.3].
void set_bends(Spline& spline);
// Fills `components` numbers. Beyond the first and last knot the curve stands still; a cubic one passes from
// the second knot to the last but one.
void evaluate(const Spline& spline, SplineKind kind, double parameter, double* result);

// `{ ... }`, the word `spline` having been taken.
std::shared_ptr<const Spline> parse_spline(Parser& p);
// Behind the spline's name: `(parameter [, kind])`. Errors at `name`.
VectorValue call_spline(Parser& p, const Token& name, const std::shared_ptr<const Spline>& spline);

} // namespace pnr
