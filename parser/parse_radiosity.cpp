// SPDX-License-Identifier: GPL-3.0-or-later
// `radiosity { ... }` of global_settings. Many of its words tune POV-Ray's cache of gathered light; ours takes those that
// say how the light looks, and does the rest by itself.
#include "parser/blocks.h"

#include <fmt/format.h>

namespace pnr {

namespace {

// A number, and a second one behind it where the word takes one.
double parse_number_pair(Parser& p) {
    const double first = parse_float(p);
    accept_comma(p);
    if (at_expression(p)) parse_float(p);
    return first;
}

bool parse_radiosity_look(Parser& p, RadiositySettings& r) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "brightness"_kw:
        next(p), r.brightness = parse_float_in(p, 0, 1e6, "`brightness`");
        return true;
    case "recursion_limit"_kw:
        next(p), r.recursion_limit = static_cast<int>(parse_float_in(p, 1, 20, "`recursion_limit`"));
        return true;
    case "gray_threshold"_kw:
        next(p), r.gray_threshold = parse_float_in(p, 0, 1, "`gray_threshold`");
        return true;
    case "count"_kw:
        next(p), r.count = std::max(1, static_cast<int>(std::min(parse_number_pair(p), 1e6)));
        return true;
    case "error_bound"_kw:
        next(p), r.error_bound = parse_float_in(p, 1e-9, 1e9, "`error_bound`");
        return true;
    case "normal"_kw:
        next(p), r.normal = parse_optional_bool(p);
        return true;
    default:
        return false;
    }
}

// What POV-Ray's own cache needs and ours does not.
bool skip_radiosity_word(Parser& p) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "pretrace_start"_kw:
    case "pretrace_end"_kw:
    case "low_error_factor"_kw:
    case "minimum_reuse"_kw:
    case "maximum_reuse"_kw:
    case "max_sample"_kw:
    case "adc_bailout"_kw:
        next(p), parse_float(p);
        return true;
    case "nearest_count"_kw:
        next(p), parse_number_pair(p);
        return true;
    case "always_sample"_kw:
    case "media"_kw:
    case "subsurface"_kw:
        next(p), parse_optional_bool(p);
        return true;
    case "save_file"_kw:
    case "load_file"_kw:
        warn(p, next(p), fmt::format("`{}` is ignored: gathered light is not kept in files", token_text(p, word, false)));
        parse_string(p);
        return true;
    default:
        return false;
    }
}

} // namespace

void parse_radiosity(Parser& p) {
    p.scene.radiosity = true;
    block(p, "radiosity", [&] {
        if (!parse_radiosity_look(p, p.settings.radiosity) && !skip_radiosity_word(p))
            unexpected(p, "radiosity",
                       {"count"_kw, "error_bound"_kw, "recursion_limit"_kw, "brightness"_kw, "gray_threshold"_kw,
                        "nearest_count"_kw, "pretrace_start"_kw, "pretrace_end"_kw, "low_error_factor"_kw,
                        "minimum_reuse"_kw, "maximum_reuse"_kw, "max_sample"_kw, "always_sample"_kw, "normal"_kw,
                        "media"_kw, "adc_bailout"_kw});
        accept_comma(p);
    });
}

} // namespace pnr
