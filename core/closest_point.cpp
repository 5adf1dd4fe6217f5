// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/closest_point.h"

#include "core/geometry.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>

namespace pnr {

namespace {

// Closest points are constructions, not decisions, so a kernel over plain doubles is all they need.
using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

struct MeshIndex {
    std::uint32_t surface = 0;
    bool inverse = false;
    Triangles triangles;              // world space; those with an area
    std::vector<std::uint32_t> names; // their numbers in the mesh
    Tree tree;
};

struct ShapeIndex {
    std::uint32_t surface = 0;
    const GeometryItem* item = nullptr;
    bool similar = false; // the transform keeps angles: nearest in the shape's space is nearest in the world
};

} // namespace

struct SurfaceIndex {
    std::vector<std::unique_ptr<MeshIndex>> meshes;
    std::vector<ShapeIndex> shapes;
    const Geometry* geometry = nullptr;
    bool gated = false;                // a tree of solids hides parts of the surfaces
    std::vector<ClosestPoint> samples; // if so: points that are seen
};

namespace {

Kernel::Point_3 to_cgal(Vec3 p) { return {p.x, p.y, p.z}; }
Vec3 from_cgal(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

// Triangles stand where the rays meet them: at float coordinates of world space.
std::unique_ptr<MeshIndex> index_mesh(const MeshData& data, const GeometryItem& item, std::uint32_t surface) {
    auto index = std::make_unique<MeshIndex>();
    index->surface = surface;
    index->inverse = item.inverse;
    const auto place = [&](std::uint32_t v) {
        return Vec3(Vec3f(transform_point(item.to_world.matrix, Vec3(data.positions[v]))));
    };
    for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
        const auto& [a, b, c] = data.triangles[t];
        const Vec3 p = place(a), q = place(b), r = place(c);
        if (!(glm::length(glm::cross(q - p, r - p)) > 0)) continue;
        index->triangles.emplace_back(to_cgal(p), to_cgal(q), to_cgal(r));
        index->names.push_back(t);
    }
    if (index->triangles.empty()) return nullptr;
    index->tree.insert(index->triangles.cbegin(), index->triangles.cend());
    index->tree.build();
    index->tree.accelerate_distance_queries();
    return index;
}

bool keeps_angles(const Mat4& m) {
    const Vec3 x(m[0]), y(m[1]), z(m[2]);
    const double xx = glm::dot(x, x), yy = glm::dot(y, y), zz = glm::dot(z, z);
    const double slack = 1e-9 * xx;
    return std::abs(xx - yy) < slack && std::abs(xx - zz) < slack && std::abs(glm::dot(x, y)) < slack &&
           std::abs(glm::dot(x, z)) < slack && std::abs(glm::dot(y, z)) < slack;
}

ClosestPoint closest_on_mesh(const MeshIndex& index, Vec3 point) {
    const auto [nearest, which] = index.tree.closest_point_and_primitive(to_cgal(point));
    const Kernel::Triangle_3& triangle = *which;
    const Vec3 a = from_cgal(triangle[0]), b = from_cgal(triangle[1]), c = from_cgal(triangle[2]);
    ClosestPoint found;
    found.position = from_cgal(nearest);
    found.distance = glm::distance(found.position, point);
    found.surface = index.surface;
    found.triangle = index.names[static_cast<std::size_t>(which - index.triangles.cbegin())];
    const Vec3 normal = glm::cross(b - a, c - a);
    const double area2 = glm::dot(normal, normal);
    const Vec3 p = found.position;
    found.weights =
        Vec3(glm::dot(glm::cross(b - p, c - p), normal), glm::dot(glm::cross(c - p, a - p), normal),
             glm::dot(glm::cross(a - p, b - p), normal)) /
        area2;
    found.normal = normal / std::sqrt(area2) * (index.inverse ? -1.0 : 1.0);
    return found;
}

// The shape's nearest point to a place of the world, found in the shape's space.
ClosestPoint project_to_shape(const ShapeIndex& index, Vec3 near_to, Vec3 point) {
    const GeometryItem& item = *index.item;
    ClosestPoint found =
        closest_point_on_shape(std::get<Shape>(item.form), transform_point(item.to_world.inverse, near_to));
    found.position = transform_point(item.to_world.matrix, found.position);
    found.normal =
        glm::normalize(transform_normal(item.to_world, found.normal)) * (item.inverse ? -1.0 : 1.0);
    found.distance = glm::distance(found.position, point);
    found.surface = index.surface;
    return found;
}

ClosestPoint closest_on_shape(const ShapeIndex& index, Vec3 point) {
    ClosestPoint best = project_to_shape(index, point, point);
    if (index.similar || !std::isfinite(best.distance)) return best;
    // Descent along the surface: step by the tangent part of the way to the query, come back to the surface,
    // shorten steps that lead away.
    double step = 1;
    for (int i = 0; i < 400 && step > 1e-9; ++i) {
        const Vec3 way = point - best.position;
        const Vec3 tangent = way - best.normal * glm::dot(way, best.normal);
        const ClosestPoint next = project_to_shape(index, best.position + step * tangent, point);
        if (next.distance < best.distance) {
            best = next;
            step *= 1.5;
        } else {
            step *= 0.5;
        }
    }
    return best;
}

// ---- trees of solids
// ---------------------------------------------------------------------------------------------------

// The surface nearest to `near_to` on the item of a point that is already known, as seen from `point`.
ClosestPoint on_same_item(const SurfaceIndex& index, const ClosestPoint& known, Vec3 near_to, Vec3 point) {
    for (const ShapeIndex& shape : index.shapes)
        if (shape.surface == known.surface) return project_to_shape(shape, near_to, point);
    for (const auto& mesh : index.meshes)
        if (mesh->surface == known.surface) {
            ClosestPoint found = closest_on_mesh(*mesh, near_to);
            found.distance = glm::distance(found.position, point);
            return found;
        }
    return {};
}

bool is_seen(const SurfaceIndex& index, const ClosestPoint& at) {
    return std::isfinite(at.distance) && is_seen(*index.geometry, at.surface, at.position, at.normal);
}

// From a seen point downhill along its surface, as far as that is seen.
ClosestPoint descend(const SurfaceIndex& index, ClosestPoint best, Vec3 point) {
    double step = 1;
    for (int i = 0; i < 200 && step > 1e-9; ++i) {
        const Vec3 way = point - best.position;
        const Vec3 tangent = way - best.normal * glm::dot(way, best.normal);
        const ClosestPoint next = on_same_item(index, best, best.position + step * tangent, point);
        const bool takes = next.distance < best.distance && is_seen(index, next);
        if (takes) best = next;
        step *= takes ? 1.5 : 0.5;
    }
    return best;
}

// Seen points of the object, where a grid of lines along each axis meets it.
void take_samples(SurfaceIndex& index, const World& world, int object) {
    constexpr int lines = 40;
    const Bounds& box = world.objects[static_cast<std::size_t>(object)].bounds;
    if (is_empty(box) || !std::isfinite(glm::length(box.high - box.low))) return;
    const Vec3 size = box.high - box.low;
    const double reach = glm::length(size);
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < lines * lines; ++i) {
            Vec3 origin = box.low, direction(0);
            origin[axis] -= 0.01 * reach;
            origin[(axis + 1) % 3] += (i / lines + 0.5) / lines * size[(axis + 1) % 3];
            origin[(axis + 2) % 3] += (i % lines + 0.5) / lines * size[(axis + 2) % 3];
            direction[axis] = 1;
            Ray ray{origin, direction, 0, 1.02 * reach};
            for (int hits = 0; hits < 64; ++hits) {
                const auto hit = closest_hit(*index.geometry, ray, RayKind::photon);
                if (!hit) break;
                ray.t_min = hit->t + 1e-9 * reach;
                if (world.surfaces[hit->surface].object != object) continue;
                ClosestPoint sample;
                sample.position = hit->position;
                sample.normal = hit->normal;
                sample.surface = hit->surface;
                index.samples.push_back(sample);
            }
        }
}

ClosestPoint nearest_sample(const SurfaceIndex& index, Vec3 point) {
    ClosestPoint best;
    for (const ClosestPoint& sample : index.samples)
        if (const double distance = glm::distance(sample.position, point); distance < best.distance)
            best = sample, best.distance = distance;
    if (!std::isfinite(best.distance)) return best;
    const ClosestPoint there = on_same_item(index, best, best.position, point);
    return descend(index, is_seen(index, there) ? there : best, point);
}

} // namespace

