// SPDX-License-Identifier: GPL-3.0-or-later
// interior: what fills a solid.
#include "parser/blocks.h"

#include <limits>

namespace pnr {

namespace {

double parse_not_negative(Parser& p, std::string_view what) {
    return parse_float_in(p, 0, std::numeric_limits<double>::max(), what);
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
        next(p), interior.caustics = parse_float(p);
        return true;
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
