// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/texture.h"

#include <algorithm>

namespace pnr {

void transform_texture(Texture& texture, const Transform& by) {
    if (!is_plain(texture)) { // what it picks from is seen in its own space
        transform_pattern(texture.pattern, by);
        return;
    }
    for (TextureLayer& layer : texture.layers) {
        transform_pigment(layer.pigment, by);
        if (layer.normal) transform_bumps(*layer.normal, by);
    }
}

namespace {

void visit_textures(const Texture& texture, const SurfacePoint& at, double share, const TextureUse& use);

void visit_average(const Texture& texture, const SurfacePoint& here, double share, const TextureUse& use) {
    double sum = 0;
    for (const auto& entry : texture.textures) sum += entry.position;
    if (!(sum > 0)) return visit_textures(texture.textures.front().value, here, share, use);
    for (const auto& entry : texture.textures)
        if (entry.position > 0) visit_textures(entry.value, here, share * entry.position / sum, use);
}

void visit_textures(const Texture& texture, const SurfacePoint& at, double share, const TextureUse& use) {
    if (is_plain(texture)) return use(texture.layers, at, share);
    const SurfacePoint here = to_pattern_space(texture.pattern, at);
    if (std::holds_alternative<AveragePattern>(texture.pattern.kind))
        return visit_average(texture, here, share, use);
    const double value = eval_pattern_here(texture.pattern, here);
    const BlendSpot spot = look_up(texture.textures, value, is_list_pattern(texture.pattern));
    if (spot.weight < 1) visit_textures(texture.textures[spot.low].value, here, share * (1 - spot.weight), use);
    if (spot.weight > 0) visit_textures(texture.textures[spot.high].value, here, share * spot.weight, use);
}

} // namespace

void for_each_texture(const Texture& texture, const SurfacePoint& at, const TextureUse& use) {
    visit_textures(texture, at, 1, use);
}

LayerPoint see_layer(const TextureLayer& layer, const SurfacePoint& at, Color above) {
    const ColorFT color = eval_pigment(layer.pigment, at);
    return {layer.finish,
            layer.normal ? perturb_normal(*layer.normal, at) : at.normal,
            color.rgb,
            std::max(0.0f, 1 - color.filter - color.transmit),
            color.rgb * color.filter + Color(color.transmit),
            above};
}

Color texture_color(const Texture& texture, const SurfacePoint& at) {
    Color sum(0);
    for_each_texture(texture, at,
                     [&](std::span<const TextureLayer> layers, const SurfacePoint& here, double share) {
                         Color above(1), color(0);
                         for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
                             const ColorFT c = eval_pigment(layer->pigment, here);
                             const bool last = layer + 1 == layers.rend();
                             const float opacity = std::max(0.0f, 1 - c.filter - c.transmit);
                             color += above * c.rgb * (last ? 1 : opacity);
                             above *= c.rgb * c.filter + Color(c.transmit);
                         }
                         sum += color * static_cast<float>(share);
                     });
    return sum;
}

namespace {

using PatternUse = std::function<void(Pattern&)>;

void visit_patterns(Pigment& pigment, const PatternUse& use) {
    use(pigment.pattern);
    for (auto& entry : pigment.pigments) visit_patterns(entry.value, use);
}

void visit_patterns(Normal& normal, const PatternUse& use) {
    use(normal.pattern);
    if (normal.picture) visit_patterns(*normal.picture, use);
    for (auto& entry : normal.normals) visit_patterns(entry.value, use);
}

} // namespace

void for_each_pattern(Texture& texture, const PatternUse& use) {
    use(texture.pattern);
    for (TextureLayer& layer : texture.layers) {
        visit_patterns(layer.pigment, use);
        if (layer.normal) visit_patterns(*layer.normal, use);
    }
    for (auto& entry : texture.textures) for_each_pattern(entry.value, use);
}

} // namespace pnr
