// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/function.h"

#include "parser/builtins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

using Kind = Instruction::Kind;

constexpr double equal_within = 1e-10; // as in expressions

double apply(Kind kind, double a, double b) {
    switch (kind) {
    case Kind::add:
        return a + b;
    case Kind::subtract:
        return a - b;
    case Kind::multiply:
        return a * b;
    case Kind::divide:
        return a / b;
    case Kind::power:
        return std::pow(a, b);
    case Kind::modulo:
        return std::fmod(a, b);
    case Kind::less:
        return a < b;
    case Kind::greater:
        return a > b;
    case Kind::equal:
        return std::abs(a - b) < equal_within;
    case Kind::less_equal:
        return a <= b;
    case Kind::greater_equal:
        return a >= b;
    case Kind::unequal:
        return std::abs(a - b) >= equal_within;
    case Kind::both:
        return is_true(a) && is_true(b);
    case Kind::either:
        return is_true(a) || is_true(b);
    case Kind::minimum:
        return std::min(a, b);
    case Kind::maximum:
        return std::max(a, b);
    default:
        return a == 0 && b == 0 ? 0 : std::atan2(a, b);
    }
}

double run(const Function& function, const double* arguments, double* stack) {
    double* top = stack; // one behind the last number
    for (const Instruction& step : function.code) {
        switch (step.kind) {
        case Kind::constant:
            *top++ = step.value;
            break;
        case Kind::argument:
            *top++ = arguments[step.index];
            break;
        case Kind::negate:
            top[-1] = -top[-1];
            break;
        case Kind::invert:
            top[-1] = !is_true(top[-1]);
            break;
        case Kind::unary:
            top[-1] = step.function(top[-1]);
            break;
        case Kind::select: {
            top -= 3;
            const double choice = top[-1];
            top[-1] = choice < 0 ? top[0] : choice == 0 ? top[1] : top[2];
            break;
        }
        case Kind::select_of_three: // b where a < 0, else c
            top -= 2;
            top[-1] = top[-1] < 0 ? top[0] : top[1];
            break;
        case Kind::call: {
            const Function& callee = *function.calls[step.index];
            top -= callee.parameters;
            *top = run(callee, top, top + callee.parameters);
            ++top;
            break;
        }
        default:
            --top;
            top[-1] = apply(step.kind, top[-1], top[0]);
        }
    }
    return top[-1];
}

// ---- compiling
// ------------------------------------------------------------------------------------------------------

struct Compiler {
    Parser& p;
    Function& function;
    std::vector<Symbol> names;
    int depth = 0; // numbers on the stack here
};

void emit(Compiler& c, Instruction step, int change) {
    c.function.code.push_back(step);
    c.function.cost += 1;
    c.depth += change;
    c.function.stack = std::max(c.function.stack, c.depth);
}

void emit(Compiler& c, Kind kind, int change) { emit(c, Instruction{kind, 0, 0, nullptr}, change); }

