// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"

#include "core/mesh_io.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

struct Primitive {
    std::uint32_t item = 0, triangle = 0;
};
struct Node {
    Bounds bounds;
    std::uint32_t first = 0, count = 0; // count 0: children at first and first + 1
};
struct Triangle {
    Vec3f a, b, c;
};

} // namespace

struct Geometry {
    std::vector<GeometryItem> items;
    std::vector<std::uint32_t> first_primitive; // of each item
    std::vector<Bounds> bounds;                 // of each item
    std::vector<Primitive> primitives;
    std::vector<Triangle> triangles; // parallel to primitives
    std::vector<Node> nodes;
    std::vector<std::uint32_t> unbounded;
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

int intersect_form(const GeometryItem& item, const Ray& ray, std::array<ShapeHit, 4>& hits) {
    if (const auto* h = std::get_if<Hemisphere>(&item.form)) {
        const int count = intersect_shape(Sphere{h->center, h->radius}, ray, hits);
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const ShapeHit hit = hits[static_cast<std::size_t>(i)];
            if (glm::dot(hit.normal, h->axis) >= 0) hits[static_cast<std::size_t>(kept++)] = hit;
        }
        return kept;
    }
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
        hits[0] = {t, n, {a, b}};
        return 1;
    }
    return intersect_shape(std::get<Shape>(item.form), ray, hits);
}

// Watertight ray/triangle test of Woop, Benthin and Wald 2013, in double.
struct WoopRay {
    Vec3 origin;
    int x, y, z;
    double sx, sy, sz;
    explicit WoopRay(const Ray& r) : origin(r.origin) {
        const Vec3 d = glm::abs(r.direction);
        z = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
        x = (z + 1) % 3;
        y = (x + 1) % 3;
        if (r.direction[z] < 0) std::swap(x, y);
        sx = r.direction[x] / r.direction[z];
        sy = r.direction[y] / r.direction[z];
        sz = 1 / r.direction[z];
    }
};

bool hit_triangle(const WoopRay& r, const Triangle& tri, double t_min, double t_max, double& t,
                  Vec3& weights) {
    const Vec3 a = Vec3(tri.a) - r.origin, b = Vec3(tri.b) - r.origin, c = Vec3(tri.c) - r.origin;
    const double ax = a[r.x] - r.sx * a[r.z], ay = a[r.y] - r.sy * a[r.z];
    const double bx = b[r.x] - r.sx * b[r.z], by = b[r.y] - r.sy * b[r.z];
    const double cx = c[r.x] - r.sx * c[r.z], cy = c[r.y] - r.sy * c[r.z];
    const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double det = u + v + w;
    if (det == 0) return false;
    t = (u * a[r.z] + v * b[r.z] + w * c[r.z]) * r.sz / det;
    if (!(t > t_min && t < t_max)) return false;
    weights = Vec3(u, v, w) / det;
    return true;
}

// The box test of Ize 2013, "Robust BVH ray traversal": the far side is widened by the rounding of both.
bool hits_box(const Bounds& box, const Ray& r, const Vec3& inverse, double t_max) {
    double t0 = r.t_min, t1 = t_max;
    for (int k = 0; k < 3; ++k) {
        double near = (box.low[k] - r.origin[k]) * inverse[k], far = (box.high[k] - r.origin[k]) * inverse[k];
        if (near > far) std::swap(near, far);
        if (near > t0) t0 = near; // NaN (0 * inf) leaves the interval as it is
        if (far * (1 + 1e-15) < t1) t1 = far * (1 + 1e-15);
    }
    return t0 <= t1;
}

