// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry_impl.h"

#include <chrono>
#include <cmath>
#include <map>

namespace pnr {

namespace {

// Copies of a mesh share one BVH where that saves more than this many triangles; else each is put into the
// scene's own, which is quicker to trace.
constexpr std::size_t worth_sharing = 50000;

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

constexpr Bounds everywhere{Vec3(-infinity), Vec3(infinity)};

bool is_finite(const Bounds& b) { return std::isfinite(largest(b.low)) && std::isfinite(largest(b.high)); }
Bounds common(const Bounds& a, const Bounds& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

// A box without an end on some sides: those may stay on sides of their own.
Bounds place_endless_box(const Bounds& own, const Transform& to_world) {
    Bounds world{Vec3(to_world.matrix[3]), Vec3(to_world.matrix[3])};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const double m = to_world.matrix[column][row];
            if (m == 0) continue;
            world.low[row] += m * (m > 0 ? own.low : own.high)[column];
            world.high[row] += m * (m > 0 ? own.high : own.low)[column];
        }
    return world;
}

Bounds place_box(const Bounds& own, const Transform& to_world) {
    if (is_empty(own)) return {};
    if (!is_finite(own)) return place_endless_box(own, to_world);
    Bounds world;
    for (int corner = 0; corner < 8; ++corner)
        world = merge(world, transform_point(to_world.matrix, {corner & 1 ? own.high.x : own.low.x,
                                                               corner & 2 ? own.high.y : own.low.y,
                                                               corner & 4 ? own.high.z : own.low.z}));
    return world;
}

// Of all items; a mesh is measured once, however often it stands there.
std::vector<Bounds> bounds_of(std::span<const GeometryItem> items) {
    std::map<const MeshData*, Bounds> meshes;
    std::vector<Bounds> all;
    all.reserve(items.size());
    for (const GeometryItem& item : items) {
        const Mesh* mesh = mesh_of(item);
        if (!mesh || !mesh->data) {
            all.push_back(item_bounds(item));
            continue;
        }
        const auto [entry, is_new] = meshes.try_emplace(mesh->data.get());
        if (is_new) entry->second = form_bounds(item);
        all.push_back(place_box(entry->second, item.to_world));
    }
    return all;
}

// Wide enough for points that were computed.
Bounds widened(const Bounds& b) {
    const auto slack = [](double x) { return std::isfinite(x) ? 0x1p-40 * std::abs(x) : 0; };
    Bounds wide = b;
    for (int k = 0; k < 3; ++k) wide.low[k] -= slack(b.low[k]), wide.high[k] += slack(b.high[k]);
    return wide;
}

// A plane that lies along two axes is seen in a slab without height, and inside it is the space to one side.
bool plane_leaf(const GeometryItem& item, const Plane& plane, CsgLeaf& leaf) {
    const Vec3 normal = transform_normal(item.to_world, plane.normal);
    const Vec3 point = transform_point(item.to_world.matrix, plane.distance * plane.normal);
    for (int k = 0; k < 3; ++k) {
        const double across = std::abs(normal[(k + 1) % 3]) + std::abs(normal[(k + 2) % 3]);
        if (!(across <= 1e-15 * std::abs(normal[k]))) continue;
        leaf.surface.low[k] = leaf.surface.high[k] = point[k];
        (normal[k] > 0 ? leaf.inside.high : leaf.inside.low)[k] = point[k];
        (normal[k] > 0 ? leaf.outside.low : leaf.outside.high)[k] = point[k];
        return true;
    }
    return false;
}

CsgLeaf leaf_of(const GeometryItem& item, const Bounds& bounds) {
    CsgLeaf leaf{bounds, everywhere, everywhere, item.inverse};
    const Shape* shape = std::get_if<Shape>(&item.form);
    const Plane* plane = shape ? std::get_if<Plane>(shape) : nullptr;
    const bool endless = shape && has_endless_inside(*shape);
    if (plane)
        plane_leaf(item, *plane, leaf);
    else if (!endless)
        leaf.inside = bounds;
    if (!is_finite(leaf.surface)) leaf.surface = common(leaf.surface, item.limits);
    if (item.inverse) std::swap(leaf.inside, leaf.outside);
    return leaf;
}

Csg make_csg_of(std::span<const GeometryItem> items, const std::vector<Bounds>& bounds,
                const std::vector<CsgNode>& solids) {
    std::vector<CsgLeaf> leaves;
    leaves.reserve(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        leaves.push_back(leaf_of(items[i], bounds[i]));
        leaves.back().inside = widened(leaves.back().inside);
        leaves.back().outside = widened(leaves.back().outside);
    }
    Csg csg = make_csg(solids, leaves);
    for (std::size_t i = 0; i < items.size(); ++i)
        if (items[i].hidden_from == hidden_from_all || is_empty(csg.seen[i])) csg.seen[i] = {};
    return csg;
}

// A mesh without a border: every edge has an even number of faces.
bool is_closed(const MeshData& mesh) {
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = t[k], b = t[(k + 1) % 3];
            edges.push_back(a < b ? a << 32 | b : b << 32 | a);
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if ((j - i) % 2) return false;
    }
    return !edges.empty();
}

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

