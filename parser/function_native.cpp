// SPDX-License-Identifier: GPL-3.0-or-later
// Functions whose body is no expression: internal, transform, spline, pigment and pattern functions.
#include "core/internal_functions.h"
#include "parser/blocks.h"
#include "parser/content.h"
#include "parser/expression.h"
#include "parser/function.h"
#include "parser/spline.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

constexpr std::size_t noise3d = 76, noise_generator = 78; // internal functions by number

// `internal(N)`: the function of POV-Ray's number N.
void parse_internal(Parser& p, Function& function) {
    next(p);
    expect(p, '(', "behind `internal`");
    const Token at_number = peek(p);
    const double number = parse_float(p);
    expect(p, ')', "to close `internal(`");
    const auto all = internal_functions();
    const bool exists =
        number >= 0 && number < static_cast<double>(all.size()) && number == std::trunc(number);
    std::size_t index = exists ? static_cast<std::size_t>(number) : 0;
    if (!exists || all[index].name.empty())
        fail(p, at_number, fmt::format("there is no internal function {}", number));
    function.parameters = all[index].parameters;
    for (int i = 0; i < function.parameters; ++i)
        function.code.push_back(
            {.kind = Instruction::Kind::argument, .index = static_cast<std::uint32_t>(i)});
    if (index == noise3d) { // the noise that counts in the scene
        function.code.push_back({.value = static_cast<double>(scene_noise_generator(p))});
        index = noise_generator;
    }
    if (!all[index].evaluate) function.unsupported = fmt::format("{}", all[index].name);
    function.code.push_back(
        {.kind = Instruction::Kind::internal, .index = static_cast<std::uint32_t>(index)});
    function.stack = all[index].parameters;
    function.cost = 20;
}

// `transform { ... }`: the point moved.
void parse_transform_function(Parser& p, Function& function) {
    next(p);
    function.parameters = 3;
    function.results = 3;
    function.cost = 10;
    function.native = [matrix = parse_transform(p).matrix](const double* a, double* results) {
        const Vec3 moved = transform_point(matrix, Vec3(a[0], a[1], a[2]));
        for (int i = 0; i < 3; ++i) results[i] = moved[i];
    };
}

// `pattern { ... }`: the value at the point.
void parse_pattern_function(Parser& p, Function& function) {
    next(p);
    function.parameters = 3;
    function.cost = 50;
    auto pattern = std::make_shared<const Pattern>(prepared(p, parse_pattern_block(p)));
    function.depth = weight_of(*pattern).depth;
    function.native = [pattern = std::move(pattern)](const double* a, double* results) {
        results[0] = eval_pattern(*pattern, {Vec3(a[0], a[1], a[2]), Vec2(a[0], a[1])});
    };
}

// `pigment { ... }`: the colour at the point.
void parse_pigment_function(Parser& p, Function& function) {
    next(p);
    function.parameters = 3;
    function.results = 5;
    function.cost = 50;
    auto pigment = std::make_shared<const Pigment>(prepared(p, parse_pigment(p, Pigment{})));
    function.depth = weight_of(*pigment).depth;
    function.native = [pigment = std::move(pigment)](const double* a, double* results) {
        const ColorFT color = eval_pigment(*pigment, {Vec3(a[0], a[1], a[2]), Vec2(a[0], a[1])});
        for (int i = 0; i < 3; ++i) results[i] = color.rgb[i];
        results[3] = color.filter;
        results[4] = color.transmit;
    };
}

// `spline { ... }`: the curve at the parameter.
void parse_spline_function(Parser& p, Function& function) {
    next(p);
    const std::shared_ptr<const Spline> spline = parse_spline(p);
    function.parameters = 1;
    function.results = spline->components;
    function.cost = 20;
    function.native = [spline](const double* a, double* results) {
        evaluate(*spline, spline->kind, a[0], results);
    };
}

} // namespace

bool parse_native(Parser& p, Function& function) {
    switch (keyword_of(peek(p))) {
    case "internal"_kw:
        parse_internal(p, function);
        return true;
    case "transform"_kw:
        parse_transform_function(p, function);
        return true;
    case "pigment"_kw:
        parse_pigment_function(p, function);
        return true;
    case "spline"_kw:
        parse_spline_function(p, function);
        return true;
    case "pattern"_kw:
        parse_pattern_function(p, function);
        return true;
    default:
        return false;
    }
}

} // namespace pnr
