// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns and the words that shape them, wherever they pick: in pigments, normals, textures, densities,
// functions.
#include "core/probe.h"
#include "parser/blocks.h"
#include "parser/expression.h"
#include "parser/function.h"

#include <optional>

namespace pnr {

namespace {

std::optional<PlainKind> plain_kind(const Token& word) {
    switch (keyword_of(word)) {
    case "bozo"_kw:
    case "spotted"_kw: // the same noise
        return PlainKind::bozo;
    case "bumps"_kw:
        return PlainKind::bumps;
    case "dents"_kw:
        return PlainKind::dents;
    case "wrinkles"_kw:
        return PlainKind::wrinkles;
    case "granite"_kw:
        return PlainKind::granite;
    case "marble"_kw:
        return PlainKind::marble;
    case "wood"_kw:
        return PlainKind::wood;
    case "leopard"_kw:
        return PlainKind::leopard;
    case "onion"_kw:
        return PlainKind::onion;
    case "radial"_kw:
        return PlainKind::radial;
    case "spherical"_kw:
        return PlainKind::spherical;
    case "cylindrical"_kw:
        return PlainKind::cylindrical;
    case "planar"_kw:
        return PlainKind::planar;
    case "boxed"_kw:
        return PlainKind::boxed;
    case "cells"_kw:
        return PlainKind::cells;
    case "ripples"_kw:
        return PlainKind::ripples;
    case "waves"_kw:
        return PlainKind::waves;
    default:
        return std::nullopt;
    }
}

// Patterns that pick from a list and have no words of their own before it.
std::optional<PatternKind> list_kind(const Token& word) {
    switch (keyword_of(word)) {
    case "checker"_kw:
        return CheckerPattern{};
    case "hexagon"_kw:
        return HexagonPattern{};
    case "cubic"_kw:
        return CubicPattern{};
    case "square"_kw:
        return SquarePattern{};
    case "triangular"_kw:
        return TriangularPattern{};
    case "brick"_kw:
        return BrickPattern{};
    default:
        return std::nullopt;
    }
}

FractalPattern parse_fractal(Parser& p, const Token& word) {
    FractalPattern fractal;
    bool julia = is(word, "julia"_kw);
    int magnet = 0;
    if (is(word, "magnet"_kw)) {
        magnet = parse_int(p, 1, 2, "the type of `magnet`");
        if (!accept(p, "mandel"_kw)) {
            if (!accept(p, "julia"_kw)) unexpected(p, "magnet", {"mandel"_kw, "julia"_kw});
            julia = true;
        }
    }
    constexpr FractalKind mandels[] = {FractalKind::mandel, FractalKind::magnet1_mandel,
                                       FractalKind::magnet2_mandel};
    constexpr FractalKind julias[] = {FractalKind::julia, FractalKind::magnet1_julia,
                                      FractalKind::magnet2_julia};
    fractal.kind = (julia ? julias : mandels)[magnet];
    if (julia) fractal.c = parse_uv(p), accept_comma(p);
    fractal.iterations = parse_int(p, 1, 1 << 24, "the number of iterations");
    return fractal;
}

// `, low, high` behind a direction.
void parse_range(Parser& p, double& low, double& high) {
    if (!accept(p, ',')) return;
    low = parse_float(p);
    accept_comma(p);
    high = parse_float(p);
}

SlopePattern parse_slope(Parser& p) {
    SlopePattern slope;
    if (!at(p, '{')) {
        slope.direction = parse_vector(p);
        parse_range(p, slope.low_slope, slope.high_slope);
        return slope;
    }
    block(p, "slope", [&] {
        if (accept(p, "altitude"_kw)) {
            slope.altitude = parse_vector(p);
            parse_range(p, slope.low_altitude, slope.high_altitude);
        } else {
            slope.toward_point = accept(p, "point_at"_kw);
            slope.direction = parse_vector(p);
            parse_range(p, slope.low_slope, slope.high_slope);
        }
    });
    return slope;
}

// `object { OBJECT, ENTRY, ENTRY }`: the entries stand inside.
void parse_object_pattern(Parser& p, const Token& word, Pattern& pattern, const ListReader& read_list) {
    set_kind(pattern, ObjectPattern{});
    open_block(p, "object");
    const std::size_t level = open_blocks(p);
    try {
        std::optional<Object> object;
        if (const Object* declared = accept_declared<Object>(p))
            object = *declared;
        else
            object = parse_object(p);
        if (!object) unexpected(p, "object", {"object"_kw, "sphere"_kw, "box"_kw, "union"_kw});
        accept_comma(p);
        try {
            std::get<ObjectPattern>(pattern.kind).inside = [probe = make_probe(*object)](Vec3 point) {
                return is_inside(*probe, point);
            };
        } catch (const std::runtime_error& problem) { // SceneError, FileError
            fail(p, word, std::string("this object cannot be built: ") + problem.what());
        }
        read_list(pattern);
        if (!close_block(p)) unexpected(p, "object", {});
    } catch (const ParseFailure&) {
        recover_block(p, level);
    }
}

DensityFilePattern parse_density_file(Parser& p) {
    DensityFilePattern density;
    accept(p, "df3"_kw);
    const Token name = peek(p);
    density.said_at = source_ref(p, name);
    density.file = resolve_file(p, name, parse_string(p));
    accept_comma(p);
    if (accept(p, "interpolate"_kw)) density.interpolate = parse_int(p, 0, 2, "`interpolate`");
    return density;
}

// Kinds with words or numbers of their own. False if none stands here.
bool parse_special_pattern(Parser& p, Pattern& pattern) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "gradient"_kw: {
        next(p);
        const Vec3 axis = parse_vector(p);
        if (axis == Vec3(0)) fail(p, word, "`gradient` needs a direction that is not zero");
        set_kind(pattern, GradientPattern{axis});
        return true;
    }
    case "average"_kw:
        next(p), set_kind(pattern, AveragePattern{});
        return true;
    case "agate"_kw:
        next(p), set_kind(pattern, AgatePattern{});
        return true;
    case "crackle"_kw:
        next(p), set_kind(pattern, CracklePattern{});
        return true;
    case "quilted"_kw:
        next(p), set_kind(pattern, QuiltedPattern{});
        return true;
    case "facets"_kw:
        next(p), set_kind(pattern, FacetsPattern{});
        return true;
    case "aoi"_kw:
        next(p), set_kind(pattern, AoiPattern{});
        return true;
    case "spiral1"_kw:
    case "spiral2"_kw:
        next(p), set_kind(pattern, SpiralPattern{parse_float(p), is(word, "spiral2"_kw)});
        return true;
    case "mandel"_kw:
    case "julia"_kw:
    case "magnet"_kw:
        next(p), set_kind(pattern, parse_fractal(p, word));
        return true;
    case "slope"_kw:
        next(p), set_kind(pattern, parse_slope(p));
        return true;
    case "tiling"_kw:
        next(p), set_kind(pattern, TilingPattern{parse_int(p, 1, 24, "`tiling`")});
        if (std::get<TilingPattern>(pattern.kind).type > 3)
            warn_unsupported(p, word, "tiling with several shapes (4 to 24)", "triangles take its place");
        return true;
    case "density_file"_kw:
        next(p), set_kind(pattern, parse_density_file(p));
        return true;
    case "image_pattern"_kw: {
        next(p);
        ImagePattern image = parse_image_map(p);
        image.is_map = false;
        set_kind(pattern, std::move(image));
        return true;
    }
    case "pigment_pattern"_kw:
        next(p);
        set_kind(pattern, PigmentPattern{std::make_shared<const Pigment>(parse_pigment(p, Pigment{}))});
        return true;
    case "function"_kw: {
        const auto function = parse_function(p);
        if (!function->unsupported.empty())
            warn_unsupported(p, word, function->unsupported, "the pattern is 0");
        charge_costly(p, word, *function);
        set_kind(pattern, FunctionPattern{function->unsupported.empty() ? ScalarField(FunctionField{function}) : nullptr});
        return true;
    }
    default:
        return false;
    }
}

