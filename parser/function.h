// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's own functions, `function (a, b) { a * sin(b) }`, compiled once to a program for a stack of
// numbers.
#pragma once

#include "core/scalar_field.h"
#include "core/types.h"
#include "parser/token.h"
#include "parser/value.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pnr {

struct Parser;

struct Instruction {
    enum class Kind : std::uint8_t {
        constant, // push value
        argument, // push argument number `index`
        negate,
        invert,
        add,
        subtract,
        multiply,
        divide,
        power,
        modulo,
        less,
        greater,
        equal,
        less_equal,
        greater_equal,
        unequal,
        both,
        either,
        minimum,
        maximum,
        arc,    // of the two on top
        select, // of the four on top
        select_of_three,
        unary,    // apply `function`, whose keyword is `index`
        call,     // of calls[index]: its arguments are on top; a vector's component number `component`
        internal, // of internal_functions()[index]: its arguments are on top
        quotient, // div(a, b)
        sum, // of calls[index], whose last argument runs from the one on top but one to the one on top; its
        product, // other arguments are this function's own
    };
    static constexpr std::uint8_t gray_component = 5; // the brightness of a colour
    Kind kind = Kind::constant;
    std::uint8_t component = 0;
    std::uint32_t index = 0;
    double value = 0;
    double (*function)(double) = nullptr;
};

struct Function {
    std::vector<Instruction> code;
    std::vector<std::shared_ptr<const Function>> calls;
    // Instead of code: fills `results` numbers from `parameters` arguments. Pure, for many threads at once.
    std::function<void(const double* arguments, double* results)> native;
    int parameters = 3;
    int results = 1;         // 3: of a transform, 2 to 5: of a spline, 5: of a pigment
    int stack = 1;           // numbers it needs at once
    double cost = 0;         // instructions run by one call, those of called functions included
    int depth = 0;           // of functions and pigments inside each other
    std::string unsupported; // why it cannot be called; empty if it can
};

// The value; may be NaN or infinite where the function has none. `arguments` has as many numbers as
// parameters. Its sum() and prod() together have at most `terms` terms, else it is NaN; what is left is in `terms` then.
double evaluate(const Function& function, std::span<const double> arguments, std::int64_t& terms);
double evaluate(const Function& function, std::span<const double> arguments); // at most a million terms

// A function of at most three parameters as a field: x, y, z are its arguments.
struct FunctionField {
    std::shared_ptr<const Function> function;
    double operator()(Vec3 p) const;
};

// Counts what it takes to call the function so often, as tokens.
void charge_calls(Parser& p, const Token& at, const Function& function, double calls);
// The same for a surface or a pattern, which will ask very often, if a single call takes long.
void charge_costly(Parser& p, const Token& at, const Function& function);

// `function [(names)] { expression }`, the word being next. Without names they are x, y, z, and u, v mean x,
// y. What we cannot evaluate is read and marked as unsupported.
std::shared_ptr<const Function> parse_function(Parser& p);
// The same behind its word (`word`), and whatever stands between.
std::shared_ptr<const Function> parse_function_body(Parser& p, const Token& word);

// function_native.cpp. Is the function's body no expression but `internal(N)`, `transform { ... }`, `spline {
// ... }`, `pigment { ... }` or `pattern { ... }`? If so it is read into `function`.
bool parse_native(Parser& p, Function& function);

// Behind the function's name: `(a, b)`, evaluated: a number or a vector. Errors at `name`.
VectorValue call_function(Parser& p, const Token& name, const std::shared_ptr<const Function>& function);

} // namespace pnr
