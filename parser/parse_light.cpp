// SPDX-License-Identifier: GPL-3.0-or-later
// Lights: POV-Ray's, and emitters that have an area.
#include "parser/blocks.h"
#include "parser/content.h"

#include <cmath>

namespace pnr {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

Vec3 parse_axis(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const Vec3 axis = parse_vector(p);
    const double length = glm::length(axis);
    if (!(length > 0)) fail(p, at, std::string(what) + " must not be zero");
    return axis / length;
}

void parse_rectangle(Parser& p, Emitter& emitter) {
    const Token at = peek(p);
    emitter.u = parse_vector(p);
    accept_comma(p);
    emitter.v = parse_vector(p);
    if (!(glm::length(glm::cross(emitter.u, emitter.v)) > 0))
        fail(p, at, "the edges of a rectangle must not be zero or parallel");
}

// `emitter { sphere r | hemisphere r, axis | disc r, axis | rectangle u, v }`
Emitter parse_emitter(Parser& p) {
    Emitter emitter;
    const Token opener = peek(p);
    bool shaped = false;
    block(p, "emitter", [&] {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "sphere"_kw:
            emitter.shape = EmitterShape::sphere;
            break;
        case "hemisphere"_kw:
            emitter.shape = EmitterShape::hemisphere;
            break;
        case "disc"_kw:
            emitter.shape = EmitterShape::disc;
            break;
        case "rectangle"_kw:
            emitter.shape = EmitterShape::rectangle;
            break;
        default:
            unexpected(p, "emitter", {"sphere"_kw, "hemisphere"_kw, "disc"_kw, "rectangle"_kw});
        }
        next(p);
        shaped = true;
        if (emitter.shape == EmitterShape::rectangle) return parse_rectangle(p, emitter);
        emitter.radius = parse_float_in(p, 1e-300, largest, "an emitter's radius");
        accept_comma(p);
        if (emitter.shape != EmitterShape::sphere) emitter.axis = parse_axis(p, "an emitter's axis");
    });
    if (!shaped) fail(p, opener, "an emitter needs a shape, such as `sphere 0.5`");
    return emitter;
}

void parse_looks_like(Parser& p, LightSource& light) {
    block(p, "looks_like", [&] {
        const Token word = peek(p);
        if (auto object = parse_object(p))
            light.looks_like.assign(1, std::move(*object));
        else if (const auto* declared = accept_declared<Object>(p))
            light.looks_like.assign(1, *declared);
        else if (!light.looks_like.empty() && parse_object_modifier(p, light.looks_like.front()))
            return;
        else
            fail(p, word, "`looks_like` needs an object");
    });
    if (light.looks_like.empty()) return;
    light.looks_like.front().no_shadow = true;
    apply_transform(translation(light.position), light.looks_like.front());
}

bool parse_light_shape(Parser& p, LightSource& light) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "spotlight"_kw:
        next(p), light.spotlight = true;
        light.radius = 30, light.falloff = 45;
        return true;
    case "parallel"_kw:
        next(p), light.parallel = true;
        return true;
    case "cylinder"_kw: // its radii are lengths
        next(p), light.cylinder = true;
        light.radius = 0.75, light.falloff = 1;
        return true;
    case "shadowless"_kw:
        next(p), light.shadowless = true;
        return true;
    case "point_at"_kw:
        next(p), light.point_at = parse_vector(p);
        return true;
    case "radius"_kw:
        next(p), light.radius = parse_float(p);
        return true;
    case "falloff"_kw:
        next(p), light.falloff = parse_float(p);
        return true;
    case "tightness"_kw:
        next(p), light.tightness = parse_float_in(p, 0, largest, "`tightness`");
        return true;
    case "fade_distance"_kw:
        next(p), light.fade_distance = parse_float_in(p, 0, largest, "`fade_distance`");
        return true;
    case "fade_power"_kw:
        next(p), light.fade_power = parse_float(p);
        return true;
    case "looks_like"_kw:
        next(p), parse_looks_like(p, light);
        return true;
    case "no_image"_kw:
        next(p), light.no_image = parse_optional_bool(p);
        return true;
    default:
        return false;
    }
}

// Radiance and power as said; they belong to the emitter, which may be said behind them.
struct Strength {
    std::optional<double> radiance, power;
};