// ---- modifiers
// ------------------------------------------------------------------------------------------------------

Turbulence& turbulence_of(Pattern& pattern) {
    if (!pattern.turbulence) pattern.turbulence = Turbulence{};
    return *pattern.turbulence;
}

bool parse_wave(Parser& p, Pattern& pattern) {
    if (accept(p, "ramp_wave"_kw))
        pattern.wave = Wave::ramp;
    else if (accept(p, "triangle_wave"_kw))
        pattern.wave = Wave::triangle;
    else if (accept(p, "sine_wave"_kw))
        pattern.wave = Wave::sine;
    else if (accept(p, "scallop_wave"_kw))
        pattern.wave = Wave::scallop;
    else if (accept(p, "cubic_wave"_kw))
        pattern.wave = Wave::cubic;
    else if (accept(p, "poly_wave"_kw)) {
        pattern.wave = Wave::poly;
        pattern.exponent = at_expression(p) ? parse_float(p) : 1;
    } else
        return false;
    return true;
}

// A word that only one kind of pattern has: read into `held` if the pattern is of that kind; elsewhere it is
// read and means nothing, as in POV-Ray.
template <class Kind, class F>
bool word_of(Parser& p, Pattern& pattern, F read) {
    Kind elsewhere;
    Kind* kind = std::get_if<Kind>(&pattern.kind);
    next(p);
    read(kind ? *kind : elsewhere);
    return true;
}

