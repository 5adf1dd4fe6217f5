// SPDX-License-Identifier: GPL-3.0-or-later
// What build_world hands to the rays: meshes and analytic shapes with their place in world space, and the BVH
// over them.
#pragma once

#include "core/csg.h"
#include "core/shape.h"
#include "core/types.h"
#include "core/world.h"

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace pnr {

// Emitters that are no shape of the language. They live here in double, so that a light's sampled points lie
// on them.
struct Hemisphere { // the half of the sphere on the side of `axis` (unit), without a lid
    Vec3 center{0};
    double radius = 1;
    Vec3 axis{0, 1, 0};
};
struct Parallelogram { // corner + a u + b v, a and b in [0, 1]; the normal is cross(u, v)
    Vec3 corner{0}, u{1, 0, 0}, v{0, 0, 1};
};

// One leaf of the scene. Its index is the hit's `surface`.
struct GeometryItem {
    std::variant<Shape, Hemisphere, Parallelogram>
        form; // a Mesh has its data; a BicubicPatch is not taken: see tessellate
    Transform to_world;
    bool inverse = false;         // normals point the other way
    std::uint8_t hidden_from = 0; // 1 << RayKind for each kind of ray that passes through
    std::uint32_t first_part = no_texture; // surface of texture 0 of the shape's own parts, if they are shown
    // Where an endless surface is looked for, in world space; nothing is looked at beyond.
    Bounds limits{Vec3(-infinity), Vec3(infinity)};
};
inline std::uint8_t ray_bit(RayKind kind) {
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(kind));
}

inline constexpr std::uint8_t hidden_from_all = 0xff;

// Builds the BVH. Degenerate triangles and shapes are kept out: nothing hits them. Meshes that stand in the
// scene more than once, and are large, are built once and met in their own space; so are those in trees of
// solids.
std::shared_ptr<const Geometry> make_geometry(std::vector<GeometryItem> items,
                                              const std::vector<CsgNode>& solids = {});

// Where each item can be seen, in world space: infinite where there is no bound, empty where it is never
// seen.
std::vector<Bounds> seen_bounds(std::span<const GeometryItem> items, const std::vector<CsgNode>& solids);

// Whether p is inside the last of the solids that were given to make_geometry. False if there were none.
bool is_inside_last(const Geometry& geometry, Vec3 p);

bool is_part_of_solid(const Geometry& geometry, std::uint32_t item);

// Whether the item's surface at p, with this normal, is seen, or cut away by its tree of solids.
bool is_seen(const Geometry& geometry, std::uint32_t item, Vec3 p, Vec3 normal);

struct GeometryStats {
    std::int64_t triangles = 0; // in the BVHs; a shared mesh counts once
    std::int64_t shapes = 0, instances = 0, unbounded = 0;
    std::int64_t bytes = 0;             // of nodes and leaf data
    double build_s = 0;                 // wall time of make_geometry
    std::uint32_t placed_triangles = 0; // in the scene's own BVH: primitives below this number
};
GeometryStats geometry_stats(const Geometry& geometry);

// The leaves as they were given to make_geometry; the index is the hit's `surface`.
std::span<const GeometryItem> geometry_items(const Geometry& geometry);

std::optional<Hit> closest_hit(const Geometry& geometry, const Ray& ray, RayKind kind);
bool is_occluded(const Geometry& geometry, const Ray& ray, RayKind kind);

// Bounds of an item in world space; infinite for unbounded shapes, empty for empty ones.
Bounds item_bounds(const GeometryItem& item);
// The same of its inside, as if it were not inverse: of a plane along the axes, the half space.
Bounds inside_bounds(const GeometryItem& item);

// The patch as triangles with smooth normals, in its own space: 2^u_steps by 2^v_steps cells [POV-Ray 3.7
// manual 3.4.5.2.2].
MeshData tessellate(const BicubicPatch& patch);

} // namespace pnr