void build_nodes(Geometry& g, std::vector<Bounds>& boxes, std::uint32_t node, std::uint32_t first,
                 std::uint32_t count) {
    Bounds all, centers;
    for (std::uint32_t i = first; i < first + count; ++i) {
        all = merge(all, boxes[i]);
        centers = merge(centers, 0.5 * (boxes[i].low + boxes[i].high));
    }
    g.nodes[node] = {all, first, count};
    const Vec3 size = centers.high - centers.low;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    if (count <= 4 || !(size[axis] > 0)) return;
    std::vector<std::uint32_t> order(count);
    for (std::uint32_t i = 0; i < count; ++i) order[i] = first + i;
    std::nth_element(
        order.begin(), order.begin() + count / 2, order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].low[axis] + boxes[a].high[axis] < boxes[b].low[axis] + boxes[b].high[axis];
        });
    std::vector<Bounds> sorted_boxes(count);
    std::vector<Primitive> sorted_primitives(count);
    std::vector<Triangle> sorted_triangles(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        sorted_boxes[i] = boxes[order[i]];
        sorted_primitives[i] = g.primitives[order[i]];
        sorted_triangles[i] = g.triangles[order[i]];
    }
    std::copy(sorted_boxes.begin(), sorted_boxes.end(), boxes.begin() + first);
    std::copy(sorted_primitives.begin(), sorted_primitives.end(), g.primitives.begin() + first);
    std::copy(sorted_triangles.begin(), sorted_triangles.end(), g.triangles.begin() + first);
    const auto child = static_cast<std::uint32_t>(g.nodes.size());
    g.nodes.resize(g.nodes.size() + 2);
    g.nodes[node].first = child;
    g.nodes[node].count = 0;
    build_nodes(g, boxes, child, first, count / 2);
    build_nodes(g, boxes, child + 1, first + count / 2, count - count / 2);
}

struct Found {
    double t = infinity;
    std::uint32_t item = 0, primitive = 0, triangle_at = 0;
    ShapeHit shape_hit;
    Vec3 weights{0};
    bool any = false;
};

void try_shape(const Geometry& g, std::uint32_t index, const Ray& ray, Found& best) {
    const GeometryItem& item = g.items[index];
    const Ray own{transform_point(item.to_world.inverse, ray.origin),
                  transform_vector(item.to_world.inverse, ray.direction), ray.t_min,
                  std::nextafter(best.t, infinity)};
    std::array<ShapeHit, 4> hits;
    if (intersect_form(item, own, hits) == 0) return;
    if (hits[0].t > best.t || (hits[0].t == best.t && g.first_primitive[index] > best.primitive)) return;
    best = {hits[0].t, index, g.first_primitive[index], 0, hits[0], Vec3(0), true};
}

// The closest hit, or any when `any` is set.
Found trace(const Geometry& g, const Ray& ray, RayKind kind, bool any) {
    Found best;
    best.t = ray.t_max;
    best.primitive = ~0u;
    const std::uint8_t bit = ray_bit(kind);
    for (const std::uint32_t index : g.unbounded)
        if (!(g.items[index].hidden_from & bit)) try_shape(g, index, ray, best);
    if (g.nodes.empty() || (any && best.any)) return best;
    const WoopRay woop(ray);
    const Vec3 inverse = 1.0 / ray.direction;
    std::uint32_t stack[128];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Node& node = g.nodes[stack[--top]];
        if (!hits_box(node.bounds, ray, inverse, best.t)) continue;
        if (node.count == 0) {
            stack[top++] = node.first;
            stack[top++] = node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Primitive p = g.primitives[i];
            if (g.items[p.item].hidden_from & bit) continue;
            if (!mesh_of(g.items[p.item])) {
                try_shape(g, p.item, ray, best);
            } else {
                double t;
                Vec3 weights;
                if (!hit_triangle(woop, g.triangles[i], ray.t_min, std::nextafter(best.t, infinity), t,
                                  weights))
                    continue;
                const std::uint32_t number = g.first_primitive[p.item] + p.triangle;
                if (t > best.t || (t == best.t && number > best.primitive)) continue;
                best = {t, p.item, number, i, {}, weights, true};
            }
            if (any && best.any) return best;
        }
    }
    return best;
}

