// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/arithmetic.h"

#include "parser/expression.h"

#include <algorithm>
#include <cmath>

namespace pnr {

// ---- operators
// ------------------------------------------------------------------------------------------------------

Power operator_power(Symbol punctuation, Angles angles) {
    switch (punctuation) {
    case '*':
    case '/':
        return product;
    case '+':
    case '-':
        return sum;
    case '<':
    case '>':
    case '=':
    case two('<', '='):
    case two('>', '='):
    case two('!', '='):
        return angles == Angles::compare ? comparison : none;
    case '&':
    case '|':
        return angles == Angles::compare ? logical : none;
    default:
        return none;
    }
}

double compare(Symbol op, double a, double b) {
    const bool equal = std::abs(a - b) < 1e-10;
    switch (op) {
    case '<':
        return a < b && !equal;
    case '>':
        return a > b && !equal;
    case '=':
        return equal;
    case two('<', '='):
        return a < b || equal;
    case two('>', '='):
        return a > b || equal;
    default:
        return !equal;
    }
}

namespace {

double combine_scalars(Symbol op, double a, double b) {
    switch (op) {
    case '+':
        return a + b;
    case '-':
        return a - b;
    case '*':
        return a * b;
    case '/':
        return a / b;
    case '&':
        return is_true(a) && is_true(b);
    case '|':
        return is_true(a) || is_true(b);
    default:
        return compare(op, a, b);
    }
}

Fault fault_of(double value) {
    if (std::isfinite(value)) return Fault::none;
    return std::isnan(value) ? Fault::not_a_number : Fault::too_large;
}

} // namespace

Fault combine(Symbol op, VectorValue& a, const VectorValue& right) {
    if (a.size == 1 && right.size == 1) {
        if (op == '/' && right.v[0] == 0) return Fault::division_by_zero;
        a.v[0] = combine_scalars(op, a.v[0], right.v[0]);
        return fault_of(a.v[0]);
    }
    VectorValue b = right;
    const int size = std::max(a.size, b.size);
    promote(a, size);
    promote(b, size);
    if (op == '/')
        for (int i = 3; i < size; ++i) // a zero that promotion filled in divides nothing
            if (b.v[i] == 0 && a.v[i] == 0) b.v[i] = 1;
    for (int i = 0; i < size; ++i) {
        if (op == '/' && b.v[i] == 0) return Fault::division_by_zero;
        a.v[i] = combine_scalars(op, a.v[i], b.v[i]);
        if (const Fault fault = fault_of(a.v[i]); fault != Fault::none) return fault;
    }
    a.is_color = a.is_color || b.is_color;
    return Fault::none;
}

void promote(VectorValue& value, int size) {
    if (value.size == 1)
        for (int i = 1; i < size; ++i) value.v[i] = value.v[0];
    else
        for (int i = value.size; i < size; ++i) value.v[i] = 0;
    value.size = std::max(value.size, size);
}

// ---- functions
// ------------------------------------------------------------------------------------------------------

namespace {

double truncate(double x) { return std::trunc(x); }
double to_radians(double x) { return x * pi / 180; }
double to_degrees(double x) { return x * 180 / pi; }
// Sums like 0.1 * 10 pass 1 by a little; an angle is meant all the same.
double within_one(double x) { return std::abs(x) > 1 && std::abs(x) < 1 + 1e-10 ? std::copysign(1, x) : x; }
double arc_cosine(double x) { return std::acos(within_one(x)); }
double arc_sine(double x) { return std::asin(within_one(x)); }
double arc_tangent(double y, double x) { return x == 0 && y == 0 ? 0 : std::atan2(y, x); }
double modulo(double a, double b) { return std::fmod(a, b); }
double divide_whole(double a, double b) { return std::trunc(a / b); }
double power(double a, double b) { return std::pow(a, b); }

Vec3 vec3(const VectorValue& value) { return {value.v[0], value.v[1], value.v[2]}; }
VectorValue vector(Vec3 v) { return {{v.x, v.y, v.z, 0, 0}, 3, false}; }

} // namespace

Unary total_function(Keyword word) {
    switch (word) {
    case "abs"_kw:
        return std::fabs;
    case "atan"_kw:
        return std::atan;
    case "asinh"_kw:
        return std::asinh;
    case "ceil"_kw:
        return std::ceil;
    case "floor"_kw:
        return std::floor;
    case "int"_kw:
        return truncate;
    case "sin"_kw:
        return std::sin;
    case "cos"_kw:
        return std::cos;
    case "tan"_kw:
        return std::tan;
    case "sinh"_kw:
        return std::sinh;
    case "cosh"_kw:
        return std::cosh;
    case "tanh"_kw:
        return std::tanh;
    case "exp"_kw:
        return std::exp;
    case "radians"_kw:
        return to_radians;
    case "degrees"_kw:
        return to_degrees;
    default:
        return nullptr;
    }
}

Unary partial_function(Keyword word) {
    switch (word) {
    case "acos"_kw:
        return arc_cosine;
    case "asin"_kw:
        return arc_sine;
    case "acosh"_kw:
        return std::acosh;
    case "atanh"_kw:
        return std::atanh;
    case "sqrt"_kw:
        return std::sqrt;
    case "ln"_kw:
        return std::log;
    case "log"_kw:
        return std::log10;
    default:
        return nullptr;
    }
}

Binary function_of_two(Keyword word) {
    switch (word) {
    case "atan2"_kw:
        return arc_tangent;
    case "mod"_kw:
        return modulo;
    case "div"_kw:
        return divide_whole;
    case "pow"_kw:
        return power;
    default:
        return nullptr;
    }
}

bool takes_two_vectors(Keyword word) {
    return word == "vcross"_kw || word == "vdot"_kw || word == "vrotate"_kw;
}

bool vector_function(Keyword word, const VectorValue& a, const VectorValue& b, VectorValue& result) {
    if (word == "vlength"_kw || word == "vnormalize"_kw) {
        double length = 0;
        for (int i = 0; i < a.size; ++i) length += a.v[i] * a.v[i];
        length = std::sqrt(length);
        if (word == "vlength"_kw) return result = scalar(length), true;
        result = a;
        if (length == 0) return true; // POV-Ray's answer for the zero vector
        for (int i = 0; i < a.size; ++i) result.v[i] /= length;
        return true;
    }
    if (word == "vcross"_kw) return result = vector(glm::cross(vec3(a), vec3(b))), true;
    if (word == "vdot"_kw) return result = scalar(glm::dot(vec3(a), vec3(b))), true;
    if (word == "vrotate"_kw)
        return result = vector(transform_vector(rotation(vec3(b)).matrix, vec3(a))), true;
    return false;
}

// x, y, z are vectors of three, u and v of two, t of four.
bool unit_vector(Keyword word, VectorValue& value) {
    switch (word) {
    case "x"_kw:
        value = {{1, 0, 0, 0, 0}, 3, false};
        return true;
    case "y"_kw:
        value = {{0, 1, 0, 0, 0}, 3, false};
        return true;
    case "z"_kw:
        value = {{0, 0, 1, 0, 0}, 3, false};
        return true;
    case "t"_kw:
        value = {{0, 0, 0, 1, 0}, 4, false};
        return true;
    case "u"_kw:
        value = {{1, 0, 0, 0, 0}, 2, false};
        return true;
    case "v"_kw:
        value = {{0, 1, 0, 0, 0}, 2, false};
        return true;
    default:
        return false;
    }
}

int component_index(Keyword word) {
    switch (word) {
    case "x"_kw:
    case "u"_kw:
    case "red"_kw:
        return 0;
    case "y"_kw:
    case "v"_kw:
    case "green"_kw:
        return 1;
    case "z"_kw:
    case "blue"_kw:
        return 2;
    case "t"_kw:
    case "filter"_kw:
        return 3;
    case "transmit"_kw:
        return 4;
    default:
        return -1;
    }
}

double next_random(std::uint32_t& state) {
    state = state * 1812433253u + 12345u;
    return static_cast<double>(state) / 4294967295.0;
}

} // namespace pnr
