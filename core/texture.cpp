// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/texture.h"

#include <algorithm>

namespace pnr {

namespace {

void transform_layer(TextureLayer& layer, const Transform& by) {
    transform_pigment(layer.pigment, by);
    if (layer.normal) transform_bumps(*layer.normal, by);
}

} // namespace

void transform_texture(Texture& texture, const Transform& by) {
    if (!is_plain(texture)) { // what it picks from is seen in its own space
        transform_pattern(texture.pattern.edit(), by);
        return;
    }
    transform_layer(texture, by);
    for (TextureLayer& layer : texture.upper) transform_layer(layer, by);
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
    if (is_plain(texture)) return use(texture, at, share);
    const SurfacePoint here = to_pattern_space(texture.pattern, at);
    if (std::holds_alternative<AveragePattern>(texture.pattern->kind))
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
    for_each_texture(texture, at, [&](const Texture& plain, const SurfacePoint& here, double share) {
        Color color(0), lowest(0);
        const Color passed = for_each_layer(plain, here, [&](const LayerPoint& layer) {
            color += layer.above * layer.color * layer.opacity;
            lowest = layer.color;
        });
        // What shines through is not seen; the lowest layer stands for it.
        sum += (color + passed * lowest) * static_cast<float>(share);
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
    for (auto& entry : normal.normals) visit_patterns(entry.value, use);
}

void visit_patterns(TextureLayer& layer, const PatternUse& use) {
    visit_patterns(layer.pigment, use);
    if (layer.normal) visit_patterns(*layer.normal, use);
}

} // namespace

void for_each_pattern(Texture& texture, const PatternUse& use) {
    if (!is_plain(texture)) use(texture.pattern.edit());
    visit_patterns(static_cast<TextureLayer&>(texture), use);
    for (TextureLayer& layer : texture.upper) visit_patterns(layer, use);
    for (auto& entry : texture.textures) for_each_pattern(entry.value, use);
}

} // namespace pnr