template <class T>
T blend(const std::array<std::uint32_t, 3>& t, const std::vector<T>& values, Vec3 w) {
    return static_cast<float>(w.x) * values[t[0]] + static_cast<float>(w.y) * values[t[1]] +
           static_cast<float>(w.z) * values[t[2]];
}

void finish_mesh_hit(const Geometry& g, const Found& f, const GeometryItem& item, Hit& hit) {
    const Triangle& tri = g.triangles[f.triangle_at];
    const MeshData& mesh = *mesh_of(item)->data;
    const std::uint32_t number = g.primitives[f.triangle_at].triangle;
    const Vec3 a(tri.a), b(tri.b), c(tri.c);
    hit.position = f.weights.x * a + f.weights.y * b + f.weights.z * c;
    const double side = (glm::determinant(glm::dmat3(item.to_world.matrix)) < 0) != item.inverse ? -1 : 1;
    hit.normal = side * glm::normalize(glm::cross(b - a, c - a));
    hit.shading_normal = hit.normal;
    if (!mesh.normals.empty()) {
        const Vec3 own(blend(mesh.normal_triangles[number], mesh.normals, f.weights));
        const Vec3 n = transform_normal(item.to_world, own);
        if (glm::dot(n, n) > 0) hit.shading_normal = glm::normalize(glm::dot(n, hit.normal) < 0 ? -n : n);
    }
    if (!mesh.uvs.empty()) hit.uv = Vec2(blend(mesh.uv_triangles[number], mesh.uvs, f.weights));
    const Vec3 size = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    hit.error = 0x1p-48 * std::max({size.x, size.y, size.z});
}

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

std::shared_ptr<const Geometry> make_geometry(std::vector<GeometryItem> items, double radius) {
    auto geometry = std::make_shared<Geometry>();
    Geometry& g = *geometry;
    g.items = std::move(items);
    std::vector<Bounds> boxes;
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < g.items.size(); ++i) {
        const GeometryItem& item = g.items[i];
        g.first_primitive.push_back(next);
        g.bounds.push_back(item_bounds(item));
        const Mesh* mesh = mesh_of(item);
        next += mesh && mesh->data ? static_cast<std::uint32_t>(mesh->data->triangles.size()) : 1;
        if (is_empty(g.bounds[i])) continue;
        if (!mesh) {
            if (!std::isfinite(g.bounds[i].low.x)) {
                g.unbounded.push_back(i);
                continue;
            }
            const Bounds b{g.bounds[i].low - 1e-12 * radius, g.bounds[i].high + 1e-12 * radius};
            g.primitives.push_back({i, 0});
            g.triangles.emplace_back();
            boxes.push_back(b);
            continue;
        }
        for (std::uint32_t k = 0; k < mesh->data->triangles.size(); ++k) {
            const auto place = [&](std::uint32_t v) {
                return Vec3f(transform_point(item.to_world.matrix, Vec3(mesh->data->positions[v])));
            };
            const auto& t = mesh->data->triangles[k];
            const Triangle tri{place(t[0]), place(t[1]), place(t[2])};
            const Vec3 n = glm::cross(Vec3(tri.b) - Vec3(tri.a), Vec3(tri.c) - Vec3(tri.a));
            if (n == Vec3(0)) continue;
            g.primitives.push_back({i, k});
            g.triangles.push_back(tri);
            boxes.push_back(merge(merge(merge(Bounds{}, Vec3(tri.a)), Vec3(tri.b)), Vec3(tri.c)));
        }
    }
    if (!boxes.empty()) {
        g.nodes.resize(1);
        build_nodes(g, boxes, 0, 0, static_cast<std::uint32_t>(boxes.size()));
    }
    return geometry;
}

std::span<const GeometryItem> geometry_items(const Geometry& geometry) { return geometry.items; }

