// SPDX-License-Identifier: GPL-3.0-or-later
// Pigments: patterns and the colours they pick.
#include "parser/blocks.h"
#include "parser/content.h"
#include "parser/expression.h"

#include <algorithm>

namespace pnr {

namespace {

bool at_color_expression(Parser& p) { return at(p, "color"_kw) || at_expression(p); }

Pigment plain(const ColorFT& color) {
    Pigment pigment;
    pigment.map = {{0, color}};
    return pigment;
}

// POV-Ray's colours for entries that are not given.
std::vector<ColorFT> default_list(const Pattern& pattern) {
    const ColorFT red{Color(1, 0, 0)}, green{Color(0, 1, 0)}, blue{Color(0, 0, 1)};
    if (std::holds_alternative<BrickPattern>(pattern.kind))
        return {{Color(0.5f)}, {Color(0.6f, 0.15f, 0.15f)}};
    std::vector<ColorFT> colors{blue, green, red};
    if (list_size(pattern) > 3)
        colors = {red, green, blue, {Color(1, 1, 0)}, {Color(0, 1, 1)}, {Color(1, 0, 1)}};
    colors.resize(static_cast<std::size_t>(list_size(pattern)));
    return colors;
}

// The colours or pigments of a list pattern; those not given keep POV-Ray's defaults.
void parse_pigment_list(Parser& p, Pigment& pigment, const Pattern& pattern) {
    std::vector<ColorFT> colors = default_list(pattern);
    std::vector<Pigment> pigments;
    bool plain_only = true;
    while (pigments.size() < colors.size() && (at_color_expression(p) || at(p, "pigment"_kw))) {
        if (accept(p, "pigment"_kw)) {
            pigments.push_back(parse_pigment(p, top_layer(p.default_texture).pigment));
            plain_only = false;
        } else {
            colors[pigments.size()] = parse_color(p);
            pigments.push_back(plain(colors[pigments.size()]));
        }
        accept_comma(p);
    }
    pigment.map.clear();
    pigment.pigments.clear();
    for (const ColorFT& color : colors) pigment.map.push_back({double(pigment.map.size()), color});
    if (plain_only) return;
    for (std::size_t i = 0; i < colors.size(); ++i)
        pigment.pigments.push_back({double(i), i < pigments.size() ? pigments[i] : plain(colors[i])});
}

bool parse_pigment_pattern(Parser& p, Pigment& pigment) {
    if (accept(p, "image_map"_kw)) {
        set_kind(pigment.pattern, parse_image_map(p));
        return true;
    }
    const Token word = peek(p);
    const bool read = parse_pattern(p, pigment.pattern,
                                    [&](const Pattern& pattern) { parse_pigment_list(p, pigment, pattern); });
    if (read && !is_list_pattern(pigment.pattern)) {
        pigment.map = default_map(word);
        pigment.pigments.clear();
    }
    return read;
}

} // namespace

void parse_pigment_item(Parser& p, Pigment& pigment) {
    if (const auto* declared = accept_declared<Pigment>(p))
        pigment = *declared;
    else if (accept(p, "color_map"_kw)) {
        pigment.map = parse_color_map(p).stops;
        pigment.pigments.clear();
    } else if (accept(p, "pigment_map"_kw))
        pigment.pigments = parse_pigment_map(p);
    else if (accept(p, "quick_color"_kw))
        parse_color(p); // for previews
    else if (Transform transform; accept_transform(p, transform))
        apply_transform(transform, pigment);
    else if (parse_pigment_pattern(p, pigment) || parse_pattern_modifier(p, pigment.pattern))
        return;
    else if (at_color_expression(p))
        pigment = plain(parse_color(p));
    else
        unexpected(p, "pigment",
                   {"color"_kw, "rgb"_kw, "checker"_kw, "gradient"_kw, "image_map"_kw, "color_map"_kw,
                    "pigment_map"_kw, "bozo"_kw, "translate"_kw, "rotate"_kw, "scale"_kw});
}

Pigment parse_pigment(Parser& p, const Pigment& start) {
    const Token opener = peek(p);
    Pigment pigment = start;
    bool uv_mapping = false; // at the end: transforms within the block still count
    block(p, "pigment", [&] {
        if (accept(p, "uv_mapping"_kw))
            uv_mapping = parse_optional_bool(p);
        else
            parse_pigment_item(p, pigment);
    });
    pigment.pattern.uv_mapping |= uv_mapping;
    check_weight(p, opener, weight_of(pigment));
    return pigment;
}

BlendMap<Pigment> parse_pigment_map(Parser& p) {
    return parse_blend_map<Pigment>(p, "pigment_map", [&] {
        Pigment entry = top_layer(p.default_texture).pigment;
        while (!at(p, ']') && !at(p, '}')) parse_pigment_item(p, entry);
        return entry;
    });
}

bool skip_pattern(Parser& p) {
    Pigment unused;
    return parse_pigment_pattern(p, unused) || parse_pattern_modifier(p, unused.pattern);
}

ColorMap parse_color_map(Parser& p) {
    ColorMap map;
    const Token opener = peek(p);
    block(p, "color_map", [&] {
        if (const auto* declared = accept_declared<ColorMap>(p)) {
            map = *declared;
            return;
        }
        expect(p, '[', "to start an entry of `color_map`, such as [0.5 rgb <1, 0, 0>]");
        const double position = parse_float(p);
        accept_comma(p);
        if (peek(p).kind == TokenKind::number) { // POV-Ray 1: [from, to color A color B]
            const double to = parse_float(p);
            accept_comma(p);
            map.stops.push_back({position, parse_color(p)});
            accept_comma(p);
            map.stops.push_back({to, parse_color(p)});
        } else
            map.stops.push_back({position, parse_color(p)});
        expect(p, ']', "to end an entry of `color_map`");
        accept_comma(p);
    });
    if (map.stops.empty()) fail(p, opener, "`color_map` needs at least one entry, such as [0 rgb 1]");
    std::stable_sort(map.stops.begin(), map.stops.end(),
                     [](const ColorStop& a, const ColorStop& b) { return a.position < b.position; });
    return map;
}

} // namespace pnr
