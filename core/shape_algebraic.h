// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces f(x, y, z) = 0: quadrics, polynomials of any degree up to 15 (cubic, quartic, poly), and two
// convex bodies, superellipsoid and ovus.
#pragma once

#include "core/shape_hits.h"

#include <array>
#include <span>
#include <vector>

namespace pnr {

inline constexpr int max_surface_order = 15;

// The number of terms of a polynomial of this degree in three variables.
constexpr int surface_terms(int order) { return (order + 1) * (order + 2) * (order + 3) / 6; }
// Where POV-Ray has the coefficient of x^i y^j z^k, i + j + k <= order: by falling powers of x, then y, then
// z.
int surface_term(int order, int i, int j, int k);

// The coefficients in that order, surface_terms(order) finite numbers; order from 2 to max_surface_order.
Shape make_polynomial_surface(int order, std::span<const double> coefficients);

// Bounds in the shape's own space (infinite on the sides where there is no end), all hits in the ray's
// interval, put into an empty list in order of t, and the inside: where the function is negative, or in a
// convex body.
Bounds bounds_of(const Quadric& s);
Bounds bounds_of(const PolynomialSurface& s);
Bounds bounds_of(const Superellipsoid& s);
Bounds bounds_of(const Ovus& s);
void intersect(const Quadric& s, const Ray& ray, HitList& hits);
void intersect(const PolynomialSurface& s, const Ray& ray, HitList& hits);
void intersect(const Superellipsoid& s, const Ray& ray, HitList& hits);
void intersect(const Ovus& s, const Ray& ray, HitList& hits);
bool is_inside(const Quadric& s, Vec3 p);
bool has_endless_inside(const Quadric& s); // the function is negative outside of the bounds
bool is_inside(const PolynomialSurface& s, Vec3 p);
bool is_inside(const Superellipsoid& s, Vec3 p);
bool is_inside(const Ovus& s, Vec3 p);

} // namespace pnr
