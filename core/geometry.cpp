// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"

#include "core/bvh.h"
#include "core/shape_hits.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace pnr {

namespace {

// Copies of a mesh share one BVH where that saves more than this many triangles; else each is put into the
// scene's own, which is quicker to trace.
constexpr std::size_t worth_sharing = 50000;

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

} // namespace

struct Geometry {
    std::vector<GeometryItem> items;
    std::vector<Bounds> bounds; // of each item
    double scale = 1;           // world to kernel space: a power of two
    Bvh bvh;
    std::vector<Other> others;
    std::vector<std::uint32_t> placed_items,
        placed_first; // meshes in the scene's own BVH, and their first triangles
    std::vector<std::uint32_t> unbounded, unbounded_primitive;
    std::uint8_t hidden_from = 0; // of all items together
    GeometryStats stats;
};

namespace {

const Mesh* mesh_of(const GeometryItem& item) {
    const Shape* shape = std::get_if<Shape>(&item.form);
    return shape ? std::get_if<Mesh>(shape) : nullptr;
}

Bounds form_bounds(const GeometryItem& item) {
    if (const auto* h = std::get_if<Hemisphere>(&item.form))
        return shape_bounds(Sphere{h->center, h->radius});
    if (const auto* p = std::get_if<Parallelogram>(&item.form)) {
        Bounds b = merge(Bounds{}, p->corner);
        b = merge(merge(b, p->corner + p->u), p->corner + p->v);
        return merge(b, p->corner + p->u + p->v);
    }
    return shape_bounds(std::get<Shape>(item.form));
}

int intersect_form(const GeometryItem& item, const Ray& ray, HitList& hits) {
    if (const auto* h = std::get_if<Hemisphere>(&item.form)) {
        intersect_shape(Sphere{h->center, h->radius}, ray, hits);
        const auto other_half = [&](const ShapeHit& hit) { return !(glm::dot(hit.normal, h->axis) >= 0); };
        hits.erase(std::remove_if(hits.begin(), hits.end(), other_half), hits.end());
        return static_cast<int>(hits.size());
    }
    hits.clear();
    if (const auto* p = std::get_if<Parallelogram>(&item.form)) {
        const Vec3 n = glm::cross(p->u, p->v);
        const double slope = glm::dot(n, ray.direction);
        if (slope == 0) return 0;
        const Vec3 o = ray.origin - p->corner;
        const double t = -glm::dot(n, o) / slope;
        if (!(t > ray.t_min && t < ray.t_max)) return 0;
        const Vec3 at = o + t * ray.direction;
        const double n2 = glm::dot(n, n);
        const double a = glm::dot(glm::cross(at, p->v), n) / n2, b = glm::dot(glm::cross(p->u, at), n) / n2;
        if (!(a >= 0 && a <= 1 && b >= 0 && b <= 1)) return 0;
        hits.push_back({t, n, {a, b}, 0});
        return 1;
    }
    return intersect_shape(std::get<Shape>(item.form), ray, hits);
}

// ---- rays in kernel space
// -------------------------------------------------------------------------------------

// A ray as the kernel wants it, and the way back: t = shift + t_kernel / rate.
struct Prepared {
    KernelRay ray;
    double shift = 0, rate = 1;
    bool misses = false; // it does not come near

    double to_kernel(double t) const { return (t - shift) * rate; }
    double from_kernel(double t) const { return shift + t / rate; }
};

// `scale` times space is kernel space, where all lies within `reach` of the origin. Rays from far away, or
// with a negative t_min, start where they come near.
Prepared prepare(Vec3 origin, Vec3 direction, double t_min, double t_max, double scale) {
    constexpr double reach = 4;
    Prepared p;
    Vec3 o = scale * origin;
    const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (!(largest > 0) || !std::isfinite(largest)) {
        p.misses = true;
        return p;
    }
    Vec3 d = direction;
    p.rate = scale;
    if (largest < 0.5 || largest >= 2) {
        const int exponent = std::ilogb(largest);
        d *= std::ldexp(1.0, -exponent);
        p.rate = std::ldexp(scale, exponent);
    }
    if (std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) > 2 * reach || t_min < 0) {
        const double d2 = glm::dot(d, d), nearest = -glm::dot(o, d) / d2, half = reach / std::sqrt(d2);
        const Vec3 closest = o + nearest * d;
        const double start = std::max((nearest - half) / p.rate, t_min);
        if (!(glm::dot(closest, closest) < reach * reach) || start >= t_max ||
            start > (nearest + half) / p.rate) {
            p.misses = true;
            return p;
        }
        p.shift = start;
        o += start * p.rate * d;
    }
    for (int k = 0; k < 3; ++k) p.ray.origin[k] = o[k], p.ray.direction[k] = d[k];
    p.ray.t_min = p.to_kernel(std::max(t_min, p.shift));
    p.ray.t_max = p.to_kernel(t_max);
    return p;
}