GeometryStats geometry_stats(const Geometry& g) {
    GeometryStats s;
    for (const Primitive& p : g.primitives) ++(mesh_of(g.items[p.item]) ? s.triangles : s.shapes);
    s.unbounded = static_cast<std::int64_t>(g.unbounded.size());
    const double bytes = static_cast<double>(g.nodes.size() * sizeof(Node) +
                                             g.primitives.size() * (sizeof(Primitive) + sizeof(Triangle)));
    s.bytes_per_triangle = s.triangles ? bytes / static_cast<double>(s.triangles) : 0;
    return s;
}

std::optional<Hit> closest_hit(const Geometry& g, const Ray& ray, RayKind kind) {
    const Found f = trace(g, ray, kind, false);
    if (!f.any) return std::nullopt;
    const GeometryItem& item = g.items[f.item];
    Hit hit;
    hit.t = f.t;
    hit.surface = f.item;
    hit.primitive = f.primitive;
    if (mesh_of(item)) {
        finish_mesh_hit(g, f, item, hit);
        return hit;
    }
    hit.position = ray.origin + f.t * ray.direction;
    const Vec3 n = transform_normal(item.to_world, f.shape_hit.normal);
    hit.normal = hit.shading_normal = (item.inverse ? -1.0 : 1.0) * glm::normalize(n);
    hit.uv = f.shape_hit.uv;
    // Rounding of the way there and of the shape's own coordinates, whose size the bounds tell.
    Vec3 size = glm::abs(ray.origin) + glm::abs(hit.position);
    if (std::isfinite(g.bounds[f.item].low.x))
        size = glm::max(size, glm::max(glm::abs(g.bounds[f.item].low), glm::abs(g.bounds[f.item].high)));
    hit.error = 0x1p-47 * std::max({size.x, size.y, size.z});
    return hit;
}

bool is_occluded(const Geometry& g, const Ray& ray, RayKind kind) { return trace(g, ray, kind, true).any; }

MeshData tessellate(const BicubicPatch& patch) {
    const int rows = 1 << std::clamp(patch.v_steps, 0, 10), columns = 1 << std::clamp(patch.u_steps, 0, 10);
    const auto basis = [](double t, double(&b)[4], double(&d)[4]) {
        const double s = 1 - t;
        b[0] = s * s * s, b[1] = 3 * s * s * t, b[2] = 3 * s * t * t, b[3] = t * t * t;
        d[0] = -3 * s * s, d[1] = 3 * s * s - 6 * s * t, d[2] = 6 * s * t - 3 * t * t, d[3] = 3 * t * t;
    };
    MeshData mesh;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            double bu[4], du[4], bv[4], dv[4];
            basis(static_cast<double>(column) / columns, bu, du);
            basis(static_cast<double>(row) / rows, bv, dv);
            Vec3 p(0), along_u(0), along_v(0);
            for (std::size_t r = 0; r < 4; ++r)
                for (std::size_t c = 0; c < 4; ++c) {
                    const Vec3& q = patch.points[r * 4 + c];
                    p += bu[c] * bv[r] * q;
                    along_u += du[c] * bv[r] * q;
                    along_v += bu[c] * dv[r] * q;
                }
            const Vec3 n = glm::cross(along_u, along_v);
            mesh.positions.emplace_back(p);
            mesh.normals.emplace_back(n == Vec3(0) ? Vec3(0) : glm::normalize(n));
            mesh.uvs.emplace_back(static_cast<double>(column) / columns, static_cast<double>(row) / rows);
        }
    }
    const auto at = [&](int row, int column) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
            mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
        }
    // Where an edge of the patch has shrunk to a point its normal comes from the triangles around it.
    const std::vector<Vec3f> around = area_weighted_normals(mesh.positions, mesh.triangles);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        if (mesh.normals[i] == Vec3f(0)) mesh.normals[i] = around[i];
    mesh.normal_triangles = mesh.triangles;
    mesh.uv_triangles = mesh.triangles;
    return mesh;
}

} // namespace pnr
