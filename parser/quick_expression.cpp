// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/quick_expression.h"

#include "parser/expression.h"

#include <cmath>

namespace pnr {

namespace {

constexpr int deepest = 40; // what is nested deeper is left to the evaluator, which counts

struct Quick {
    Parser& p;
    const TokenFrame& frame;
    std::uint32_t at; // of the frame's tokens
    int depth = 0;
    std::vector<std::pair<std::size_t, std::uint32_t>> streams{}; // of random numbers, as they were before
};

bool conditional(Quick& q, Angles angles, VectorValue& result);

const StoredToken& token(const Quick& q) { return q.frame.tokens[q.at]; } // at the end: what stands behind
bool at_end(const Quick& q) { return q.at >= q.frame.end; }
bool accept(Quick& q, char punctuation) {
    if (at_end(q) || !is(token(q), punctuation)) return false;
    ++q.at;
    return true;
}

bool number(Quick& q, Angles angles, double& result) {
    VectorValue value;
    if (!conditional(q, angles, value) || value.size != 1) return false;
    result = value.v[0];
    return true;
}

bool vector(Quick& q, VectorValue& result) {
    result = {};
    result.size = 0;
    do {
        if (result.size == 5 || !number(q, Angles::bracket, result.v[result.size])) return false;
        ++result.size;
    } while (accept(q, ','));
    return result.size >= 2 && accept(q, '>');
}

bool random(Quick& q, VectorValue& result) {
    double stream = 0;
    if (!number(q, Angles::compare, stream)) return false;
    auto& states = q.p.in.random_streams;
    if (!(stream >= 0) || stream >= static_cast<double>(states.size())) return false;
    const auto index = static_cast<std::size_t>(stream);
    q.streams.emplace_back(index, states[index]);
    result = scalar(next_random(states[index]));
    return true;
}

// min and max of any number of numbers.
bool extreme(Quick& q, bool largest, VectorValue& result) {
    double value = 0, other = 0;
    if (!number(q, Angles::compare, value)) return false;
    while (accept(q, ',')) {
        if (!number(q, Angles::compare, other)) return false;
        value = largest ? std::max(value, other) : std::min(value, other);
    }
    result = scalar(value);
    return true;
}

bool function_of_vectors(Quick& q, Keyword word, VectorValue& result) {
    VectorValue a, b;
    if (!conditional(q, Angles::compare, a)) return false;
    promote(a, 3);
    if (takes_two_vectors(word)) {
        if (!accept(q, ',') || !conditional(q, Angles::compare, b)) return false;
        promote(b, 3);
    }
    return vector_function(word, a, b, result);
}

// The arguments of a function of the language, behind its `(`.
bool call(Quick& q, Keyword word, VectorValue& result) {
    double a = 0, b = 0;
    Unary unary = total_function(word);
    if (!unary) unary = partial_function(word);
    if (unary) {
        if (!number(q, Angles::compare, a)) return false;
        result = scalar(unary(a));
    } else if (const Binary binary = function_of_two(word)) {
        if (!number(q, Angles::compare, a) || !accept(q, ',') || !number(q, Angles::compare, b)) return false;
        result = scalar(binary(a, b));
    } else if (word == "min"_kw || word == "max"_kw) {
        if (!extreme(q, word == "max"_kw, result)) return false;
    } else if (word == "rand"_kw) {
        if (!random(q, result)) return false;
    } else if (!function_of_vectors(q, word, result)) {
        return false;
    }
    for (int i = 0; i < result.size; ++i)
        if (!std::isfinite(result.v[i])) return false;
    return accept(q, ')');
}

bool is_vector_function(Keyword word) {
    return takes_two_vectors(word) || word == "vlength"_kw || word == "vnormalize"_kw;
}

bool builtin(Quick& q, Keyword word, VectorValue& result) {
    if (unit_vector(word, result)) return true;
    switch (word) {
    case "pi"_kw:
        result = scalar(pi);
        return true;
    case "on"_kw:
    case "yes"_kw:
    case "true"_kw:
        result = scalar(1);
        return true;
    case "off"_kw:
    case "no"_kw:
    case "false"_kw:
        result = scalar(0);
        return true;
    case "clock"_kw:
        result = scalar(q.p.in.options.clock);
        return true;
    default:
        break;
    }
    const bool known = total_function(word) || partial_function(word) || function_of_two(word) ||
                       word == "min"_kw || word == "max"_kw || word == "rand"_kw || is_vector_function(word);
    return known && accept(q, '(') && call(q, word, result);
}

// An element of an array of numbers or vectors, from its first `[`.
const Value* element_of(Quick& q, const ArrayValue& array) {
    std::size_t element = 0;
    for (const int size : array.dimensions) {
        double index = 0;
        if (!accept(q, '[') || !number(q, Angles::compare, index) || !accept(q, ']')) return nullptr;
        const double whole = std::trunc(index + 1e-8);
        if (index < -1e-8 || whole >= size) return nullptr;
        element = element * static_cast<std::size_t>(size) + static_cast<std::size_t>(whole);
    }
    return &array.elements[element];
}

bool word_value(Quick& q, Symbol symbol, VectorValue& result) {
    const Value* value = lookup(q.p.in, symbol);
    if (!value) return is_keyword(symbol) && builtin(q, static_cast<Keyword>(symbol), result);
    if (const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value->data)) {
        value = element_of(q, **array);
        if (!value) return false;
    }
    if (const double* plain = std::get_if<double>(&value->data)) {
        result.v[0] = *plain;
        result.size = 1;
        result.is_color = false;
        return true;
    }
    const auto* held = std::get_if<VectorValue>(&value->data);
    if (held) result = *held;
    return held != nullptr;
}

bool primary(Quick& q, VectorValue& result) {
    if (at_end(q)) return false;
    const StoredToken& first = token(q);
    ++q.at;
    switch (kind_of(first)) {
    case TokenKind::number:
        result.v[0] = first.number;
        result.size = 1;
        result.is_color = false;
        break;
    case TokenKind::word:
        if (!word_value(q, first.name.symbol, result)) return false;
        break;
    case TokenKind::punctuation:
        if (first.name.symbol == '(') {
            if (!conditional(q, Angles::compare, result) || !accept(q, ')')) return false;
        } else if (first.name.symbol != '<' || !vector(q, result)) {
            return false;
        }
        break;
    default:
        return false;
    }
    while (accept(q, '.')) {
        if (at_end(q) || kind_of(token(q)) != TokenKind::word) return false;
        const int index = component_index(static_cast<Keyword>(token(q).name.symbol));
        if (index < 0 || result.size == 1 || index >= result.size) return false;
        result = scalar(result.v[index]);
        ++q.at;
    }
    return true;
}

bool unary(Quick& q, VectorValue& result) {
    if (at_end(q) || kind_of(token(q)) != TokenKind::punctuation) return primary(q, result);
    const Symbol sign = token(q).name.symbol;
    if (sign != '-' && sign != '+' && sign != '!') return primary(q, result);
    ++q.at;
    if (q.depth >= deepest) return false;
    ++q.depth;
    if (!unary(q, result)) return false;
    --q.depth;
    if (sign == '-')
        for (int i = 0; i < result.size; ++i) result.v[i] = -result.v[i];
    if (sign == '!')
        for (int i = 0; i < result.size; ++i) result.v[i] = !is_true(result.v[i]);
    return true;
}

Power power_here(const Quick& q, Angles angles) {
    if (at_end(q) || kind_of(token(q)) != TokenKind::punctuation) return none;
    return operator_power(token(q).name.symbol, angles);
}

bool binary(Quick& q, int minimum, Angles angles, VectorValue& left) {
    if (!unary(q, left)) return false;
    for (;;) {
        const Power power = power_here(q, angles);
        if (power == none || power < minimum) return true;
        const Symbol op = token(q).name.symbol;
        ++q.at;
        VectorValue right;
        if (!binary(q, power + 1, angles, right) || combine(op, left, right) != Fault::none) return false;
    }
}

bool conditional(Quick& q, Angles angles, VectorValue& result) {
    if (q.depth >= deepest) return false;
    ++q.depth;
    if (!binary(q, logical, angles, result)) return false;
    if (accept(q, '?')) {
        if (result.size != 1) return false;
        const bool chosen = is_true(result.v[0]);
        VectorValue yes, no;
        if (!conditional(q, angles, yes) || !accept(q, ':') || !conditional(q, angles, no)) return false;
        result = chosen ? yes : no;
    }
    --q.depth;
    return true;
}

// Where the expression's first token lies, also if the buffer holds it.
bool find_start(const Expander& in, std::uint32_t& start) {
    const TokenFrame& frame = in.frames.back();
    start = frame.position;
    if (!in.buffered) return true;
    if (start == 0) return false;
    const StoredToken& before = frame.tokens[--start];
    return in.buffer.span.source == frame.source && in.buffer.span.begin == before.begin &&
           in.buffer.kind == kind_of(before);
}

} // namespace

bool quick_expression(Parser& p, Angles angles, VectorValue& result) {
    Expander& in = p.in;
    if (in.frames.empty()) return false;
    std::uint32_t start = 0;
    if (!find_start(in, start)) return false;
    Quick q{p, in.frames.back(), start};
    const bool done = conditional(q, angles, result) && ends_here(in, in.frames.back(), q.at);
    const std::uint32_t taken = q.at - start;
    if (!done || in.used.tokens + taken > in.options.budgets.tokens) {
        for (auto was = q.streams.rbegin(); was != q.streams.rend(); ++was)
            in.random_streams[was->first] = was->second;
        return false;
    }
    in.frames.back().position = q.at;
    in.used.tokens += taken;
    in.tokens_taken += taken;
    in.buffered = false;
    return true;
}

} // namespace pnr
