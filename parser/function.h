// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's own functions, `function (a, b) { a * sin(b) }`, compiled once to a program for a stack of
// numbers.
#pragma once

#include "core/scalar_field.h"
#include "core/types.h"
#include "parser/token.h"

#include <cstdint>
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
        unary, // apply `function`
        call,  // of calls[index]: its arguments are on top
    };
    Kind kind = Kind::constant;
    std::uint32_t index = 0;
    double value = 0;
    double (*function)(double) = nullptr;
};

struct Function {
    std::vector<Instruction> code;
    std::vector<std::shared_ptr<const Function>> calls;
    int parameters = 3;
    int stack = 1;           // numbers it needs at once
    double cost = 0;         // instructions run by one call, those of called functions included
    std::string unsupported; // why it cannot be called; empty if it can
};

// The value; may be NaN or infinite where the function has none. `arguments` has as many numbers as
// parameters.
double evaluate(const Function& function, std::span<const double> arguments);

// A function of at most three parameters as a field: x, y, z are its arguments.
ScalarField field_of(std::shared_ptr<const Function> function);

// `function [(names)] { expression }`, the word being next. Without names they are x, y, z, and u, v mean x,
// y. What we cannot evaluate (internal, pigment, pattern, spline, transform functions) is read and marked as
// unsupported.
std::shared_ptr<const Function> parse_function(Parser& p);

// Behind the function's name: `(a, b)`, evaluated. Errors at `name`.
double call_function(Parser& p, const Token& name, const std::shared_ptr<const Function>& function);

} // namespace pnr
