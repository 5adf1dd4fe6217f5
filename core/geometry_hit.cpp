// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry_impl.h"
#include "core/shape_field.h"

#include <cmath>

namespace pnr {

namespace {

template <class T>
T blend(const std::array<std::uint32_t, 3>& t, const std::vector<T>& values, Vec3 w) {
    return static_cast<float>(w.x) * values[t[0]] + static_cast<float>(w.y) * values[t[1]] +
           static_cast<float>(w.z) * values[t[2]];
}

struct Corners {
    Vec3 a, b, c;
};

// The shares of the corners at the point of the triangle closest to p, about; e and f are its sides from the
// first corner, n their cross product.
Vec3 barycentric(const Corners& t, Vec3 e, Vec3 f, Vec3 n, Vec3 p) {
    const Vec3 q = p - t.a;
    const double share = 1 / glm::dot(n, n);
    double b = glm::dot(glm::cross(q, f), n) * share, c = glm::dot(glm::cross(e, q), n) * share;
    if (!std::isfinite(b) || !std::isfinite(c)) return {1, 0, 0};
    b = std::clamp(b, 0.0, 1.0);
    c = std::clamp(c, 0.0, 1 - b);
    return {1 - b - c, b, c};
}

// The textures of a triangle's corners, by their shares.
void mix_corners(const GeometryItem& item, const std::array<std::uint32_t, 3>& numbers, Vec3 weights,
                 Hit& hit) {
    if (numbers[0] == no_texture || item.first_part == no_texture) return;
    const auto surface = [&](std::size_t k) { return item.first_part + numbers[k]; };
    hit.surface = surface(0);
    if (numbers[0] == numbers[1] && numbers[0] == numbers[2]) return;
    std::array<std::size_t, 3> order{0, 1, 2};
    const double w[3] = {weights.x, weights.y, weights.z};
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return w[a] > w[b]; });
    for (std::size_t k = 0; k < 3; ++k) {
        hit.mixed[k] = surface(order[k]);
        hit.shares[static_cast<int>(k)] = static_cast<float>(w[order[k]]);
    }
    hit.surface = hit.mixed[0];
}

void blend_normals(const GeometryItem& item, const MeshData& mesh, std::uint32_t number, Vec3 weights,
                   Hit& hit) {
    const Vec3 blended(blend(mesh.normal_triangles[number], mesh.normals, weights));
    const Vec3 shading = transform_normal(item.to_world, blended);
    const double length = glm::length(shading);
    if (length > 0) hit.shading_normal = (glm::dot(shading, hit.normal) < 0 ? -1.0 : 1.0) * shading / length;
}

// `corners` are in the space that `to_world` takes to the world (null: the world itself); p is about the hit,
// in that space. `side` is 1 where their winding is that of the outside, else -1.
void finish_mesh_hit(const GeometryItem& item, std::uint32_t number, const Corners& corners,
                     const Transform* to_world, double side, Vec3 p, Hit& hit) {
    const MeshData& mesh = *mesh_of(item)->data;
    const Vec3 e = corners.b - corners.a, f = corners.c - corners.a, n = glm::cross(e, f);
    const Vec3 weights = barycentric(corners, e, f, n, p);
    // Rounding of the corners' sum and of the plane that rays are cut with, whose normal is the worse the
    // thinner the triangle is; then of the way to the world.
    const double size = std::max({largest(corners.a), largest(corners.b), largest(corners.c)});
    const double sides = std::max(largest(e), largest(f)), height = largest(n);
    hit.error = 0x1p-48 * size + 0x1p-50 * sides * (sides * sides / height);
    hit.position = corners.a + weights.y * e + weights.z * f;
    Vec3 normal = n / height;
    if (to_world) {
        normal = transform_normal(*to_world, normal);
        hit.position = transform_point(to_world->matrix, hit.position);
        double stretch = 0;
        for (int k = 0; k < 3; ++k) stretch += largest(Vec3(to_world->matrix[k]));
        hit.error = 2 * stretch * hit.error + 0x1p-48 * (stretch * size + largest(Vec3(to_world->matrix[3])));
    }
    hit.normal = hit.shading_normal = side * glm::normalize(normal);
    if (!mesh.normals.empty()) blend_normals(item, mesh, number, weights, hit);
    if (!mesh.uvs.empty()) hit.uv = Vec2(blend(mesh.uv_triangles[number], mesh.uvs, weights));
    if (!mesh.texture_triangles.empty()) mix_corners(item, mesh.texture_triangles[number], weights, hit);
}

