// SPDX-License-Identifier: GPL-3.0-or-later
// Most expressions are made of numbers, variables, operators and the common functions, and stand in one frame. These
// are evaluated straight from the stored tokens, without a token being handed from function to function.
#pragma once

#include "parser/arithmetic.h"
#include "parser/parser.h"

namespace pnr {

// The expression that is next, taken. False, with nothing taken or changed, if it holds anything else (a directive,
// a macro, a string, a colour word), if its end is not certain, or if it is wrong: the evaluator then does it, and
// says what is wrong.
bool quick_expression(Parser& p, Angles angles, VectorValue& result);

} // namespace pnr
