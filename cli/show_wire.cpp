// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/show_wire.h"

#include "cli/drawing.h"
#include "core/geometry.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace pnr {

namespace {

// Edges of one mesh, each once.
std::set<std::pair<std::uint32_t, std::uint32_t>> edges_of(const MeshData& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[static_cast<std::size_t>(i)],
                                b = t[static_cast<std::size_t>((i + 1) % 3)];
            edges.insert({std::min(a, b), std::max(a, b)});
        }
    return edges;
}

// Sets the pixels along the line between two places where nothing lies before it.
void draw_edge(Image<Color>& picture, const Rendering& r, Vec3 a, Vec3 b, Color color) {
    const auto from = project(r.gbuffer.view, a), to = project(r.gbuffer.view, b);
    if (!from || !to) return;
    const double pixels = glm::distance(from->pixel, to->pixel);
    if (!(pixels < 1e5)) return;
    const int steps = std::max(1, static_cast<int>(std::ceil(pixels)));
    for (int i = 0; i <= steps; ++i) {
        const auto at = project(r.gbuffer.view, a + (b - a) * (static_cast<double>(i) / steps));
        if (!at) continue;
        const int x = static_cast<int>(std::floor(at->pixel.x)),
                  y = static_cast<int>(std::floor(at->pixel.y));
        if (!picture.contains(x, y)) continue;
        const Seen& seen = r.gbuffer.seen.at(x, y);
        const double depth = static_cast<double>(seen.via == 0 ? seen.z : seen.z_specular);
        if (depth == 0 || at->distance <= 1.01 * depth) picture.at(x, y) = color;
    }
}

// Between neighbours: other things, or the same one far behind itself, are silhouettes; a turn of more than
// 40 degrees is a crease.
enum class Border { none, crease, silhouette };
Border border(const Seen& a, const Seen& b) {
    if (a.object != b.object || a.via != b.via) return Border::silhouette;
    if (a.object == 0) return Border::none;
    const Vec3f way = b.position - a.position; // within the surface of either, or across a gap
    const float off = std::max(std::abs(glm::dot(way, a.normal)), std::abs(glm::dot(way, b.normal)));
    const bool turned = glm::dot(a.normal, b.normal) < 0.77f;
    if (off > 0.05f * a.z && glm::length(way) > 0.05f * a.z) return Border::silhouette;
    return turned ? Border::crease : Border::none;
}

} // namespace

Image<Color> draw_wire(Image<Color> picture, const Rendering& r) {
    const Color edge = displayed(0.45f, 0.65f, 1), crease = displayed(0.7f, 0.7f, 0.7f),
                silhouette = displayed(1, 1, 1);
    for (const GeometryItem& item : geometry_items(*r.world.geometry)) {
        const auto* shape = std::get_if<Shape>(&item.form);
        const Mesh* mesh = shape ? std::get_if<Mesh>(shape) : nullptr;
        if (!mesh || !mesh->data || (item.hidden_from & ray_bit(RayKind::camera)) != 0) continue;
        const auto place = [&](std::uint32_t i) {
            return transform_point(item.to_world.matrix, Vec3(mesh->data->positions[i]));
        };
        for (const auto& [a, b] : edges_of(*mesh->data)) draw_edge(picture, r, place(a), place(b), edge);
    }
    const Image<Seen>& seen = r.gbuffer.seen;
    for (int y = 0; y < seen.height; ++y)
        for (int x = 0; x < seen.width; ++x) {
            Border most = Border::none;
            if (x + 1 < seen.width) most = border(seen.at(x, y), seen.at(x + 1, y));
            if (y + 1 < seen.height) most = std::max(most, border(seen.at(x, y), seen.at(x, y + 1)));
            if (most != Border::none) picture.at(x, y) = most == Border::crease ? crease : silhouette;
        }
    return picture;
}

} // namespace pnr
