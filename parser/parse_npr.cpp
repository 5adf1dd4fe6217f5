// SPDX-License-Identifier: GPL-3.0-or-later
// The language of painting: npr { ... }. A block's items are kept in order and played over the defaults when
// the whole text is read (resolve_paint), since global_settings may stand behind the objects; seeds and axes,
// which transforms move, are kept in the word's own style.
#include "parser/blocks.h"

#include <fmt/format.h>

namespace pnr {

namespace {

constexpr double longest = 100000; // pixels at 512: beyond it a typing error

using Items = std::vector<std::function<void(PaintStyle&)>>;

double parse_length(Parser& p, std::string_view what) { return parse_float_in(p, 0, longest, what); }

void say(PaintWord& word, double PaintStyle::*field, double value) {
    word.said.emplace_back([field, value](PaintStyle& style) { style.*field = value; });
}

template <class Owner>
void parse_noise(Parser& p, Owner& to) {
    to.noise_lightness = parse_float_in(p, 0, 1, "`noise` in lightness");
    accept_comma(p);
    if (at_expression(p)) to.noise_chroma = parse_float_in(p, 0, 1, "`noise` in colour");
}

// ---- seeds
// ----------------------------------------------------------------------------------------------------

Seed parse_seed(Parser& p) {
    Seed seed;
    const Token opener = peek(p);
    seed.said_at = source_ref(p, opener);
    bool started = false;
    block(p, "seed", [&] {
        if (!started) {
            started = true;
            seed.position = parse_vector(p);
            accept_comma(p);
            const Token at = peek(p);
            seed.direction = parse_vector(p);
            if (seed.direction == Vec3(0)) fail(p, at, "the direction of a seed must not be zero");
            accept_comma(p);
        } else if (accept(p, "weight"_kw))
            seed.weight = parse_float_in(p, 0, 1e6, "`weight` of a seed");
        else
            unexpected(p, "seed", {"weight"_kw});
    });
    if (!started) fail(p, opener, "a seed needs a place and a direction: seed { <0, 1, 0>, x }");
    return seed;
}

RbfKernel parse_kernel(Parser& p) {
    if (accept(p, "biharmonic"_kw) || accept(p, "linear"_kw)) return RbfKernel::biharmonic;
    if (accept(p, "triharmonic"_kw)) return RbfKernel::triharmonic;
    unexpected(p, "kernel", {"biharmonic"_kw, "triharmonic"_kw, "linear"_kw});
}

SeedDistance parse_distance(Parser& p) {
    if (accept(p, "straight"_kw)) return SeedDistance::straight;
    if (accept(p, "geodesic"_kw)) return SeedDistance::geodesic;
    unexpected(p, "distance", {"straight"_kw, "geodesic"_kw});
}

void parse_rbf(Parser& p, PaintWord& word) {
    block(p, "rbf", [&] {
        if (accept(p, "kernel"_kw)) {
            const RbfKernel kernel = parse_kernel(p);
            word.said.emplace_back([kernel](PaintStyle& style) { style.kernel = kernel; });
        } else if (accept(p, "distance"_kw)) {
            const SeedDistance distance = parse_distance(p);
            word.said.emplace_back([distance](PaintStyle& style) { style.distance = distance; });
        } else if (accept(p, "smooth"_kw)) {
            say(word, &PaintStyle::smooth, parse_float_in(p, 0, 1e6, "`smooth`"));
        } else if (accept(p, "neighbours"_kw)) {
            const int n = parse_int(p, 0, 1000000, "`neighbours`");
            word.said.emplace_back([n](PaintStyle& style) { style.neighbours = n; });
        } else
            unexpected(p, "rbf", {"kernel"_kw, "distance"_kw, "smooth"_kw, "neighbours"_kw});
    });
}

// A new block of seeds takes the place of those said before.
void parse_seeds(Parser& p, PaintWord& word) {
    word.style.seeds.clear();
    block(p, "seeds", [&] {
        constexpr std::size_t most = 10'000;
        const Token word_token = peek(p);
        if (word.style.seeds.size() >= most)
            fail(p, word_token, fmt::format("an object has at most {} seeds", most));
        if (accept(p, "seed"_kw))
            word.style.seeds.push_back(parse_seed(p));
        else if (accept(p, "rbf"_kw))
            parse_rbf(p, word);
        else
            unexpected(p, "seeds", {"seed"_kw, "rbf"_kw});
    });
}

// ---- field
// ----------------------------------------------------------------------------------------------------

FieldSource parse_field_source(Parser& p, PaintWord& word) {
    const Token name = peek(p);
    switch (keyword_of(name)) {
    case "curvature_min"_kw:
        next(p);
        return FieldSource::curvature_min;
    case "curvature_max"_kw:
        next(p);
        return FieldSource::curvature_max;
    case "light"_kw:
        next(p);
        return FieldSource::light;
    case "gradient"_kw:
        next(p);
        return FieldSource::gradient;
    case "along"_kw:
        next(p), word.style.field_vector = parse_vector(p);
        break;
    case "around"_kw:
        next(p), word.style.field_point = parse_vector(p), accept_comma(p);
        word.style.field_vector = parse_vector(p);
        break;
    default:
        unexpected(
            p, "field",
            {"curvature_min"_kw, "curvature_max"_kw, "along"_kw, "around"_kw, "light"_kw, "gradient"_kw});
    }
    if (word.style.field_vector == Vec3(0)) fail(p, name, "the axis of a field must not be zero");
    return is(name, "along"_kw) ? FieldSource::along : FieldSource::around;
}

// `field curvature_min [weight w]`: beside seeds it has the share w of the blend; without a weight it stands
// alone.
void parse_field(Parser& p, PaintWord& word) {
    const FieldSource source = parse_field_source(p, word);
    const double weight = accept(p, "weight"_kw) ? parse_float_in(p, 0, 1, "`weight` of a field") : 0;
    word.own_axis = source == FieldSource::along || source == FieldSource::around;
    word.said.emplace_back([source, weight](PaintStyle& style) {
        style.field = source;
        style.field_weight = weight;
    });
}

// ---- interpolation and ilic
// -----------------------------------------------------------------------------------

void parse_interpolation(Parser& p, PaintWord& word) {
    block(p, "interpolation", [&] {
        if (accept(p, "radius"_kw)) {
            say(word, &PaintStyle::radius, parse_length(p, "`radius` of the interpolation"));
        } else if (accept(p, "fill"_kw)) {
            if (!at(p, "nearest"_kw) && !at(p, "random"_kw))
                unexpected(p, "fill", {"nearest"_kw, "random"_kw});
            const Fill fill = accept(p, "random"_kw) ? Fill::random : (next(p), Fill::nearest);
            word.said.emplace_back([fill](PaintStyle& style) { style.fill = fill; });
        } else if (accept(p, "folds"_kw)) {
            word.said.emplace_back([folds = parse_optional_bool(p)](PaintStyle& style) { style.folds = folds; });
        } else
            unexpected(p, "interpolation", {"radius"_kw, "fill"_kw, "folds"_kw});
    });
}

PaintLayer parse_layer(Parser& p) {
    PaintLayer layer;
    block(p, "layer", [&] {
        if (accept(p, "length"_kw))
            layer.length = parse_length(p, "`length`");
        else if (accept(p, "cell"_kw))
            layer.cell = parse_float_in(p, 0.01, longest, "`cell`");
        else if (accept(p, "noise"_kw))
            parse_noise(p, layer);
        else if (accept(p, "edge"_kw))
            layer.edge = parse_float_in(p, 0, 1e6, "`edge`");
        else if (accept(p, "opacity"_kw))
            layer.opacity = parse_float_in(p, 0, 1, "`opacity`");
        else if (accept(p, "blur"_kw))
            layer.blur = parse_length(p, "`blur`");
        else if (accept(p, "bare"_kw)) {
            layer.bare = parse_float_in(p, 0, 1, "`bare`");
            accept_comma(p);
            if (at_expression(p)) layer.bare_plain = parse_float_in(p, 0, 1, "`bare` on plain parts");
        } else
            unexpected(p, "layer",
                       {"length"_kw, "cell"_kw, "noise"_kw, "edge"_kw, "opacity"_kw, "blur"_kw, "bare"_kw});
        accept_comma(p);
    });
    return layer;
}

void parse_gaussian(Parser& p, PaintWord& word) {
    const double first = parse_length(p, "the first window of `gaussian`");
    accept_comma(p);
    const double second = parse_length(p, "the second window of `gaussian`");
    word.said.emplace_back([first, second](PaintStyle& style) {
        style.gaussian_first = first;
        style.gaussian_second = second;
    });
}

void parse_ilic(Parser& p, PaintWord& word) {
    bool first_layer = true; // the layers of one block stand together, in place of those said before
    block(p, "ilic", [&] {
        if (accept(p, "length"_kw))
            say(word, &PaintStyle::length, parse_length(p, "`length`"));
        else if (accept(p, "cell"_kw))
            say(word, &PaintStyle::cell, parse_float_in(p, 0.01, longest, "`cell`"));
        else if (accept(p, "edge"_kw))
            say(word, &PaintStyle::edge, parse_float_in(p, 0, 1e6, "`edge`"));
        else if (accept(p, "size"_kw))
            say(word, &PaintStyle::size, parse_float_in(p, 0.01, 100, "`size`"));
        else if (accept(p, "step"_kw))
            say(word, &PaintStyle::step, parse_float_in(p, 0.01, 100, "`step`"));
        else if (accept(p, "gaussian"_kw))
            parse_gaussian(p, word);
        else if (accept(p, "noise"_kw)) {
            PaintStyle n = default_style();
            parse_noise(p, n);
            say(word, &PaintStyle::noise_lightness, n.noise_lightness);
            say(word, &PaintStyle::noise_chroma, n.noise_chroma);
        } else if (accept(p, "layer"_kw)) {
            word.said.emplace_back([layer = parse_layer(p), first_layer](PaintStyle& style) {
                if (first_layer) style.layers.clear();
                style.layers.push_back(layer);
            });
            first_layer = false;
        } else
            unexpected(p, "ilic",
                       {"length"_kw, "cell"_kw, "noise"_kw, "edge"_kw, "size"_kw, "gaussian"_kw, "step"_kw,
                        "layer"_kw});
        accept_comma(p);
    });
}

// ---- the rest
// -------------------------------------------------------------------------------------------------

void parse_style(Parser& p, PaintWord& word) {
    const Token name = next(p);
    const std::string text = token_text(p, name, false);
    PaintStyle trial;
    if (name.kind != TokenKind::word || !set_style(trial, text)) {
        std::string known;
        for (const std::string& other : style_words()) known += (known.empty() ? "" : ", ") + other;
        fail(p, name, fmt::format("there is no painting style `{}`", text), "styles are " + known);
    }
    word.said.emplace_back([text](PaintStyle& style) { set_style(style, text); });
}

void parse_tone(Parser& p, PaintWord& word) {
    block(p, "tone", [&] {
        if (accept(p, "contrast"_kw))
            say(word, &PaintStyle::contrast, parse_float_in(p, 0, 100, "`contrast`"));
        else if (accept(p, "saturation"_kw))
            say(word, &PaintStyle::saturation, parse_float_in(p, 0, 100, "`saturation`"));
        else if (accept(p, "warm"_kw))
            say(word, &PaintStyle::warm, parse_float_in(p, -1, 1, "`warm`"));
        else
            unexpected(p, "tone", {"contrast"_kw, "saturation"_kw, "warm"_kw});
        accept_comma(p);
    });
}

void parse_relief(Parser& p, PaintWord& word) {
    say(word, &PaintStyle::relief, parse_float_in(p, 0, 10, "`relief`"));
    accept_comma(p);
    if (at_expression(p)) say(word, &PaintStyle::bristle, parse_float_in(p, 0, 10, "`relief` of bristles"));
}

void copy_word(const PaintWord& from, PaintWord& to) {
    if (from.paper_mode) to.paper_mode = from.paper_mode;
    to.said.insert(to.said.end(), from.said.begin(), from.said.end());
    if (!from.style.seeds.empty()) to.style.seeds = from.style.seeds;
    if (!from.own_axis) return;
    to.own_axis = true;
    to.style.field_vector = from.style.field_vector;
    to.style.field_point = from.style.field_point;
}

void parse_npr_item(Parser& p, PaintWord& word) {
    if (const auto* declared = accept_declared<PaintWord>(p))
        copy_word(*declared, word);
    else if (accept(p, "style"_kw))
        parse_style(p, word);
    else if (accept(p, "seeds"_kw))
        parse_seeds(p, word);
    else if (accept(p, "field"_kw))
        parse_field(p, word);
    else if (accept(p, "interpolation"_kw))
        parse_interpolation(p, word);
    else if (accept(p, "ilic"_kw))
        parse_ilic(p, word);
    else if (accept(p, "tone"_kw))
        parse_tone(p, word);
    else if (accept(p, "relief"_kw))
        parse_relief(p, word);
    else if (accept(p, "mix"_kw))
        say(word, &PaintStyle::mix, parse_float_in(p, 0, 1, "`mix`"));
    else if (accept(p, "paper_mode"_kw))
        word.paper_mode = parse_optional_bool(p);
    else
        unexpected(p, "npr",
                   {"style"_kw, "seeds"_kw, "field"_kw, "interpolation"_kw, "ilic"_kw, "tone"_kw, "relief"_kw,
                    "mix"_kw, "paper_mode"_kw});
}

PaintStyle resolve_style(const PaintWord& defaults, const PaintWord& own) {
    PaintStyle style =
        own.paper_mode.value_or(defaults.paper_mode.value_or(false)) ? paper_style() : default_style();
    for (const auto& item : defaults.said) item(style);
    for (const auto& item : own.said) item(style);
    const PaintWord& axis = own.own_axis ? own : defaults;
    style.field_vector = axis.style.field_vector;
    style.field_point = axis.style.field_point;
    style.seeds = own.style.seeds;
    return style;
}

void resolve_object(const PaintWord& defaults, Object& object) {
    if (object.npr) {
        object.npr->style = resolve_style(defaults, *object.npr);
        object.npr->said.clear();
    }
    for (Object& child : object.children) resolve_object(defaults, child);
}

} // namespace

void parse_npr(Parser& p, PaintWord& word) {
    const Telling painters(p.in, Listener::paint);
    word.on = true;
    if (at(p, '{'))
        block(p, "npr", [&] { parse_npr_item(p, word); });
    else
        word.on = parse_optional_bool(p);
}

void resolve_paint(Parser& p) {
    for (Object& object : p.scene.objects) resolve_object(p.paint_defaults, object);
    p.scene.paint_defaults = resolve_style(p.paint_defaults, PaintWord{});
}

} // namespace pnr
