// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/curvature.h"

#include "core/geometry.h"
#include "core/parallel.h"
#include "core/shape_hits.h"

#include <cmath>
#include <unordered_map>

namespace pnr {

namespace {

constexpr double tensor_spread = 1.0 / 30; // of the object's extent: the width over which curvature is taken
constexpr double axis_spread = 1.0 / 15;   // ... and over which axes are blended
constexpr int most_spreads = 400;          // of very fine meshes: beyond that the widths are narrower

void add_outer(SymmetricTensor& m, Vec3 v, double w) {
    m[0] += w * v.x * v.x;
    m[1] += w * v.y * v.y;
    m[2] += w * v.z * v.z;
    m[3] += w * v.x * v.y;
    m[4] += w * v.x * v.z;
    m[5] += w * v.y * v.z;
}

double form(const SymmetricTensor& m, Vec3 a, Vec3 b) {
    return m[0] * a.x * b.x + m[1] * a.y * b.y + m[2] * a.z * b.z + m[3] * (a.x * b.y + a.y * b.x) +
           m[4] * (a.x * b.z + a.z * b.x) + m[5] * (a.y * b.z + a.z * b.y);
}

// The eigenvectors of a tensor's tangent part. `first` belongs to the larger eigenvalue.
struct TangentEigen {
    double first_value = 0, second_value = 0;
    Vec3 first{0}, second{0};
};
TangentEigen tangent_eigen(const SymmetricTensor& m, Vec3 normal) {
    const Frame frame = make_frame(normal);
    const double xx = form(m, frame.x, frame.x), xy = form(m, frame.x, frame.y),
                 yy = form(m, frame.y, frame.y);
    const double mean = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    TangentEigen e;
    e.first_value = mean + half;
    e.second_value = mean - half;
    e.first = frame.x * std::cos(angle) + frame.y * std::sin(angle);
    e.second = frame.y * std::cos(angle) - frame.x * std::sin(angle);
    return e;
}

// The axis of least |curvature| of a curvature tensor, as long as the anisotropy (|k1| - |k2|) / (|k1| +
// |k2|), in [0, 1].
Vec3 least_axis(const SymmetricTensor& curvature, Vec3 normal) {
    const TangentEigen e = tangent_eigen(curvature, normal);
    const double a = std::abs(e.first_value), b = std::abs(e.second_value);
    if (!(a + b > 0)) return Vec3(0);
    return (a < b ? e.first : e.second) * (std::abs(a - b) / (a + b));
}

// ---- meshes
// -------------------------------------------------------------------------------------------------------

struct WeldedMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    double extent = 0;
};

// Gives each place one number; places closer than a millionth of the extent mostly share it.
class Welder {
public:
    explicit Welder(const Bounds& bounds)
        : low_(bounds.low), cell_(1e-6 * glm::distance(bounds.low, bounds.high)) {}
    std::uint32_t number(Vec3 p, std::vector<Vec3>& positions) {
        const glm::i64vec3 q(glm::floor((p - low_) / (cell_ > 0 ? cell_ : 1) + 0.5));
        const std::uint64_t key = static_cast<std::uint64_t>(q.x) * 73856093u ^
                                  static_cast<std::uint64_t>(q.y) * 19349663u << 11 ^
                                  static_cast<std::uint64_t>(q.z) * 83492791u << 22;
        const auto range = seen_.equal_range(key);
        for (auto it = range.first; it != range.second; ++it)
            if (glm::distance(positions[it->second], p) <= 2 * cell_) return it->second;
        positions.push_back(p);
        const auto index = static_cast<std::uint32_t>(positions.size() - 1);
        seen_.emplace(key, index);
        return index;
    }

private:
    Vec3 low_;
    double cell_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> seen_;
};

WeldedMesh weld_meshes(const World& world, int object, std::vector<std::uint32_t>& first_triangle) {
    WeldedMesh mesh;
    const auto items = geometry_items(*world.geometry);
    first_triangle.assign(items.size(), 0);
    const auto mesh_of = [&](std::size_t i) -> const MeshData* {
        if (world.surfaces[i].object != object || world.surfaces[i].light >= 0) return nullptr;
        const Shape* shape = std::get_if<Shape>(&items[i].form);
        const Mesh* said = shape ? std::get_if<Mesh>(shape) : nullptr;
        return said ? said->data.get() : nullptr;
    };
    Bounds bounds;
    for (std::size_t i = 0; i < items.size() && i < world.surfaces.size(); ++i)
        if (mesh_of(i)) bounds = merge(bounds, item_bounds(items[i]));
    if (is_empty(bounds)) return mesh;
    mesh.extent = glm::distance(bounds.low, bounds.high);
    Welder welder(bounds);
    for (std::size_t i = 0; i < items.size() && i < world.surfaces.size(); ++i) {
        const MeshData* data = mesh_of(i);
        if (!data) continue;
        first_triangle[i] = static_cast<std::uint32_t>(mesh.triangles.size());
        std::vector<std::uint32_t> number(data->positions.size());
        for (std::size_t v = 0; v < number.size(); ++v)
            number[v] = welder.number(transform_point(items[i].to_world.matrix, Vec3(data->positions[v])),
                                      mesh.positions);
        for (const auto& [a, b, c] : data->triangles)
            mesh.triangles.push_back({number[a], number[b], number[c]});
    }
    return mesh;
}

Vec3 area_normal(const WeldedMesh& mesh, const std::array<std::uint32_t, 3>& t) {
    return 0.5 * glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                            mesh.positions[t[2]] - mesh.positions[t[0]]);
}

