// SPDX-License-Identifier: GPL-3.0-or-later
// Pigments: patterns and the colours they pick.
#include "parser/blocks.h"
#include "parser/expression.h"

#include <algorithm>

namespace pnr {

namespace {

// Patterns that pick from a continuous map, and those that pick from a list; not one of them is evaluated
// yet.
bool is_unsupported_pattern(const Token& token) {
    switch (keyword_of(token)) {
    case "agate"_kw:
    case "average"_kw:
    case "boxed"_kw:
    case "bozo"_kw:
    case "brick"_kw:
    case "bumps"_kw:
    case "cells"_kw:
    case "crackle"_kw:
    case "cubic"_kw:
    case "cylindrical"_kw:
    case "density_file"_kw:
    case "dents"_kw:
    case "facets"_kw:
    case "function"_kw:
    case "granite"_kw:
    case "hexagon"_kw:
    case "image_pattern"_kw:
    case "julia"_kw:
    case "leopard"_kw:
    case "magnet"_kw:
    case "mandel"_kw:
    case "marble"_kw:
    case "object"_kw:
    case "onion"_kw:
    case "pigment_pattern"_kw:
    case "planar"_kw:
    case "quilted"_kw:
    case "radial"_kw:
    case "ripples"_kw:
    case "slope"_kw:
    case "spherical"_kw:
    case "spiral1"_kw:
    case "spiral2"_kw:
    case "spotted"_kw:
    case "tiling"_kw:
    case "triangular"_kw:
    case "waves"_kw:
    case "wood"_kw:
    case "wrinkles"_kw:
        return true;
    default:
        return false;
    }
}

bool at_color_expression(Parser& p) { return at(p, "color"_kw) || at_expression(p); }

// A map's end belongs to the last colour, its start to the first: the mean over [0, 1] of the piecewise
// linear map.
ColorFT mean_color(const std::vector<ColorStop>& map) {
    ColorFT sum;
    const auto add = [&](const ColorFT& c, double weight) {
        const float w = static_cast<float>(weight);
        sum.rgb += c.rgb * w, sum.filter += c.filter * w, sum.transmit += c.transmit * w;
    };
    add(map.front().color, std::clamp(map.front().position, 0.0, 1.0));
    add(map.back().color, 1 - std::clamp(map.back().position, 0.0, 1.0));
    for (std::size_t i = 0; i + 1 < map.size(); ++i) {
        const double width =
            std::clamp(map[i + 1].position, 0.0, 1.0) - std::clamp(map[i].position, 0.0, 1.0);
        add(map[i].color, width / 2), add(map[i + 1].color, width / 2);
    }
    return sum;
}

// One colour of a list pattern: a colour, or a block pigment, which counts by its mean.
ColorFT parse_list_color(Parser& p) {
    const Token word = peek(p);
    if (!accept(p, "pigment"_kw)) return parse_color(p);
    const Pigment inner = parse_pigment(p, Pigment{});
    if (!std::holds_alternative<UniformPattern>(inner.pattern))
        warn_unsupported(p, word, "pigment inside a pattern", "its mean colour is used");
    return mean_color(inner.map);
}

// `checker A, B`: up to `most` colours; those not given keep POV-Ray's defaults.
void parse_color_list(Parser& p, Pigment& pigment, std::vector<ColorFT> defaults) {
    for (std::size_t i = 0; i < defaults.size() && (at_color_expression(p) || at(p, "pigment"_kw)); ++i) {
        defaults[i] = parse_list_color(p);
        accept_comma(p);
    }
    pigment.map.clear();
    for (const ColorFT& color : defaults) pigment.map.push_back({double(pigment.map.size()), color});
}

std::vector<ColorStop> gray_ramp() { return {{0, {Color(0)}}, {1, {Color(1)}}}; }

void parse_gradient(Parser& p, const Token& word, Pigment& pigment) {
    const Vec3 axis = parse_vector(p);
    if (axis == Vec3(0)) fail(p, word, "`gradient` needs a direction that is not zero");
    pigment.pattern = GradientPattern{axis};
    pigment.map = gray_ramp();
}

void parse_unsupported_pattern(Parser& p, const Token& word, Pigment& pigment) {
    warn_unsupported(p, word, token_text(p, word, false), "its mean colour is painted");
    pigment.pattern = UniformPattern{};
    pigment.map = gray_ramp();
    accept(p, "df3"_kw);
    while (at_string(p) || at_color_expression(p)) {
        if (at_string(p))
            parse_string(p);
        else
            parse_color(p);
        accept_comma(p);
    }
    if (at(p, '{')) skip_block(p, token_text(p, word, false));
}

// Words behind a pattern that shape it. False if none stands here.
bool parse_pattern_modifier(Parser& p, Pigment& pigment) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "frequency"_kw:
        next(p), pigment.frequency = parse_float(p);
        return true;
    case "phase"_kw:
        next(p), pigment.phase = parse_float(p);
        return true;
    case "ramp_wave"_kw:
        next(p);
        return true;
    case "quick_color"_kw:
        next(p), parse_color(p);
        return true;
    case "uv_mapping"_kw:
        next(p);
        if (auto* image = std::get_if<ImagePattern>(&pigment.pattern))
            image->map_type = ImageMapType::uv;
        else
            warn_unsupported(p, word, "uv_mapping of patterns", "the pattern stays in space");
        return true;
    case "turbulence"_kw:
    case "warp"_kw:
    case "triangle_wave"_kw:
    case "sine_wave"_kw:
    case "scallop_wave"_kw:
    case "cubic_wave"_kw:
    case "poly_wave"_kw:
        warn_unsupported(p, next(p), token_text(p, word, false), "the pattern is drawn without it");
        skip_argument(p, token_text(p, word, false));
        return true;
    case "octaves"_kw:
    case "omega"_kw:
    case "lambda"_kw:
    case "agate_turb"_kw:
    case "noise_generator"_kw:
    case "control0"_kw:
    case "control1"_kw:
    case "metric"_kw:
    case "offset"_kw:
    case "form"_kw:
    case "solid"_kw:
    case "interpolate"_kw:
    case "mortar"_kw:
    case "brick_size"_kw:
    case "exponent"_kw:
    case "exterior"_kw:
    case "interior"_kw:
        next(p), skip_argument(p, token_text(p, word, false));
        while (accept(p, ',')) skip_argument(p, token_text(p, word, false)); // interior and exterior take two
        return true;
    default:
        return false;
    }
}

