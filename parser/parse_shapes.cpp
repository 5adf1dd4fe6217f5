// SPDX-License-Identifier: GPL-3.0-or-later
// The analytic shapes: their own items, up to the first modifier. Directions without a
// length are errors, sizes of zero warnings.
#include "parser/blocks.h"

#include <cmath>

namespace pnr {

namespace {

// POV-Ray takes what has no size, and shows nothing of it: a scene that grows things from nothing is right.
void warn_empty(Parser& p, const Token& at, std::string_view what) {
    warn(p, at, std::string(what) + " has no size: nothing is seen of it");
}

double parse_radius(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const double radius = parse_float(p);
    if (!std::isfinite(radius)) fail(p, at, "the radius of " + std::string(what) + " is not finite");
    if (radius == 0) warn_empty(p, at, what);
    return std::abs(radius); // POV-Ray takes negative radii by their size
}

Vec3 parse_item(Parser& p) {
    const Vec3 v = parse_vector(p);
    accept_comma(p);
    return v;
}

} // namespace

Shape parse_sphere(Parser& p) {
    Sphere sphere;
    sphere.center = parse_item(p);
    sphere.radius = parse_radius(p, "this sphere");
    return sphere;
}

Shape parse_box(Parser& p) {
    const Token at = peek(p);
    const Vec3 a = parse_item(p);
    const Vec3 b = parse_vector(p);
    if (a.x == b.x || a.y == b.y || a.z == b.z)
        warn(p, at, std::string("this box has no thickness along ") + (a.x == b.x ? "x" : a.y == b.y ? "y" : "z"));
    return Box{glm::min(a, b), glm::max(a, b)};
}

Shape parse_plane(Parser& p) {
    const Token at = peek(p);
    Plane plane;
    const Vec3 normal = parse_item(p);
    const double length = glm::length(normal);
    if (!(length > 0)) fail(p, at, "the normal of a plane must not be zero");
    plane.normal = normal / length;
    plane.distance = parse_float(p); // along the unit normal, as in POV-Ray
    return plane;
}

Shape parse_cylinder(Parser& p) {
    const Token at = peek(p);
    Cylinder cylinder;
    cylinder.base = parse_item(p);
    cylinder.cap = parse_item(p);
    if (cylinder.base == cylinder.cap) fail(p, at, "the two ends of a cylinder must differ");
    cylinder.radius = parse_radius(p, "this cylinder");
    return cylinder;
}

Shape parse_cone(Parser& p) {
    const Token at = peek(p);
    Cone cone;
    cone.base = parse_item(p);
    cone.base_radius = std::abs(parse_float(p));
    accept_comma(p);
    cone.cap = parse_item(p);
    cone.cap_radius = std::abs(parse_float(p));
    if (cone.base == cone.cap) fail(p, at, "the two ends of a cone must differ");
    if (cone.base_radius == 0 && cone.cap_radius == 0) warn_empty(p, at, "this cone");
    if (cone.base_radius == cone.cap_radius) return Cylinder{cone.base, cone.cap, cone.base_radius, false};
    return cone;
}

Shape parse_torus(Parser& p) {
    Torus torus;
    torus.major = parse_radius(p, "this torus");
    accept_comma(p);
    torus.minor = parse_radius(p, "this torus");
    return torus;
}

Shape parse_disc(Parser& p) {
    Disc disc;
    disc.center = parse_item(p);
    const Token at = peek(p);
    const Vec3 normal = parse_item(p);
    const double length = glm::length(normal);
    if (!(length > 0)) fail(p, at, "the normal of a disc must not be zero");
    disc.normal = normal / length;
    disc.radius = parse_radius(p, "this disc");
    accept_comma(p);
    if (at_expression(p)) {
        const Token hole = peek(p);
        disc.hole = std::abs(parse_float(p));
        if (disc.hole >= disc.radius)
            warn(p, hole, "the hole is as large as the disc: nothing is seen of it");
    }
    return disc;
}

} // namespace pnr