// Each edge's triangles; an edge of more than two is not used.
struct EdgeSides {
    std::uint32_t first = 0, second = 0;
    int count = 0;
};

std::unordered_map<std::uint64_t, EdgeSides> collect_edges(const WeldedMesh& mesh) {
    std::unordered_map<std::uint64_t, EdgeSides> edges;
    edges.reserve(mesh.triangles.size() * 3 / 2);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            if (a == b) continue;
            EdgeSides& edge = edges[std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)];
            (edge.count == 0 ? edge.first : edge.second) = t;
            ++edge.count;
        }
    }
    return edges;
}

// Neighbours of every vertex, in compressed rows, in a fixed order.
struct Neighbours {
    std::vector<std::uint32_t> begin, vertices;
};

Neighbours collect_neighbours(std::size_t vertices,
                              const std::unordered_map<std::uint64_t, EdgeSides>& edges) {
    Neighbours n;
    n.begin.assign(vertices + 1, 0);
    for (const auto& [key, sides] : edges) {
        ++n.begin[(key >> 32) + 1];
        ++n.begin[(key & 0xffffffffu) + 1];
    }
    for (std::size_t v = 0; v < vertices; ++v) n.begin[v + 1] += n.begin[v];
    n.vertices.resize(n.begin[vertices]);
    std::vector<std::uint32_t> next(n.begin.begin(), n.begin.end() - 1);
    for (const auto& [key, sides] : edges) {
        const auto a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
        n.vertices[next[a]++] = b;
        n.vertices[next[b]++] = a;
    }
    for (std::size_t v = 0; v < vertices; ++v) // the map's order is not ours to rely on
        std::sort(n.vertices.begin() + n.begin[v], n.vertices.begin() + n.begin[v + 1]);
    return n;
}

// Repeated averages of each vertex with its neighbours: a Gaussian whose width grows with the root of the
// number of rounds.
void spread(std::vector<SymmetricTensor>& values, const Neighbours& neighbours, int rounds) {
    std::vector<SymmetricTensor> next(values.size());
    for (int round = 0; round < rounds; ++round) {
        parallel_for(static_cast<std::int64_t>(values.size()), 8192,
                     [&](std::int64_t begin, std::int64_t end, std::int64_t) {
                         for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end);
                              ++v) {
                             SymmetricTensor sum = values[v];
                             const std::uint32_t first = neighbours.begin[v], last = neighbours.begin[v + 1];
                             for (std::uint32_t i = first; i < last; ++i)
                                 for (std::size_t c = 0; c < 6; ++c)
                                     sum[c] += values[neighbours.vertices[i]][c];
                             for (double& c : sum) c /= static_cast<double>(last - first + 1);
                             next[v] = sum;
                         }
                     });
        values.swap(next);
    }
}

int rounds_for(double width, double edge_length) {
    // A vertex and six neighbours at one edge length: the variance grows by 6/7 / 2 squared edges a round
    // along each axis.
    const double rounds = edge_length > 0 ? width * width / (edge_length * edge_length * 3.0 / 7.0) : 0;
    return static_cast<int>(std::clamp(std::ceil(rounds), 1.0, static_cast<double>(most_spreads)));
}