void finish_emitter(Parser& p, const Token& at, LightSource& light, const Strength& said) {
    if (said.radiance && said.power) fail(p, at, "an emitter takes `radiance` or `power`, not both");
    const bool strong = said.radiance || said.power;
    if (!light.emitter) {
        if (strong)
            fail(p, at, "`radiance` and `power` need an emitter", "say for example: emitter { sphere 0.5 }");
        return;
    }
    Emitter& emitter = *light.emitter;
    if (strong) emitter.radiance = said.radiance, emitter.power = said.power;
    if (!emitter.radiance && !emitter.power)
        fail(p, at, "an emitter needs `radiance` (W/(m^2 sr)) or `power` (W)");
    if (light.spotlight || light.parallel || light.cylinder)
        fail(p, at,
             "an emitter shines by its own shape: `spotlight`, `parallel` and `cylinder` do not go with it");
}

// Emitters of a round shape stay round.
void check_scale(Parser& p, const Token& at, const LightSource& light, const Transform& by) {
    if (!light.emitter || light.emitter->shape == EmitterShape::rectangle) return;
    const glm::dmat3 m(by.matrix);
    const glm::dmat3 square = glm::transpose(m) * m;
    const double mean = (square[0][0] + square[1][1] + square[2][2]) / 3;
    double off = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(square[i][j] - (i == j ? mean : 0)));
    if (off > 1e-9 * mean)
        warn(p, at, "an emitter is scaled alike in all directions: by the mean of this scale");
}

} // namespace

LightSource parse_light_source(Parser& p) {
    LightSource light;
    Strength strength;
    const Token opener = peek(p);
    light.said_at = source_ref(p, opener);
    bool started = false;
    block(p, "light_source", [&] {
        if (!started) {
            started = true;
            if (const auto* declared = accept_declared<LightSource>(p)) {
                light = *declared;
                return;
            }
            light.position = parse_vector(p);
            accept_comma(p);
            light.color = parse_color(p).rgb;
            return;
        }
        const Token word = peek(p);
        if (Transform transform; accept_transform(p, transform)) {
            check_scale(p, word, light, transform);
            return apply_transform(transform, light);
        }
        if (parse_light_shape(p, light) || parse_light_shadow(p, light)) return;
        if (accept(p, "emitter"_kw))
            light.emitter = parse_emitter(p);
        else if (accept(p, "radiance"_kw))
            strength.radiance = parse_float_in(p, 0, largest, "`radiance`");
        else if (accept(p, "power"_kw))
            strength.power = parse_float_in(p, 0, largest, "`power`");
        else
            unexpected(p, "light_source",
                       {"spotlight"_kw, "parallel"_kw, "cylinder"_kw, "point_at"_kw, "radius"_kw,
                        "falloff"_kw, "tightness"_kw, "fade_distance"_kw, "fade_power"_kw, "shadowless"_kw,
                        "emitter"_kw, "radiance"_kw, "power"_kw, "area_light"_kw, "translate"_kw});
    });
    finish_emitter(p, opener, light, strength);
    if (light.area && light.area->columns * light.area->rows == 1 && light.area->jitter == false) light.area.reset();
    if (light.emitter && light.area) fail(p, opener, "an emitter has its own area: `area_light` does not go with it");
    if (light.parallel && light.point_at == light.position)
        fail(p, opener, "`point_at` of a parallel light must differ from its position");
    const Weight weight = weight_of(light);
    check_weight(p, opener, weight);
    charge(p, opener, weight.bytes);
    return light;
}

void apply_transform(const Transform& by, LightSource& light) {
    const auto point = [&](Vec3& v) { v = transform_point(by.matrix, v); };
    const auto vector = [&](Vec3& v) { v = transform_vector(by.matrix, v); };
    point(light.position);
    point(light.point_at);
    for (auto* objects : {&light.looks_like, &light.projected_through})
        for (Object& object : *objects) apply_transform(by, object);
    if (light.area) vector(light.area->u), vector(light.area->v);
    if (!light.emitter) return;
    Emitter& emitter = *light.emitter;
    vector(emitter.u), vector(emitter.v);
    // A disc's axis is a normal; under a uniform scale that is the vector's own image. The radius grows by
    // the mean scale.
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(by.matrix))));
    emitter.radius *= scale;
    const Vec3 axis = transform_normal(by, emitter.axis);
    emitter.axis = axis / glm::length(axis);
}

} // namespace pnr