// ---- what the kernel calls
// ------------------------------------------------------------------------------------

struct Trace {
    const Geometry& g;
    const Ray& ray; // in world space
    std::uint8_t bit;
    const Prepared& prepared;
    ShapeHit shape_hit{}; // of the best hit, if that is a shape
};

bool better(double t, std::uint32_t primitive, const KernelHit& hit) {
    return t < hit.t || (t == hit.t && primitive < hit.primitive);
}

bool meets_shape(Trace& trace, std::uint32_t index, std::uint32_t primitive, KernelHit& hit) {
    const GeometryItem& item = trace.g.items[index];
    const Ray own{transform_point(item.to_world.inverse, trace.ray.origin),
                  transform_vector(item.to_world.inverse, trace.ray.direction), trace.ray.t_min,
                  trace.ray.t_max};
    HitList hits;
    if (intersect_form(item, own, hits) == 0) return false;
    const double t = trace.prepared.to_kernel(hits[0].t);
    if (!better(t, primitive, hit)) return false;
    hit.t = t;
    hit.primitive = primitive;
    hit.item = index;
    hit.triangle = no_primitive;
    trace.shape_hit = hits[0];
    return true;
}

bool meets_instance(const Other& other, const GeometryItem& item, double scale, const KernelRay& ray,
                    KernelHit& hit) {
    const SharedMesh& mesh = *other.mesh;
    const Vec3 o(ray.origin[0], ray.origin[1], ray.origin[2]),
        d(ray.direction[0], ray.direction[1], ray.direction[2]);
    const Prepared own =
        prepare(transform_point(item.to_world.inverse, o / scale),
                transform_vector(item.to_world.inverse, d / scale), ray.t_min, hit.t, mesh.scale);
    if (own.misses) return false;
    KernelHit found;
    found.t = own.ray.t_max;
    closest(mesh.bvh, own.ray, {}, found);
    if (found.primitive == no_primitive) return false;
    const double t = own.from_kernel(found.t);
    if (!(t > ray.t_min) || !better(t, other.first_primitive + found.triangle, hit)) return false;
    hit = {t, other.first_primitive + found.triangle, other.item, found.triangle};
    return true;
}

bool meets_other(const void* context, std::uint32_t index, const KernelRay& ray, KernelHit& hit) {
    Trace& trace = *static_cast<Trace*>(const_cast<void*>(context));
    const Other& other = trace.g.others[index];
    const GeometryItem& item = trace.g.items[other.item];
    if (item.hidden_from & trace.bit) return false;
    if (!other.mesh) return meets_shape(trace, other.item, other.first_primitive, hit);
    return meets_instance(other, item, trace.g.scale, ray, hit);
}

std::size_t placed_index(const Geometry& g, std::uint32_t triangle) {
    return static_cast<std::size_t>(std::upper_bound(g.placed_first.begin(), g.placed_first.end(), triangle) -
                                    g.placed_first.begin()) -
           1;
}

bool sees_triangle(const void* context, std::uint32_t triangle) {
    const Trace& trace = *static_cast<const Trace*>(context);
    return !(trace.g.items[trace.g.placed_items[placed_index(trace.g, triangle)]].hidden_from & trace.bit);
}

KernelCalls calls_for(Trace& trace) {
    const bool all_seen = !(trace.g.hidden_from & trace.bit);
    return {&trace, &meets_other, all_seen ? nullptr : &sees_triangle};
}

// ---- from the kernel's hit to the world's
// ---------------------------------------------------------------------

template <class T>
T blend(const std::array<std::uint32_t, 3>& t, const std::vector<T>& values, Vec3 w) {
    return static_cast<float>(w.x) * values[t[0]] + static_cast<float>(w.y) * values[t[1]] +
           static_cast<float>(w.z) * values[t[2]];
}

double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

struct Corners {
    Vec3 a, b, c;
};