// The curvature tensors at the vertices, before spreading. The normal cycle lays a bend along its edge, where
// the curvature tensor has it across: the two differ by a quarter turn, done by the caller.
std::vector<SymmetricTensor> normal_cycle(const WeldedMesh& mesh,
                                          const std::unordered_map<std::uint64_t, EdgeSides>& edges,
                                          double& mean_edge) {
    std::vector<std::pair<std::uint64_t, EdgeSides>> ordered(edges.begin(), edges.end());
    std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<SymmetricTensor> tensors(mesh.positions.size(), SymmetricTensor{});
    double sum = 0;
    for (const auto& [key, sides] : ordered) {
        const auto a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
        const Vec3 edge = mesh.positions[b] - mesh.positions[a];
        const double length = glm::length(edge);
        sum += length;
        if (sides.count != 2 || !(length > 0)) continue;
        const Vec3 m = area_normal(mesh, mesh.triangles[sides.first]),
                   n = area_normal(mesh, mesh.triangles[sides.second]);
        const double area = glm::length(m) + glm::length(n);
        if (!(glm::length(m) > 0 && glm::length(n) > 0)) continue;
        const Vec3 along = edge / length;
        const Vec3 mu = glm::normalize(m), nu = glm::normalize(n);
        // The sign tells ridges from valleys; which is which depends on the winding, and only consistency
        // matters.
        const auto& t = mesh.triangles[sides.first];
        const bool forward = (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
        const double sine = glm::dot(glm::cross(mu, nu), along) * (forward ? 1 : -1);
        const double angle = std::atan2(sine, glm::dot(mu, nu));
        if (!(area > 0) || !std::isfinite(angle)) continue;
        add_outer(tensors[a], along, angle * length);
        add_outer(tensors[b], along, angle * length);
    }
    mean_edge = ordered.empty() ? 0 : sum / static_cast<double>(ordered.size());
    return tensors;
}

std::vector<SymmetricTensor> mesh_axes(const WeldedMesh& mesh) {
    const auto edges = collect_edges(mesh);
    const Neighbours neighbours = collect_neighbours(mesh.positions.size(), edges);
    double mean_edge = 0;
    std::vector<SymmetricTensor> tensors = normal_cycle(mesh, edges, mean_edge);
    std::vector<Vec3> normals(mesh.positions.size(), Vec3(0));
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) normals[v] += area_normal(mesh, t);
    spread(tensors, neighbours, rounds_for(tensor_spread * mesh.extent, mean_edge));
    for (std::size_t v = 0; v < tensors.size(); ++v) {
        const double length = glm::length(normals[v]);
        if (!(length > 0)) {
            tensors[v] = {};
            continue;
        }
        const Vec3 normal = normals[v] / length;
        // Along an edge that bends the curvature is least, so here the axis of the greatest value is wanted.
        const Vec3 axis = least_axis(tensors[v], normal);
        const double strength = glm::length(axis);
        tensors[v] = {};
        if (strength > 0) add_outer(tensors[v], glm::cross(normal, axis) / strength, strength);
    }
    spread(tensors, neighbours, rounds_for(axis_spread * mesh.extent, mean_edge));
    return tensors;
}

// ---- shapes
// -------------------------------------------------------------------------------------------------------

// Gradient and second derivatives of a function that is zero on the shape, in its own space, at a point of
// its surface; second derivatives all zero on flat faces.
struct Implicit {
    Vec3 gradient{0};
    glm::dmat3 second{0.0};
};

glm::dmat3 outer(Vec3 a, Vec3 b) { return glm::outerProduct(a, b); }

Implicit revolved_side(Vec3 base, Vec3 cap, double base_radius, double cap_radius, Vec3 p, Vec3 normal) {
    const double height = glm::distance(base, cap);
    if (!(height > 0)) return {normal, glm::dmat3(0.0)};
    const Vec3 axis = (cap - base) / height;
    const double slope = (cap_radius - base_radius) / height;
    const Vec3 from = p - base;
    const double h = glm::dot(from, axis);
    const Vec3 across = from - h * axis;
    // On a lid the normal is the axis; on the side it leans by the slope.
    if (std::abs(glm::dot(normal, axis)) > 1 - 1e-9) return {normal, glm::dmat3(0.0)};
    return {across - slope * (base_radius + slope * h) * axis,
            glm::dmat3(1.0) - (1 + slope * slope) * outer(axis, axis)};
}

