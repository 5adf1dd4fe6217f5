// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluator's inner vocabulary. Expressions are evaluated while their tokens are pulled: no tree is
// built.
//
// An operand is a VectorValue; size 1 is a scalar. As in POV-Ray a scalar beside a vector is spread over all
// its components, and a shorter vector beside a longer one is filled up with zeros.
#pragma once

#include "parser/arithmetic.h"
#include "parser/parser.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

namespace pnr {

VectorValue parse_operand_expression(Parser& p,
                                     Angles angles); // numbers, vectors and colours; finite or an error
double parse_condition(Parser& p);                   // a scalar, comparisons allowed; strings may be compared
VectorValue parse_primary(Parser& p);
VectorValue vector_literal(Parser& p);
bool at_color(Parser& p);
void parse_channels(Parser& p, VectorValue& color); // `filter 0.5` and the like, if they stand here: into `color`
VectorValue color_expression(Parser& p); // `color ...`, `rgb ...`, `red 1 green 2`: five components

inline VectorValue scalar(double value) { return {{value, 0, 0, 0, 0}, 1, false}; }
inline bool is_true(double value) { return std::abs(value) > 1e-10; }   // POV-Ray's idea of truth
double scalar_of(Parser& p, const VectorValue& value, const Token& at); // error if it is a vector
void promote(VectorValue& value, int size);

// POV-Ray's `.gray` of red, green and blue.
inline double brightness(const double* c) { return 0.297 * c[0] + 0.589 * c[1] + 0.114 * c[2]; }
int component_index(Keyword word); // of `.x`, `.red` ...; -1: no such component

bool at_string(Parser& p);

// `[i][j]` of an array, all taken, the innermost array and the element's number there. Error out of range.
std::pair<std::shared_ptr<ArrayValue>, std::size_t> take_subscripts(Parser& p, const Token& name,
                                                                    const std::shared_ptr<ArrayValue>& array);
Value array_value(Parser& p); // `array[n]... { ... }`

// builtins.cpp
bool is_number_builtin(Keyword word); // a function or constant whose value is a number or vector
bool is_string_builtin(Keyword word);
VectorValue call_number_builtin(Parser& p, const Token& name);
std::string call_string_builtin(Parser& p, const Token& name);

} // namespace pnr