// The map's stops when the pattern was a stand-in for one that we lack.
void average_map(Pigment& pigment) {
    if (std::holds_alternative<UniformPattern>(pigment.pattern) && pigment.map.size() > 1)
        pigment.map = {{0, mean_color(pigment.map)}};
}

void parse_solid_color(Parser& p, Pigment& pigment) {
    pigment = Pigment{};
    pigment.map = {{0, parse_color(p)}};
}

bool parse_pattern(Parser& p, Pigment& pigment) {
    const Token word = peek(p);
    if (is_unsupported_pattern(word)) return parse_unsupported_pattern(p, next(p), pigment), true;
    switch (keyword_of(word)) {
    case "checker"_kw:
        next(p);
        pigment.pattern = CheckerPattern{};
        parse_color_list(p, pigment, {{Color(0, 0, 1)}, {Color(0, 1, 0)}}); // POV-Ray's defaults
        return true;
    case "gradient"_kw:
        parse_gradient(p, next(p), pigment);
        return true;
    case "image_map"_kw:
        next(p), pigment.pattern = parse_image_map(p);
        return true;
    default:
        return false;
    }
}

void parse_pigment_item(Parser& p, Pigment& pigment) {
    if (const auto* declared = accept_declared<Pigment>(p))
        pigment = *declared;
    else if (parse_pattern(p, pigment) || parse_pattern_modifier(p, pigment))
        return;
    else if (accept(p, "color_map"_kw))
        pigment.map = parse_color_map(p).stops;
    else if (at(p, "pigment_map"_kw)) {
        warn_unsupported(p, next(p), "pigment_map", "it is left out");
        skip_block(p, "pigment_map");
    } else if (Transform transform; accept_transform(p, transform))
        apply_transform(transform, pigment);
    else if (at_color_expression(p))
        parse_solid_color(p, pigment);
    else
        unexpected(p, "pigment",
                   {"color"_kw, "rgb"_kw, "checker"_kw, "gradient"_kw, "image_map"_kw, "color_map"_kw,
                    "translate"_kw, "rotate"_kw, "scale"_kw});
}

} // namespace

Pigment parse_pigment(Parser& p, const Pigment& start) {
    Pigment pigment = start;
    block(p, "pigment", [&] { parse_pigment_item(p, pigment); });
    average_map(pigment);
    return pigment;
}

bool skip_pattern(Parser& p) {
    Pigment unused;
    return parse_pattern(p, unused) || parse_pattern_modifier(p, unused);
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

ImagePattern parse_image_map(Parser& p) {
    ImagePattern image;
    image.interpolate = false; // POV-Ray's default is the nearest pixel
    image.as_stored = p.scene.povray && (!p.in.version_said || p.in.version < 3.7); // as POV-Ray 3.7 does
    const Token opener = peek(p);
    block(p, "image_map", [&] {
        const Token word = peek(p);
        if (at_string(p)) {
            image.said_at = source_ref(p, word);
            image.file = resolve_file(p, word, parse_string(p));
            return;
        }
        switch (keyword_of(word)) {
        case "png"_kw:
        case "jpeg"_kw:
        case "gif"_kw:
        case "tga"_kw:
        case "tiff"_kw:
        case "ppm"_kw:
        case "pgm"_kw:
        case "exr"_kw:
        case "hdr"_kw:
        case "iff"_kw:
        case "sys"_kw:
            next(p);
            return; // the file itself says what it is
        case "map_type"_kw: {
            next(p);
            const int type = parse_int(p, 0, 7, "`map_type`");
            if (type != 0 && type != 1 && type != 2 && type != 5)
                fail(p, word, "`map_type` is 0 (planar), 1 (spherical), 2 (cylindrical) or 5 (torus)");
            image.map_type = static_cast<ImageMapType>(type);
            return;
        }
        case "once"_kw:
            next(p), image.once = true;
            return;
        case "interpolate"_kw:
            next(p), image.interpolate = parse_int(p, 0, 4, "`interpolate`") != 0;
            return;
        case "use_color"_kw:
        case "premultiplied"_kw:
            next(p), parse_optional_bool(p);
            return;
        case "gamma"_kw:
        case "filter"_kw:
        case "transmit"_kw:
        case "use_index"_kw:
        case "use_alpha"_kw:
            warn_unsupported(p, next(p), token_text(p, word, false), "the picture's own values are used");
            accept(p, "all"_kw);
            while (at_expression(p)) parse_float(p), accept_comma(p);
            return;
        default:
            unexpected(p, "image_map", {"png"_kw, "jpeg"_kw, "map_type"_kw, "once"_kw, "interpolate"_kw});
        }
    });
    if (image.file.empty()) fail(p, opener, "`image_map` needs a picture, such as \"wood.png\"");
    return image;
}

} // namespace pnr
