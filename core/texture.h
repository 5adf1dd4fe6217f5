// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface looks like: POV-Ray's `texture`. Either plain, which is one or more layers of pigment, normal and finish,
// or patterned: other textures, picked by a pattern.
#pragma once

#include "core/finish.h"
#include "core/normal.h"
#include "core/pattern.h"
#include "core/pigment.h"
#include "core/types.h"

#include <functional>
#include <optional>
#include <vector>

namespace pnr {

struct TextureLayer {
    Pigment pigment;
    Boxed<Normal> normal;
    Finish finish;
};

struct Texture : TextureLayer {             // plain: the lowest layer, of most textures the only one
    std::vector<TextureLayer> upper;         // the layers on it, from below
    Seldom<Pattern> pattern;                 // what picks from `textures`
    std::vector<BlendEntry<Texture>> textures; // not empty: these instead
};

inline bool is_plain(const Texture& texture) { return texture.textures.empty(); }
inline TextureLayer& top_layer(Texture& texture) {
    return texture.upper.empty() ? static_cast<TextureLayer&>(texture) : texture.upper.back();
}

// The texture follows its object, like transform_pigment.
void transform_texture(Texture& texture, const Transform& by);

// The plain textures that a point shows, each with the point as it sees it (in the space of the patterns around it) and its
// share; the shares add up to 1.
using TextureUse = std::function<void(const Texture&, const SurfacePoint&, double)>;
void for_each_texture(const Texture& texture, const SurfacePoint& at, const TextureUse& use);

// One layer at a point.
struct LayerPoint {
    const Finish& finish;
    Vec3 normal;   // perturbed, unit
    Color color;   // the pigment's
    float opacity; // 1 - filter - transmit, at least 0
    Color passed;  // of light that goes through: filter * colour + transmit
    Color above;   // the same of all layers above it
};
LayerPoint see_layer(const TextureLayer& layer, const SurfacePoint& at, Color above);

// `use(LayerPoint)` from the uppermost layer down to the first that lets nothing through; what goes through all of them.
template <class F>
Color for_each_layer(const Texture& plain, const SurfacePoint& at, F use) {
    Color passed(1);
    const auto see = [&](const TextureLayer& layer) {
        const LayerPoint point = see_layer(layer, at, passed);
        use(point);
        passed *= point.passed;
    };
    for (auto layer = plain.upper.rbegin(); layer != plain.upper.rend() && !is_black(passed); ++layer) see(*layer);
    if (!is_black(passed)) see(plain);
    return passed;
}

// The colour that the point shows in even light: its layers' pigments over each other, blended by the patterns around them.
Color texture_color(const Texture& texture, const SurfacePoint& at);

// Every pattern of the texture: of its pigments and normals at any depth, and those that pick from textures.
void for_each_pattern(Texture& texture, const std::function<void(Pattern&)>& use);

} // namespace pnr
