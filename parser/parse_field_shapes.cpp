// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes given by fields: isosurface, blob, height_field, julia_fractal, parametric. Their own items, up to
// the first modifier.
#include "core/shape_field.h"
#include "parser/blocks.h"
#include "parser/expression.h"
#include "parser/function_field.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

Vec3 parse_item(Parser& p) {
    const Vec3 v = parse_vector(p);
    accept_comma(p);
    return v;
}

double parse_positive(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const double value = parse_float(p);
    if (!(value > 0 && std::isfinite(value))) fail(p, at, fmt::format("{} must be more than 0", what));
    accept_comma(p);
    return value;
}

// Outside of the template: clang 14 would look for the operator at run time.
constexpr Keyword sphere_word = "sphere"_kw, box_word = "box"_kw;

// `{ sphere { centre, radius } }` or `{ box { corner, corner } }`.
template <class Data>
void parse_contained_by(Parser& p, Data& data) {
    block(p, "contained_by", [&] {
        const Token word = peek(p);
        if (accept(p, sphere_word)) {
            data.in_sphere = true;
            block(p, "sphere", [&] { data.sphere = std::get<Sphere>(parse_sphere(p)); });
        } else if (accept(p, box_word)) {
            data.in_sphere = false;
            block(p, "box", [&] { data.box = std::get<Box>(parse_box(p)); });
            const Vec3 size = data.box.high - data.box.low;
            if (!(size.x > 0 && size.y > 0 && size.z > 0)) fail(p, word, "this container has no volume");
        } else {
            unexpected(p, "contained_by", {sphere_word, box_word});
        }
    });
}

// The word being next. What cannot be evaluated is a warning, and `otherwise` everywhere.
FieldProgram parse_field(Parser& p, std::string_view what, double otherwise) {
    const Token word = peek(p);
    if (!at(p, "function"_kw)) fail(p, word, fmt::format("`{}` needs a `function {{ ... }}` first", what));
    const auto function = parse_function(p);
    if (function->unsupported.empty()) {
        charge_costly(p, word, *function);
        return field_program(function);
    }
    warn_unsupported(p, word, fmt::format("{} of {}", what, function->unsupported), "it is left out");
    FieldProgram constant;
    constant.steps.push_back({FieldOp::constant, 0, 0, 0, 0, otherwise});
    return constant;
}

// ---- isosurface

bool parse_isosurface_item(Parser& p, IsosurfaceData& data) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "contained_by"_kw:
        next(p), parse_contained_by(p, data);
        return true;
    case "threshold"_kw:
        next(p), data.threshold = parse_float(p);
        return true;
    case "accuracy"_kw:
        next(p), data.accuracy = parse_positive(p, "`accuracy`");
        return true;
    case "max_gradient"_kw:
        next(p), data.max_gradient = parse_positive(p, "`max_gradient`");
        return true;
    case "evaluate"_kw: // POV-Ray's search for max_gradient starts at the first number
        next(p), data.max_gradient = parse_positive(p, "the gradient of `evaluate`");
        parse_float(p), accept_comma(p), parse_float(p);
        return true;
    case "max_trace"_kw: // all crossings are found always
        next(p), parse_int(p, 1, 1 << 20, "`max_trace`");
        return true;
    case "all_intersections"_kw:
        next(p);
        return true;
    case "open"_kw:
        next(p), data.open = true;
        return true;
    default:
        return false;
    }
}

// ---- blob

// A component's braces, behind its own numbers: transforms and a texture.
void parse_component_modifiers(Parser& p, BlobComponent& component, PartTextures& textures, Object& part) {
    if (!parse_object_modifier(p, part))
        unexpected(p, "component of a blob",
                   {"texture"_kw, "pigment"_kw, "finish"_kw, "translate"_kw, "rotate"_kw, "scale"_kw});
    component.transform = part.transform;
    if (!part.texture) return;
    if (component.texture == no_texture) {
        component.texture = static_cast<std::uint32_t>(textures.list.size());
        textures.list.emplace_back();
    }
    textures.list[component.texture] = *part.texture;
}

void parse_component(Parser& p, BlobData& blob, PartTextures& textures, bool cylinder) {
    const std::string_view what = cylinder ? "cylinder" : "sphere";
    BlobComponent component;
    Object part;
    bool started = false;
    block(p, what, [&] {
        if (started) return parse_component_modifiers(p, component, textures, part);
        started = true;
        component.base = component.cap = parse_item(p);
        if (cylinder) component.cap = parse_item(p);
        component.radius = parse_positive(p, "the radius of a blob's component");
        accept(p, "strength"_kw);
        component.strength = parse_float(p);
    });
    if (started) blob.components.push_back(component);
}

