// SPDX-License-Identifier: GPL-3.0-or-later
// What POV-Ray's operators and functions of numbers compute, without a word about where they stand: the evaluator
// (expression.cpp) and its quick path (quick_expression.cpp) share it.
#pragma once

#include "parser/keywords.h"
#include "parser/token.h"
#include "parser/value.h"

namespace pnr {

// Where an expression stands: whether `<` and `>` between operands compare. In blocks and inside vectors they
// don't: there `<` starts the next vector and `>` closes this one.
enum class Angles : bool { bracket, compare };

// Binding powers; & and | bind alike, as do all comparisons. `none`: no operator.
enum Power : int { none = 0, logical = 1, comparison = 2, sum = 3, product = 4 };
Power operator_power(Symbol punctuation, Angles angles);

constexpr Symbol two(char a, char b) { return static_cast<Symbol>(a) | static_cast<Symbol>(b) << 8; }
// Equal means within 1e-10, as for POV-Ray. `op`: a comparison's sign.
double compare(Symbol op, double a, double b);

enum class Fault { none, division_by_zero, not_a_number, too_large };
// a op b into a. A number beside a vector is spread over all its components, a shorter vector is filled up with
// zeros.
Fault combine(Symbol op, VectorValue& a, const VectorValue& b);

using Unary = double (*)(double);
using Binary = double (*)(double, double);
// Functions of one number and of two; null: none of that name. NaN or infinite where they have no value.
Unary total_function(Keyword word);   // defined everywhere
Unary partial_function(Keyword word); // not so
Binary function_of_two(Keyword word); // atan2 mod div pow

// vlength vnormalize vcross vdot vrotate; `b` means nothing to the first two. False: none of them.
bool vector_function(Keyword word, const VectorValue& a, const VectorValue& b, VectorValue& result);
bool takes_two_vectors(Keyword word); // vcross vdot vrotate
bool unit_vector(Keyword word, VectorValue& value); // x y z u v t
int component_index(Keyword word);    // `.x`, `.red` ...: -1: none
double next_random(std::uint32_t& state); // POV-Ray's generator, a linear congruence of 32 bits; 0 to 1

} // namespace pnr
