// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that are given by polynomials and the like: quadric, cubic, quartic, poly, polynomial,
// superellipsoid, ovus.
#include "core/shape_algebraic.h"

#include "parser/blocks.h"

#include <algorithm>

namespace pnr {

namespace {

Vec3 parse_item(Parser& p) {
    const Vec3 v = parse_vector(p);
    accept_comma(p);
    return v;
}

double parse_positive(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const double value = parse_float(p);
    if (!(value > 0)) fail(p, at, std::string(what) + " must be greater than 0");
    accept_comma(p);
    return value;
}

// < so many numbers as the order has terms >
Shape parse_coefficients(Parser& p, int order) {
    const Token at = peek(p);
    std::vector<double> c(static_cast<std::size_t>(surface_terms(order)));
    charge(p, at, c.size() * sizeof(double));
    expect(p, '<', "to start the coefficients");
    for (std::size_t i = 0; i < c.size(); ++i) {
        if (is(peek(p), '>'))
            fail(p, at,
                 "a polynomial of order " + std::to_string(order) + " has " + std::to_string(c.size()) +
                     " coefficients, here are " + std::to_string(i));
        c[i] = parse_float(p);
        accept_comma(p);
    }
    expect(p, '>', "behind the coefficients");
    return make_polynomial_surface(order, c);
}

int parse_order(Parser& p) {
    const int order = parse_int(p, 2, max_surface_order, "the order of a polynomial");
    accept_comma(p);
    return order;
}

} // namespace

Shape parse_quadric(Parser& p) {
    const Vec3 squares = parse_item(p), products = parse_item(p), linear = parse_item(p);
    const double constant = parse_float(p);
    return Quadric{{squares.x, squares.y, squares.z, products.x, products.y, products.z, linear.x, linear.y,
                    linear.z, constant}};
}

Shape parse_cubic(Parser& p) { return parse_coefficients(p, 3); }
Shape parse_quartic(Parser& p) { return parse_coefficients(p, 4); }
Shape parse_poly(Parser& p) { return parse_coefficients(p, parse_order(p)); }

// ORDER, xyz(i, j, k): c, ...
Shape parse_polynomial(Parser& p) {
    const int order = parse_order(p);
    std::vector<double> c(static_cast<std::size_t>(surface_terms(order)));
    while (accept(p, "xyz"_kw)) {
        int powers[3];
        const Token at = peek(p);
        expect(p, '(', "to start the powers of x, y and z");
        for (int& power : powers) {
            power = parse_int(p, 0, order, "a power");
            accept_comma(p);
        }
        expect(p, ')', "behind the powers of x, y and z");
        if (powers[0] + powers[1] + powers[2] > order)
            fail(p, at, "these powers add up to more than the polynomial's order, " + std::to_string(order));
        expect(p, ':', "in front of the coefficient");
        c[static_cast<std::size_t>(surface_term(order, powers[0], powers[1], powers[2]))] = parse_float(p);
        accept_comma(p);
    }
    return make_polynomial_surface(order, c);
}

Shape parse_superellipsoid(Parser& p) {
    const Token at = peek(p);
    const Vec2 e = parse_uv(p);
    if (!(e.x > 0 && e.y > 0)) fail(p, at, "both exponents of a superellipsoid must be greater than 0");
    return Superellipsoid{e.x, e.y};
}

Shape parse_ovus(Parser& p) {
    Ovus ovus;
    ovus.bottom = parse_positive(p, "the radius of an ovus");
    const Token at = peek(p);
    ovus.top = parse_positive(p, "the radius of an ovus");
    if (ovus.top >= 2 * ovus.bottom)
        warn(p, at, "the second radius is twice the first or more: this ovus is a sphere");
    return ovus;
}

} // namespace pnr
