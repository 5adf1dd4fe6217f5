// SPDX-License-Identifier: GPL-3.0-or-later
// Parametric surfaces become meshes. The square of u and v is cut into quarters again and again, until the
// middles of a piece's edges and its own middle are within the accuracy of where flat pieces would have them.
// All vertices stand on one grid of u and v; a piece takes up the vertices that smaller neighbours have on
// its edges, so that no gap is left.
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace pnr {

namespace {

constexpr int side = 1 << 10;               // of the grid
constexpr int coarsest = side >> 5;         // the largest piece
constexpr std::size_t most_pieces = 400000; // beyond, pieces are taken as they are

struct Piece {
    int u, v, size;
};

struct Tessellator {
    const ParametricData& data;
    MeshData mesh{};
    FieldScratch scratch{};
    std::unordered_map<int, std::uint32_t> vertices{};
    std::vector<Piece> pieces{};

    Vec2 parameters(int u, int v) const {
        return data.low + Vec2(u, v) / double(side) * (data.high - data.low);
    }
    Vec3 point(Vec2 at) {
        const FieldProgram* const fields[3] = {&data.x, &data.y, &data.z};
        Vec3 p;
        for (int k = 0; k < 3; ++k) {
            p[k] = field_value(*fields[k], Vec3(at.x, at.y, 0), scratch);
            if (!(std::abs(p[k]) < 1e30)) p[k] = 0;
        }
        return p;
    }
    Vec3 grid_point(int u, int v) { return point(parameters(u, v)); }

    bool is_flat(int u, int v, int size) {
        const int h = size / 2;
        const Vec3 a = grid_point(u, v), b = grid_point(u + size, v), c = grid_point(u, v + size),
                   d = grid_point(u + size, v + size);
        const auto lies = [&](Vec3 expected, int x, int y) {
            return glm::distance(expected, grid_point(x, y)) <= data.accuracy;
        };
        return lies(0.5 * (a + b), u + h, v) && lies(0.5 * (a + c), u, v + h) &&
               lies(0.5 * (b + d), u + size, v + h) && lies(0.5 * (c + d), u + h, v + size) &&
               lies(0.25 * (a + b + c + d), u + h, v + h);
    }

    void divide(int u, int v, int size) {
        const bool enough = size == 1 || pieces.size() >= most_pieces;
        if (size <= coarsest && (enough || is_flat(u, v, size))) {
            vertex(u, v), vertex(u + size, v), vertex(u, v + size), vertex(u + size, v + size);
            pieces.push_back({u, v, size});
            return;
        }
        const int h = size / 2;
        divide(u, v, h), divide(u + h, v, h), divide(u, v + h, h), divide(u + h, v + h, h);
    }

    static int key(int u, int v) { return u * (side + 1) + v; }

    std::uint32_t add_vertex(Vec3 p, Vec3 normal, Vec2 uv) {
        const double length = glm::length(normal);
        mesh.positions.emplace_back(p);
        mesh.normals.emplace_back(length > 0 ? normal / length : Vec3(0));
        mesh.uvs.emplace_back(uv);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }

    std::uint32_t vertex(int u, int v) {
        const auto [entry, is_new] = vertices.try_emplace(key(u, v));
        if (!is_new) return entry->second;
        const Vec2 at = parameters(u, v), step = 1e-4 * (data.high - data.low);
        const Vec3 along_u = point(at + Vec2(step.x, 0)) - point(at - Vec2(step.x, 0));
        const Vec3 along_v = point(at + Vec2(0, step.y)) - point(at - Vec2(0, step.y));
        return entry->second = add_vertex(point(at), glm::cross(along_u, along_v), at);
    }

    // The vertices from one end of an edge up to the other, which is left out.
    void edge(std::vector<std::uint32_t>& ring, int u0, int v0, int u1, int v1) {
        const int um = (u0 + u1) / 2, vm = (v0 + v1) / 2;
        if (std::abs(u1 - u0) + std::abs(v1 - v0) > 1 && vertices.contains(key(um, vm))) {
            edge(ring, u0, v0, um, vm);
            edge(ring, um, vm, u1, v1);
        } else {
            ring.push_back(vertex(u0, v0));
        }
    }

    void fill(const Piece& p) {
        std::vector<std::uint32_t> ring;
        edge(ring, p.u, p.v, p.u + p.size, p.v);
        edge(ring, p.u + p.size, p.v, p.u + p.size, p.v + p.size);
        edge(ring, p.u + p.size, p.v + p.size, p.u, p.v + p.size);
        edge(ring, p.u, p.v + p.size, p.u, p.v);
        if (ring.size() == 4) {
            add_triangle(ring[0], ring[1], ring[2]);
            add_triangle(ring[0], ring[2], ring[3]);
            return;
        }
        const std::uint32_t middle = vertex(p.u + p.size / 2, p.v + p.size / 2);
        for (std::size_t i = 0; i < ring.size(); ++i)
            add_triangle(middle, ring[i], ring[(i + 1) % ring.size()]);
    }

    bool is_contained(std::uint32_t v) const { return is_contained(Vec3(mesh.positions[v])); }
    bool is_contained(Vec3 p) const {
        return data.in_sphere ? inside_shape(data.sphere, p) : inside_shape(data.box, p);
    }

    // Where the edge from a vertex inside the container to one outside leaves it.
    std::uint32_t leave(std::uint32_t inside, std::uint32_t outside) {
        const Vec3 a(mesh.positions[inside]), b(mesh.positions[outside]);
        double low = 0, high = 1;
        for (int i = 0; i < 40; ++i) {
            const double t = 0.5 * (low + high);
            (is_contained(a + t * (b - a)) ? low : high) = t;
        }
        const auto between = [&](auto p, auto q) { return p + low * (q - p); };
        return add_vertex(between(a, b), between(Vec3(mesh.normals[inside]), Vec3(mesh.normals[outside])),
                          between(Vec2(mesh.uvs[inside]), Vec2(mesh.uvs[outside])));
    }

    // The part of it inside the container.
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::array<std::uint32_t, 3> corners{a, b, c};
        std::vector<std::uint32_t> kept;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t here = corners[i], next = corners[(i + 1) % 3];
            const bool in = is_contained(here), next_in = is_contained(next);
            if (in) kept.push_back(here);
            if (in && !next_in) kept.push_back(leave(here, next));
            if (!in && next_in) kept.push_back(leave(next, here));
        }
        for (std::size_t i = 2; i < kept.size(); ++i)
            mesh.triangles.push_back({kept[0], kept[i - 1], kept[i]});
    }
};

} // namespace

MeshData tessellate(const Parametric& shape) {
    Tessellator t{*shape.data};
    t.divide(0, 0, side);
    for (const Piece& piece : t.pieces) t.fill(piece);
    t.mesh.normal_triangles = t.mesh.uv_triangles = t.mesh.triangles;
    return std::move(t.mesh);
}

Bounds bounds_of(const Parametric& shape) {
    return shape_bounds(shape.data->in_sphere ? Shape(shape.data->sphere) : Shape(shape.data->box));
}

} // namespace pnr
