// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of geometry share: rays (geometry.cpp), their hits (geometry_hit.cpp) and the building of it
// all (geometry_build.cpp).
#pragma once

#include "core/bvh.h"
#include "core/csg.h"
#include "core/geometry.h"
#include "core/shape_hits.h"

#include <algorithm>

namespace pnr {

// A mesh in its own space, times a power of two.
struct SharedMesh {
    Bvh bvh;
    double scale = 1;
};

// What the BVH calls an other primitive: an analytic shape, or an instance of a shared mesh.
struct Other {
    std::uint32_t item = 0;
    std::uint32_t first_primitive = 0;
    std::shared_ptr<const SharedMesh> mesh; // null: a shape
};

struct Geometry {
    std::vector<GeometryItem> items;
    std::vector<Bounds> bounds; // of each item's form
    Csg csg;
    std::vector<std::shared_ptr<const SharedMesh>>
        solid_meshes; // of items in trees: null if the mesh is no solid
    double scale = 1; // world to kernel space: a power of two
    Bvh bvh;
    std::vector<Other> others;
    std::vector<std::uint32_t> placed_items,
        placed_first; // meshes in the scene's own BVH, and their first triangles
    std::vector<double> placed_side; // -1 where their winding is not the outside's: a mirror, or an inverse
    std::vector<std::uint32_t> unbounded, unbounded_primitive;
    std::uint8_t hidden_from = 0; // of all items together
    GeometryStats stats;
};

inline double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

inline const Mesh* mesh_of(const GeometryItem& item) {
    const Shape* shape = std::get_if<Shape>(&item.form);
    return shape ? std::get_if<Mesh>(shape) : nullptr;
}

// A ray as the kernel wants it, and the way back: t = shift + t_kernel / rate.
struct Prepared {
    KernelRay ray;
    double shift = 0, rate = 1;
    bool misses = false; // it does not come near

    double to_kernel(double t) const { return (t - shift) * rate; }
    double from_kernel(double t) const { return shift + t / rate; }
};

// `scale` times space is kernel space, where all lies within a few units of the origin. Rays from far away,
// or with a negative t_min, start where they come near.
Prepared prepare(Vec3 origin, Vec3 direction, double t_min, double t_max, double scale);

// A query under way, and the best hit with a shape so far.
struct Trace {
    const Geometry& g;
    const Ray& ray; // in world space
    std::uint8_t bit;
    const Prepared& prepared;
    ShapeHit shape_hit{};
};

void finish(const Geometry& g, const Ray& ray, const Prepared& prepared, const Trace& trace,
            const KernelHit& found, Hit& hit);

// Which placed mesh a triangle of the scene's own BVH belongs to: an index into placed_items.
std::size_t placed_index(const Geometry& g, std::uint32_t triangle);

// A bound on how far a hit with an analytic shape, found in double, is off its surface.
double shape_hit_error(const Geometry& g, std::uint32_t item, const Ray& ray, const ShapeHit& hit);

// Tells for csg.h's functions whether a point of the world is inside an item's form; the context is a
// Geometry.
bool is_inside_form(const void* context, std::uint32_t item, Vec3 p);
inline CsgInside solids_of(const Geometry& g) { return {&g, &is_inside_form}; }

} // namespace pnr
