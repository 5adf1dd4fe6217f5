// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry_impl.h"

#include <cmath>

namespace pnr {

namespace {

int intersect_form(const GeometryItem& item, const Ray& ray, HitList& hits, int enough) {
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
    return intersect_shape(std::get<Shape>(item.form), ray, hits, enough);
}

bool better(double t, std::uint32_t primitive, const KernelHit& hit) {
    return t < hit.t || (t == hit.t && primitive < hit.primitive);
}

// Whether the item's tree lets a hit be seen: `error` bounds how far p is off the surface, whose normal is n.
// The points that are asked about lie so far before and behind that surfaces meant to coincide do.
bool shows(const Geometry& g, std::uint32_t item, Vec3 p, Vec3 direction, Vec3 n, double error) {
    const std::uint32_t leaf = g.csg.leaf_of_item[item];
    if (leaf == no_csg) return true;
    const double length = glm::length(direction);
    const double slope = std::abs(glm::dot(n, direction)) / (glm::length(n) * length);
    const Vec3 step = (8 * error / (length * (slope > 0x1p-14 ? slope : 0x1p-14))) * direction;
    return csg_shows(g.csg, leaf, p - step, p + step, solids_of(g));
}

bool meets_shape(Trace& trace, std::uint32_t index, std::uint32_t primitive, KernelHit& hit) {
    const GeometryItem& item = trace.g.items[index];
    const double end = trace.prepared.from_kernel(hit.t);
    const Ray own{transform_point(item.to_world.inverse, trace.ray.origin),
                  transform_vector(item.to_world.inverse, trace.ray.direction), trace.ray.t_min,
                  std::min(trace.ray.t_max, end + 0x1p-40 * std::abs(end))};
    HitList hits;
    const bool gated = trace.g.csg.leaf_of_item[index] != no_csg;
    intersect_form(item, own, hits, gated ? all_hits : 1);
    for (const ShapeHit& met : hits) {
        const double t = trace.prepared.to_kernel(met.t);
        if (!better(t, primitive, hit)) return false;
        if (!shows(trace.g, index, trace.ray.origin + met.t * trace.ray.direction, trace.ray.direction,
                   transform_normal(item.to_world, met.normal),
                   shape_hit_error(trace.g, index, trace.ray, met)))
            continue;
        hit.t = t;
        hit.primitive = primitive;
        hit.item = index;
        hit.triangle = no_primitive;
        trace.shape_hit = met;
        return true;
    }
    return false;
}

// What the gate of a mesh in a tree needs to know of the ray that its BVH sees in a space of its own.
struct InstanceGate {
    const Trace& trace;
    const Other& other;
    const Prepared& own;
};

bool gate_triangle(const void* context, std::uint32_t number, double t) {
    const auto& [trace, other, own] = *static_cast<const InstanceGate*>(context);
    const Geometry& g = trace.g;
    const GeometryItem& item = g.items[other.item];
    float v[9];
    other.mesh->bvh.triangles->corners(number, v);
    const Vec3 a(v[0], v[1], v[2]), b(v[3], v[4], v[5]), c(v[6], v[7], v[8]);
    const double world_t = trace.prepared.from_kernel(own.from_kernel(t));
    const Vec3 p = trace.ray.origin + world_t * trace.ray.direction;
    const double size = largest(trace.ray.origin) + largest(p) + largest(g.bounds[other.item].low) +
                        largest(g.bounds[other.item].high);
    return shows(g, other.item, p, trace.ray.direction,
                 transform_normal(item.to_world, glm::cross(b - a, c - a)), 0x1p-46 * size);
}

bool meets_instance(const Trace& trace, const Other& other, const KernelRay& ray, KernelHit& hit) {
    const SharedMesh& mesh = *other.mesh;
    const GeometryItem& item = trace.g.items[other.item];
    const Vec3 o(ray.origin[0], ray.origin[1], ray.origin[2]),
        d(ray.direction[0], ray.direction[1], ray.direction[2]);
    const Prepared own =
        prepare(transform_point(item.to_world.inverse, o / trace.g.scale),
                transform_vector(item.to_world.inverse, d / trace.g.scale), ray.t_min, hit.t, mesh.scale);
    if (own.misses) return false;
    const InstanceGate gate{trace, other, own};
    KernelHit found;
    found.t = own.ray.t_max;
    const bool gated = trace.g.csg.leaf_of_item[other.item] != no_csg;
    closest(mesh.bvh, own.ray, gated ? KernelCalls{&gate, nullptr, &gate_triangle} : KernelCalls{}, found);
    if (found.primitive == no_primitive) return false;
    const double t = own.from_kernel(found.t);
    if (!(t > ray.t_min) || !better(t, other.first_primitive + found.triangle, hit)) return false;
    hit = {t, other.first_primitive + found.triangle, other.item, found.triangle, nullptr};
    return true;
}

bool meets_other(const void* context, std::uint32_t index, const KernelRay& ray, KernelHit& hit) {
    Trace& trace = *static_cast<Trace*>(const_cast<void*>(context));
    const Other& other = trace.g.others[index];
    const GeometryItem& item = trace.g.items[other.item];
    if (item.hidden_from & trace.bit) return false;
    if (!other.mesh) return meets_shape(trace, other.item, other.first_primitive, hit);
    return meets_instance(trace, other, ray, hit);
}

bool sees_triangle(const void* context, std::uint32_t triangle, double) {
    const Trace& trace = *static_cast<const Trace*>(context);
    return !(trace.g.items[trace.g.placed_items[placed_index(trace.g, triangle)]].hidden_from & trace.bit);
}

KernelCalls calls_for(Trace& trace) {
    const bool all_seen = !(trace.g.hidden_from & trace.bit);
    return {&trace, &meets_other, all_seen ? nullptr : &sees_triangle};
}

// ---- insides
// ---------------------------------------------------------------------------------------------------

bool count_triangle(const void* context, std::uint32_t, double) {
    ++*static_cast<int*>(const_cast<void*>(context));
    return false; // and go on
}

// By the parity of the surfaces on the way out.
bool is_inside_mesh(const SharedMesh& mesh, Vec3 p, Vec3 way) {
    const Prepared ray = prepare(p, way, 0, infinity, mesh.scale);
    if (ray.misses) return false;
    int count = 0;
    KernelHit none;
    none.t = infinity;
    closest(mesh.bvh, ray.ray, {&count, nullptr, &count_triangle}, none);
    return count % 2 == 1;
}

} // namespace

bool is_inside_form(const void* context, std::uint32_t index, Vec3 p) {
    const Geometry& g = *static_cast<const Geometry*>(context);
    const GeometryItem& item = g.items[index];
    const Vec3 own = transform_point(item.to_world.inverse, p);
    const Shape* shape = std::get_if<Shape>(&item.form);
    if (!shape) return false; // emitters are no solids
    const Mesh* mesh = std::get_if<Mesh>(shape);
    if (!mesh) return inside_shape(*shape, own);
    constexpr Vec3 any_way(0.5773, 0.6112, 0.5414); // no edge of a model lies along it
    const SharedMesh* solid = g.solid_meshes[index].get();
    return solid && is_inside_mesh(*solid, own, mesh->inside_vector.value_or(any_way));
}

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

GeometryStats geometry_stats(const Geometry& g) { return g.stats; }

bool is_inside_last(const Geometry& g, Vec3 p) {
    if (g.csg.nodes.empty()) return false;
    return csg_contains(g.csg, static_cast<std::uint32_t>(g.csg.nodes.size()) - 1, p, solids_of(g));
}

bool is_part_of_solid(const Geometry& g, std::uint32_t item) { return g.csg.leaf_of_item[item] != no_csg; }

bool is_seen(const Geometry& g, std::uint32_t item, Vec3 p, Vec3 normal) {
    if (g.items[item].hidden_from == hidden_from_all) return false;
    const double size = largest(p) + largest(g.bounds[item].low) + largest(g.bounds[item].high);
    return shows(g, item, p, normal, normal, 0x1p-44 * (std::isfinite(size) ? size : largest(p)));
}

std::span<const GeometryItem> geometry_items(const Geometry& geometry) { return geometry.items; }

std::optional<Hit> closest_hit(const Geometry& g, const Ray& ray, RayKind kind) {
    Prepared prepared = prepare(ray.origin, ray.direction, ray.t_min, ray.t_max, g.scale);
    Trace trace{g, ray, ray_bit(kind), prepared};
    // Unbounded shapes are met in world units: a ray that starts far away is not cut for them.
    KernelHit hit;
    hit.t = prepared.to_kernel(ray.t_max);
    for (std::size_t i = 0; i < g.unbounded.size(); ++i)
        if (!(g.items[g.unbounded[i]].hidden_from & trace.bit))
            meets_shape(trace, g.unbounded[i], g.unbounded_primitive[i], hit);
    if (!prepared.misses) {
        prepared.ray.t_max = std::min(prepared.ray.t_max, std::nextafter(hit.t, infinity));
        closest(g.bvh, prepared.ray, calls_for(trace), hit);
    }
    // Made in its place: a copy would wait for what has just been stored number by number.
    std::optional<Hit> found;
    if (hit.primitive != no_primitive) finish(g, ray, prepared, trace, hit, found.emplace());
    return found;
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
