// SPDX-License-Identifier: GPL-3.0-or-later
// What the built-in functions share: reading arguments, and those of strings that give numbers.
#pragma once

#include "parser/expression.h"

namespace pnr {

void open_arguments(Parser& p, const Token& name);
void close_arguments(Parser& p, const Token& name);
void comma_argument(Parser& p, const Token& name);
double number_argument(Parser& p);
VectorValue vector_argument(Parser& p); // at least 3 components

double number_of_strings(Parser& p, const Token& name); // strlen strcmp asc val, behind the `(`

// inside, trace, min_extent, max_extent (builtins_object.cpp), behind the `(`.
bool is_object_function(Keyword word);
VectorValue object_function(Parser& p, const Token& name);

} // namespace pnr
