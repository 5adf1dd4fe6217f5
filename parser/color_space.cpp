// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/color_space.h"

#include <cmath>

namespace pnr {

double srgb_to_linear(double encoded) {
    const double a = std::abs(encoded);
    return std::copysign(a <= 0.04045 ? a / 12.92 : std::pow((a + 0.055) / 1.055, 2.4), encoded);
}

double linear_to_srgb(double linear) {
    const double a = std::abs(linear);
    return std::copysign(a <= 0.0031308 ? a * 12.92 : 1.055 * std::pow(a, 1 / 2.4) - 0.055, linear);
}

double to_working(double linear, double assumed_gamma) {
    if (assumed_gamma == 0) return linear_to_srgb(linear);
    if (assumed_gamma == 1) return linear;
    return std::copysign(std::pow(std::abs(linear), 1 / assumed_gamma), linear);
}

} // namespace pnr
