// SPDX-License-Identifier: GPL-3.0-or-later
// texture and material: pigment, normal, finish and interior under one name; layers and patterns of textures.
#include "parser/blocks.h"
#include "parser/content.h"

#include <algorithm>

namespace pnr {

namespace {

// An entry of a list or map of textures starts from #default's.
BlendMap<Texture> parse_texture_list(Parser& p) {
    BlendMap<Texture> list;
    while (accept(p, "texture"_kw)) {
        list.push_back({static_cast<double>(list.size()), parse_texture(p, p.default_texture)});
        accept_comma(p);
    }
    return list;
}

// `tiles { texture {...} tile2 texture {...} }`: a checker.
void parse_tiles(Parser& p, Texture& texture) {
    set_kind(texture.pattern.edit(), CheckerPattern{});
    texture.textures.clear();
    block(p, "tiles", [&] {
        accept(p, "tile2"_kw);
        if (!accept(p, "texture"_kw)) unexpected(p, "tiles", {"texture"_kw, "tile2"_kw});
        Texture tile = p.default_texture;
        if (at(p, '{'))
            tile = parse_texture(p, tile);
        else
            parse_texture_item(p, tile);
        texture.textures.push_back({static_cast<double>(texture.textures.size()), std::move(tile)});
    });
    if (texture.textures.size() != 2) return texture.textures.clear();
    std::swap(texture.textures[0].value, texture.textures[1].value); // the second one has the cell at the origin
}

void parse_material_map(Parser& p, const Token& word, Texture& texture) {
    warn_unsupported(p, word, "material_map", "the first texture of it is used");
    bool first = true;
    block(p, "material_map", [&] {
        if (!accept(p, "texture"_kw)) return next(p), void();
        const Texture entry = parse_texture(p, p.default_texture);
        if (first) texture = entry;
        first = false;
    });
}

// Patterns of textures. False if none stands here.
bool parse_texture_pattern(Parser& p, Texture& texture) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "texture_map"_kw:
        next(p), texture.textures = parse_texture_map(p);
        return true;
    case "tiles"_kw:
        next(p), parse_tiles(p, texture);
        return true;
    case "material_map"_kw:
        next(p), parse_material_map(p, word, texture);
        return true;
    default:
        break;
    }
    const auto read_list = [&](const Pattern&) {
        if (auto list = parse_texture_list(p); !list.empty()) texture.textures = std::move(list);
    };
    return parse_pattern(p, texture.pattern.edit(), read_list) || parse_pattern_modifier(p, texture.pattern.edit());
}

void map_layer_by_uv(TextureLayer& layer) {
    layer.pigment.pattern.uv_mapping = true;
    if (layer.normal) layer.normal->pattern.uv_mapping = true;
}

} // namespace

void map_by_uv(Texture& texture) {
    texture.pattern.edit().uv_mapping = true;
    map_layer_by_uv(texture);
    for (TextureLayer& layer : texture.upper) map_layer_by_uv(layer);
}

void parse_texture_item(Parser& p, Texture& texture) {
    TextureLayer& top = top_layer(texture);
    if (const auto* declared = accept_declared<Texture>(p))
        texture = *declared;
    else if (accept(p, "pigment"_kw))
        top.pigment = parse_pigment(p, top.pigment);
    else if (accept(p, "finish"_kw))
        top.finish = parse_finish(p, top.finish);
    else if (accept(p, "normal"_kw))
        top.normal = parse_normal(p, top.normal.value_or(Normal{}));
    else if (Transform transform; accept_transform(p, transform))
        apply_transform(transform, texture);
    else if (!parse_texture_pattern(p, texture))
        unexpected(p, "texture",
                   {"pigment"_kw, "finish"_kw, "normal"_kw, "texture_map"_kw, "translate"_kw, "rotate"_kw, "scale"_kw});
}

Texture parse_texture(Parser& p, const Texture& start) {
    const Token opener = peek(p);
    Texture texture = start;
    bool uv_mapping = false;
    block(p, "texture", [&] {
        if (accept(p, "uv_mapping"_kw))
            uv_mapping = parse_optional_bool(p);
        else
            parse_texture_item(p, texture);
    });
    if (texture.textures.empty()) texture.pattern = {}; // a list without entries shows #default's texture
    if (uv_mapping) map_by_uv(texture);
    check_weight(p, opener, weight_of(texture));
    return texture;
}

BlendMap<Texture> parse_texture_map(Parser& p) {
    return parse_blend_map<Texture>(p, "texture_map", [&] {
        Texture texture = p.default_texture;
        while (!at(p, ']') && !at(p, '}') && !at_end(p)) {
            if (accept(p, "texture"_kw))
                add_layer(p, texture, parse_texture(p, p.default_texture), false);
            else
                parse_texture_item(p, texture);
        }
        return texture;
    });
}

void add_layer(Parser& p, Texture& below, const Texture& texture, bool layered) {
    if (!layered || !is_plain(texture) || !is_plain(below)) {
        if (layered) warn(p, peek(p), "a patterned texture can't be layered: the last one is drawn alone");
        below = texture;
        return;
    }
    below.upper.push_back(texture);
    below.upper.insert(below.upper.end(), texture.upper.begin(), texture.upper.end());
    if (!texture.upper.empty()) check_weight(p, peek(p), weight_of(below));
}

SaidMaterial parse_material(Parser& p) {
    SaidMaterial material;
    block(p, "material", [&] {
        if (const auto* declared = accept_declared<SaidMaterial>(p))
            material = *declared;
        else if (accept(p, "texture"_kw)) {
            const Texture texture = parse_texture(p, p.default_texture);
            if (material.texture)
                add_layer(p, *material.texture, texture, true);
            else
                material.texture = texture;
        } else if (accept(p, "interior_texture"_kw))
            material.interior_texture = parse_texture(p, p.default_texture);
        else if (accept(p, "interior"_kw))
            material.interior = parse_interior(p, material.interior.value_or(Interior{}));
        else if (Transform transform; accept_transform(p, transform)) {
            if (material.texture) apply_transform(transform, *material.texture);
            if (material.interior_texture) apply_transform(transform, *material.interior_texture);
        } else
            unexpected(p, "material", {"texture"_kw, "interior"_kw, "interior_texture"_kw});
    });
    return material;
}

} // namespace pnr
