// SPDX-License-Identifier: GPL-3.0-or-later
// finish and interior: how a surface answers to light, and what fills it.
#include "parser/blocks.h"

#include <fmt/format.h>

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

// What an ignored finish word takes: a block, numbers, or nothing.
void skip_finish_word(Parser& p, const Token& word) {
    warn_unsupported(p, word, token_text(p, word, false), "the finish goes without it");
    skip_argument(p, token_text(p, word, false));
}

void parse_diffuse(Parser& p, Finish& finish) {
    accept(p, "albedo"_kw);
    finish.diffuse = parse_not_negative(p, "`diffuse`");
    if (!accept(p, ',') && !at_number(p)) return;
    warn_unsupported(p, peek(p), "diffuse of the back side", "both sides are alike");
    parse_float(p);
}

bool parse_finish_word(Parser& p, Finish& f) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "ambient"_kw:
        next(p), f.ambient = parse_color(p).rgb;
        return true;
    case "emission"_kw:
        next(p), f.emission = parse_color(p).rgb;
        return true;
    case "diffuse"_kw:
        next(p), parse_diffuse(p, f);
        return true;
    case "brilliance"_kw:
        next(p), f.brilliance = parse_not_negative(p, "`brilliance`");
        return true;
    case "phong"_kw:
        next(p), accept(p, "albedo"_kw);
        f.phong = parse_not_negative(p, "`phong`");
        return true;
    case "phong_size"_kw:
        next(p), f.phong_size = parse_not_negative(p, "`phong_size`");
        return true;
    case "specular"_kw:
        next(p), accept(p, "albedo"_kw);
        f.specular = parse_not_negative(p, "`specular`");
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
    case "irid"_kw:
    case "subsurface"_kw:
    case "use_alpha"_kw:
        skip_finish_word(p, next(p));
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

bool parse_interior_word(Parser& p, Interior& interior) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "ior"_kw:
        next(p), interior.ior = parse_float_in(p, 1e-3, 1e3, "`ior`");
        return true;
    case "fade_distance"_kw:
        next(p), interior.fade_distance = parse_not_negative(p, "`fade_distance`");
        return true;
    case "fade_power"_kw:
        next(p), interior.fade_power = parse_not_negative(p, "`fade_power`");
        return true;
    case "fade_color"_kw:
        next(p), interior.fade_color = parse_color(p).rgb;
        return true;
    case "caustics"_kw:
        next(p), parse_float(p);
        return true; // POV-Ray's faked caustics: photons do better
    case "dispersion"_kw:
        warn_unsupported(p, next(p), "dispersion", "all colours are refracted alike");
        parse_float(p);
        return true;
    case "dispersion_samples"_kw:
        next(p), parse_float(p);
        return true;
    case "media"_kw:
        warn_unsupported(p, next(p), "media", "the inside is clear");
        skip_block(p, "media");
        return true;
    default:
        return false;
    }
}

} // namespace

Finish parse_finish(Parser& p, const Finish& start) {
    Finish finish = start;
    block(p, "finish", [&] {
        if (const auto* declared = accept_declared<Finish>(p))
            finish = *declared;
        else if (parse_finish_word(p, finish))
            accept_comma(p);
        else
            unexpected(p, "finish",
                       {"ambient"_kw, "diffuse"_kw, "emission"_kw, "brilliance"_kw, "phong"_kw,
                        "phong_size"_kw, "specular"_kw, "roughness"_kw, "metallic"_kw, "reflection"_kw,
                        "conserve_energy"_kw});
    });
    return finish;
}

Interior parse_interior(Parser& p, const Interior& start) {
    Interior interior = start;
    block(p, "interior", [&] {
        if (const auto* declared = accept_declared<Interior>(p))
            interior = *declared;
        else if (!parse_interior_word(p, interior))
            unexpected(p, "interior",
                       {"ior"_kw, "fade_distance"_kw, "fade_power"_kw, "fade_color"_kw, "caustics"_kw});
    });
    return interior;
}

} // namespace pnr
