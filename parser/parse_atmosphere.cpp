// SPDX-License-Identifier: GPL-3.0-or-later
// background, sky_sphere, fog and rainbow.
#include "parser/blocks.h"
#include "parser/content.h"

#include <limits>

namespace pnr {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

Vec3 parse_direction(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const Vec3 v = parse_vector(p);
    if (!(glm::length(v) > 0)) fail(p, at, std::string(what) + " must not be zero");
    return glm::normalize(v);
}

bool at_color(Parser& p) { return at(p, "color"_kw) || at_expression(p); }

bool parse_fog_turbulence(Parser& p, Fog& fog) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "turbulence"_kw:
        next(p), fog.turbulence = parse_vector(p);
        return true;
    case "turb_depth"_kw:
        next(p), fog.depth = parse_float(p);
        return true;
    case "octaves"_kw:
        next(p), fog.octaves = parse_int(p, 1, 10, "`octaves`");
        return true;
    case "lambda"_kw:
        next(p), fog.lambda = parse_float(p);
        return true;
    case "omega"_kw:
        next(p), fog.omega = parse_float(p);
        return true;
    default:
        return false;
    }
}

bool parse_fog_word(Parser& p, Fog& fog) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "fog_type"_kw:
        next(p), fog.ground = parse_int(p, 1, 2, "`fog_type`") == 2;
        return true;
    case "distance"_kw:
        next(p), fog.distance = parse_float_in(p, 0, largest, "`distance` of fog");
        return true;
    case "fog_offset"_kw:
        next(p), fog.offset = parse_float(p);
        return true;
    case "fog_alt"_kw:
        next(p), fog.altitude = parse_float_in(p, 0, largest, "`fog_alt`");
        return true;
    case "up"_kw:
        next(p), fog.up = parse_direction(p, "`up` of fog");
        return true;
    default:
        return parse_fog_turbulence(p, fog);
    }
}

bool parse_arc_word(Parser& p, Rainbow& rainbow) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "direction"_kw:
        next(p), rainbow.direction = parse_direction(p, "`direction` of a rainbow");
        return true;
    case "up"_kw:
        next(p), rainbow.up = parse_direction(p, "`up` of a rainbow");
        return true;
    case "angle"_kw:
        next(p), rainbow.angle = parse_float_in(p, 0, 360, "`angle` of a rainbow");
        return true;
    case "width"_kw:
        next(p), rainbow.width = parse_float_in(p, 0, 360, "`width` of a rainbow");
        return true;
    case "distance"_kw:
        next(p), rainbow.distance = parse_float_in(p, 1e-300, largest, "`distance` of a rainbow");
        return true;
    case "jitter"_kw:
        next(p), rainbow.jitter = parse_float(p);
        return true;
    case "arc_angle"_kw:
        next(p), rainbow.arc_angle = parse_float_in(p, 0, 360, "`arc_angle`");
        return true;
    case "falloff_angle"_kw:
        next(p), rainbow.falloff_angle = parse_float_in(p, 0, 360, "`falloff_angle`");
        return true;
    case "color_map"_kw:
        next(p), rainbow.map = parse_color_map(p).stops;
        return true;
    default:
        return false;
    }
}

} // namespace

ColorFT parse_background(Parser& p) {
    ColorFT color;
    block(p, "background", [&] { color = parse_color(p); });
    return color;
}

SkySphere parse_sky_sphere(Parser& p) {
    const Token opener = peek(p);
    SkySphere sky;
    block(p, "sky_sphere", [&] {
        if (const auto* declared = accept_declared<SkySphere>(p))
            sky = *declared;
        else if (accept(p, "pigment"_kw))
            sky.layers.push_back(parse_pigment(p, Pigment{}));
        else if (accept(p, "emission"_kw))
            sky.emission = parse_color(p).rgb;
        else if (Transform transform; accept_transform(p, transform))
            for (Pigment& layer : sky.layers) apply_transform(transform, layer);
        else
            unexpected(p, "sky_sphere", {"pigment"_kw, "emission"_kw, "rotate"_kw, "scale"_kw, "translate"_kw});
    });
    check_weight(p, opener, weight_of(sky));
    return sky;
}

Fog parse_fog(Parser& p) {
    Fog fog;
    block(p, "fog", [&] {
        if (const auto* declared = accept_declared<Fog>(p))
            fog = *declared;
        else if (Transform transform; accept_transform(p, transform))
            fog.up = glm::normalize(transform_vector(transform.matrix, fog.up));
        else if (parse_fog_word(p, fog))
            accept_comma(p);
        else if (at_color(p))
            fog.color = parse_color(p), accept_comma(p);
        else
            unexpected(p, "fog",
                       {"fog_type"_kw, "distance"_kw, "color"_kw, "fog_alt"_kw, "fog_offset"_kw, "up"_kw,
                        "turbulence"_kw, "turb_depth"_kw, "octaves"_kw, "omega"_kw, "lambda"_kw});
    });
    return fog;
}

Rainbow parse_rainbow(Parser& p) {
    Rainbow rainbow;
    const Token opener = peek(p);
    block(p, "rainbow", [&] {
        if (const auto* declared = accept_declared<Rainbow>(p))
            rainbow = *declared;
        else if (Transform transform; accept_transform(p, transform)) {
            rainbow.direction = glm::normalize(transform_vector(transform.matrix, rainbow.direction));
            rainbow.up = glm::normalize(transform_vector(transform.matrix, rainbow.up));
        } else if (parse_arc_word(p, rainbow))
            accept_comma(p);
        else
            unexpected(p, "rainbow",
                       {"direction"_kw, "angle"_kw, "width"_kw, "distance"_kw, "color_map"_kw, "arc_angle"_kw,
                        "falloff_angle"_kw, "up"_kw, "jitter"_kw});
    });
    if (rainbow.falloff_angle > rainbow.arc_angle) {
        if (rainbow.falloff_angle < 360) fail(p, opener, "`falloff_angle` of a rainbow must not be larger than `arc_angle`");
        rainbow.falloff_angle = rainbow.arc_angle;
    }
    if (glm::length(glm::cross(rainbow.direction, rainbow.up)) < 1e-9)
        fail(p, opener, "`direction` and `up` of a rainbow must not be parallel");
    return rainbow;
}

} // namespace pnr
