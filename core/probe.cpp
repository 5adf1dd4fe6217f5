// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/probe.h"

#include "core/geometry.h"
#include "core/shape_hits.h"
#include "core/world.h"

#include <variant>

namespace pnr {

struct Probe {
    World world;
};

namespace {

// The geometry alone.
Object bare(const Object& said) {
    Object object;
    object.said_at = said.said_at;
    object.shape = said.shape;
    object.combination = said.combination;
    object.transform = said.transform;
    object.inverse = said.inverse;
    for (const Object& child : said.children) object.children.push_back(bare(child));
    for (const Object& clip : said.clips) object.clips.push_back(bare(clip));
    for (const Object& bound : said.bounds) object.bounds.push_back(bare(bound));
    return object;
}

Bounds shape_box(const Object& object) {
    const Mesh* mesh = std::get_if<Mesh>(&*object.shape);
    if (mesh && !mesh->data) return {Vec3(-infinity), Vec3(infinity)};
    GeometryItem item;
    item.form = *object.shape;
    item.to_world = object.transform;
    // An endless inside is no extent, but for planes along an axis, where POV-Ray says how far the half space
    // reaches.
    return has_endless_inside(*object.shape) && !std::holds_alternative<Plane>(*object.shape)
               ? item_bounds(item)
               : inside_bounds(item);
}

} // namespace

std::shared_ptr<const Probe> make_probe(const Object& object) {
    Scene scene;
    // A merge of one: it shows what the object shows, and makes it a tree that knows its inside.
    Object& whole = scene.objects.emplace_back();
    whole.combination = Combination::merge;
    whole.children.push_back(bare(object));
    auto probe = std::make_shared<Probe>();
    probe->world = build_world(scene, {});
    return probe;
}

bool is_inside(const Probe& probe, Vec3 point) {
    return is_inside_last(*probe.world.geometry, point - probe.world.offset);
}

std::optional<ProbeHit> trace(const Probe& probe, Vec3 origin, Vec3 direction) {
    const World& world = probe.world;
    const double length = glm::length(direction);
    if (!(length > 0)) return std::nullopt;
    const auto hit = closest_hit(world, {origin - world.offset, direction / length, 1e-6}, RayKind::camera);
    if (!hit) return std::nullopt;
    const Shape& shape = std::get<Shape>(geometry_items(*world.geometry)[hit->leaf].form);
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    const bool faces_away =
        mesh && (mesh->data->normals.empty() || glm::dot(hit->shading_normal, direction) > 0);
    return ProbeHit{hit->position + world.offset, (faces_away ? -1.0 : 1.0) * hit->shading_normal};
}

Bounds object_bounds(const Object& object) {
    if (object.shape) return shape_box(object);
    const bool differs = object.combination == Combination::differ;
    const bool common = differs || object.combination == Combination::intersect;
    Bounds all = common ? Bounds{Vec3(-infinity), Vec3(infinity)} : Bounds{};
    for (std::size_t i = 0; i < object.children.size() && !(differs && i > 0); ++i) {
        const Object& child = object.children[i];
        if (common && child.inverse && !differs) continue; // what it takes away
        const Bounds box = object_bounds(child);
        all = common ? Bounds{glm::max(all.low, box.low), glm::min(all.high, box.high)} : merge(all, box);
    }
    return all;
}

} // namespace pnr