bool parse_word_of_kind(Parser& p, Pattern& pattern) {
    const auto number = [&p](double& value) { value = parse_float(p); };
    switch (keyword_of(peek(p))) {
    case "agate_turb"_kw:
        return word_of<AgatePattern>(p, pattern, [&](auto& k) { number(k.turbulence); });
    case "control0"_kw:
        return word_of<QuiltedPattern>(p, pattern, [&](auto& k) { number(k.control0); });
    case "control1"_kw:
        return word_of<QuiltedPattern>(p, pattern, [&](auto& k) { number(k.control1); });
    case "metric"_kw:
        return word_of<CracklePattern>(p, pattern, [&](auto& k) { number(k.metric); });
    case "offset"_kw:
        return word_of<CracklePattern>(p, pattern, [&](auto& k) { number(k.offset); });
    case "solid"_kw:
        return word_of<CracklePattern>(p, pattern, [&](auto& k) { k.solid = parse_optional_bool(p); });
    case "form"_kw:
        return word_of<CracklePattern>(p, pattern, [&](auto& k) { k.form = parse_vector(p); });
    case "mortar"_kw:
        return word_of<BrickPattern>(p, pattern, [&](auto& k) { number(k.mortar); });
    case "brick_size"_kw:
        return word_of<BrickPattern>(p, pattern, [&](auto& k) { k.size = parse_vector(p); });
    case "coords"_kw:
        return word_of<FacetsPattern>(p, pattern, [&](auto& k) { number(k.coords); });
    case "size"_kw:
        return word_of<FacetsPattern>(p, pattern, [&](auto& k) { number(k.size); });
    case "interpolate"_kw:
        return word_of<DensityFilePattern>(
            p, pattern, [&](auto& k) { k.interpolate = parse_int(p, 0, 2, "`interpolate`"); });
    default:
        return false;
    }
}

