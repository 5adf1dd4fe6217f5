// SPDX-License-Identifier: GPL-3.0-or-later
// Operands: literals, identifiers with subscripts and components, colours; and values that are no numbers:
// strings, arrays, blocks.
#include "parser/blocks.h"
#include "parser/color_space.h"
#include "parser/content.h"
#include "parser/expression.h"
#include "parser/function.h"
#include "parser/quick_expression.h"
#include "parser/spline.h"
#include "parser/suggest.h"

#include <fmt/format.h>

namespace pnr {

namespace {

[[noreturn]] void unknown_identifier(Parser& p, const Token& token) {
    SymbolEntry& entry = p.in.symbols[token.symbol];
    if (entry.poisoned) give_up(p, token); // reported where it was first met
    entry.poisoned = true;
    const std::string_view word = p.in.words.text(token.symbol);
    std::string message = is_keyword(token.symbol) ? fmt::format("`{}` is no value", word)
                                                   : fmt::format("`{}` is not declared", word);
    fail(p, token, std::move(message), help_for_unknown_name(p, token));
}

bool is_numeric(const Value& value) {
    return std::holds_alternative<double>(value.data) || std::holds_alternative<VectorValue>(value.data);
}

const Value* sample(const ArrayValue& array) {
    for (const Value& element : array.elements) {
        const auto* inner = std::get_if<std::shared_ptr<ArrayValue>>(&element.data);
        if (const Value* found = inner ? sample(**inner) : &element; found && found->data.index() != 0)
            return found;
    }
    return nullptr;
}

// The name of a function or spline with `(` behind it, the name being in the buffer.
bool is_call(Parser& p, const Value& value) {
    if (!std::holds_alternative<std::shared_ptr<const Function>>(value.data) &&
        !std::holds_alternative<std::shared_ptr<const Spline>>(value.data))
        return false;
    const TokenFrame& frame = p.in.frames.back();
    return frame.position < frame.end && is(frame.tokens[frame.position], '(');
}

// What the identifier that is next stands for; for an array with a subscript behind it: some element, for its
// type.
const Value* shown_value(Parser& p, const Token& token) {
    const Value* value = lookup(p.in, token.symbol);
    const auto* array = value ? std::get_if<std::shared_ptr<ArrayValue>>(&value->data) : nullptr;
    if (!array || !p.in.buffered) return value;
    const TokenFrame& frame = p.in.frames.back();
    if (frame.position == frame.end || !is(frame.tokens[frame.position], '[')) return value;
    const Value* element = sample(**array);
    return element ? element : value;
}

VectorValue take_component(Parser& p, const VectorValue& value) {
    next(p); // the dot
    const Token name = next(p);
    if (is(name, "gray"_kw)) return scalar(brightness(value.v));
    const int index = component_index(keyword_of(name));
    if (index < 0)
        fail(p, name, fmt::format("expected a component behind `.`, found {}", token_text(p, name)),
             "components are x y z t, u v, red green blue filter transmit gray");
    if (value.size == 1)
        fail(p, name, fmt::format("a number has no component `.{}`", token_text(p, name, false)));
    if (index >= value.size)
        fail(p, name,
             fmt::format("a vector of {} components has no `.{}`", value.size, token_text(p, name, false)));
    return scalar(value.v[index]);
}

VectorValue operand_from(Parser& p, const Value& value, const Token& name) {
    if (const double* number = std::get_if<double>(&value.data)) return scalar(*number);
    if (const VectorValue* vector = std::get_if<VectorValue>(&value.data)) return *vector;
    fail(p, name,
         fmt::format("a number or vector is needed here, `{}` is {}", token_text(p, name, false),
                     article_name(value)),
         std::holds_alternative<std::shared_ptr<ArrayValue>>(value.data)
             ? fmt::format("an element of it is {}[index]", token_text(p, name, false))
             : usage_of(value, token_text(p, name, false)));
}

VectorValue parse_parentheses(Parser& p) {
    const Token opener = next(p);
    const Nesting nesting(p, opener);
    VectorValue value;
    if (at_string(p))
        value = scalar(parse_condition(p));
    else
        value = parse_operand_expression(p, Angles::compare);
    if (!at(p, ')')) {
        const Token found = peek(p);
        fail(p, found, fmt::format("expected `)`, found {}", token_text(p, found)),
             is(found, ',') ? "a vector is written in < >: <0, 1, 0>" : "");
    }
    next(p);
    return value;
}

VectorValue parse_word(Parser& p) {
    const Token token = peek(p);
    const auto word = static_cast<Keyword>(token.symbol);
    if (lookup(p.in, token.symbol)) {
        const Value& value = take_variable(p);
        if (const auto* function = std::get_if<std::shared_ptr<const Function>>(&value.data))
            return call_function(p, token, std::shared_ptr<const Function>(*function));
        if (const auto* spline = std::get_if<std::shared_ptr<const Spline>>(&value.data))
            return call_spline(p, token, std::shared_ptr<const Spline>(*spline));
        return operand_from(p, value, token);
    }
    if (is_keyword(token.symbol)) {
        if (at_color(p)) return color_expression(p);
        if (is_number_builtin(word)) {
            const Nesting nesting(p, token);
            return call_number_builtin(p, next(p));
        }
        if (is_string_builtin(word)) fail(p, token, "a number is needed here, this is a string");
        if (is_reserved(token.symbol)) missing_value(p, token, "a number or vector");
    }
    next(p);
    unknown_identifier(p, token);
}

} // namespace

VectorValue vector_literal(Parser& p) {
    const Token opener = next(p);
    const Nesting nesting(p, opener);
    VectorValue value;
    value.size = 0;
    while (!at(p, '>')) {
        const Token first = peek(p);
        if (value.size == 5) fail(p, first, "a vector has at most 5 components");
        value.v[value.size++] = scalar_of(p, parse_operand_expression(p, Angles::bracket), first);
        if (!accept(p, ',') && !at(p, '>') && !at_expression(p)) { // POV-Ray takes <0 1 0>, too
            const Token found = peek(p);
            fail(p, found, fmt::format("expected `,` or `>` in the vector, found {}", token_text(p, found)));
        }
    }
    next(p);
    if (value.size < 2) fail(p, opener, "a vector has at least 2 components");
    return value;
}

VectorValue parse_primary(Parser& p) {
    const Token& token = peek(p);
    VectorValue value;
    if (token.kind == TokenKind::number) {
        return scalar(next(p).value);
    } else if (token.kind == TokenKind::word) {
        value = parse_word(p);
    } else if (is(token, '<')) {
        value = vector_literal(p);
    } else if (is(token, '(')) {
        value = parse_parentheses(p);
    } else {
        missing_value(p, Token(token), "a number or vector");
    }
    while (is(peek_operator(p), '.')) value = take_component(p, value);
    return value;
}

// ---- identifiers
// ----------------------------------------------------------------------------------------------------

namespace {

// Looks at the token as it stands: were the frame's end passed to find a `[`, a macro's local array would be
// gone.
bool at_subscript(const Parser& p) {
    if (p.in.buffered) return is(p.in.buffer, '[');
    const TokenFrame& frame = p.in.frames.back();
    return frame.position < frame.end && is(frame.tokens[frame.position], '[');
}

} // namespace

std::pair<std::shared_ptr<ArrayValue>, std::size_t>
take_subscripts(Parser& p, const Token& name, const std::shared_ptr<ArrayValue>& array) {
    std::size_t element = 0;
    for (std::size_t d = 0; d < array->dimensions.size(); ++d) {
        if (!at_subscript(p))
            fail(p, name,
                 fmt::format("`{}` has {} dimension{}: {} needed behind it", token_text(p, name, false),
                             array->dimensions.size(), array->dimensions.size() == 1 ? "" : "s",
                             array->dimensions.size() == 1 ? "one `[index]` is" : "as many `[index]` are"));
        next(p);
        const Token first = peek(p);
        const double index = scalar_of(p, parse_operand_expression(p, Angles::compare), first);
        const int size = array->dimensions[d];
        // POV-Ray truncates, after a nudge for sums like 0.1 * 30
        const double whole = std::trunc(index + 1e-8);
        if (index < -1e-8 || whole >= size)
            fail(p, first,
                 fmt::format("index {} is outside of `{}`, which goes from 0 to {}", index,
                             token_text(p, name, false), size - 1));
        element = element * static_cast<std::size_t>(size) + static_cast<std::size_t>(whole);
        expect(p, ']', "to close the index");
    }
    return {array, element};
}

const Value& take_variable(Parser& p) {
    const Token name = next(p);
    const Value* value = lookup(p.in, name.symbol);
    if (!value) unknown_identifier(p, name);
    const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value->data);
    if (!array || !at_subscript(p)) return *value;
    std::shared_ptr<ArrayValue> inside = *array;
    for (;;) {
        const auto [elements, element] = take_subscripts(p, name, inside);
        const Value& found = elements->elements[element];
        if (found.data.index() == 0)
            fail(p, name, fmt::format("this element of `{}` has no value yet", token_text(p, name, false)));
        const auto* deeper = std::get_if<std::shared_ptr<ArrayValue>>(&found.data);
        if (!deeper || !at_subscript(p)) return found;
        inside = *deeper;
    }
}

