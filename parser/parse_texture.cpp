// SPDX-License-Identifier: GPL-3.0-or-later
// texture and material: pigment, finish and interior under one name.
#include "parser/blocks.h"

namespace pnr {

namespace {

void parse_texture_item(Parser& p, Texture& texture, bool& first, std::string_view what);

// Things of a texture that we lack: surface normals, and textures that are patterns of textures.
bool skip_texture_word(Parser& p, Texture& texture, bool& first) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "normal"_kw:
        warn_unsupported(p, next(p), "normal", "surfaces are left smooth");
        skip_block(p, "normal");
        return true;
    case "texture_map"_kw:
    case "material_map"_kw:
    case "tiles"_kw:
        warn_unsupported(p, next(p), token_text(p, word, false), "the first texture of it is used");
        if (word.symbol != static_cast<Symbol>("texture_map"_kw)) return skip_block(p, "texture"), true;
        block(p, "texture_map", [&] {
            expect(p, '[', "to start an entry of `texture_map`");
            if (at_expression(p)) parse_float(p), accept_comma(p); // `average` needs no place
            Texture inner = texture;
            bool innermost = true;
            while (!at(p, ']') && !at(p, '}')) {
                if (accept(p, "texture"_kw))
                    inner = parse_texture(p, inner);
                else
                    parse_texture_item(p, inner, innermost, "texture_map");
            }
            expect(p, ']', "to end an entry of `texture_map`");
            if (first) texture = inner;
            first = false;
        });
        return true;
    case "texture"_kw: { // `checker texture {...} texture {...}`
        warn_unsupported(p, next(p), "patterns of textures", "the first texture is used");
        const Texture inner = parse_texture(p, texture);
        accept_comma(p);
        if (first) texture = inner;
        first = false;
        return true;
    }
    case "uv_mapping"_kw:
        next(p), parse_optional_bool(p);
        return true;
    default:
        return false;
    }
}

void parse_texture_item(Parser& p, Texture& texture, bool& first, std::string_view what) {
    if (const auto* declared = accept_declared<Texture>(p))
        texture = *declared;
    else if (accept(p, "pigment"_kw))
        texture.pigment = parse_pigment(p, texture.pigment);
    else if (accept(p, "finish"_kw))
        texture.finish = parse_finish(p, texture.finish);
    else if (Transform transform; accept_transform(p, transform))
        apply_transform(transform, texture);
    else if (!skip_texture_word(p, texture, first) && !skip_pattern(p))
        unexpected(p, what,
                   {"pigment"_kw, "finish"_kw, "normal"_kw, "translate"_kw, "rotate"_kw, "scale"_kw});
}

} // namespace

Texture parse_texture(Parser& p, const Texture& start) {
    Texture texture = start;
    bool first = true;
    block(p, "texture", [&] { parse_texture_item(p, texture, first, "texture"); });
    return texture;
}

SaidMaterial parse_material(Parser& p) {
    SaidMaterial material;
    block(p, "material", [&] {
        if (const auto* declared = accept_declared<SaidMaterial>(p))
            material = *declared;
        else if (accept(p, "texture"_kw))
            material.texture = parse_texture(p, p.default_texture);
        else if (accept(p, "interior"_kw))
            material.interior = parse_interior(p, material.interior.value_or(Interior{}));
        else if (Transform transform; accept_transform(p, transform)) {
            if (material.texture) apply_transform(transform, *material.texture);
        } else if (at(p, "interior_texture"_kw)) {
            warn_unsupported(p, next(p), "interior_texture", "both sides are alike");
            skip_block(p, "interior_texture");
        } else
            unexpected(p, "material", {"texture"_kw, "interior"_kw});
    });
    return material;
}

} // namespace pnr
