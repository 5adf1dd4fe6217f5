// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pattern_values.h"

namespace pnr {

namespace {

double square_tile(double x, double z) {
    return 2 * std::max(std::abs(fraction(x) - 0.5), std::abs(fraction(z) - 0.5));
}

// Hexagons of edge 1, one about (2, 0).
double hexagon_tile(double x, double z) {
    const Vec2 center = nearest_hexagon(x - 2, z);
    const double dx = x - 2 - center.x, dz = z - center.y;
    const double edge = std::sqrt(0.75); // distance of an edge from the centre
    const double slanted = std::max(std::abs(dz * 0.5 + dx * edge), std::abs(dz * 0.5 - dx * edge));
    return std::max(std::abs(dz), slanted) / edge;
}

// Triangles of edge 1, one with its base from the origin to (1, 0). From the middle to the border those that point down go
// through the upper half of the values, the others through the lower.
double triangle_tile(double x, double z) {
    const double height = std::sqrt(0.75);
    double row = fraction(z / height), column = fraction(x - z / std::sqrt(3.0));
    const bool pointing_down = row + column >= 1;
    if (pointing_down) row = 1 - row, column = 1 - column;
    const double value = 1 - 3 * std::min({row, column, 1 - row - column});
    return pointing_down ? (1 + value) / 2 : value / 2;
}

} // namespace

double value_of(const TilingPattern& kind, const SurfacePoint& at) {
    switch (kind.type) {
    case 1:
        return square_tile(at.point.x, at.point.z);
    case 2:
        return hexagon_tile(at.point.x, at.point.z);
    default:
        return triangle_tile(at.point.x, at.point.z);
    }
}

} // namespace pnr
