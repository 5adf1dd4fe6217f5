// SPDX-License-Identifier: GPL-3.0-or-later
// Running functions, and calling them from expressions.
#include "parser/function.h"

#include "core/internal_functions.h"
#include "parser/builtins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

using Kind = Instruction::Kind;

constexpr std::size_t most_results = 5;
constexpr std::int64_t most_terms = 1'000'000; // of sum() and prod()

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
    case Kind::quotient:
        return std::trunc(a / b);
    case Kind::less:
        return a < b;
    case Kind::greater:
        return a > b;
    case Kind::equal:
        return a == b; // exactly, unlike in expressions
    case Kind::less_equal:
        return a <= b;
    case Kind::greater_equal:
        return a >= b;
    case Kind::unequal:
        return a != b;
    case Kind::both:
        return a != 0 && b != 0;
    case Kind::either:
        return a != 0 || b != 0;
    case Kind::minimum:
        return std::min(a, b);
    case Kind::maximum:
        return std::max(a, b);
    default:
        return a == 0 && b == 0 ? 0 : std::atan2(a, b);
    }
}

double run(const Function& function, const double* arguments, double* stack, std::int64_t& terms);

double call(const Function& callee, std::uint8_t component, const double* arguments, double* stack,
            std::int64_t& terms) {
    if (!callee.native) return run(callee, arguments, stack, terms);
    double results[most_results] = {};
    callee.native(arguments, results);
    if (component == Instruction::gray_component) return brightness(results);
    return results[component];
}

// sum(i, first, last, term) and prod: `term` has this function's parameters and then i.
double run_series(const Function& term, bool is_sum, const double* arguments, double first, double last,
                  double* stack, std::int64_t& terms) {
    std::copy_n(arguments, term.parameters - 1, stack);
    double result = is_sum ? 0 : 1;
    for (double i = first; i <= last + 1e-10; i += 1) {
        if (--terms < 0) return std::numeric_limits<double>::quiet_NaN();
        stack[term.parameters - 1] = i;
        const double value = call(term, 0, stack, stack + term.parameters, terms);
        result = is_sum ? result + value : result * value;
    }
    return result;
}

double run(const Function& function, const double* arguments, double* stack, std::int64_t& terms) {
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
            top[-1] = top[-1] == 0;
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
            *top = call(callee, step.component, top, top + callee.parameters, terms);
            ++top;
            break;
        }
        case Kind::internal: {
            const InternalFunction& internal = internal_functions()[step.index];
            top -= internal.parameters;
            *top = internal.evaluate(top);
            ++top;
            break;
        }
        case Kind::sum:
        case Kind::product:
            --top;
            top[-1] = run_series(*function.calls[step.index], step.kind == Kind::sum, arguments, top[-1],
                                 top[0], top, terms);
            break;
        default:
            --top;
            top[-1] = apply(step.kind, top[-1], top[0]);
        }
    }
    return top[-1];
}

} // namespace

double evaluate(const Function& function, std::span<const double> arguments, std::int64_t& terms) {
    constexpr int usual = 64;
    if (function.stack < usual) {
        std::array<double, usual> stack;
        return call(function, 0, arguments.data(), stack.data(), terms);
    }
    std::vector<double> stack(static_cast<std::size_t>(function.stack) + 1);
    return call(function, 0, arguments.data(), stack.data(), terms);
}

double evaluate(const Function& function, std::span<const double> arguments) {
    std::int64_t terms = most_terms;
    return evaluate(function, arguments, terms);
}

double FunctionField::operator()(Vec3 p) const {
    const std::array<double, 3> arguments{p.x, p.y, p.z};
    return evaluate(*function, std::span(arguments).first(static_cast<std::size_t>(function->parameters)));
}

void charge_calls(Parser& p, const Token& at, const Function& function, double calls) {
    constexpr double instructions = 10; // in the time of a token
    p.in.used.tokens += static_cast<std::int64_t>(std::min(function.cost / instructions * calls, 1e15));
    if (p.in.used.tokens > p.in.options.budgets.tokens)
        stop_at_limit(p, at, &Budgets::tokens, "this function takes more work than a scene may ask for");
}

void charge_costly(Parser& p, const Token& at, const Function& function) {
    constexpr double costly = 1e4, calls = 1000;
    if (function.cost > costly) charge_calls(p, at, function, calls);
}

VectorValue call_function(Parser& p, const Token& name, const std::shared_ptr<const Function>& function) {
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
    charge_calls(p, name, *function, 1);
    VectorValue result;
    result.size = function->results;
    result.is_color = function->results == 5;
    if (function->native)
        function->native(arguments.data(), result.v);
    else {
        std::int64_t terms = most_terms;
        result.v[0] = evaluate(*function, arguments, terms);
        charge_work(p, name, (most_terms - terms) / 2);
    }
    for (int i = 0; i < result.size; ++i)
        if (!std::isfinite(result.v[i]))
            fail(p, name, fmt::format("`{}` has no finite value here", token_text(p, name, false)));
    return result;
}

} // namespace pnr