// The largest three shares of a blob's components; those without a texture show the object's.
void mix_parts(Hit& hit, const GeometryItem& item, const BlobShares& all) {
    double sum = 0;
    for (const auto& [texture, share] : all) sum += share;
    if (!(sum > 0)) return;
    for (std::size_t k = 0; k < all.size(); ++k) {
        hit.mixed[k] = all[k].texture == no_texture ? hit.surface : item.first_part + all[k].texture;
        hit.shares[static_cast<int>(k)] = static_cast<float>(all[k].share / sum);
    }
    hit.surface = hit.mixed[0];
    if (all[1].share == 0) hit.shares = Vec3f(0);
}

void finish_shape_hit(const Geometry& g, const Ray& ray, const ShapeHit& shape_hit, Hit& hit) {
    const GeometryItem& item = g.items[hit.leaf];
    hit.position = ray.origin + shape_hit.t * ray.direction;
    const Vec3 n = transform_normal(item.to_world, shape_hit.normal);
    const double side = item.inverse ? -1 : 1;
    hit.normal = hit.shading_normal = side * glm::normalize(n / largest(n));
    if (shape_hit.shading != Vec3(0)) {
        const Vec3 smooth = transform_normal(item.to_world, shape_hit.shading);
        hit.shading_normal = side * glm::normalize(smooth / largest(smooth));
    }
    hit.error = shape_hit_error(g, hit.leaf, ray, shape_hit);
    const Shape* shape = std::get_if<Shape>(&item.form);
    hit.uv = shape ? uv_of(*shape, shape_hit) : shape_hit.uv;
    const Blob* blob = shape ? std::get_if<Blob>(shape) : nullptr;
    if (blob && item.first_part != no_texture)
        mix_parts(hit, item, blob_shares(*blob->data, transform_point(item.to_world.inverse, hit.position)));
}

void finish_hit(const Geometry& g, const Ray& ray, const Prepared& prepared, const Trace& trace,
                const KernelHit& found, Hit& hit) {
    hit.t = prepared.from_kernel(found.t);
    hit.primitive = found.primitive;
    if (found.triangle == no_primitive) {
        hit.t = trace.shape_hit.t;
        hit.surface = hit.leaf = found.item;
        finish_shape_hit(g, ray, trace.shape_hit, hit);
        return;
    }
    const Vec3 p = ray.origin + hit.t * ray.direction;
    if (found.primitive < g.stats.placed_triangles) {
        const std::size_t placed = placed_index(g, found.triangle);
        // From the block that the ray has just met: CGAL's triangles are seldom in the cache.
        const auto stride = static_cast<std::size_t>(g.bvh.kernel->block_size);
        const double back = 1 / g.scale; // exact
        const auto corner = [&](std::size_t v) {
            const float* x = found.corners + 3 * v * stride;
            return back * Vec3(x[0], x[stride], x[2 * stride]);
        };
        hit.surface = hit.leaf = g.placed_items[placed];
        finish_mesh_hit(g.items[hit.leaf], found.triangle - g.placed_first[placed],
                        {corner(0), corner(1), corner(2)}, nullptr, g.placed_side[placed], p, hit);
    } else {
        hit.surface = hit.leaf = found.item;
        const GeometryItem& item = g.items[found.item];
        const MeshData& mesh = *mesh_of(item)->data;
        const auto& t = mesh.triangles[found.triangle];
        const Corners corners{Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]),
                              Vec3(mesh.positions[t[2]])};
        finish_mesh_hit(item, found.triangle, corners, &item.to_world, item.inverse ? -1 : 1,
                        transform_point(item.to_world.inverse, p), hit);
    }
}

} // namespace

std::size_t placed_index(const Geometry& g, std::uint32_t triangle) {
    return static_cast<std::size_t>(std::upper_bound(g.placed_first.begin(), g.placed_first.end(), triangle) -
                                    g.placed_first.begin()) -
           1;
}

double shape_hit_error(const Geometry& g, std::uint32_t index, const Ray& ray, const ShapeHit& hit) {
    // Rounding of the way there and of the shape's own coordinates, whose size the bounds tell.
    const Bounds& b = g.bounds[index];
    double size = largest(ray.origin) + largest(ray.origin + hit.t * ray.direction);
    if (std::isfinite(b.low.x)) size = std::max({size, largest(b.low), largest(b.high)});
    double stretch = 0;
    for (int k = 0; k < 3; ++k) stretch += largest(Vec3(g.items[index].to_world.matrix[k]));
    return std::max(0x1p-47 * size, stretch * hit.error);
}

void finish(const Geometry& g, const Ray& ray, const Prepared& prepared, const Trace& trace,
            const KernelHit& found, Hit& hit) {
    finish_hit(g, ray, prepared, trace, found, hit);
    if (const std::uint32_t leaf = g.csg.leaf_of_item[hit.leaf]; leaf != no_csg)
        if (const std::uint32_t shown = csg_textured_item(g.csg, leaf, hit.position, solids_of(g));
            shown != hit.leaf) {
            hit.surface = shown;
            hit.shares = Vec3f(0);
        }
}

} // namespace pnr