// The shares of the corners at the point of the triangle closest to p, about.
Vec3 barycentric(const Corners& t, Vec3 p) {
    const Vec3 e = t.b - t.a, f = t.c - t.a, n = glm::cross(e, f), q = p - t.a;
    const double n2 = glm::dot(n, n);
    double b = glm::dot(glm::cross(q, f), n) / n2, c = glm::dot(glm::cross(e, q), n) / n2;
    if (!std::isfinite(b) || !std::isfinite(c)) return {1, 0, 0};
    b = std::clamp(b, 0.0, 1.0);
    c = std::clamp(c, 0.0, 1 - b);
    return {1 - b - c, b, c};
}

// `corners` are in the space that `to_world` takes to the world; p is about the hit, in that space.
void finish_mesh_hit(const GeometryItem& item, std::uint32_t number, const Corners& corners,
                     const Transform& to_world, Vec3 p, Hit& hit) {
    const MeshData& mesh = *mesh_of(item)->data;
    const Vec3 weights = barycentric(corners, p);
    const Vec3 e = corners.b - corners.a, f = corners.c - corners.a, n = glm::cross(e, f);
    const Vec3 own = corners.a + weights.y * e + weights.z * f;
    hit.position = transform_point(to_world.matrix, own);
    const bool mirrored = glm::determinant(glm::dmat3(item.to_world.matrix)) < 0;
    // The corners' own space is either the mesh's, or the world: there a mirror has turned the winding round.
    const bool in_world = &to_world != &item.to_world;
    const double side = (in_world && mirrored) != item.inverse ? -1 : 1;
    hit.normal = side * glm::normalize(transform_normal(to_world, n / largest(n)));
    hit.shading_normal = hit.normal;
    if (!mesh.normals.empty()) {
        const Vec3 blended(blend(mesh.normal_triangles[number], mesh.normals, weights));
        const Vec3 shading = transform_normal(item.to_world, blended);
        const double length = glm::length(shading);
        if (length > 0)
            hit.shading_normal = (glm::dot(shading, hit.normal) < 0 ? -1.0 : 1.0) * shading / length;
    }
    if (!mesh.uvs.empty()) hit.uv = Vec2(blend(mesh.uv_triangles[number], mesh.uvs, weights));
    // Rounding of the corners' sum and of the plane that rays are cut with, whose normal is the worse the
    // thinner the triangle is; then of the way to the world.
    const double size = std::max({largest(corners.a), largest(corners.b), largest(corners.c)});
    const double sides = std::max(largest(e), largest(f));
    const double own_error = 0x1p-48 * size + 0x1p-50 * sides * (sides * sides / largest(n));
    if (in_world) {
        hit.error = own_error;
        return;
    }
    double stretch = 0, shift = 0;
    for (int k = 0; k < 3; ++k) stretch += largest(Vec3(to_world.matrix[k]));
    shift = largest(Vec3(to_world.matrix[3]));
    hit.error = 2 * stretch * own_error + 0x1p-48 * (stretch * size + shift);
}

void finish_shape_hit(const Geometry& g, const Ray& ray, const ShapeHit& shape_hit, Hit& hit) {
    const GeometryItem& item = g.items[hit.surface];
    hit.position = ray.origin + shape_hit.t * ray.direction;
    const Vec3 n = transform_normal(item.to_world, shape_hit.normal);
    hit.normal = hit.shading_normal = (item.inverse ? -1.0 : 1.0) * glm::normalize(n / largest(n));
    hit.uv = shape_hit.uv;
    // Rounding of the way there and of the shape's own coordinates, whose size the bounds tell.
    const Bounds& b = g.bounds[hit.surface];
    double size = largest(ray.origin) + largest(hit.position);
    if (std::isfinite(b.low.x)) size = std::max({size, largest(b.low), largest(b.high)});
    double stretch = 0;
    for (int k = 0; k < 3; ++k) stretch += largest(Vec3(item.to_world.matrix[k]));
    hit.error = std::max(0x1p-47 * size, stretch * shape_hit.error);
}

static const Transform in_place;

