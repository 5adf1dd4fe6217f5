// SPDX-License-Identifier: GPL-3.0-or-later
// What a light says of its shadows: area_light, projected_through; and of media and photons.
#include "parser/blocks.h"

#include <cmath>

namespace pnr {

namespace {

constexpr int most_rows = 10000;

AreaGrid& grid_of(LightSource& light) {
    if (!light.area) light.area.emplace();
    return *light.area;
}

// Points in a row or column. POV-Ray takes any number and cuts it off.
int parse_grid_size(Parser& p) {
    return static_cast<int>(parse_float_in(p, 1, most_rows, "the size of an area_light"));
}

void parse_area_light(Parser& p, LightSource& light) {
    AreaGrid& area = grid_of(light);
    area.u = parse_vector(p), accept_comma(p);
    area.v = parse_vector(p), accept_comma(p);
    area.columns = parse_grid_size(p), accept_comma(p);
    area.rows = parse_grid_size(p);
}

// `photons { reflection on|off  refraction on|off  area_light }`
void parse_light_photons(Parser& p, LightSource& light) {
    block(p, "photons", [&] {
        if (accept(p, "reflection"_kw))
            light.reflection_photons = parse_optional_bool(p);
        else if (accept(p, "refraction"_kw))
            light.refraction_photons = parse_optional_bool(p);
        else if (!accept(p, "area_light"_kw)) // photons start all over the area anyway
            unexpected(p, "photons", {"reflection"_kw, "refraction"_kw, "area_light"_kw});
    });
}

void parse_projected_through(Parser& p, LightSource& light) {
    light.projected_through.clear();
    block(p, "projected_through", [&] {
        const Token word = peek(p);
        if (auto object = parse_object(p))
            light.projected_through.assign(1, std::move(*object));
        else if (const auto* declared = accept_declared<Object>(p))
            light.projected_through.assign(1, *declared);
        else if (light.projected_through.empty() || !parse_object_modifier(p, light.projected_through.front()))
            fail(p, word, "`projected_through` needs an object");
    });
}

} // namespace

bool parse_light_shadow(Parser& p, LightSource& light) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "area_light"_kw:
        next(p), parse_area_light(p, light);
        return true;
    case "adaptive"_kw:
        next(p), grid_of(light).adaptive = parse_int(p, 0, 100, "`adaptive`");
        return true;
    case "jitter"_kw:
        next(p), grid_of(light).jitter = true;
        return true;
    case "circular"_kw:
        next(p), grid_of(light).circular = true;
        return true;
    case "orient"_kw:
        next(p), grid_of(light).orient = true;
        return true;
    case "area_illumination"_kw:
        next(p), grid_of(light).illuminates = parse_optional_bool(p);
        return true;
    case "media_attenuation"_kw:
        next(p), light.media_attenuation = parse_optional_bool(p);
        return true;
    case "media_interaction"_kw: // no medium is drawn that it could light
        next(p), parse_optional_bool(p);
        return true;
    case "projected_through"_kw:
        next(p), parse_projected_through(p, light);
        return true;
    case "photons"_kw:
        next(p), parse_light_photons(p, light);
        return true;
    default:
        return false;
    }
}

} // namespace pnr