int argument_number(const Compiler& c, Symbol symbol) {
    const auto found = std::find(c.names.begin(), c.names.end(), symbol);
    return found == c.names.end() ? -1 : static_cast<int>(found - c.names.begin()) % c.function.parameters;
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
            emit(c, Instruction{Kind::unary, 0, 0, unary}, 0);
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

void compile_call(Compiler& c, const std::shared_ptr<const Function>& callee, const Token& name) {
    next(c.p);
    if (!callee->unsupported.empty()) {
        c.function.unsupported = callee->unsupported;
    }
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
    c.function.stack = std::max(c.function.stack, c.depth + callee->stack + 1);
    emit(c, Instruction{Kind::call, static_cast<std::uint32_t>(c.function.calls.size() - 1), 0, nullptr},
         1 - count);
    // `.red`, `.x`: of a pigment's, spline's or transform's function; what it gives is unsupported anyway
    if (!callee->unsupported.empty() && accept(c.p, '.')) next(c.p);
}

void compile_primary(Compiler& c) {
    const Token token = peek(c.p);
    const Nesting nesting(c.p, token);
    if (token.kind == TokenKind::word) {
        const int argument = argument_number(c, token.symbol);
        if (argument >= 0) {
            next(c.p);
            emit(c, Instruction{Kind::argument, static_cast<std::uint32_t>(argument), 0, nullptr}, 1);
            return;
        }
        if (const Value* value = lookup(c.p.in, token.symbol)) {
            if (const auto* callee = std::get_if<std::shared_ptr<const Function>>(&value->data))
                return compile_call(c, std::shared_ptr<const Function>(*callee), token);
        } else if (is_keyword(token.symbol)) {
            const auto word = static_cast<Keyword>(token.symbol);
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
    emit(c, Instruction{Kind::constant, 0, value, nullptr}, 1);
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

// What stands in place of an expression in functions of other kinds, up to the function's `}`.
void skip_body(Parser& p) {
    const std::int64_t depth = p.in.brace_depth;
    while (!at_end(p) && !(p.in.brace_depth == depth && at(p, '}'))) next(p);
}

bool is_other_kind(const Token& token) {
    switch (keyword_of(token)) {
    case "internal"_kw:
    case "pigment"_kw:
    case "pattern"_kw:
    case "spline"_kw:
    case "transform"_kw:
        return true;
    default:
        return false;
    }
}

std::vector<Symbol> parameter_names(Parser& p) {
    std::vector<Symbol> names;
    if (!accept(p, '(')) {
        for (const Keyword word : {"x"_kw, "y"_kw, "z"_kw, "u"_kw, "v"_kw})
            names.push_back(static_cast<Symbol>(word));
        return names;
    }
    while (!accept(p, ')')) {
        const Token name = next(p);
        if (name.kind != TokenKind::word)
            fail(p, name, fmt::format("expected the name of a parameter, found {}", token_text(p, name)));
        names.push_back(name.symbol);
        if (names.size() > 56) fail(p, name, "a function has at most 56 parameters");
        if (!at(p, ')')) expect(p, ',', "between the parameters");
    }
    if (names.empty()) fail(p, peek(p), "a function needs at least one parameter");
    return names;
}

constexpr double most_cost = 1e7; // instructions of one call

} // namespace

double evaluate(const Function& function, std::span<const double> arguments) {
    std::vector<double> stack(static_cast<std::size_t>(function.stack) + 1);
    return run(function, arguments.data(), stack.data());
}

ScalarField field_of(std::shared_ptr<const Function> function) {
    return [function = std::move(function)](Vec3 p) {
        const std::array<double, 3> arguments{p.x, p.y, p.z};
        return evaluate(*function, std::span(arguments).first(static_cast<std::size_t>(function->parameters)));
    };
}

std::shared_ptr<const Function> parse_function(Parser& p) {
    const Token word = next(p);
    auto function = std::make_shared<Function>();
    const bool named = at(p, '(');
    Compiler compiler{p, *function, parameter_names(p), 0};
    function->parameters = named ? static_cast<int>(compiler.names.size()) : 3;
    open_block(p, "the function");
    const std::size_t level = open_blocks(p);
    try {
        const Token first = peek(p);
        if (is_other_kind(first)) {
            function->unsupported = fmt::format("{} functions", token_text(p, first, false));
            skip_body(p);
        } else {
            compile(compiler, 1);
        }
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
    return function;
}

double call_function(Parser& p, const Token& name, const std::shared_ptr<const Function>& function) {
    const Nesting nesting(p, name);
    open_arguments(p, name);
    std::vector<double> arguments;
    do {
        const Token first = peek(p);
        const VectorValue value = parse_operand_expression(p, Angles::compare);
        for (int i = 0; i < value.size; ++i) arguments.push_back(value.v[i]); // a vector is its components
        if (arguments.size() > 64) fail(p, first, "too many arguments");
    } while (accept(p, ','));
    close_arguments(p, name);
    if (!function->unsupported.empty())
        fail(p, name, fmt::format("{} cannot be evaluated here", function->unsupported));
    if (static_cast<int>(arguments.size()) != function->parameters)
        fail(p, name,
             fmt::format("`{}` takes {} arguments, {} are given", token_text(p, name, false),
                         function->parameters, arguments.size()));
    p.in.used.tokens += static_cast<std::int64_t>(function->cost / 10); // evaluation is work, too
    const double result = evaluate(*function, arguments);
    if (!std::isfinite(result))
        fail(p, name, fmt::format("`{}` has no finite value here", token_text(p, name, false)));
    return result;
}

} // namespace pnr
