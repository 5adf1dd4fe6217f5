// SPDX-License-Identifier: GPL-3.0-or-later
// Compiling a function's text to its program.
#include "parser/builtins.h"
#include "parser/content.h"
#include "parser/function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

using Kind = Instruction::Kind;

struct Compiler {
    Parser& p;
    Function& function;
    std::vector<std::pair<Symbol, int>>
        names;     // and the numbers of the arguments that they mean; the last counts
    int depth = 0; // numbers on the stack here
};

void emit(Compiler& c, Instruction step, int change) {
    c.function.code.push_back(step);
    c.function.cost += 1;
    c.depth += change;
    c.function.stack = std::max(c.function.stack, c.depth);
}

void emit(Compiler& c, Kind kind, int change) { emit(c, Instruction{.kind = kind}, change); }

int argument_number(const Compiler& c, Symbol symbol) {
    const auto found = std::find_if(c.names.rbegin(), c.names.rend(),
                                    [&](const auto& name) { return name.first == symbol; });
    return found == c.names.rend() ? -1 : found->second;
}

void compile(Compiler& c, int minimum);

using Unary = double (*)(double);

Unary unary_function(Keyword word) {
    switch (word) {
    case "acos"_kw:
        return std::acos;
    case "acosh"_kw:
        return std::acosh;
    case "asin"_kw:
        return std::asin;
    case "atanh"_kw:
        return std::atanh;
    case "ln"_kw:
        return std::log;
    case "log"_kw:
        return std::log10;
    case "sqrt"_kw:
        return std::sqrt;
    case "sqr"_kw:
        return [](double v) { return v * v; };
    default:
        return total_function(word);
    }
}

// Kinds of two operands that are written as functions; constant: none.
Kind binary_function(Keyword word) {
    switch (word) {
    case "atan2"_kw:
        return Kind::arc;
    case "mod"_kw:
        return Kind::modulo;
    case "div"_kw:
        return Kind::quotient;
    case "pow"_kw:
        return Kind::power;
    case "min"_kw:
        return Kind::minimum;
    case "max"_kw:
        return Kind::maximum;
    default:
        return Kind::constant;
    }
}

void compile_select(Compiler& c, const Token& name) {
    compile(c, 1);
    comma_argument(c.p, name);
    compile(c, 1);
    comma_argument(c.p, name);
    compile(c, 1);
    if (accept(c.p, ',')) {
        compile(c, 1);
        emit(c, Kind::select, -3);
    } else {
        emit(c, Kind::select_of_three, -2);
    }
}

void compile_builtin(Compiler& c, const Token& name) {
    const auto word = static_cast<Keyword>(name.symbol);
    open_arguments(c.p, name);
    if (word == "select"_kw) {
        compile_select(c, name);
    } else {
        compile(c, 1);
        const Unary unary = unary_function(word);
        if (unary) {
            emit(c, Instruction{.kind = Kind::unary, .index = static_cast<std::uint32_t>(word), .function = unary}, 0);
        } else {
            const Kind kind = binary_function(word);
            const bool many = kind == Kind::minimum || kind == Kind::maximum;
            if (!many) comma_argument(c.p, name);
            while (!many || accept(c.p, ',')) {
                compile(c, 1);
                emit(c, kind, -1);
                if (!many) break;
            }
        }
    }
    close_arguments(c.p, name);
}

// `.red`, `.x`: a component of a vector; its number.
std::uint8_t compile_component(Compiler& c, const Function& callee, const Token& name) {
    if (!is(peek(c.p), '.')) {
        if (callee.results > 1)
            fail(c.p, name,
                 fmt::format("`{}` gives a vector; take one component with .x, .y, .z, .red ...",
                             token_text(c.p, name, false)));
        return 0;
    }
    next(c.p);
    const Token component = next(c.p);
    if (is(component, "gray"_kw) && (callee.results == 5 || !callee.unsupported.empty()))
        return Instruction::gray_component;
    const int number = component_index(keyword_of(component));
    if (number < 0 || (number >= callee.results && callee.unsupported.empty()))
        fail(c.p, component,
             fmt::format("`{}` has no component `.{}`", token_text(c.p, name, false),
                         token_text(c.p, component, false)));
    return static_cast<std::uint8_t>(number);
}