bool at_expression(Parser& p) {
    const Token& token = peek(p);
    if (token.kind == TokenKind::number) return true;
    if (token.kind == TokenKind::punctuation)
        return token.symbol == '<' || token.symbol == '(' || token.symbol == '-' || token.symbol == '+' ||
               token.symbol == '!';
    if (token.kind != TokenKind::word) return false;
    if (const Value* value = shown_value(p, token)) return is_numeric(*value) || is_call(p, *value);
    return is_keyword(token.symbol) && (is_number_builtin(static_cast<Keyword>(token.symbol)) || at_color(p));
}

// ---- colours
// --------------------------------------------------------------------------------------------------------

namespace {

// `rgb EXPR` and its kin: the components the expression gives, in the places the word names.
VectorValue color_components(Parser& p, Keyword word) {
    VectorValue value = parse_operand_expression(p, Angles::bracket);
    const bool is_srgb = word == "srgb"_kw || word == "srgbf"_kw || word == "srgbt"_kw || word == "srgbft"_kw;
    const bool has_filter =
        word == "rgbf"_kw || word == "rgbft"_kw || word == "srgbf"_kw || word == "srgbft"_kw;
    const bool has_transmit =
        word == "rgbt"_kw || word == "rgbft"_kw || word == "srgbt"_kw || word == "srgbft"_kw;
    if (value.size == 1) promote(value, 3 + has_filter + has_transmit);
    promote(value, 5);
    VectorValue color = value;
    color.is_color = true;
    if (!has_filter && has_transmit) { // the fourth number is transmit, even a colour's filter
        color.v[3] = 0;
        color.v[4] = value.v[3];
    }
    if (is_srgb)
        for (int i = 0; i < 3; ++i)
            color.v[i] = to_working(srgb_to_linear(color.v[i]), p.scene.assumed_gamma);
    return color;
}

bool is_color_word(Keyword word) {
    switch (word) {
    case "rgb"_kw:
    case "rgbf"_kw:
    case "rgbt"_kw:
    case "rgbft"_kw:
    case "srgb"_kw:
    case "srgbf"_kw:
    case "srgbt"_kw:
    case "srgbft"_kw:
        return true;
    default:
        return false;
    }
}

bool is_channel_word(Keyword word) {
    return word == "red"_kw || word == "green"_kw || word == "blue"_kw || word == "filter"_kw ||
           word == "transmit"_kw || word == "alpha"_kw;
}

} // namespace

