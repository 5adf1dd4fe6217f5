// SPDX-License-Identifier: GPL-3.0-or-later
// normal: patterns that turn the shading normal.
#include "parser/blocks.h"
#include "parser/content.h"

#include <algorithm>

namespace pnr {

namespace {

// What #default says, without it POV-Ray's own.
Normal default_normal(Parser& p) { return top_layer(p.default_texture).normal.value_or(Normal{}); }

// The amount behind a pattern's word.
void parse_size(Parser& p, Normal& normal) {
    accept_comma(p);
    if (at_expression(p)) normal.size = parse_float(p);
}

// `checker normal {...} normal {...}`, or an amount in place of the list.
void parse_normal_list(Parser& p, Normal& normal) {
    BlendMap<Normal> list;
    while (accept(p, "normal"_kw)) {
        list.push_back({static_cast<double>(list.size()), parse_normal(p, default_normal(p))});
        accept_comma(p);
    }
    if (!list.empty()) normal.normals = std::move(list);
}

// The picture, and what else stands in its block.
void parse_bump_map(Parser& p, Normal& normal) {
    ImagePattern image = parse_image_map(p, &normal.size);
    image.as_stored = true;
    set_kind(normal.pattern, std::move(image));
}

std::vector<SlopeStop> parse_slope_stops(Parser& p) {
    const SlopeMap map = parse_slope_map(p);
    return map.stops;
}

void parse_normal_item(Parser& p, Normal& normal) {
    const auto read_list = [&](const Pattern&) { parse_normal_list(p, normal); };
    if (const auto* declared = accept_declared<Normal>(p))
        normal = *declared;
    else if (accept(p, "bump_map"_kw))
        parse_bump_map(p, normal);
    else if (accept(p, "slope_map"_kw))
        normal.slopes = parse_slope_stops(p);
    else if (accept(p, "normal_map"_kw))
        normal.normals = parse_normal_map(p);
    else if (accept(p, "bump_size"_kw))
        normal.size = parse_float(p);
    else if (accept(p, "accuracy"_kw))
        normal.accuracy = parse_float_in(p, 1e-9, 1e9, "`accuracy`");
    else if (accept(p, "no_bump_scale"_kw))
        normal.scale_bumps = !parse_optional_bool(p);
    else if (Transform transform; accept_transform(p, transform))
        transform_bumps(normal, transform);
    else if (const Token word = peek(p); parse_pattern(p, normal.pattern, read_list)) {
        parse_size(p, normal);
        if (is(word, "facets"_kw)) warn_unsupported(p, word, "facets", "the surface is left smooth");
    }
    else if (!parse_pattern_modifier(p, normal.pattern))
        unexpected(p, "normal",
                   {"bumps"_kw, "dents"_kw, "wrinkles"_kw, "ripples"_kw, "waves"_kw, "bump_map"_kw, "bump_size"_kw,
                    "slope_map"_kw, "normal_map"_kw, "accuracy"_kw, "translate"_kw, "rotate"_kw, "scale"_kw});
}

} // namespace

Normal parse_normal(Parser& p, const Normal& start) {
    const Token opener = peek(p);
    Normal normal = start;
    bool uv_mapping = false;
    block(p, "normal", [&] {
        if (accept(p, "uv_mapping"_kw))
            uv_mapping = parse_optional_bool(p);
        else
            parse_normal_item(p, normal);
    });
    normal.pattern.uv_mapping |= uv_mapping;
    check_weight(p, opener, weight_of(normal));
    return normal;
}

BlendMap<Normal> parse_normal_map(Parser& p) {
    return parse_blend_map<Normal>(p, "normal_map", [&] {
        Normal normal = default_normal(p);
        while (!at(p, ']') && !at(p, '}') && !at_end(p)) parse_normal_item(p, normal);
        return normal;
    });
}

SlopeMap parse_slope_map(Parser& p) {
    SlopeMap map;
    const Token opener = peek(p);
    block(p, "slope_map", [&] {
        if (const auto* declared = accept_declared<SlopeMap>(p)) {
            map = *declared;
            return;
        }
        expect(p, '[', "to start an entry of `slope_map`, such as [0.5 <1, 0>]");
        SlopeStop stop;
        stop.position = parse_float(p);
        accept_comma(p);
        const Vec2 said = parse_uv(p);
        stop.height = said.x, stop.slope = said.y;
        map.stops.push_back(stop);
        expect(p, ']', "to end an entry of `slope_map`");
        accept_comma(p);
    });
    if (map.stops.empty()) fail(p, opener, "`slope_map` needs at least one entry, such as [0 <0, 1>]");
    std::stable_sort(map.stops.begin(), map.stops.end(),
                     [](const SlopeStop& a, const SlopeStop& b) { return a.position < b.position; });
    return map;
}

} // namespace pnr
