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

using Unary = double (*)(double);

double truncate(double x) { return std::trunc(x); }
double to_radians(double x) { return x * pi / 180; }
double to_degrees(double x) { return x * 180 / pi; }

} // namespace

double (*total_function(Keyword word))(double) {
    switch (word) {
    case "abs"_kw:
        return std::fabs;
    case "atan"_kw:
        return std::atan;
    case "asinh"_kw:
        return std::asinh;
    case "ceil"_kw:
        return std::ceil;
    case "floor"_kw:
        return std::floor;
    case "int"_kw:
        return truncate;
    case "sin"_kw:
        return std::sin;
    case "cos"_kw:
        return std::cos;
    case "tan"_kw:
        return std::tan;
    case "sinh"_kw:
        return std::sinh;
    case "cosh"_kw:
        return std::cosh;
    case "tanh"_kw:
        return std::tanh;
    case "exp"_kw:
        return std::exp;
    case "radians"_kw:
        return to_radians;
    case "degrees"_kw:
        return to_degrees;
    default:
        return nullptr;
    }
}

namespace {

double checked(Parser& p, const Token& name, double argument, double result) {
    if (!std::isfinite(result))
        fail(p, name, fmt::format("{}({}) has no finite value", token_text(p, name, false), argument));
    return result;
}

// Functions of one number that have no value for some.
double partial_function(Parser& p, const Token& name, double x) {
    switch (static_cast<Keyword>(name.symbol)) {
    case "acos"_kw:
        return checked(p, name, x,
                       std::acos(std::abs(x) > 1 && std::abs(x) < 1 + 1e-10 ? std::copysign(1, x) : x));
    case "asin"_kw:
        return checked(p, name, x,
                       std::asin(std::abs(x) > 1 && std::abs(x) < 1 + 1e-10 ? std::copysign(1, x) : x));
    case "acosh"_kw:
        return checked(p, name, x, std::acosh(x));
    case "atanh"_kw:
        return checked(p, name, x, std::atanh(x));
    case "sqrt"_kw:
        return checked(p, name, x, std::sqrt(x));
    case "ln"_kw:
        return checked(p, name, x, std::log(x));
    default:
        return checked(p, name, x, std::log10(x));
    }
}

bool is_partial_function(Keyword word) {
    switch (word) {
    case "acos"_kw:
    case "asin"_kw:
    case "acosh"_kw:
    case "atanh"_kw:
    case "sqrt"_kw:
    case "ln"_kw:
    case "log"_kw:
        return true;
    default:
        return false;
    }
}

bool is_binary_function(Keyword word) {
    switch (word) {
    case "atan2"_kw:
    case "mod"_kw:
    case "div"_kw:
    case "pow"_kw:
        return true;
    default:
        return false;
    }
}

double binary_function(Parser& p, const Token& name, double a, double b) {
    const auto word = static_cast<Keyword>(name.symbol);
    if (word == "atan2"_kw) return a == 0 && b == 0 ? 0 : std::atan2(a, b);
    if (word == "mod"_kw || word == "div"_kw) {
        if (b == 0) fail(p, name, fmt::format("{}({}, 0): division by zero", token_text(p, name, false), a));
        return word == "mod"_kw ? std::fmod(a, b) : std::trunc(a / b);
    }
    const double result = std::pow(a, b);
    if (!std::isfinite(result)) fail(p, name, fmt::format("pow({}, {}) has no finite value", a, b));
    return result;
}

// POV-Ray's generator: a linear congruence of 32 bits; `seed` starts a stream, `rand` steps it.
double next_random(Parser& p, const Token& name, double stream) {
    const auto count = static_cast<double>(p.in.random_streams.size());
    if (!(stream >= 0) || stream >= count)
        fail(p, name, fmt::format("{} is no stream of random numbers", stream), "seed(number) makes one");
    std::uint32_t& state = p.in.random_streams[static_cast<std::size_t>(stream)];
    state = state * 1812433253u + 12345u;
    return static_cast<double>(state) / 4294967295.0;
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
            stop(p, name,
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

// x, y, z are vectors of three, u and v of two, t of four.
bool unit_vector(Keyword word, VectorValue& value) {
    switch (word) {
    case "x"_kw:
        value = {{1, 0, 0, 0, 0}, 3, false};
        return true;
    case "y"_kw:
        value = {{0, 1, 0, 0, 0}, 3, false};
        return true;
    case "z"_kw:
        value = {{0, 0, 1, 0, 0}, 3, false};
        return true;
    case "t"_kw:
        value = {{0, 0, 0, 1, 0}, 4, false};
        return true;
    case "u"_kw:
        value = {{1, 0, 0, 0, 0}, 2, false};
        return true;
    case "v"_kw:
        value = {{0, 1, 0, 0, 0}, 2, false};
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

Vec3 vec3(const VectorValue& value) { return {value.v[0], value.v[1], value.v[2]}; }
VectorValue vector(Vec3 v) { return {{v.x, v.y, v.z, 0, 0}, 3, false}; }

// vturbulence(lambda, omega, octaves, point)
VectorValue turbulence_function(Parser& p, const Token& name) {
    Turbulence words;
    words.lambda = number_argument(p);
    comma_argument(p, name);
    words.omega = number_argument(p);
    comma_argument(p, name);
    words.octaves = static_cast<int>(std::clamp(number_argument(p), 1.0, 10.0));
    comma_argument(p, name);
    return vector(turbulence_vector(vec3(vector_argument(p)), words));
}

VectorValue vector_function(Parser& p, const Token& name) {
    if (is(name, "vturbulence"_kw)) return turbulence_function(p, name);
    const VectorValue a = vector_argument(p);
    const auto word = static_cast<Keyword>(name.symbol);
    double length = 0;
    for (int i = 0; i < a.size; ++i) length += a.v[i] * a.v[i];
    length = std::sqrt(length);
    if (word == "vlength"_kw) return scalar(length);
    if (word == "vnormalize"_kw) {
        VectorValue unit = a;
        if (length == 0) return unit; // POV-Ray's answer for the zero vector
        for (int i = 0; i < a.size; ++i) unit.v[i] /= length;
        return unit;
    }
    comma_argument(p, name);
    const VectorValue b = vector_argument(p);
    if (word == "vcross"_kw) return vector(glm::cross(vec3(a), vec3(b)));
    if (word == "vdot"_kw) return scalar(glm::dot(vec3(a), vec3(b)));
    if (word == "vrotate"_kw) return vector(transform_vector(rotation(vec3(b)).matrix, vec3(a)));
    comma_argument(p, name);
    const double angle = number_argument(p);
    if (glm::length(vec3(b)) == 0) fail(p, name, "vaxis_rotate() about an axis of length 0");
    return vector(transform_vector(axis_rotation(vec3(b), angle).matrix, vec3(a)));
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
        return next_random(p, name, number_argument(p));
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
    return total_function(word) || is_partial_function(word) || is_binary_function(word) ||
           is_constant(word) || is_vector_function(word) || is_other_function(word) ||
           is_object_function(word) || unit_vector(word, ignored);
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
    } else if (is_partial_function(word)) {
        value = scalar(partial_function(p, name, number_argument(p)));
    } else if (is_binary_function(word)) {
        const double a = number_argument(p);
        comma_argument(p, name);
        value = scalar(binary_function(p, name, a, number_argument(p)));
    } else if (is_vector_function(word)) {
        value = vector_function(p, name);
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
