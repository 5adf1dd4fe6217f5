// SPDX-License-Identifier: GPL-3.0-or-later
// `warp { ... }`: one bend of a pattern's space.
#include "parser/blocks.h"

#include <algorithm>

namespace pnr {

namespace {

// The index of the axis that the vector lies along; -1 if none or several.
int axis_of(Vec3 v) {
    int axis = -1;
    for (int i = 0; i < 3; ++i)
        if (v[i] != 0) axis = axis < 0 ? i : 3;
    return axis == 3 ? -1 : axis;
}

RepeatWarp parse_repeat(Parser& p, const Token& word) {
    RepeatWarp warp;
    const Vec3 said = parse_vector(p);
    warp.axis = axis_of(said);
    if (warp.axis < 0) fail(p, word, "`repeat` needs a vector along one axis, such as 2*x");
    warp.width = said[warp.axis];
    while (!at(p, '}')) {
        if (accept(p, "offset"_kw))
            warp.offset = parse_vector(p);
        else if (accept(p, "flip"_kw)) {
            const Vec3 flip = parse_vector(p);
            for (int i = 0; i < 3; ++i) warp.flip[i] = flip[i] != 0 ? -1 : 1;
        } else
            unexpected(p, "warp", {"offset"_kw, "flip"_kw});
    }
    return warp;
}

BlackHoleWarp parse_black_hole(Parser& p) {
    BlackHoleWarp warp;
    warp.center = parse_vector(p);
    accept_comma(p);
    warp.radius = parse_float(p);
    while (!at(p, '}')) {
        if (accept(p, "strength"_kw))
            warp.strength = parse_float(p);
        else if (accept(p, "falloff"_kw))
            warp.falloff = parse_float(p);
        else if (accept(p, "inverse"_kw))
            warp.inverse = true;
        else if (accept(p, "repeat"_kw)) {
            warp.repeat = true;
            warp.repeat_size = parse_vector(p);
        } else if (accept(p, "turbulence"_kw))
            warp.turbulence = parse_vector(p);
        else
            unexpected(p, "warp", {"strength"_kw, "falloff"_kw, "inverse"_kw, "repeat"_kw, "turbulence"_kw});
    }
    return warp;
}

Turbulence parse_turbulence_warp(Parser& p) {
    Turbulence warp;
    warp.amount = parse_vector(p);
    while (!at(p, '}'))
        if (!parse_turbulence_word(p, warp)) unexpected(p, "warp", {"octaves"_kw, "omega"_kw, "lambda"_kw});
    return warp;
}

MapWarp parse_map_warp(Parser& p, MapShape shape) {
    MapWarp warp;
    warp.shape = shape;
    if (shape == MapShape::planar && at_expression(p)) {
        warp.orientation = parse_vector(p);
        accept_comma(p);
        warp.distance = parse_float(p);
    }
    while (!at(p, '}')) {
        if (accept(p, "orientation"_kw))
            warp.orientation = parse_vector(p);
        else if (accept(p, "dist_exp"_kw))
            warp.dist_exp = parse_float(p);
        else if (accept(p, "major_radius"_kw))
            warp.major_radius = parse_float(p);
        else
            unexpected(p, "warp", {"orientation"_kw, "dist_exp"_kw, "major_radius"_kw});
    }
    const double length = glm::length(warp.orientation);
    if (!(length > 0)) fail(p, peek(p), "the orientation of a warp is a direction, not zero");
    warp.orientation /= length;
    return warp;
}

} // namespace

bool parse_turbulence_word(Parser& p, Turbulence& turbulence) {
    if (accept(p, "octaves"_kw))
        turbulence.octaves = std::clamp(parse_int(p, -1000, 1000, "`octaves`"), 1, 10);
    else if (accept(p, "omega"_kw))
        turbulence.omega = parse_float(p);
    else if (accept(p, "lambda"_kw))
        turbulence.lambda = parse_float(p);
    else
        return false;
    return true;
}

void parse_warp(Parser& p, Pattern& pattern) {
    block(p, "warp", [&] {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "repeat"_kw:
            next(p), add_warp(pattern, parse_repeat(p, word));
            return;
        case "black_hole"_kw:
            next(p), add_warp(pattern, parse_black_hole(p));
            return;
        case "turbulence"_kw:
            next(p), add_warp(pattern, parse_turbulence_warp(p));
            return;
        case "spherical"_kw:
            next(p), add_warp(pattern, parse_map_warp(p, MapShape::spherical));
            return;
        case "cylindrical"_kw:
            next(p), add_warp(pattern, parse_map_warp(p, MapShape::cylindrical));
            return;
        case "toroidal"_kw:
            next(p), add_warp(pattern, parse_map_warp(p, MapShape::toroidal));
            return;
        case "planar"_kw:
            next(p), add_warp(pattern, parse_map_warp(p, MapShape::planar));
            return;
        case "cubic"_kw:
            next(p), add_warp(pattern, parse_map_warp(p, MapShape::cubic));
            return;
        default:
            unexpected(p, "warp",
                       {"repeat"_kw, "black_hole"_kw, "turbulence"_kw, "spherical"_kw, "cylindrical"_kw,
                        "toroidal"_kw, "planar"_kw, "cubic"_kw});
        }
    });
}

} // namespace pnr