std::shared_ptr<const SurfaceIndex> index_surface(const World& world, int object) {
    auto index = std::make_shared<SurfaceIndex>();
    if (!world.geometry) return index;
    index->geometry = world.geometry.get();
    const auto items = geometry_items(*world.geometry);
    for (std::uint32_t i = 0; i < items.size() && i < world.surfaces.size(); ++i) {
        if (world.surfaces[i].object != object || world.surfaces[i].light >= 0) continue;
        const Shape* shape = std::get_if<Shape>(&items[i].form);
        if (!shape || items[i].hidden_from == hidden_from_all) continue;
        index->gated |= is_part_of_solid(*world.geometry, i);
        if (const auto* mesh = std::get_if<Mesh>(shape)) {
            if (!mesh->data) continue;
            if (auto made = index_mesh(*mesh->data, items[i], i)) index->meshes.push_back(std::move(made));
        } else {
            index->shapes.push_back({i, &items[i], keeps_angles(items[i].to_world.matrix)});
        }
    }
    if (index->gated) take_samples(*index, world, object);
    return index;
}

ClosestPoint closest_point(const SurfaceIndex& index, Vec3 point) {
    ClosestPoint best, hidden;
    const auto consider = [&](const ClosestPoint& found) {
        ClosestPoint& place = index.gated && !is_seen(index, found) ? hidden : best;
        if (found.distance < place.distance ||
            (found.distance == place.distance && found.surface < place.surface))
            place = found;
    };
    for (const auto& mesh : index.meshes) consider(closest_on_mesh(*mesh, point));
    for (const ShapeIndex& shape : index.shapes) consider(closest_on_shape(shape, point));
    // Something hidden is nearer: what is seen of that may be nearer, too.
    if (hidden.distance < best.distance) consider(nearest_sample(index, point));
    return best;
}

ClosestPoint closest_point_on_object(const World& world, int object, Vec3 point) {
    return closest_point(*index_surface(world, object), point);
}

} // namespace pnr
