// SPDX-License-Identifier: GPL-3.0-or-later
// global_settings.
#include "parser/blocks.h"

#include <fmt/format.h>

namespace pnr {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

void parse_gather(Parser& p, PhotonSettings& photons) {
    const Token at = peek(p);
    photons.gather_min = parse_int(p, 0, 1 << 20, "`gather`");
    accept_comma(p);
    photons.gather_max = at_expression(p) ? parse_int(p, 1, 1 << 20, "`gather`") : photons.gather_min;
    if (photons.gather_max < photons.gather_min)
        fail(p, at, "the second number of `gather` is the larger one");
}

void parse_count(Parser& p, PhotonSettings& photons) {
    const Token at = peek(p);
    const double count = parse_float(p);
    if (!(count >= 0 && count <= 1e12)) fail(p, at, "`count` of photons must lie between 0 and 1e12");
    photons.count = static_cast<std::int64_t>(count);
    photons.count_given = true;
}

void parse_photons(Parser& p) {
    PhotonSettings& photons = p.settings.photons;
    photons.wanted = true;
    block(p, "photons", [&] {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "count"_kw:
            next(p), parse_count(p, photons);
            return;
        case "spacing"_kw:
            next(p), photons.spacing = parse_float_in(p, 1e-300, largest, "`spacing`");
            photons.count_given = true;
            return;
        case "gather"_kw:
            next(p), parse_gather(p, photons);
            return;
        case "global"_kw:
            next(p), photons.global = parse_optional_bool(p);
            return;
        case "radius"_kw:
            next(p), photons.radius = parse_float_in(p, 0, largest, "`radius` of photons");
            while (accept(p, ',')) parse_float(p); // POV-Ray's radii for its later searches
            return;
        // What POV-Ray's own tracing needs and ours does not.
        case "autostop"_kw:
        case "jitter"_kw:
        case "max_trace_level"_kw:
        case "adc_bailout"_kw:
            next(p), parse_float(p);
            return;
        case "expand_thresholds"_kw:
            next(p), parse_float(p), accept_comma(p), parse_float(p);
            return;
        case "media"_kw:
            warn_unsupported(p, next(p), "media photons", "light crosses media unchanged");
            parse_float(p), accept_comma(p);
            if (at_expression(p)) parse_float(p);
            return;
        case "save_file"_kw:
        case "load_file"_kw:
            warn(p, next(p), fmt::format("`{}` is ignored", token_text(p, word, false)),
                 "use the options --save-photons and --load-photons");
            parse_string(p);
            return;
        default:
            unexpected(p, "photons",
                       {"count"_kw, "spacing"_kw, "gather"_kw, "radius"_kw, "global"_kw, "autostop"_kw,
                        "jitter"_kw, "max_trace_level"_kw, "media"_kw});
        }
    });
}

void parse_assumed_gamma(Parser& p) {
    if (accept(p, "srgb"_kw))
        p.scene.assumed_gamma = 0;
    else
        p.scene.assumed_gamma = parse_float_in(p, 1e-3, 1e3, "`assumed_gamma`");
    p.settings.render.grid.value_gamma = p.scene.assumed_gamma;
}

void parse_view(Parser& p) {
    if (accept(p, "shoulder"_kw))
        p.settings.render.view = View::shoulder;
    else if (accept(p, "clip"_kw))
        p.settings.render.view = View::clip;
    else
        unexpected(p, "view", {"shoulder"_kw, "clip"_kw});
}

void parse_default_paint(Parser& p, const Token& word) {
    parse_npr(p, p.paint_defaults);
    if (p.paint_defaults.style.seeds.empty()) return;
    p.paint_defaults.style.seeds.clear();
    warn(p, word, "seeds belong to an object: the defaults have none");
}

// Settings of POV-Ray's that change nothing here.
bool skip_setting(Parser& p) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "hf_gray_16"_kw:
        next(p), parse_optional_bool(p);
        return true;
    case "charset"_kw:
        next(p), next(p);
        return true;
    case "max_intersections"_kw:
    case "mm_per_unit"_kw:
        next(p), parse_float(p);
        return true;
    case "subsurface"_kw:
        warn_unsupported(p, next(p), "subsurface", "light stays on the surface");
        skip_block(p, "subsurface");
        return true;
    default:
        return false;
    }
}

void parse_setting(Parser& p) {
    const Token word = peek(p);
    RenderSettings& render = p.settings.render;
    switch (keyword_of(word)) {
    case "assumed_gamma"_kw:
        next(p), parse_assumed_gamma(p);
        return;
    case "max_trace_level"_kw:
        next(p), render.max_trace_level = parse_int(p, 1, 256, "`max_trace_level`");
        return;
    case "adc_bailout"_kw:
        next(p), render.adc_bailout = parse_float_in(p, 0, 1, "`adc_bailout`");
        return;
    case "irid_wavelength"_kw:
        next(p), p.scene.irid_wavelength = parse_color(p).rgb;
        return;
    case "ambient_light"_kw:
        next(p), p.scene.ambient_light = parse_color(p).rgb;
        return;
    case "noise_generator"_kw:
        next(p), p.scene.noise_generator = parse_int(p, 1, 3, "`noise_generator`");
        return;
    case "number_of_waves"_kw:
        next(p), p.scene.number_of_waves = parse_int(p, 1, 64, "`number_of_waves`");
        return;
    case "photons"_kw:
        next(p), parse_photons(p);
        return;
    case "npr"_kw:
        next(p), parse_default_paint(p, word);
        return;
    case "view"_kw:
        next(p), parse_view(p);
        return;
    case "radiosity"_kw:
        next(p), parse_radiosity(p);
        return;
    default:
        break;
    }
    if (!skip_setting(p))
        unexpected(p, "global_settings",
                   {"assumed_gamma"_kw, "max_trace_level"_kw, "adc_bailout"_kw, "ambient_light"_kw,
                    "photons"_kw, "npr"_kw, "view"_kw, "radiosity"_kw});
}

} // namespace

void parse_global_settings(Parser& p) {
    block(p, "global_settings", [&] {
        parse_setting(p);
        accept_comma(p);
    });
}

} // namespace pnr