    bool is_shared(std::uint32_t item) const {
        const MeshData& mesh = *mesh_of(g.items[item])->data;
        return g.csg.leaf_of_item[item] != no_csg ||
               (uses.at(&mesh) - 1) * mesh.triangles.size() > worth_sharing;
    }

    const std::shared_ptr<const SharedMesh>& share_once(const MeshData& mesh) {
        auto& entry = shared[&mesh];
        if (!entry) entry = share(mesh);
        return entry;
    }

    void measure(const std::vector<CsgNode>& solids) {
        g.bounds = bounds_of(g.items);
        g.csg = make_csg_of(g.items, g.bounds, solids);
        Bounds all;
        for (std::uint32_t i = 0; i < g.items.size(); ++i) {
            if (!is_empty(g.csg.seen[i]) && is_finite(g.csg.seen[i])) all = merge(all, g.csg.seen[i]);
            if (const Mesh* mesh = mesh_of(g.items[i])) ++uses[mesh->data.get()];
            if (!is_empty(g.csg.seen[i])) g.hidden_from |= g.items[i].hidden_from;
        }
        if (!is_empty(all)) g.scale = 0.5 / power_of_two_below(std::max(largest(all.low), largest(all.high)));
    }

    void place_mesh(std::uint32_t index) {
        const GeometryItem& item = g.items[index];
        const MeshData& mesh = *mesh_of(item)->data;
        g.placed_items.push_back(index);
        g.placed_first.push_back(static_cast<std::uint32_t>(corners.size() / 9));
        const bool mirrored = glm::determinant(glm::dmat3(item.to_world.matrix)) < 0;
        g.placed_side.push_back(mirrored != item.inverse ? -1 : 1);
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
        const Bounds& b = g.csg.seen[index];
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
            if (is_empty(g.csg.seen[i])) continue;
            const Mesh* mesh = mesh_of(g.items[i]);
            if (!is_finite(g.csg.seen[i])) {
                if (mesh) continue;
                g.unbounded.push_back(i);
                g.unbounded_primitive.push_back(next++);
            } else if (!mesh) {
                add_other(i, next, nullptr, 1);
                ++g.stats.shapes;
            } else if (is_shared(i)) {
                add_other(i, next, share_once(*mesh->data),
                          static_cast<std::uint32_t>(mesh->data->triangles.size()));
                ++g.stats.instances;
            }
        }
    }

    // Meshes of the text are solids if they say so, those of files if they are closed.
    void find_solid_meshes() {
        g.solid_meshes.resize(g.items.size());
        std::map<const MeshData*, bool> closed;
        for (std::uint32_t i = 0; i < g.items.size(); ++i) {
            const Mesh* mesh = mesh_of(g.items[i]);
            if (!mesh || g.csg.leaf_of_item[i] == no_csg || mesh->data->triangles.empty()) continue;
            if (!mesh->inside_vector) {
                if (mesh->file.empty()) continue;
                const auto [entry, is_new] = closed.try_emplace(mesh->data.get());
                if (is_new) entry->second = is_closed(*mesh->data);
                if (!entry->second) continue;
            }
            g.solid_meshes[i] = share_once(*mesh->data);
        }
    }
};

} // namespace

Bounds item_bounds(const GeometryItem& item) { return place_box(form_bounds(item), item.to_world); }

Bounds inside_bounds(const GeometryItem& item) {
    const CsgLeaf leaf = leaf_of(item, item_bounds(item));
    return item.inverse ? leaf.outside : leaf.inside;
}

std::vector<Bounds> seen_bounds(std::span<const GeometryItem> items, const std::vector<CsgNode>& solids) {
    return make_csg_of(items, bounds_of(items), solids).seen;
}

std::shared_ptr<const Geometry> make_geometry(std::vector<GeometryItem> items,
                                              const std::vector<CsgNode>& solids) {
    const auto start = std::chrono::steady_clock::now();
    auto geometry = std::make_shared<Geometry>();
    Geometry& g = *geometry;
    g.items = std::move(items);
    GeometryBuilder builder{g, {}, {}, {}, {}};
    builder.measure(solids);
    for (std::uint32_t i = 0; i < g.items.size(); ++i)
        if (mesh_of(g.items[i]) && !is_empty(g.csg.seen[i]) && !builder.is_shared(i)) builder.place_mesh(i);
    builder.add_others();
    builder.find_solid_meshes();
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

} // namespace pnr