// ---- height_field

bool accept_file_type(Parser& p, bool& pot) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "pot"_kw:
        pot = true;
        [[fallthrough]];
    case "gif"_kw:
    case "tga"_kw:
    case "png"_kw:
    case "jpeg"_kw:
    case "tiff"_kw:
    case "ppm"_kw:
    case "pgm"_kw:
    case "exr"_kw:
    case "hdr"_kw:
    case "iff"_kw:
    case "sys"_kw:
        next(p);
        return true;
    default:
        return false;
    }
}

// `function W, H { ... }`
void parse_height_function(Parser& p, HeightFieldData& data) {
    const Token word = next(p);
    data.width = parse_int(p, 2, 1 << 15, "the width of a height field");
    accept_comma(p);
    data.height = parse_int(p, 2, 1 << 15, "the height of a height field");
    charge(p, word,
           sizeof(float) * static_cast<std::size_t>(data.width) * static_cast<std::size_t>(data.height));
    const auto function = parse_function_body(p, word);
    if (function->unsupported.empty()) {
        charge_calls(p, word, *function, double(data.width) * data.height);
        data.function = [field = field_program(function)](Vec3 at) {
            FieldScratch scratch;
            return field_value(field, at, scratch);
        };
        return;
    }
    warn_unsupported(p, word, fmt::format("height_field of {}", function->unsupported), "it is flat");
    data.function = [](Vec3) { return 0.0; };
}

// ---- julia_fractal

void parse_four(Parser& p, double (&numbers)[4]) {
    const Token at = peek(p);
    VectorValue v = parse_operand_expression(p, Angles::bracket);
    if (v.size != 1 && v.size < 4) fail(p, at, "four numbers are needed here");
    promote(v, 4);
    for (int i = 0; i < 4; ++i) tell(p.in, numbers[i] = v.v[i]);
    accept_comma(p);
}

std::optional<JuliaFractalData::Map> map_of(const Token& word) {
    using Map = JuliaFractalData::Map;
    switch (keyword_of(word)) {
    case "sqr"_kw:
        return Map::square;
    case "cube"_kw:
        return Map::cube;
    case "exp"_kw:
        return Map::exp;
    case "reciprocal"_kw:
        return Map::reciprocal;
    case "sin"_kw:
        return Map::sin;
    case "asin"_kw:
        return Map::asin;
    case "sinh"_kw:
        return Map::sinh;
    case "asinh"_kw:
        return Map::asinh;
    case "cos"_kw:
        return Map::cos;
    case "acos"_kw:
        return Map::acos;
    case "cosh"_kw:
        return Map::cosh;
    case "acosh"_kw:
        return Map::acosh;
    case "tan"_kw:
        return Map::tan;
    case "atan"_kw:
        return Map::atan;
    case "tanh"_kw:
        return Map::tanh;
    case "atanh"_kw:
        return Map::atanh;
    case "ln"_kw:
        return Map::ln;
    case "pwr"_kw:
        return Map::power;
    default:
        return std::nullopt;
    }
}

void parse_power(Parser& p, JuliaFractalData& data) {
    expect(p, '(', "behind `pwr`");
    data.power[0] = parse_float(p);
    expect(p, ',', "between the two numbers of `pwr`");
    data.power[1] = parse_float(p);
    expect(p, ')', "to close `pwr(`");
}

bool parse_julia_item(Parser& p, JuliaFractalData& data) {
    const Token word = peek(p);
    if (const auto map = map_of(word)) {
        next(p), data.map = *map;
        if (*map == JuliaFractalData::Map::power) parse_power(p, data);
        return true;
    }
    switch (keyword_of(word)) {
    case "quaternion"_kw:
        next(p), data.algebra = JuliaFractalData::Algebra::quaternion;
        return true;
    case "hypercomplex"_kw:
        next(p), data.algebra = JuliaFractalData::Algebra::hypercomplex;
        return true;
    case "max_iteration"_kw:
        next(p), data.max_iteration = parse_int(p, 1, 100000, "`max_iteration`");
        return true;
    case "precision"_kw:
        next(p), data.precision = std::max(parse_positive(p, "`precision`"), 1.0);
        return true;
    case "slice"_kw: {
        next(p);
        const Token at = peek(p);
        parse_four(p, data.slice);
        data.slice_distance = parse_float(p);
        if (data.slice[3] == 0) fail(p, at, "the fourth number of `slice` must not be 0");
        double length2 = 0;
        for (const double v : data.slice) length2 += v * v;
        for (double& v : data.slice) v /= std::sqrt(length2);
        return true;
    }
    default:
        return false;
    }
}

} // namespace

