// SPDX-License-Identifier: GPL-3.0-or-later
// The functions and constants whose value is a number or a vector; those of strings are in
// builtins_string.cpp.
#include "parser/builtins.h"

#include "core/noise.h"
#include "parser/library.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <filesystem>

namespace pnr {

// ---- arguments
// ------------------------------------------------------------------------------------------------------

void open_arguments(Parser& p, const Token& name) {
    if (!at(p, '('))
        fail(p, name, fmt::format("`{}` is a function: it needs `(`", token_text(p, name, false)));
    next(p);
}

void close_arguments(Parser& p, const Token& name) {
    if (at(p, ')')) {
        next(p);
        return;
    }
    const Token found = peek(p);
    fail(p, found,
         fmt::format("expected `)` to close `{}(`, found {}", token_text(p, name, false),
                     token_text(p, found)));
}

void comma_argument(Parser& p, const Token& name) {
    if (accept(p, ',')) return;
    const Token found = peek(p);
    fail(p, found,
         fmt::format("`{}` needs another argument: expected `,`, found {}", token_text(p, name, false),
                     token_text(p, found)));
}

double number_argument(Parser& p) { return parse_condition(p); }

VectorValue vector_argument(Parser& p) {
    VectorValue value = parse_operand_expression(p, Angles::compare);
    promote(value, 3);
    return value;
}

namespace {

double checked(Parser& p, const Token& name, double argument, double result) {
    if (!std::isfinite(result))
        fail(p, name, fmt::format("{}({}) has no finite value", token_text(p, name, false), argument));
    return result;
}

double checked_binary(Parser& p, const Token& name, double a, double b) {
    const auto word = static_cast<Keyword>(name.symbol);
    if (b == 0 && (word == "mod"_kw || word == "div"_kw))
        fail(p, name, fmt::format("{}({}, 0): division by zero", token_text(p, name, false), a));
    const double result = function_of_two(word)(a, b);
    if (!std::isfinite(result))
        fail(p, name, fmt::format("{}({}, {}) has no finite value", token_text(p, name, false), a, b));
    return result;
}

// `seed` starts a stream of random numbers, `rand` steps it.
double random_of(Parser& p, const Token& name, double stream) {
    const auto count = static_cast<double>(p.in.random_streams.size());
    if (!(stream >= 0) || stream >= count)
        fail(p, name, fmt::format("{} is no stream of random numbers", stream), "seed(number) makes one");
    return next_random(p.in.random_streams[static_cast<std::size_t>(stream)]);
}

double new_stream(Parser& p, const Token& name, double seed) {
    if (p.in.random_streams.size() >= 1'000'000) stop(p, name, "more than 1000000 streams of random numbers");
    // A number beyond 32 bits becomes the smallest one, as in the conversion that POV-Ray's processor makes.
    const bool fits = seed > -2147483649.0 && seed < 2147483648.0;
    p.in.random_streams.push_back(fits ? static_cast<std::uint32_t>(static_cast<std::int32_t>(seed))
                                       : 0x80000000u);
    return static_cast<double>(p.in.random_streams.size() - 1);
}

double min_or_max(Parser& p, bool largest) {
    double value = number_argument(p);
    while (accept(p, ',')) {
        const double other = number_argument(p);
        value = largest ? std::max(value, other) : std::min(value, other);
    }
    return value;
}

// select(a, b, c [, d]): b if a < 0, c if a = 0, d if a > 0; without d, c stands for both.
VectorValue select_value(Parser& p, const Token& name) {
    const double choice = number_argument(p);
    comma_argument(p, name);
    const VectorValue negative = parse_operand_expression(p, Angles::compare);
    comma_argument(p, name);
    const VectorValue zero = parse_operand_expression(p, Angles::compare);
    const VectorValue positive = accept(p, ',') ? parse_operand_expression(p, Angles::compare) : zero;
    return choice < 0 ? negative : choice > 0 ? positive : zero;
}

const ArrayValue& array_argument(Parser& p, const Token& name) {
    const Token token = peek(p);
    const Value* value = token.kind == TokenKind::word ? lookup(p.in, token.symbol) : nullptr;
    if (!value)
        fail(p, token,
             fmt::format("{} needs an array, found {}", token_text(p, name, false), token_text(p, token)));
    const Value& taken = take_variable(p);
    const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&taken.data);
    if (!array)
        fail(p, token,
             fmt::format("{} needs an array, `{}` is {}", token_text(p, name, false),
                         token_text(p, token, false), article_name(taken)));
    return **array;
}

double dimension_size(Parser& p, const Token& name) {
    const ArrayValue& array = array_argument(p, name);
    const std::vector<int> sizes = array.dimensions;
    comma_argument(p, name);
    const Token first = peek(p);
    const double dimension = number_argument(p);
    if (dimension < 1 || dimension > static_cast<double>(sizes.size()))
        fail(p, first,
             fmt::format("the array has {} dimension{}, counted from 1; there is no {}", sizes.size(),
                         sizes.size() == 1 ? "" : "s", dimension));
    return sizes[static_cast<std::size_t>(dimension) - 1];
}

double defined_argument(Parser& p, const Token& name) {
    // the identifier need not have a value
    const Token identifier = next(p);
    if (identifier.kind != TokenKind::word)
        fail(p, name, fmt::format("defined() needs an identifier, found {}", token_text(p, identifier)));
    return is_declared(p.in, identifier.symbol);
}

double bits(Parser& p, const Token& name) {
    const auto word = static_cast<Keyword>(name.symbol);
    auto value = static_cast<std::int64_t>(number_argument(p));
    while (accept(p, ',')) {
        const auto other = static_cast<std::int64_t>(number_argument(p));
        if (word == "bitwise_and"_kw)
            value &= other;
        else if (word == "bitwise_or"_kw)
            value |= other;
        else
            value ^= other;
    }
    return static_cast<double>(value);
}

// sum(i, first, last, f(i)) and prod: the last argument is evaluated once for each i.
double sum_or_product(Parser& p, const Token& name) {
    const bool is_sum = static_cast<Keyword>(name.symbol) == "sum"_kw;
    const Token variable = next(p);
    if (variable.kind != TokenKind::word || is_reserved(variable.symbol))
        fail(p, variable, fmt::format("{} needs the name of its variable first", token_text(p, name, false)));
    comma_argument(p, name);
    const double first = number_argument(p);
    comma_argument(p, name);
    const double last = number_argument(p);
    comma_argument(p, name);
    TokenFrame& frame = p.in.frames.back();
    const std::size_t frames = p.in.frames.size();
    const std::uint32_t start = frame.position;
    const std::uint32_t scope = frame.scope;
    double result = is_sum ? 0 : 1;
    for (double i = first; i <= last + 1e-9; i += 1) {
        if (++p.in.used.loop_turns > p.in.options.budgets.loop_turns)
            stop_at_limit(p, name, &Budgets::loop_turns,
                 fmt::format("the scene's loops turn more than {} times", p.in.options.budgets.loop_turns));
        if (p.in.frames.size() != frames || p.in.frames.back().scope != scope)
            fail(p, name, "the last argument must stand in one macro or file");
        p.in.frames.back().position = start;
        p.in.buffered = false;
        p.in.symbols[variable.symbol].bindings.push_back(
            {scope, std::make_shared<Cell>(Cell{Value{i}}), nullptr, 0});
        const double term = number_argument(p);
        p.in.symbols[variable.symbol].bindings.pop_back();
        result = is_sum ? result + term : result * term;
    }
    if (last + 1e-9 < first) fail(p, name, fmt::format("{} has no terms", token_text(p, name, false)));
    return result;
}

// Days since 2000-01-01 00:00 UTC.
double days_now() {
    constexpr double epoch_2000 = 946684800;
    return (static_cast<double>(std::time(nullptr)) - epoch_2000) / 86400;
}

double constant(Parser& p, Keyword word) {
    switch (word) {
    case "pi"_kw:
        return pi;
    case "tau"_kw:
        return 2 * pi;
    case "on"_kw:
    case "yes"_kw:
    case "true"_kw:
        return 1;
    case "clock"_kw:
        return p.in.options.clock;
    case "clock_on"_kw:
        return p.in.options.final_frame > p.in.options.initial_frame;
    case "now"_kw:
        return days_now();
    case "version"_kw:
        return p.in.version;
    default:
        return 0; // off no false
    }
}

bool is_constant(Keyword word) {
    switch (word) {
    case "pi"_kw:
    case "tau"_kw:
    case "on"_kw:
    case "yes"_kw:
    case "true"_kw:
    case "off"_kw:
    case "no"_kw:
    case "false"_kw:
    case "clock"_kw:
    case "clock_on"_kw:
    case "now"_kw:
    case "version"_kw:
        return true;
    default:
        return false;
    }
}

bool is_vector_function(Keyword word) {
    switch (word) {
    case "vlength"_kw:
    case "vnormalize"_kw:
    case "vcross"_kw:
    case "vdot"_kw:
    case "vrotate"_kw:
    case "vaxis_rotate"_kw:
    case "vturbulence"_kw:
        return true;
    default:
        return false;
    }
}

// vturbulence(lambda, omega, octaves, point)
VectorValue turbulence_function(Parser& p, const Token& name) {
    Turbulence words;
    words.lambda = number_argument(p);
    comma_argument(p, name);
    words.omega = number_argument(p);
    comma_argument(p, name);
    words.octaves = static_cast<int>(std::clamp(number_argument(p), 1.0, 10.0));
    comma_argument(p, name);
    const VectorValue at = vector_argument(p);
    const Vec3 moved = turbulence_vector(Vec3(at.v[0], at.v[1], at.v[2]), words);
    return {{moved.x, moved.y, moved.z, 0, 0}, 3, false};
}

VectorValue call_vector_function(Parser& p, const Token& name) {
    if (is(name, "vturbulence"_kw)) return turbulence_function(p, name);
    const VectorValue a = vector_argument(p);
    const auto word = static_cast<Keyword>(name.symbol);
    VectorValue b, result;
    if (word != "vlength"_kw && word != "vnormalize"_kw) {
        comma_argument(p, name);
        b = vector_argument(p);
    }
    if (vector_function(word, a, b, result)) return result;
    comma_argument(p, name); // vaxis_rotate
    const double angle = number_argument(p);
    const Vec3 axis(b.v[0], b.v[1], b.v[2]);
    if (glm::length(axis) == 0) fail(p, name, "vaxis_rotate() about an axis of length 0");
    const Vec3 turned = transform_vector(axis_rotation(axis, angle).matrix, Vec3(a.v[0], a.v[1], a.v[2]));
    return {{turned.x, turned.y, turned.z, 0, 0}, 3, false};
}

bool is_other_function(Keyword word) {
    switch (word) {
    case "min"_kw:
    case "max"_kw:
    case "rand"_kw:
    case "seed"_kw:
    case "select"_kw:
    case "strlen"_kw:
    case "strcmp"_kw:
    case "asc"_kw:
    case "val"_kw:
    case "dimensions"_kw:
    case "dimension_size"_kw:
    case "defined"_kw:
    case "file_exists"_kw:
    case "bitwise_and"_kw:
    case "bitwise_or"_kw:
    case "bitwise_xor"_kw:
    case "sum"_kw:
    case "prod"_kw:
        return true;
    default:
        return false;
    }
}

double other_function(Parser& p, const Token& name) {
    switch (static_cast<Keyword>(name.symbol)) {
    case "min"_kw:
        return min_or_max(p, false);
    case "max"_kw:
        return min_or_max(p, true);
    case "rand"_kw:
        return random_of(p, name, number_argument(p));
    case "seed"_kw:
        return new_stream(p, name, number_argument(p));
    case "dimensions"_kw:
        return static_cast<double>(array_argument(p, name).dimensions.size());
    case "dimension_size"_kw:
        return dimension_size(p, name);
    case "defined"_kw:
        return defined_argument(p, name);
    case "file_exists"_kw:
        return file_exists(p, parse_string(p));
    case "bitwise_and"_kw:
    case "bitwise_or"_kw:
    case "bitwise_xor"_kw:
        return bits(p, name);
    case "sum"_kw:
    case "prod"_kw:
        return sum_or_product(p, name);
    default:
        return number_of_strings(p, name);
    }
}

} // namespace

