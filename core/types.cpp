// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/types.h"

#include <cmath>

namespace pnr {

bool is_identity(const Transform& t) { return t.matrix == Mat4(1); }

Transform translation(Vec3 offset) {
    Transform t;
    t.matrix[3] = glm::dvec4(offset, 1);
    t.inverse[3] = glm::dvec4(-offset, 1);
    return t;
}

Transform scaling(Vec3 factors) {
    Transform t;
    for (int i = 0; i < 3; ++i) {
        t.matrix[i][i] = factors[i];
        t.inverse[i][i] = 1 / factors[i];
    }
    return t;
}

namespace {

// Exact at multiples of 90 degrees, where authors expect corners to meet.
struct SinCos {
    double sin, cos;
};
SinCos sin_cos_degrees(double degrees) {
    const double turns = std::remainder(degrees, 360.0);
    if (turns == 0) return {0, 1};
    if (turns == 90) return {1, 0};
    if (turns == -90) return {-1, 0};
    if (std::abs(turns) == 180) return {0, -1};
    const double radians = turns * pi / 180;
    return {std::sin(radians), std::cos(radians)};
}

Transform rotation_from(const glm::dmat3& m) { return {Mat4(m), Mat4(glm::transpose(m))}; }

} // namespace

Transform rotation(Vec3 degrees) {
    const auto [sx, cx] = sin_cos_degrees(degrees.x);
    const auto [sy, cy] = sin_cos_degrees(degrees.y);
    const auto [sz, cz] = sin_cos_degrees(degrees.z);
    // Columns are the images of x, y, z. In POV-Ray's left-handed space +x rotation takes y to z, +y takes z to x, +z x to y.
    const glm::dmat3 x(1, 0, 0, 0, cx, sx, 0, -sx, cx);
    const glm::dmat3 y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
    const glm::dmat3 z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
    return rotation_from(z * y * x);
}

Transform axis_rotation(Vec3 axis, double degrees) {
    const double length = glm::length(axis);
    if (!(length > 0)) return {};
    const Vec3 a = axis / length;
    const auto [s, c] = sin_cos_degrees(degrees);
    const glm::dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return rotation_from(c * glm::dmat3(1) + s * cross + (1 - c) * glm::outerProduct(a, a));
}

Transform matrix_transform(const double (&rows)[12]) {
    Transform t;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) t.matrix[row][column] = rows[row * 3 + column];
    const glm::dmat3 linear(t.matrix);
    const double scale = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    if (!(std::abs(glm::determinant(linear)) > 1e-14 * scale)) throw std::invalid_argument("matrix is singular");
    t.inverse = glm::inverse(t.matrix);
    return t;
}

Frame make_frame(Vec3 n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

} // namespace pnr
