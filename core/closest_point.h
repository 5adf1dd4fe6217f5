// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of an object's surface: where seeds snap to.
#pragma once

#include "core/shape.h"
#include "core/world.h"

#include <memory>

namespace pnr {

struct ClosestPoint {
    Vec3 position{0};           // world space, on the surface
    Vec3 normal{0};             // unit, geometric, to the outside as modelled
    double distance = infinity; // from the query; infinity: the object has no surface
    std::uint32_t surface = 0;  // index into World::surfaces
    std::uint32_t triangle = 0; // of its mesh
    Vec3 weights{0};            // barycentric, on a mesh
};

struct SurfaceIndex; // closest_point.cpp

// All surfaces of one object (its number in World::objects), made ready for queries: an AABB tree over the
// triangles of each mesh [CGAL, AABB_tree]. The world must outlive it.
std::shared_ptr<const SurfaceIndex> index_surface(const World& world, int object);

// The point nearest to `point`: exact on triangles; on analytic shapes to rounding, or, where a transform
// makes an ellipsoid of a sphere, a point of the surface at which no small move comes nearer. Ties go to the
// shape that stands first. Of trees of solids, points that are seen; near their edges to about a hundredth
// of the object's size. Safe to call from several threads.
ClosestPoint closest_point(const SurfaceIndex& index, Vec3 point);

// For a single query.
ClosestPoint closest_point_on_object(const World& world, int object, Vec3 point);

// In the shape's own space; for meshes and patches nothing: distance infinity. The normal is unit and points
// outside.
ClosestPoint closest_point_on_shape(const Shape& shape, Vec3 point);

// What closest_point_on_shape takes for shapes without a formula: found by hits along lines, to about 1e-8 of the distance,
// at edges to 1e-3; at once where the point lies on the surface.
ClosestPoint closest_point_by_rays(const Shape& shape, Vec3 point);

} // namespace pnr
