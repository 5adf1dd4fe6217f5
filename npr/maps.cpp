// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/maps.h"

#include "npr/paint.h"

namespace pnr {

// Half the angle by the larger of sine and cosine, the other by the sine of the whole.
Vec2f axis_direction(Vec2f axis) {
    const float length = glm::length(axis);
    if (!(length > 0)) return {1, 0};
    const float c = axis.x / length, s = axis.y / length;
    const float larger = std::sqrt(0.5f + 0.5f * std::abs(c)), other = 0.5f * s / larger;
    if (c >= 0) return {larger, other};
    const Vec2f d(std::abs(other), std::copysign(larger, s));
    return d.x < 1e-7f ? Vec2f(0, 1) : d; // both ends of the range are the vertical axis
}

Vec2f direction_axis(Vec2f d) {
    const float length2 = glm::dot(d, d);
    if (!(length2 > 0)) return {0, 0};
    return Vec2f(d.x * d.x - d.y * d.y, 2 * d.x * d.y) / length2;
}

double scaled(double pixels_at_512, int height) { return pixels_at_512 * height / 512.0; }

bool is_turned(Vec2 d) { return glm::dot(Vec2(canonical_direction(d)), d) < 0; }

Vec2f canonical_direction(Vec2 d) {
    const double length = glm::length(d);
    if (!(length > 0) || !std::isfinite(length)) return {1, 0};
    Vec2f unit(d / length);
    if (unit.x < 0 || (unit.x == 0 && unit.y < 0)) unit = -unit;
    return unit + Vec2f(0); // no negative zeros
}

} // namespace pnr
