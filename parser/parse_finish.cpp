// SPDX-License-Identifier: GPL-3.0-or-later
// finish: how a surface answers to light.
#include "parser/blocks.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace pnr {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

double parse_not_negative(Parser& p, std::string_view what) { return parse_float_in(p, 0, largest, what); }

bool at_number(Parser& p) { return at_expression(p); }

// The braces of `reflection { [min,] max ... }`.
Reflection parse_reflection_block(Parser& p) {
    Reflection r;
    int colors = 0;
    block(p, "reflection", [&] {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "fresnel"_kw:
            next(p), r.fresnel = parse_optional_bool(p);
            return;
        case "falloff"_kw:
            next(p), r.falloff = parse_not_negative(p, "`falloff` of a reflection");
            return;
        case "exponent"_kw:
            next(p), r.exponent = parse_not_negative(p, "`exponent` of a reflection");
            return;
        case "metallic"_kw:
            next(p), r.metallic = at_number(p) ? parse_float(p) : 1;
            return;
        default:
            break;
        }
        if (colors == 2 || !(at(p, "color"_kw) || at_expression(p)))
            unexpected(p, "reflection", {"fresnel"_kw, "falloff"_kw, "exponent"_kw, "metallic"_kw});
        r.max = parse_color(p).rgb;
        if (colors++ == 0) r.min = r.max;
        accept_comma(p);
    });
    return r;
}

void parse_reflection(Parser& p, Finish& finish) {
    if (at(p, '{')) {
        finish.reflection = parse_reflection_block(p);
        return;
    }
    finish.reflection.min = finish.reflection.max = parse_color(p).rgb;
}

// `albedo` in front of a strength: it is the share of light that goes there in all, not the peak.
struct Albedos {
    bool diffuse = false, phong = false, specular = false;
};

// The peaks that belong to the shares that were said, once brilliance and the like are known
// [POV-Ray 3.7 reference, "Finish"; the factors are measured].
void resolve_albedos(const Albedos& said, Finish& f) {
    if (said.diffuse) {
        const double scale = (f.brilliance + 1) / 2;
        f.diffuse *= scale, f.diffuse_back *= scale;
    }
    if (said.phong) f.phong *= (f.phong_size + 1) / 2;
    if (said.specular) {
        const double n = 1 / f.roughness;
        f.specular *= (n + 2) / (4 * (2 - std::exp2(-n / 2)));
    }
}

double parse_strength(Parser& p, std::string_view what, bool& albedo) {
    albedo = accept(p, "albedo"_kw);
    return parse_not_negative(p, what);
}

void parse_diffuse(Parser& p, Finish& finish, bool& albedo) {
    finish.diffuse = parse_strength(p, "`diffuse`", albedo);
    accept_comma(p);
    if (at_number(p)) finish.diffuse_back = parse_not_negative(p, "`diffuse` of the back");
}

Iridescence parse_irid(Parser& p, const Iridescence& start) {
    Iridescence irid = start;
    block(p, "irid", [&] {
        if (accept(p, "thickness"_kw))
            irid.thickness = parse_float(p);
        else if (accept(p, "turbulence"_kw))
            irid.turbulence = parse_float(p);
        else if (at_number(p))
            irid.amount = parse_float(p);
        else
            unexpected(p, "irid", {"thickness"_kw, "turbulence"_kw});
        accept_comma(p);
    });
    return irid;
}

bool parse_finish_word(Parser& p, Finish& f, Albedos& albedos) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "ambient"_kw:
        next(p), f.ambient = parse_color(p).rgb;
        return true;
    case "emission"_kw:
        next(p), f.emission = parse_color(p).rgb;
        return true;
    case "diffuse"_kw:
        next(p), parse_diffuse(p, f, albedos.diffuse);
        return true;
    case "brilliance"_kw:
        next(p), f.brilliance = parse_not_negative(p, "`brilliance`");
        return true;
    case "phong"_kw:
        next(p), f.phong = parse_strength(p, "`phong`", albedos.phong);
        return true;
    case "phong_size"_kw:
        next(p), f.phong_size = parse_not_negative(p, "`phong_size`");
        return true;
    case "specular"_kw:
        next(p), f.specular = parse_strength(p, "`specular`", albedos.specular);
        return true;
    case "roughness"_kw:
        next(p), f.roughness = parse_float_in(p, 1e-9, largest, "`roughness`");
        return true;
    case "metallic"_kw:
        next(p), f.metallic = at_number(p) ? parse_float(p) : 1;
        return true;
    case "reflection"_kw:
        next(p), parse_reflection(p, f);
        return true;
    case "reflection_exponent"_kw:
        next(p), f.reflection.exponent = parse_not_negative(p, "`reflection_exponent`");
        return true;
    case "conserve_energy"_kw:
        next(p), f.conserve_energy = parse_optional_bool(p);
        return true;
    case "crand"_kw:
        next(p), f.crand = parse_not_negative(p, "`crand`");
        return true;
    case "irid"_kw:
        next(p), f.irid = parse_irid(p, f.irid);
        return true;
    case "subsurface"_kw:
        warn_unsupported(p, next(p), "subsurface", "no light is scattered below the surface");
        skip_block(p, "subsurface");
        return true;
    case "refraction"_kw:
    case "ior"_kw:
    case "caustics"_kw:
    case "fade_distance"_kw:
    case "fade_power"_kw:
        warn(p, next(p),
             fmt::format("`{}` belongs into `interior`; here it is ignored", token_text(p, word, false)));
        parse_float(p);
        return true;
    default:
        return false;
    }
}

} // namespace

Finish parse_finish(Parser& p, const Finish& start) {
    Finish finish = start;
    Albedos albedos;
    block(p, "finish", [&] {
        if (const auto* declared = accept_declared<Finish>(p))
            finish = *declared;
        else if (parse_finish_word(p, finish, albedos))
            accept_comma(p);
        else
            unexpected(p, "finish",
                       {"ambient"_kw, "diffuse"_kw, "emission"_kw, "brilliance"_kw, "phong"_kw,
                        "phong_size"_kw, "specular"_kw, "roughness"_kw, "metallic"_kw, "reflection"_kw,
                        "conserve_energy"_kw, "crand"_kw, "irid"_kw});
    });
    resolve_albedos(albedos, finish);
    return finish;
}

} // namespace pnr
