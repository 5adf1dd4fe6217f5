// SPDX-License-Identifier: GPL-3.0-or-later
// The words everything else is written in: vectors, colours, rays, boxes, transforms.
//
// Space. Scene space is the author's (POV-Ray's: left-handed, y up). World space is scene space moved so that
// the scene's centre is the origin (`world = scene - World::offset`): everything past build_world is in it.
// Geometry is decided in double; photons, pixels and colours are stored in float.
#pragma once

#include <glm/glm.hpp>

#include <limits>
#include <stdexcept>
#include <string>

namespace pnr {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Mat4 = glm::dmat4;

// Linear Rec.709 RGB: radiance in W/(m^2 sr), irradiance, flux in W or albedo, as the name at hand says.
using Color = glm::vec3;

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// Rec.709 luminance of a linear colour.
inline float luminance(Color c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float max_component(Color c) { return c.x > c.y ? (c.x > c.z ? c.x : c.z) : (c.y > c.z ? c.y : c.z); }
inline bool is_black(Color c) { return c.x == 0 && c.y == 0 && c.z == 0; }

// A half line or segment: points origin + t direction, t_min < t < t_max. The direction need not be unit, so t
// is in units of its length; passes that want distances use unit directions.
struct Ray {
    Vec3 origin{0};
    Vec3 direction{0, 0, 1};
    double t_min = 0;
    double t_max = infinity;
};

// Axis-aligned box; empty when any low > high.
struct Bounds {
    Vec3 low{infinity};
    Vec3 high{-infinity};
};

inline bool is_empty(const Bounds& b) { return b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z; }
inline Bounds merge(const Bounds& a, const Bounds& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }
inline Bounds merge(const Bounds& a, Vec3 p) { return {glm::min(a.low, p), glm::max(a.high, p)}; }

// An affine map and its inverse, kept together so that neither is ever recomputed with a different rounding.
struct Transform {
    Mat4 matrix{1};
    Mat4 inverse{1};
};

inline Vec3 transform_point(const Mat4& m, Vec3 p) { return Vec3(m * glm::dvec4(p, 1)); }
inline Vec3 transform_vector(const Mat4& m, Vec3 v) { return Vec3(m * glm::dvec4(v, 0)); }
// Normals go by the inverse transposed; the result is not normalised.
inline Vec3 transform_normal(const Transform& t, Vec3 n) { return Vec3(glm::transpose(t.inverse) * glm::dvec4(n, 0)); }
// First `first`, then `second`.
inline Transform then(const Transform& first, const Transform& second) {
    return {second.matrix * first.matrix, first.inverse * second.inverse};
}
bool is_identity(const Transform& t);

Transform translation(Vec3 offset);
Transform scaling(Vec3 factors);    // a factor of 0 is invalid input: the caller checks (POV-Ray takes 1 and warns)
Transform rotation(Vec3 degrees);   // about x, then y, then z, left-handed, as POV-Ray's rotate
Transform axis_rotation(Vec3 axis, double degrees); // about an axis through the origin, left-handed (vaxis_rotate)
// POV-Ray's matrix <...>: twelve numbers, rows of the row-vector convention. Throws std::invalid_argument if singular.
Transform matrix_transform(const double (&rows)[12]);

// Two unit vectors that make a right-handed frame (x, y, n) with the unit vector n, without a branch that could
// fail near an axis [Duff et al. 2017, "Building an orthonormal basis, revisited"].
struct Frame {
    Vec3 x, y, z;
};
Frame make_frame(Vec3 n);

// Where the scene's text said a thing; line and column count from 1, 0 means "not from text".
struct SourceRef {
    std::string file;
    int line = 0;
    int column = 0;
};

// Something in the scene cannot be built or rendered. The command line prints it as `file:line:col: error: text`.
struct SceneError : std::runtime_error {
    SceneError(SourceRef where, const std::string& text) : std::runtime_error(text), said_at(std::move(where)) {}
    SourceRef said_at;
};

// A file that can't be read or written (exit code 4).
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace pnr
