// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/expression.h"

#include "parser/quick_expression.h"
#include "parser/suggest.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

Power power_of(const Token& token, Angles angles) {
    return token.kind == TokenKind::punctuation ? operator_power(token.symbol, angles) : none;
}

void apply(Parser& p, const Token& op, VectorValue& a, const VectorValue& b) {
    switch (combine(op.symbol, a, b)) {
    case Fault::none:
        return;
    case Fault::division_by_zero:
        fail(p, op, "division by zero");
    case Fault::not_a_number:
        fail(p, op, "the result is not a number");
    case Fault::too_large:
        fail(p, op, "the result is too large for a number");
    }
}

VectorValue parse_unary(Parser& p) {
    const Token& token = peek(p);
    if (token.kind != TokenKind::punctuation) return parse_primary(p);
    if (token.symbol == '-' || token.symbol == '+' || token.symbol == '!') {
        const Token op = next(p);
        const Nesting nesting(p, op);
        VectorValue value = parse_unary(p);
        if (op.symbol == '-')
            for (double& v : value.v) v = -v;
        if (op.symbol == '!')
            for (int i = 0; i < value.size; ++i) value.v[i] = !is_true(value.v[i]);
        return value;
    }
    return parse_primary(p);
}

VectorValue parse_binary(Parser& p, int minimum, Angles angles) {
    VectorValue left = parse_unary(p);
    for (;;) {
        const Token& seen = peek_operator(p);
        const Power power = power_of(seen, angles);
        if (power == none || power < minimum) return left;
        const Token op = next(p);
        // Deeper only for operators that bind more tightly: left to right among equals.
        const VectorValue right = parse_binary(p, power + 1, angles);
        apply(p, op, left, right);
    }
}

VectorValue parse_conditional(Parser& p, Angles angles) {
    if (VectorValue quick; quick_expression(p, angles, quick)) return quick;
    const VectorValue value = parse_binary(p, logical, angles);
    if (!is(peek_operator(p), '?')) return value;
    const Token question = next(p);
    const bool chosen = is_true(scalar_of(p, value, question));
    // Both sides are evaluated, as in POV-Ray; nested ones group to the right.
    const Nesting nesting(p, question);
    const VectorValue yes = parse_conditional(p, angles);
    expect(p, ':', "between the two values of `?`");
    const VectorValue no = parse_conditional(p, angles);
    return chosen ? yes : no;
}

bool compare_strings(Parser& p) {
    const std::string left = parse_string(p);
    const Token op = next(p);
    if (power_of(op, Angles::compare) != comparison)
        fail(p, op, fmt::format("expected a comparison behind the string, found {}", token_text(p, op)));
    const int order = left.compare(parse_string(p));
    return compare(op.symbol, order, 0) != 0;
}

} // namespace

double scalar_of(Parser& p, const VectorValue& value, const Token& at) {
    if (value.size != 1)
        fail(p, at, fmt::format("a number is needed here, this is a vector of {} components", value.size),
             "take one with .x, .y or .z, or its length with vlength()");
    return value.v[0];
}

VectorValue parse_operand_expression(Parser& p, Angles angles) { return parse_conditional(p, angles); }

double parse_condition(Parser& p) {
    if (at_string(p)) return compare_strings(p);
    const Token first = peek(p);
    return scalar_of(p, parse_conditional(p, Angles::compare), first);
}

namespace {

void tell(Expander& in, const VectorValue& value) {
    for (const double v : value.v) pnr::tell(in, v);
}

} // namespace

// ---- what the blocks ask for
// ----------------------------------------------------------------------------------------

double parse_float(Parser& p) {
    const Token first = peek(p);
    const double value = scalar_of(p, parse_conditional(p, Angles::bracket), first);
    pnr::tell(p.in, value);
    return value;
}

double parse_float_in(Parser& p, double low, double high, std::string_view what) {
    const Token first = peek(p);
    const double value = parse_float(p);
    if (value >= low && value <= high) return value;
    if (high == infinity) fail(p, first, fmt::format("{} must be at least {}, this is {}", what, low, value));
    if (low == -infinity) fail(p, first, fmt::format("{} must be at most {}, this is {}", what, high, value));
    fail(p, first, fmt::format("{} must be between {} and {}, this is {}", what, low, high, value));
}

int parse_int(Parser& p, int low, int high, std::string_view what) {
    const Token first = peek(p);
    const double value = parse_float(p);
    if (value < low || value > high)
        fail(p, first, fmt::format("{} must be between {} and {}, this is {}", what, low, high, value));
    return static_cast<int>(value);
}

bool parse_bool(Parser& p) { return is_true(parse_float(p)); }

bool parse_optional_bool(Parser& p) { return at_expression(p) ? parse_bool(p) : true; }

Vec3 parse_vector(Parser& p) {
    const Token first = peek(p);
    if (at_color(p))
        fail(p, first, fmt::format("a position or direction is needed here, {} starts a colour", token_text(p, first)),
             help_for_missing_value(p, first));
    VectorValue value = parse_conditional(p, Angles::bracket);
    if (value.size == 1) promote(value, 3);
    if (value.size == 2) promote(value, 3);
    if (value.size > 3 && !value.is_color)
        fail(p, first, fmt::format("a vector of 3 components is needed here, this has {}", value.size));
    tell(p.in, value);
    return {value.v[0], value.v[1], value.v[2]};
}

Vec2 parse_uv(Parser& p) {
    const Token first = peek(p);
    VectorValue value = parse_conditional(p, Angles::bracket);
    promote(value, 2);
    if (value.size > 2)
        fail(p, first, fmt::format("a vector of 2 components is needed here, this has {}", value.size));
    tell(p.in, value);
    return {value.v[0], value.v[1]};
}

ColorFT parse_color(Parser& p) {
    const Token first = peek(p);
    VectorValue value = at_color(p) ? color_expression(p) : parse_conditional(p, Angles::bracket);
    parse_channels(p, value); // White filter 0.9
    promote(value, 5);
    tell(p.in, value);
    const double largest = std::max({value.v[0], value.v[1], value.v[2]});
    if (largest > 10 && !p.in.blocks.empty() && p.in.blocks.back().what == "pigment")
        warn(p, first, fmt::format("a surface's colour goes from 0 to 1, this has {}", largest),
             largest <= 255 ? "colours of 0 to 255 are written rgb <255, 128, 0> / 255" : "");
    const auto f = [&](int i) { return static_cast<float>(value.v[i]); };
    return {{f(0), f(1), f(2)}, f(3), f(4)};
}

} // namespace pnr