Hit finish(const Geometry& g, const Ray& ray, const Prepared& prepared, const Trace& trace,
           const KernelHit& found) {
    Hit hit;
    hit.t = prepared.from_kernel(found.t);
    hit.primitive = found.primitive;
    if (found.triangle == no_primitive) {
        hit.t = trace.shape_hit.t;
        hit.surface = found.item;
        finish_shape_hit(g, ray, trace.shape_hit, hit);
        return hit;
    }
    const Vec3 p = ray.origin + hit.t * ray.direction;
    if (found.primitive < g.stats.placed_triangles) {
        const std::size_t placed = placed_index(g, found.triangle);
        float v[9];
        g.bvh.triangles->corners(found.triangle, v);
        const Corners corners{Vec3(v[0], v[1], v[2]) / g.scale, Vec3(v[3], v[4], v[5]) / g.scale,
                              Vec3(v[6], v[7], v[8]) / g.scale};
        hit.surface = g.placed_items[placed];
        finish_mesh_hit(g.items[hit.surface], found.triangle - g.placed_first[placed], corners, in_place, p,
                        hit);
    } else {
        hit.surface = found.item;
        const GeometryItem& item = g.items[found.item];
        const MeshData& mesh = *mesh_of(item)->data;
        const auto& t = mesh.triangles[found.triangle];
        const Corners corners{Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]),
                              Vec3(mesh.positions[t[2]])};
        finish_mesh_hit(item, found.triangle, corners, item.to_world,
                        transform_point(item.to_world.inverse, p), hit);
    }
    return hit;
}

// ---- building
// -------------------------------------------------------------------------------------------------

double power_of_two_below(double x) { return x > 0 && std::isfinite(x) ? std::ldexp(1.0, std::ilogb(x)) : 1; }

std::shared_ptr<const SharedMesh> share(const MeshData& mesh) {
    auto shared = std::make_shared<SharedMesh>();
    double size = 0;
    for (const Vec3f& p : mesh.positions) size = std::max(size, largest(Vec3(p)));
    shared->scale = 0.5 / power_of_two_below(size);
    std::vector<float> corners;
    corners.reserve(9 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t)
            for (int k = 0; k < 3; ++k)
                corners.push_back(
                    static_cast<float>(shared->scale * static_cast<double>(mesh.positions[v][k])));
    shared->bvh = build_bvh(corners, {}, best_kernel());
    return shared;
}

struct GeometryBuilder {
    Geometry& g;
    std::vector<float> corners;
    std::vector<FloatBox> boxes;
    std::map<const MeshData*, std::size_t> uses;
    std::map<const MeshData*, std::shared_ptr<const SharedMesh>> shared;

    bool is_shared(const MeshData& mesh) const {
        return (uses.at(&mesh) - 1) * mesh.triangles.size() > worth_sharing;
    }

    void measure() {
        Bounds all;
        for (const GeometryItem& item : g.items) {
            g.bounds.push_back(item_bounds(item));
            const Bounds& b = g.bounds.back();
            if (!is_empty(b) && std::isfinite(largest(b.low)) && std::isfinite(largest(b.high)))
                all = merge(all, b);
            if (const Mesh* mesh = mesh_of(item)) ++uses[mesh->data.get()];
            g.hidden_from |= item.hidden_from;
        }
        if (!is_empty(all)) g.scale = 0.5 / power_of_two_below(std::max(largest(all.low), largest(all.high)));
    }

    void place_mesh(std::uint32_t index) {
        const GeometryItem& item = g.items[index];
        const MeshData& mesh = *mesh_of(item)->data;
        g.placed_items.push_back(index);
        g.placed_first.push_back(static_cast<std::uint32_t>(corners.size() / 9));
        std::vector<Vec3f> placed;
        placed.reserve(mesh.positions.size());
        for (const Vec3f& p : mesh.positions)
            placed.emplace_back(g.scale * transform_point(item.to_world.matrix, Vec3(p)));
        for (const auto& t : mesh.triangles)
            for (const std::uint32_t v : t)
                for (int k = 0; k < 3; ++k) corners.push_back(placed[v][k]);
    }

    void add_other(std::uint32_t index, std::uint32_t& next, std::shared_ptr<const SharedMesh> mesh,
                   std::uint32_t size) {
        const Bounds& b = g.bounds[index];
        FloatBox box;
        for (int k = 0; k < 3; ++k) { // outwards, by more than what rounds here and in the transforms
            const double slack =
                0x1p-22 * std::max(std::abs(b.low[k]), std::abs(b.high[k])) + 0x1p-40 / g.scale;
            box.low[k] = static_cast<float>(g.scale * (b.low[k] - slack));
            box.high[k] = static_cast<float>(g.scale * (b.high[k] + slack));
        }
        boxes.push_back(box);
        g.others.push_back({index, next, std::move(mesh)});
        next += size;
    }

