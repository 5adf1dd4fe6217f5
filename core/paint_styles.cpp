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
    to.size = from.size;
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

PaintLayer layer(double length, double cell, double lightness, double chroma) {
    PaintLayer made;
    made.length = length;
    made.cell = cell;
    made.noise_lightness = lightness;
    made.noise_chroma = chroma;
    return made;
}

PaintLayer blurred(PaintLayer made, double blur) {
    made.blur = blur;
    return made;
}

// A coat that lies over others and leaves these shares of them bare.
PaintLayer over(PaintLayer made, double opacity, double bare, double bare_plain) {
    made.opacity = opacity;
    made.bare = bare;
    made.bare_plain = bare_plain;
    return made;
}

PaintLayer soft(PaintLayer made, double edge) {
    made.edge = edge;
    return made;
}

PaintStyle oil() {
    PaintStyle s;
    s.layers = {blurred(layer(42, 9, 0.036, 0.020), 3), over(layer(32, 5.5, 0.040, 0.026), 0.9, 0.10, 0.55),
                over(layer(18, 3, 0.034, 0.020), 0.9, 0.20, 0.92)};
    s.contrast = 1.3;
    s.saturation = 1.25;
    s.warm = 0.03;
    s.relief = 0.12;
    s.bristle = 0.012;
    return s;
}

PaintStyle impasto() {
    PaintStyle s;
    s.layers = {blurred(layer(46, 12, 0.040, 0.026), 3),
                over(layer(36, 7.5, 0.044, 0.030), 0.95, 0.15, 0.60)};
    s.contrast = 1.3;
    s.saturation = 1.3;
    s.warm = 0.03;
    s.relief = 0.22;
    s.bristle = 0.02;
    return s;
}

PaintStyle pastel() {
    PaintStyle s;
    s.layers = {soft(blurred(layer(22, 6, 0.030, 0.022), 2), 10),
                over(soft(layer(14, 3, 0.036, 0.028), 14), 0.6, 0.2, 0.6)};
    s.contrast = 1.1;
    s.saturation = 1.15;
    s.warm = 0.02;
    return s;
}

PaintStyle fur() {
    PaintStyle s;
    s.layers = {blurred(layer(40, 4, 0.040, 0.012), 2), over(layer(34, 2.2, 0.055, 0.014), 0.85, 0.3, 0.5)};
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
        // `ilic` is the paper's: within paper_mode to the letter.
        copy_brush(style.paper_mode && word == "ilic" ? paper_style() : named.make(), style);
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