bool at_color(Parser& p) {
    const Token& token = peek(p);
    if (token.kind != TokenKind::word || !is_reserved(token.symbol)) return false;
    const auto word = static_cast<Keyword>(token.symbol);
    return word == "color"_kw || is_color_word(word) || is_channel_word(word);
}

VectorValue color_expression(Parser& p) {
    const Token first = peek(p);
    const Nesting nesting(p, first);
    accept(p, "color"_kw);
    const Token& token = peek(p);
    VectorValue color{{0, 0, 0, 0, 0}, 5, true};
    if (token.kind == TokenKind::word && is_color_word(static_cast<Keyword>(token.symbol))) {
        const auto word = static_cast<Keyword>(next(p).symbol);
        color = color_components(p, word);
    } else if (!(token.kind == TokenKind::word && is_channel_word(static_cast<Keyword>(token.symbol)))) {
        color = parse_operand_expression(p, Angles::bracket);
        if (color.size == 1 && color.v[0] != 0)
            warn(p, first, "one number as a colour sets filter and transmit too",
                 "`rgb` before it leaves them 0");
        promote(color, 5);
        color.is_color = true;
    }
    parse_channels(p, color);
    return color;
}

void parse_channels(Parser& p, VectorValue& color) {
    for (;;) {
        const Token& channel = peek_operator(p);
        if (channel.kind != TokenKind::word || !is_channel_word(static_cast<Keyword>(channel.symbol))) return;
        const auto word = static_cast<Keyword>(next(p).symbol);
        const int index = word == "alpha"_kw ? 3 : component_index(word);
        promote(color, 5);
        color.v[index] = parse_float(p);
    }
}

// ---- strings
// --------------------------------------------------------------------------------------------------------

bool at_string(Parser& p) {
    const Token& token = peek(p);
    if (token.kind == TokenKind::string) return true;
    if (token.kind != TokenKind::word) return false;
    if (const Value* value = shown_value(p, token)) return std::holds_alternative<std::string>(value->data);
    return is_keyword(token.symbol) && is_string_builtin(static_cast<Keyword>(token.symbol));
}