    void add_others() {
        auto next = static_cast<std::uint32_t>(corners.size() / 9);
        for (std::uint32_t i = 0; i < g.items.size(); ++i) {
            if (is_empty(g.bounds[i])) continue;
            const Mesh* mesh = mesh_of(g.items[i]);
            if (!std::isfinite(largest(g.bounds[i].low)) || !std::isfinite(largest(g.bounds[i].high))) {
                if (mesh) continue;
                g.unbounded.push_back(i);
                g.unbounded_primitive.push_back(next++);
            } else if (!mesh) {
                add_other(i, next, nullptr, 1);
                ++g.stats.shapes;
            } else if (is_shared(*mesh->data)) {
                auto& entry = shared[mesh->data.get()];
                if (!entry) entry = share(*mesh->data);
                add_other(i, next, entry, static_cast<std::uint32_t>(mesh->data->triangles.size()));
                ++g.stats.instances;
            }
        }
    }
};

} // namespace

Bounds item_bounds(const GeometryItem& item) {
    const Bounds own = form_bounds(item);
    if (is_empty(own)) return {};
    if (!std::isfinite(own.low.x) || !std::isfinite(own.high.x)) return {Vec3(-infinity), Vec3(infinity)};
    Bounds world;
    for (int corner = 0; corner < 8; ++corner)
        world = merge(world, transform_point(item.to_world.matrix, {corner & 1 ? own.high.x : own.low.x,
                                                                    corner & 2 ? own.high.y : own.low.y,
                                                                    corner & 4 ? own.high.z : own.low.z}));
    return world;
}

std::shared_ptr<const Geometry> make_geometry(std::vector<GeometryItem> items) {
    const auto start = std::chrono::steady_clock::now();
    auto geometry = std::make_shared<Geometry>();
    Geometry& g = *geometry;
    g.items = std::move(items);
    GeometryBuilder builder{g, {}, {}, {}, {}};
    builder.measure();
    for (std::uint32_t i = 0; i < g.items.size(); ++i) {
        const Mesh* mesh = mesh_of(g.items[i]);
        if (mesh && !is_empty(g.bounds[i]) && !builder.is_shared(*mesh->data)) builder.place_mesh(i);
    }
    builder.add_others();
    g.bvh = build_bvh(builder.corners, builder.boxes, best_kernel());
    g.stats.placed_triangles = static_cast<std::uint32_t>(builder.corners.size() / 9);
    std::size_t bytes = g.bvh.bytes, triangles = g.bvh.triangle_count;
    for (const auto& [mesh, shared] : builder.shared)
        bytes += shared->bvh.bytes, triangles += shared->bvh.triangle_count;
    g.stats.triangles = static_cast<std::int64_t>(triangles);
    g.stats.unbounded = static_cast<std::int64_t>(g.unbounded.size());
    g.stats.bytes = static_cast<std::int64_t>(bytes);
    g.stats.build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return geometry;
}

GeometryStats geometry_stats(const Geometry& g) { return g.stats; }

std::span<const GeometryItem> geometry_items(const Geometry& geometry) { return geometry.items; }

std::optional<Hit> closest_hit(const Geometry& g, const Ray& ray, RayKind kind) {
    const Prepared prepared = prepare(ray.origin, ray.direction, ray.t_min, ray.t_max, g.scale);
    Trace trace{g, ray, ray_bit(kind), prepared};
    // Unbounded shapes are met in world units: a ray that starts far away is not cut for them.
    KernelHit hit;
    hit.t = prepared.to_kernel(ray.t_max);
    for (std::size_t i = 0; i < g.unbounded.size(); ++i)
        if (!(g.items[g.unbounded[i]].hidden_from & trace.bit))
            meets_shape(trace, g.unbounded[i], g.unbounded_primitive[i], hit);
    if (!prepared.misses) {
        KernelRay kernel_ray = prepared.ray;
        kernel_ray.t_max = std::min(kernel_ray.t_max, std::nextafter(hit.t, infinity));
        closest(g.bvh, kernel_ray, calls_for(trace), hit);
    }
    if (hit.primitive == no_primitive) return std::nullopt;
    return finish(g, ray, prepared, trace, hit);
}

bool is_occluded(const Geometry& g, const Ray& ray, RayKind kind) {
    const Prepared prepared = prepare(ray.origin, ray.direction, ray.t_min, ray.t_max, g.scale);
    Trace trace{g, ray, ray_bit(kind), prepared};
    KernelHit hit;
    hit.t = prepared.to_kernel(ray.t_max);
    for (std::size_t i = 0; i < g.unbounded.size(); ++i)
        if (!(g.items[g.unbounded[i]].hidden_from & trace.bit) &&
            meets_shape(trace, g.unbounded[i], g.unbounded_primitive[i], hit))
            return true;
    return !prepared.misses && occluded(g.bvh, prepared.ray, calls_for(trace));
}

} // namespace pnr