Shape parse_isosurface(Parser& p) {
    auto data = std::make_shared<IsosurfaceData>();
    const Token at = peek(p);
    data->field = parse_field(p, "isosurface", 1e30);
    charge(p, at, data->field.steps.size() * sizeof(FieldStep));
    accept_comma(p);
    while (parse_isosurface_item(p, *data)) accept_comma(p);
    return Isosurface{std::move(data), nullptr};
}

Shape parse_blob(Parser& p) {
    const Token start = peek(p);
    auto blob = std::make_shared<BlobData>();
    auto textures = std::make_shared<PartTextures>();
    for (;; accept_comma(p)) {
        const Token word = peek(p);
        if (accept(p, "threshold"_kw)) {
            blob->threshold = parse_positive(p, "`threshold` of a blob");
        } else if (accept(p, "sphere"_kw)) {
            parse_component(p, *blob, *textures, false);
        } else if (accept(p, "cylinder"_kw)) {
            parse_component(p, *blob, *textures, true);
        } else if (accept(p, "component"_kw)) { // strength, radius, centre
            BlobComponent component;
            component.strength = parse_float(p);
            accept_comma(p);
            component.radius = parse_positive(p, "the radius of a blob's component");
            component.base = component.cap = parse_vector(p);
            blob->components.push_back(component);
        } else {
            break;
        }
        charge(p, word, sizeof(BlobComponent) + 2 * sizeof(BlobData::Node));
    }
    if (blob->components.empty())
        fail(p, start, "a blob needs at least one component: sphere, cylinder or component");
    finish_blob(*blob);
    Blob shape{std::move(blob), nullptr};
    if (!textures->list.empty()) shape.textures = std::move(textures);
    return shape;
}

Shape parse_height_field(Parser& p) {
    auto data = std::make_shared<HeightFieldData>();
    const Token start = peek(p);
    data->said_at = source_ref(p, start);
    if (at(p, "function"_kw)) {
        parse_height_function(p, *data);
    } else {
        accept_file_type(p, data->pot);
        const Token name = peek(p);
        data->said_at = source_ref(p, name);
        data->file = resolve_file(p, name, parse_string(p));
        data->pot |= data->file.ends_with(".pot");
        while (at(p, "gamma"_kw) ||
               at(p, "premultiplied"_kw)) // heights are no light: taken as they are stored
            accept(p, "gamma"_kw) ? (accept(p, "srgb"_kw) ? 0 : parse_float(p))
                                  : (next(p), parse_optional_bool(p));
    }
    for (;;) {
        if (accept(p, "smooth"_kw))
            data->smooth = parse_optional_bool(p);
        else if (accept(p, "water_level"_kw))
            data->water_level = parse_float(p);
        else if (accept(p, "hierarchy"_kw))
            parse_optional_bool(p);
        else
            return HeightField{std::move(data), nullptr};
    }
}

Shape parse_julia_fractal(Parser& p) {
    auto data = std::make_shared<JuliaFractalData>();
    parse_four(p, data->parameter);
    const Token at = peek(p);
    while (parse_julia_item(p, *data)) accept_comma(p);
    using Data = JuliaFractalData;
    if (data->algebra == Data::Algebra::quaternion && data->map != Data::Map::square &&
        data->map != Data::Map::cube)
        fail(p, at,
             "quaternions have `sqr` and `cube` alone; the other functions are of `hypercomplex` numbers");
    return JuliaFractal{std::move(data)};
}

Shape parse_parametric(Parser& p) {
    auto data = std::make_shared<ParametricData>();
    for (FieldProgram* field : {&data->x, &data->y, &data->z}) {
        *field = parse_field(p, "parametric", 0);
        accept_comma(p);
    }
    data->low = parse_uv(p);
    accept_comma(p);
    data->high = parse_uv(p);
    accept_comma(p);
    for (;; accept_comma(p)) {
        if (accept(p, "contained_by"_kw))
            parse_contained_by(p, *data);
        else if (accept(p, "accuracy"_kw))
            data->accuracy = parse_positive(p, "`accuracy`");
        else if (accept(p, "max_gradient"_kw))
            parse_float(p); // nothing is guessed from it
        else if (accept(p, "precompute"_kw)) {
            parse_float(p), accept_comma(p);
            while (accept(p, "x"_kw) || accept(p, "y"_kw) || accept(p, "z"_kw)) accept_comma(p);
        } else
            return Parametric{std::move(data)};
    }
}

} // namespace pnr
