// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_check.h"

#include "core/probe.h"

#include <algorithm>

namespace pnr {

namespace {

bool is_plain_union(const Object& object) {
    return !object.shape && object.combination == Combination::unite && !object.inverse;
}

bool holds(const Object& object, Vec3 point) {
    const Mesh* mesh = object.shape ? std::get_if<Mesh>(&*object.shape) : nullptr;
    if (mesh && (!mesh->data || !mesh->inside_vector)) return false;
    const Bounds box = object_bounds(object);
    const bool near =
        glm::all(glm::lessThanEqual(box.low, point)) && glm::all(glm::lessThanEqual(point, box.high));
    if (!near && !object.inverse) return false;
    try {
        return is_inside(*make_probe(object), point);
    } catch (const SceneError&) { // build_world will say what is wrong with it
        return false;
    }
}

bool is_opaque(const Texture& texture) {
    const auto clear = [](const TextureLayer& layer) { return is_see_through(layer.pigment); };
    if (is_plain(texture))
        return !clear(texture) || !std::all_of(texture.upper.begin(), texture.upper.end(), clear);
    return std::all_of(texture.textures.begin(), texture.textures.end(),
                       [](const auto& entry) { return is_opaque(entry.value); });
}

} // namespace

std::vector<const Object*> solids_about(const std::vector<Object>& objects, Vec3 point) {
    std::vector<const Object*> found;
    for (const Object& object : objects) {
        if (object.hollow) continue;
        if (is_plain_union(object)) {
            const auto within = solids_about(object.children, point);
            found.insert(found.end(), within.begin(), within.end());
        } else if (holds(object, point)) {
            found.push_back(&object);
        }
    }
    return found;
}

bool is_opaque(const Object& object) {
    if (object.no_shadow || (object.texture && !is_opaque(*object.texture))) return false;
    return std::all_of(object.children.begin(), object.children.end(),
                       [](const Object& child) { return is_opaque(child); });
}

} // namespace pnr