bool is_number_builtin(Keyword word) {
    VectorValue ignored;
    return total_function(word) || partial_function(word) || function_of_two(word) ||
           is_constant(word) || is_vector_function(word) || is_other_function(word) || is_object_function(word) ||
           unit_vector(word, ignored);
}

VectorValue call_number_builtin(Parser& p, const Token& name) {
    const auto word = static_cast<Keyword>(name.symbol);
    VectorValue value;
    if (unit_vector(word, value)) return value;
    if (is_constant(word)) return scalar(constant(p, word));
    open_arguments(p, name);
    if (const Unary function = total_function(word)) {
        const double argument = number_argument(p);
        value = scalar(checked(p, name, argument, function(argument)));
    } else if (const Unary partial = partial_function(word)) {
        const double argument = number_argument(p);
        value = scalar(checked(p, name, argument, partial(argument)));
    } else if (function_of_two(word)) {
        const double a = number_argument(p);
        comma_argument(p, name);
        value = scalar(checked_binary(p, name, a, number_argument(p)));
    } else if (is_vector_function(word)) {
        value = call_vector_function(p, name);
    } else if (is_object_function(word)) {
        value = object_function(p, name);
    } else if (word == "select"_kw) {
        value = select_value(p, name);
    } else {
        value = scalar(other_function(p, name));
    }
    close_arguments(p, name);
    return value;
}

} // namespace pnr
