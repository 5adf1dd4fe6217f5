// SPDX-License-Identifier: GPL-3.0-or-later
// Real roots of polynomials, for surfaces that are given by them.
//
// Roots are isolated by Descartes' rule on Bernstein coefficients, halving the interval [Lane and Riesenfeld
// 1981, "Bounds on a polynomial"; Collins and Akritas 1976]. Signs that rounding leaves open are evaluated
// with compensated Horner sums, as if in twice the precision [Graillat, Langlois and Louvet 2009, "Algorithms
// for accurate, validated and fast polynomial evaluation"]. What halving does not part soon, as near-multiple
// roots, is parted by the roots of the derivative, between which the polynomial is monotone. Each root is
// then closed in by Newton steps inside brackets.
#pragma once

#include <span>

namespace pnr {

inline constexpr int max_polynomial_degree = 35;

// The roots of c[0] + c[1] t + c[2] t^2 + ... with low <= t <= high, in increasing order, into `roots`, which
// has room for the degree's number. Simple roots come once; a pair that cannot be told from a double root
// comes twice or not at all, so that the number of roots between two points is odd exactly if the sign
// changes from the one to the other (a zero counts as positive). low and high may be infinite. Leading
// coefficients may be zero. Nothing is found if all are zero or one is not finite, or if there are more than
// max_polynomial_degree + 1.
int real_roots(std::span<const double> c, double low, double high, double* roots);

// The same for a polynomial in Bernstein form on [0, 1], b.size() - 1 its degree (>= 0). Signs are decided by
// plain evaluation: where a curve is only touched within rounding, the pair of roots may be missed.
int bernstein_roots(std::span<const double> b, double* roots);

// In Bernstein form at s.
double bernstein_value(std::span<const double> b, double s);

// r = a times b in Bernstein form; r has room for a.size() + b.size() - 1 numbers.
void bernstein_product(std::span<const double> a, std::span<const double> b, double* r);

} // namespace pnr
