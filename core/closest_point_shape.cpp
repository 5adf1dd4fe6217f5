// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/closest_point.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Vec3 unit_or(Vec3 v, Vec3 otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

ClosestPoint found(Vec3 position, Vec3 normal, Vec3 query) {
    return {position, normal, glm::distance(position, query), 0, 0, Vec3(0)};
}

ClosestPoint on_sphere(const Sphere& s, Vec3 p) {
    const Vec3 outward = unit_or(p - s.center, {0, 1, 0});
    return found(s.center + std::abs(s.radius) * outward, outward, p);
}

ClosestPoint on_box(const Box& b, Vec3 p) {
    const Vec3 low = glm::min(b.low, b.high), high = glm::max(b.low, b.high);
    Vec3 q = glm::clamp(p, low, high);
    // The face: the one the query is farthest outside of, or, from within, the nearest.
    int axis = 0;
    double best = -infinity, side = 1;
    for (int k = 0; k < 3; ++k) {
        for (const double s : {-1.0, 1.0}) {
            const double outside = s < 0 ? low[k] - p[k] : p[k] - high[k];
            if (!(outside > best)) continue;
            best = outside;
            axis = k;
            side = s;
        }
    }
    q[axis] = side < 0 ? low[axis] : high[axis];
    Vec3 normal(0);
    normal[axis] = side;
    return found(q, normal, p);
}

// A surface of revolution about the line through `base` along `axis` (unit), in the half plane of distance r
// from the line and height h along it.
struct Revolution {
    Vec3 base, axis, outward; // outward: unit, from the line to the query
    Vec2 query;               // (r, h)

    Revolution(Vec3 base_, Vec3 axis_, Vec3 p) : base(base_), axis(axis_) {
        const Vec3 d = p - base;
        query.y = glm::dot(d, axis);
        const Vec3 away = d - query.y * axis;
        query.x = glm::length(away);
        outward = query.x > 0 ? away / query.x : make_frame(axis).x;
    }
    ClosestPoint lift(Vec2 at, Vec2 normal, Vec3 p) const {
        return found(base + at.y * axis + at.x * outward,
                     glm::normalize(normal.x * outward + normal.y * axis), p);
    }
};

// The nearest point of the segment a b, whose normal is to the right of a -> b in (r, h).
ClosestPoint on_profile(const Revolution& r, Vec2 a, Vec2 b, Vec3 p) {
    const Vec2 way = b - a;
    const double length2 = glm::dot(way, way);
    const double t = length2 > 0 ? std::clamp(glm::dot(r.query - a, way) / length2, 0.0, 1.0) : 0;
    const Vec2 normal = length2 > 0 ? Vec2(way.y, -way.x) : Vec2(1, 0);
    return r.lift(a + t * way, normal, p);
}

void keep_nearer(ClosestPoint& best, const ClosestPoint& other) {
    if (other.distance < best.distance) best = other;
}

// Cylinders and cones: the side, and the two lids unless open.
ClosestPoint on_frustum(Vec3 base, Vec3 cap, double base_radius, double cap_radius, bool open, Vec3 p) {
    const double height = glm::distance(base, cap);
    const Revolution r(base, unit_or(cap - base, {0, 1, 0}), p);
    ClosestPoint best = on_profile(r, {base_radius, 0}, {cap_radius, height}, p);
    if (!open) {
        keep_nearer(best, on_profile(r, {0, 0}, {base_radius, 0}, p));
        keep_nearer(best, on_profile(r, {cap_radius, height}, {0, height}, p));
    }
    return best;
}

ClosestPoint on_torus(const Torus& t, Vec3 p) {
    const Revolution r(Vec3(0), {0, 1, 0}, p);
    const Vec2 tube(t.major, 0);
    Vec2 away = r.query - tube;
    const double distance = glm::length(away);
    away = distance > 0 ? away / distance : Vec2(1, 0);
    return r.lift(tube + t.minor * away, away, p);
}

} // namespace

ClosestPoint closest_point_on_shape(const Shape& shape, Vec3 p) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return on_sphere(*s, p);
    if (const auto* b = std::get_if<Box>(&shape)) return on_box(*b, p);
    if (const auto* plane = std::get_if<Plane>(&shape))
        return found(p + (plane->distance - glm::dot(plane->normal, p)) * plane->normal, plane->normal, p);
    if (const auto* c = std::get_if<Cylinder>(&shape))
        return on_frustum(c->base, c->cap, c->radius, c->radius, c->open, p);
    if (const auto* c = std::get_if<Cone>(&shape))
        return on_frustum(c->base, c->cap, c->base_radius, c->cap_radius, c->open, p);
    if (const auto* t = std::get_if<Torus>(&shape)) return on_torus(*t, p);
    if (const auto* d = std::get_if<Disc>(&shape)) {
        const Revolution r(d->center, d->normal, p);
        return r.lift({std::clamp(r.query.x, d->hole, d->radius), 0}, {0, 1}, p);
    }
    if (std::holds_alternative<Mesh>(shape) || std::holds_alternative<BicubicPatch>(shape)) return {};
    return closest_point_by_rays(shape, p);
}

} // namespace pnr
