// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns that number the regions of a tiling of space.
#include "core/pattern_values.h"

namespace pnr {

namespace {

bool odd(double whole) { return std::fmod(std::abs(whole), 2.0) == 1; }

// Of the hexagon that holds a point, counted along two axes of the grid; found by rounding in all three.
Vec2 hexagon_number(double x, double z) {
    const double q = x * (2.0 / 3), r = z / std::sqrt(3.0) - x / 3;
    double i = std::round(q), j = std::round(r);
    const double k = std::round(-q - r);
    const double di = std::abs(i - q), dj = std::abs(j - r), dk = std::abs(k + q + r);
    if (di > dj && di > dk)
        i = -j - k;
    else if (dj > dk)
        j = -i - k;
    return {i, j};
}

} // namespace

Vec2 nearest_hexagon(double x, double z) {
    const Vec2 number = hexagon_number(x, z);
    return {1.5 * number.x, std::sqrt(3.0) * (number.y + number.x / 2)};
}

double value_of(const CheckerPattern&, const SurfacePoint& at) {
    const Vec3 cell = glm::floor(at.point + Vec3(at.tolerance));
    return std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0);
}

// Hexagons of edge 1 in the xz plane, no two of one colour side by side.
double value_of(const HexagonPattern&, const SurfacePoint& at) {
    const Vec2 hexagon = hexagon_number(at.point.x, at.point.z);
    const double number = std::fmod(2 * hexagon.x + hexagon.y, 3.0);
    return number < 0 ? number + 3 : number;
}

// By the cube's face that the point looks through from the origin: x, y, z, -x, -y, -z.
double value_of(const CubicPattern&, const SurfacePoint& at) {
    const Vec3 a = glm::abs(at.point);
    if (a.x >= a.y && a.x >= a.z) return at.point.x >= 0 ? 0 : 3;
    if (a.y >= a.z) return at.point.y >= 0 ? 1 : 4;
    return at.point.z >= 0 ? 2 : 5;
}

// Unit squares in the xz plane: 0 1 above 3 2 (x to the right, z down), again and again.
double value_of(const SquarePattern&, const SurfacePoint& at) {
    const bool x = odd(std::floor(at.point.x + at.tolerance)), z = odd(std::floor(at.point.z + at.tolerance));
    return x ? (z ? 2 : 3) : (z ? 1 : 0);
}

// Triangles of edge 1 in the xz plane, one with its base from the origin to (1, 0), in rows that are three
// cells long: each cell of the sheared grid is a triangle that points up and one that points down.
double value_of(const TriangularPattern&, const SurfacePoint& at) {
    const double row = at.point.z / std::sqrt(0.75) + at.tolerance;
    const double column = at.point.x - at.point.z / std::sqrt(3.0) + at.tolerance;
    const double number = std::fmod(std::floor(column) - std::floor(row), 3.0);
    const auto cell = static_cast<std::size_t>(number < 0 ? number + 3 : number);
    constexpr double up[] = {0, 4, 2}, down[] = {3, 5, 1};
    return fraction(row) + fraction(column) < 1 ? up[cell] : down[cell];
}

double value_of(const BrickPattern& kind, const SurfacePoint& at) {
    const Vec3 mortar = Vec3(kind.mortar) / kind.size; // at the far end of each brick
    const Vec3 p = (at.point + Vec3(at.tolerance)) / kind.size + mortar;
    if (fraction(p.y) <= mortar.y) return 0;
    const double shift = fraction((p.y - mortar.y) / 2) < 0.5 ? 0 : 0.5; // of every other layer
    if (fraction(p.x + shift) <= mortar.x) return 0;
    return fraction(p.z + 0.5 - shift) <= mortar.z ? 0 : 1;
}

} // namespace pnr