// The function being compiled calls another one.
void deepen(Compiler& c, const Function& callee, const Token& name) {
    c.function.depth = std::max(c.function.depth, callee.depth + 1);
    check_depth(c.p, name, c.function.depth);
}

// How many terms a series has whose bounds are given by this code; a guess where they are no plain numbers.
double known_terms(std::span<const Instruction> bounds) {
    constexpr double guess = 10, most = 1e6;
    if (bounds.size() != 2 || bounds[0].kind != Kind::constant || bounds[1].kind != Kind::constant) return guess;
    return std::clamp(bounds[1].value - bounds[0].value + 1, 1.0, most);
}

void compile_call(Compiler& c, const std::shared_ptr<const Function>& callee, const Token& name) {
    next(c.p);
    tell_thing(c.p.in, callee.get());
    if (!callee->unsupported.empty()) c.function.unsupported = callee->unsupported;
    open_arguments(c.p, name);
    int count = 0;
    do {
        compile(c, 1);
        ++count;
    } while (accept(c.p, ','));
    close_arguments(c.p, name);
    if (count != callee->parameters && callee->unsupported.empty())
        fail(c.p, name,
             fmt::format("`{}` takes {} arguments, {} are given", token_text(c.p, name, false),
                         callee->parameters, count));
    c.function.calls.push_back(callee);
    c.function.cost += callee->cost;
    deepen(c, *callee, name);
    c.function.stack = std::max(c.function.stack, c.depth + callee->stack + 1);
    Instruction step{.kind = Kind::call, .index = static_cast<std::uint32_t>(c.function.calls.size() - 1)};
    // A function that is nothing but an internal one needs no frame of its own.
    const bool forwards = callee->code.size() == static_cast<std::size_t>(callee->parameters) + 1 &&
                          callee->code.back().kind == Kind::internal;
    if (forwards) step = callee->code.back();
    step.component = compile_component(c, *callee, name);
    emit(c, step, 1 - count);
}

// sum(i, first, last, term): the term becomes a function of this one's parameters and i.
void compile_series(Compiler& c, const Token& name) {
    const bool is_sum = is(name, "sum"_kw);
    open_arguments(c.p, name);
    const Token variable = next(c.p);
    if (variable.kind != TokenKind::word)
        fail(c.p, variable,
             fmt::format("{} needs the name of its variable first", token_text(c.p, name, false)));
    comma_argument(c.p, name);
    const std::size_t bounds = c.function.code.size();
    compile(c, 1);
    comma_argument(c.p, name);
    compile(c, 1);
    comma_argument(c.p, name);
    const double terms = known_terms(std::span(c.function.code).subspan(bounds));
    auto term = std::make_shared<Function>();
    term->parameters = c.function.parameters + 1;
    Compiler inner{c.p, *term, c.names, 0};
    inner.names.emplace_back(variable.symbol, c.function.parameters);
    compile(inner, 1);
    close_arguments(c.p, name);
    c.function.calls.push_back(term);
    c.function.cost += terms * term->cost;
    deepen(c, *term, name);
    c.function.stack = std::max(c.function.stack, c.depth + term->parameters + term->stack + 1);
    if (!term->unsupported.empty()) c.function.unsupported = term->unsupported;
    emit(c,
         Instruction{.kind = is_sum ? Kind::sum : Kind::product,
                     .index = static_cast<std::uint32_t>(c.function.calls.size() - 1)},
         -1);
}

void compile_primary(Compiler& c) {
    const Token token = peek(c.p);
    const Nesting nesting(c.p, token);
    if (token.kind == TokenKind::word) {
        const int argument = argument_number(c, token.symbol);
        if (argument >= 0) {
            next(c.p);
            emit(c, Instruction{.kind = Kind::argument, .index = static_cast<std::uint32_t>(argument)}, 1);
            return;
        }
        if (const Value* value = lookup(c.p.in, token.symbol)) {
            if (const auto* callee = std::get_if<std::shared_ptr<const Function>>(&value->data))
                return compile_call(c, std::shared_ptr<const Function>(*callee), token);
        } else if (is_keyword(token.symbol)) {
            const auto word = static_cast<Keyword>(token.symbol);
            if (word == "sum"_kw || word == "prod"_kw) return compile_series(c, next(c.p));
            if (word == "select"_kw || unary_function(word) || binary_function(word) != Kind::constant)
                return compile_builtin(c, next(c.p));
        }
    }
    if (is(token, '(')) {
        next(c.p);
        compile(c, 1);
        expect(c.p, ')', "to close the parenthesis");
        return;
    }
    const double value = scalar_of(c.p, parse_primary(c.p), token);
    tell(c.p.in, value);
    emit(c, Instruction{.value = value}, 1);
}