namespace {

std::string string_value(Parser& p) {
    const Token token = peek(p);
    if (token.kind == TokenKind::string) {
        next(p);
        return p.in.strings[token.symbol];
    }
    if (token.kind == TokenKind::word) {
        if (lookup(p.in, token.symbol)) {
            const Value& value = take_variable(p);
            if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
            fail(p, token,
                 fmt::format("a string is needed here, `{}` is {}", token_text(p, token, false),
                             article_name(value)));
        }
        if (is_keyword(token.symbol) && is_string_builtin(static_cast<Keyword>(token.symbol))) {
            const Nesting nesting(p, token);
            return call_string_builtin(p, next(p));
        }
        if (!is_keyword(token.symbol)) {
            next(p);
            unknown_identifier(p, token);
        }
    }
    fail(p, token, fmt::format("expected a string, found {}", token_text(p, token)),
         "strings stand in quotes: \"text\"; str(number, 0, 3) makes one of a number");
}

} // namespace

std::string parse_string(Parser& p) {
    std::string text = string_value(p);
    tell_text(p.in, text);
    return text;
}

// ---- values of any kind
// ---------------------------------------------------------------------------------------------

namespace {

Value value_of(Parser& p, Angles angles);

void fill_array(Parser& p, ArrayValue& array, std::size_t dimension, std::size_t& element,
                const Token& name) {
    open_block(p, "the array's values");
    const std::size_t level = open_blocks(p);
    int count = 0;
    try {
        while (!close_block(p)) {
            const Token first = peek(p);
            if (++count > array.dimensions[dimension])
                fail(p, first,
                     fmt::format("this dimension of the array has only {} elements",
                                 array.dimensions[dimension]));
            if (dimension + 1 < array.dimensions.size())
                fill_array(p, array, dimension + 1, element, name);
            else
                array.elements[element++] = stored_value(p, name, value_of(p, Angles::bracket));
            if (!accept(p, ',')) accept(p, ';');
        }
    } catch (const ParseFailure&) {
        recover_block(p, level);
        throw;
    }
    if (count < array.dimensions[dimension])
        fail(p, name,
             fmt::format("this dimension of the array has {} elements, {} are given",
                         array.dimensions[dimension], count));
}

} // namespace

Value array_value(Parser& p) {
    const Token name = next(p);
    std::vector<int> dimensions;
    double count = 1;
    while (is(peek_operator(p), '[')) {
        next(p);
        const Token first = peek(p);
        const double size =
            std::trunc(scalar_of(p, parse_operand_expression(p, Angles::compare), first) + 1e-8);
        if (size < 1) fail(p, first, "an array needs at least one element");
        count *= size;
        if (count > static_cast<double>(p.in.options.budgets.array_elements))
            stop_at_limit(p, first, &Budgets::array_elements,
                 fmt::format("the array has more than {} elements", p.in.options.budgets.array_elements));
        expect(p, ']', "to close the size");
        dimensions.push_back(static_cast<int>(size));
        if (dimensions.size() > 15) fail(p, first, "an array has at most 15 dimensions");
    }
    if (dimensions.empty()) fail(p, name, "expected the size, `array[n]`");
    const std::shared_ptr<ArrayValue> array = make_array(p, name, std::move(dimensions));
    if (is(peek_operator(p), '{')) {
        const Nesting nesting(p, name);
        std::size_t element = 0;
        fill_array(p, *array, 0, element, name);
    }
    return Value{array};
}

namespace {

// Between the values of an array the commas may be missing: there `<` starts the next one.
Value value_of(Parser& p, Angles angles) {
    if (VectorValue quick; quick_expression(p, angles, quick))
        return quick.size == 1 ? Value{quick.v[0]} : Value{quick};
    const Token token = peek(p);
    const Nesting nesting(p, token);
    if (token.kind == TokenKind::string) return Value{parse_string(p)};
    if (token.kind == TokenKind::word) {
        if (const Value* value = shown_value(p, token)) {
            if (!is_numeric(*value) && !is_call(p, *value)) return take_variable(p);
        } else if (is(token, "function"_kw)) {
            const Telling world(p.in, Listener::world);
            return Value{parse_function(p)};
        } else if (is(token, "spline"_kw)) {
            const Telling world(p.in, Listener::world);
            next(p);
            return Value{parse_spline(p)};
        } else if (is(token, "array"_kw)) {
            return array_value(p);
        } else if (at_string(p)) {
            return Value{parse_string(p)};
        } else if (!at_expression(p)) {
            // Whoever asks for it: others may use it later.
            const Telling world(p.in, Listener::world);
            if (auto block_value = parse_declared_block(p))
                return Value{make_declared(p, token, std::move(*block_value))};
        }
    }
    VectorValue number = parse_operand_expression(p, angles);
    if (number.size == 1) return Value{number.v[0]};
    return Value{number};
}

} // namespace

Value parse_value(Parser& p) { return value_of(p, Angles::compare); }

} // namespace pnr