// Of a shape that rays alone can tell of: how the normal turns from one side of the point to the other.
Implicit by_neighbours(const Shape& shape, Vec3 p, Vec3 normal) {
    const Bounds box = shape_bounds(shape);
    const double size = glm::distance(box.low, box.high);
    const double step = 2e-3 * (std::isfinite(size) ? size : 1 + glm::length(p));
    const Frame frame = make_frame(normal);
    HitList hits;
    const auto normal_at = [&](Vec3 away) {
        const Vec3 above = p + away + 4 * step * normal;
        if (intersect_shape(shape, {above, -normal, 0, 8 * step}, hits, 1) == 0) return normal;
        const Vec3 n = glm::normalize(hits.front().normal);
        return glm::dot(n, normal) > 0.5 ? n : normal; // beyond an edge
    };
    const Vec3 along_x = (normal_at(step * frame.x) - normal_at(-step * frame.x)) / (2 * step);
    const Vec3 along_y = (normal_at(step * frame.y) - normal_at(-step * frame.y)) / (2 * step);
    const double xx = glm::dot(along_x, frame.x), yy = glm::dot(along_y, frame.y),
                 xy = 0.5 * (glm::dot(along_x, frame.y) + glm::dot(along_y, frame.x));
    return {normal, xx * outer(frame.x, frame.x) + yy * outer(frame.y, frame.y) +
                        xy * (outer(frame.x, frame.y) + outer(frame.y, frame.x))};
}

Implicit implicit_of(const Shape& shape, Vec3 p, Vec3 normal) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return {p - s->center, glm::dmat3(1.0)};
    if (const auto* c = std::get_if<Cylinder>(&shape))
        return revolved_side(c->base, c->cap, c->radius, c->radius, p, normal);
    if (const auto* c = std::get_if<Cone>(&shape))
        return revolved_side(c->base, c->cap, c->base_radius, c->cap_radius, p, normal);
    if (const auto* t = std::get_if<Torus>(&shape)) {
        const double rho = std::hypot(p.x, p.z);
        if (!(rho > 0)) return {normal, glm::dmat3(0.0)};
        const Vec3 out(p.x / rho, 0, p.z / rho), up(0, 1, 0), round(-out.z, 0, out.x);
        return {(rho - t->major) * out + p.y * up,
                outer(out, out) + outer(up, up) + (rho - t->major) / rho * outer(round, round)};
    }
    if (std::holds_alternative<Box>(shape) || std::holds_alternative<Plane>(shape) ||
        std::holds_alternative<Disc>(shape))
        return {normal, glm::dmat3(0.0)};
    return by_neighbours(shape, p, normal);
}

// The shape operator of a level set, P H P / |g|, in world space: exact under any affine map.
SymmetricTensor shape_curvature(const GeometryItem& item, Vec3 position, Vec3 normal) {
    const Vec3 p = transform_point(item.to_world.inverse, position);
    const glm::dmat3 linear(item.to_world.matrix);
    const Vec3 own_normal = glm::normalize(glm::transpose(linear) * normal);
    const Implicit f = implicit_of(std::get<Shape>(item.form), p, own_normal);
    const glm::dmat3 back(item.to_world.inverse);
    const Vec3 gradient = glm::transpose(back) * f.gradient;
    const double length = glm::length(gradient);
    if (!(length > 0)) return {};
    const glm::dmat3 h = glm::transpose(back) * f.second * back / length;
    return {h[0][0], h[1][1], h[2][2], h[1][0], h[2][0], h[2][1]};
}

} // namespace

CurvatureField make_curvature_field(const World& world, int object) {
    CurvatureField field;
    field.world = &world;
    field.surface = index_surface(world, object);
    if (!world.geometry) return field;
    WeldedMesh mesh = weld_meshes(world, object, field.first_triangle);
    field.axes = mesh_axes(mesh);
    field.triangles = std::move(mesh.triangles);
    return field;
}

Vec3 eval_curvature_axis(const CurvatureField& field, Vec3 position, Vec3 normal, bool largest) {
    const ClosestPoint at = closest_point(*field.surface, position);
    if (!std::isfinite(at.distance)) return Vec3(0);
    const GeometryItem& item = geometry_items(*field.world->geometry)[at.surface];
    Vec3 least;
    if (std::holds_alternative<Mesh>(std::get<Shape>(item.form))) {
        const auto& triangle = field.triangles[field.first_triangle[at.surface] + at.triangle];
        SymmetricTensor sum{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 6; ++c)
                sum[c] += at.weights[static_cast<glm::length_t>(k)] * field.axes[triangle[k]][c];
        const TangentEigen e = tangent_eigen(sum, normal);
        least = e.first * (e.first_value - e.second_value);
    } else {
        least = least_axis(shape_curvature(item, at.position, at.normal), normal);
    }
    return largest ? glm::cross(normal, least) : least;
}

} // namespace pnr