void compile_unary(Compiler& c) {
    const Token token = peek(c.p);
    if (is(token, '-') || is(token, '+') || is(token, '!')) {
        const Nesting nesting(c.p, token);
        next(c.p);
        compile(c, 5); // below `^`: -x^2 is -(x^2)
        if (is(token, '-')) emit(c, Kind::negate, 0);
        if (is(token, '!')) emit(c, Kind::invert, 0);
        return;
    }
    compile_primary(c);
}

struct Operator {
    int power = 0; // of binding; 0: no operator
    Kind kind = Kind::constant;
};

Operator operator_of(const Token& token) {
    if (token.kind != TokenKind::punctuation) return {};
    switch (token.symbol) {
    case '&':
        return {1, Kind::both};
    case '|':
        return {1, Kind::either};
    case '<':
        return {2, Kind::less};
    case '>':
        return {2, Kind::greater};
    case '=':
        return {2, Kind::equal};
    case '<' | '=' << 8:
        return {2, Kind::less_equal};
    case '>' | '=' << 8:
        return {2, Kind::greater_equal};
    case '!' | '=' << 8:
        return {2, Kind::unequal};
    case '+':
        return {3, Kind::add};
    case '-':
        return {3, Kind::subtract};
    case '*':
        return {4, Kind::multiply};
    case '/':
        return {4, Kind::divide};
    case '^':
        return {5, Kind::power};
    default:
        return {};
    }
}

void compile(Compiler& c, int minimum) {
    compile_unary(c);
    for (;;) {
        const Operator op = operator_of(peek(c.p));
        if (op.power == 0 || op.power < minimum) return;
        next(c.p);
        compile(c, op.power + 1);
        emit(c, op.kind, -1);
    }
}

// The names of the parameters, and the number of arguments.
int parameter_names(Parser& p, std::vector<std::pair<Symbol, int>>& names) {
    if (!accept(p, '(')) {
        int argument = 0;
        for (const Keyword word : {"x"_kw, "y"_kw, "z"_kw, "u"_kw, "v"_kw})
            names.emplace_back(static_cast<Symbol>(word), argument++ % 3);
        return 3;
    }
    while (!accept(p, ')')) {
        const Token name = next(p);
        if (name.kind != TokenKind::word)
            fail(p, name, fmt::format("expected the name of a parameter, found {}", token_text(p, name)));
        names.emplace_back(name.symbol, static_cast<int>(names.size()));
        if (names.size() > 56) fail(p, name, "a function has at most 56 parameters");
        if (!at(p, ')')) expect(p, ',', "between the parameters");
    }
    if (names.empty()) fail(p, peek(p), "a function needs at least one parameter");
    return static_cast<int>(names.size());
}

constexpr double most_cost = 1e7; // instructions of one call

} // namespace

std::shared_ptr<const Function> parse_function(Parser& p) {
    const Token word = next(p);
    return parse_function_body(p, word);
}

std::shared_ptr<const Function> parse_function_body(Parser& p, const Token& word) {
    auto function = std::make_shared<Function>();
    Compiler compiler{p, *function, {}, 0};
    function->parameters = parameter_names(p, compiler.names);
    open_block(p, "the function");
    const std::size_t level = open_blocks(p);
    try {
        if (!parse_native(p, *function)) compile(compiler, 1);
        if (!close_block(p)) {
            const Token found = peek(p);
            fail(p, found,
                 fmt::format("expected `}}` behind the function's expression, found {}",
                             token_text(p, found)));
        }
    } catch (const ParseFailure&) {
        recover_block(p, level);
        throw;
    }
    if (function->cost > most_cost) fail(p, word, "this function calls others too often to be evaluated");
    remember_told(p.in, function.get());
    return function;
}

} // namespace pnr
