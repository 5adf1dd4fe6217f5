// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/settings.h"

#include <array>

namespace pnr {

namespace {

// The part of a style that `style WORD` sets: everything about how paint is laid, nothing about where it
// runs.
void copy_brush(const PaintStyle& from, PaintStyle& to) {
    to.length = from.length;
    to.cell = from.cell;
    to.noise_lightness = from.noise_lightness;
    to.noise_chroma = from.noise_chroma;
    to.edge = from.edge;
    to.layers = from.layers;
    to.contrast = from.contrast;
    to.saturation = from.saturation;
    to.warm = from.warm;
    to.relief = from.relief;
    to.bristle = from.bristle;
    to.gaussian_first = from.gaussian_first;
    to.gaussian_second = from.gaussian_second;
    to.step = from.step;
    to.box_weights = from.box_weights;
}

PaintStyle oil() {
    PaintStyle s;
    s.layers = {
        {.length = 39, .cell = 9, .noise_lightness = 0.036, .noise_chroma = 0.020, .blur = 3},
        {.length = 30,
         .cell = 5,
         .noise_lightness = 0.042,
         .noise_chroma = 0.028,
         .opacity = 0.85,
         .keep = 0.3,
         .keep_plain = 0.5},
        {.length = 16,
         .cell = 3,
         .noise_lightness = 0.036,
         .noise_chroma = 0.020,
         .opacity = 0.9,
         .keep = 0.45,
         .keep_plain = 0.6},
    };
    s.contrast = 1.3;
    s.saturation = 1.25;
    s.warm = 0.03;
    s.relief = 0.12;
    s.bristle = 0.015;
    return s;
}

PaintStyle impasto() {
    PaintStyle s;
    s.layers = {
        {.length = 44, .cell = 12, .noise_lightness = 0.040, .noise_chroma = 0.026, .blur = 3},
        {.length = 34,
         .cell = 7.5,
         .noise_lightness = 0.046,
         .noise_chroma = 0.032,
         .opacity = 0.95,
         .keep = 0.25,
         .keep_plain = 0.35},
    };
    s.contrast = 1.3;
    s.saturation = 1.3;
    s.warm = 0.03;
    s.relief = 0.22;
    s.bristle = 0.025;
    return s;
}

PaintStyle pastel() {
    PaintStyle s;
    s.layers = {
        {.length = 22, .cell = 6, .noise_lightness = 0.030, .noise_chroma = 0.022, .edge = 10, .blur = 2},
        {.length = 14,
         .cell = 3,
         .noise_lightness = 0.036,
         .noise_chroma = 0.028,
         .edge = 14,
         .opacity = 0.6,
         .keep = 0.35,
         .keep_plain = 0.3},
    };
    s.contrast = 1.1;
    s.saturation = 1.15;
    s.warm = 0.02;
    return s;
}

PaintStyle fur() {
    PaintStyle s;
    s.layers = {
        {.length = 40, .cell = 4, .noise_lightness = 0.040, .noise_chroma = 0.012, .blur = 2},
        {.length = 34,
         .cell = 2.2,
         .noise_lightness = 0.055,
         .noise_chroma = 0.014,
         .opacity = 0.85,
         .keep = 0.3,
         .keep_plain = 0.2},
    };
    s.contrast = 1.2;
    s.relief = 0.05;
    return s;
}

PaintStyle wash() {
    PaintStyle s;
    s.length = 20;
    s.cell = 2.5;
    s.edge = 0;
    s.noise_lightness = 0.035;
    s.noise_chroma = 0.02;
    s.contrast = 1.15;
    s.saturation = 1.15;
    return s;
}

using Maker = PaintStyle (*)();
struct NamedStyle {
    std::string_view word;
    Maker make;
};
constexpr std::array<NamedStyle, 6> styles{{{"ilic", default_style},
                                            {"oil", oil},
                                            {"impasto", impasto},
                                            {"pastel", pastel},
                                            {"fur", fur},
                                            {"wash", wash}}};

} // namespace

bool set_style(PaintStyle& style, std::string_view word) {
    for (const NamedStyle& named : styles) {
        if (named.word != word) continue;
        copy_brush(named.make(), style);
        return true;
    }
    return false;
}

std::vector<std::string> style_words() {
    std::vector<std::string> words;
    for (const NamedStyle& named : styles) words.emplace_back(named.word);
    return words;
}

FieldSource painted_field(const PaintStyle& style) {
    if (style.field == FieldSource::seeds && style.seeds.empty()) return FieldSource::curvature_min;
    return style.field;
}

Vec2 field_windows(const PaintStyle& style) {
    const FieldSource field = painted_field(style);
    const bool curved = field == FieldSource::curvature_min || field == FieldSource::curvature_max;
    return {style.gaussian_first.value_or(curved ? 31 : 15), style.gaussian_second.value_or(curved ? 15 : 7)};
}

} // namespace pnr