bool parse_fractal_word(Parser& p, Pattern& pattern) {
    const Token word = peek(p);
    const bool exterior = is(word, "exterior"_kw);
    if (is(word, "exponent"_kw))
        return word_of<FractalPattern>(p, pattern,
                                       [&](auto& k) { k.exponent = parse_int(p, 2, 33, "`exponent`"); });
    if (!exterior && !is(word, "interior"_kw)) return false;
    return word_of<FractalPattern>(p, pattern, [&](auto& k) {
        (exterior ? k.exterior_type : k.interior_type) = parse_int(p, 0, 6, token_text(p, word));
        accept_comma(p);
        (exterior ? k.exterior_factor : k.interior_factor) = parse_float(p);
    });
}

} // namespace

bool parse_pattern(Parser& p, Pattern& pattern, const ListReader& read_list) {
    const Token word = peek(p);
    if (const auto kind = plain_kind(word)) {
        next(p), set_kind(pattern, PlainPattern{*kind});
        return true;
    }
    if (const auto kind = list_kind(word)) {
        next(p), set_kind(pattern, *kind);
        read_list(pattern);
        return true;
    }
    if (is(word, "object"_kw)) {
        parse_object_pattern(p, next(p), pattern, read_list);
        return true;
    }
    return parse_special_pattern(p, pattern);
}

bool parse_pattern_modifier(Parser& p, Pattern& pattern) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "turbulence"_kw:
        next(p), turbulence_of(pattern).amount = parse_vector(p);
        return true;
    case "octaves"_kw:
    case "omega"_kw:
    case "lambda"_kw:
        return parse_turbulence_word(p, turbulence_of(pattern));
    case "frequency"_kw:
        next(p), pattern.frequency = parse_float(p);
        return true;
    case "phase"_kw:
        next(p), pattern.phase = parse_float(p);
        return true;
    case "noise_generator"_kw:
        next(p), pattern.noise_generator = parse_int(p, 1, 3, "`noise_generator`");
        return true;
    case "uv_mapping"_kw:
        next(p), pattern.uv_mapping = parse_optional_bool(p);
        return true;
    case "warp"_kw:
        next(p), parse_warp(p, pattern);
        return true;
    default:
        return parse_wave(p, pattern) || parse_fractal_word(p, pattern) || parse_word_of_kind(p, pattern);
    }
}

Pattern parse_pattern_block(Parser& p) {
    Pattern pattern;
    block(p, "pattern", [&] {
        if (Transform transform; accept_transform(p, transform))
            transform_pattern(pattern, transform);
        else if (!parse_pattern(p, pattern, [](const Pattern&) {}) && !parse_pattern_modifier(p, pattern))
            unexpected(p, "pattern",
                       {"bozo"_kw, "granite"_kw, "gradient"_kw, "checker"_kw, "crackle"_kw, "turbulence"_kw,
                        "translate"_kw, "rotate"_kw, "scale"_kw});
    });
    return pattern;
}

namespace {

// Files are read once for all functions of a scene, but for those whose gamma changes between.
template <class Prepare>
void prepare_now(Parser& p, Prepare prepare) {
    PatternAssets& assets = p.pattern_assets;
    if (assets.assumed_gamma != p.scene.assumed_gamma) assets.pictures.clear();
    assets.assumed_gamma = p.scene.assumed_gamma;
    assets.noise_generator = scene_noise_generator(p);
    assets.number_of_waves = p.scene.number_of_waves;
    const Token at = peek(p);
    try {
        prepare(assets);
    } catch (const std::runtime_error& problem) { // FileError, SceneError
        fail(p, at, problem.what());
    }
}

} // namespace

int scene_noise_generator(const Parser& p) {
    if (p.noise_said) return p.scene.noise_generator;
    return p.in.version < 3.5 ? 1 : 2;
}

Pattern prepared(Parser& p, Pattern pattern) {
    prepare_now(p, [&](PatternAssets& assets) { prepare_pattern(pattern, assets); });
    return pattern;
}

Pigment prepared(Parser& p, Pigment pigment) {
    prepare_now(p, [&](PatternAssets& assets) { prepare_pigment(pigment, assets); });
    return pigment;
}

} // namespace pnr
