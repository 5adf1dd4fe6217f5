// SPDX-License-Identifier: GPL-3.0-or-later
// Interval arithmetic with forward derivatives along a line [Moore 1966, "Interval Analysis"; Griewank and
// Walther 2008, "Evaluating Derivatives", on forward differentiation; Mitchell 1990, "Robust ray intersection
// with interval arithmetic", on its use for rays]. Ends are not rounded outwards: what rounding could hide
// lies below the accuracy of any hit. Unbounded ends are `field_huge`, so that no infinity, and so no NaN,
// arises.
#include "core/field_program.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

constexpr double equal_within = 1e-10; // as in the language's expressions

struct Interval {
    double low, high;
};

double clamped(double v) {
    return v < -field_huge ? -field_huge : v < field_huge ? v : field_huge;
} // NaN: huge
Interval clamped(Interval v) { return {clamped(v.low), clamped(v.high)}; }
constexpr Interval any{-field_huge, field_huge};
bool is_constant(Interval v) { return v.low == v.high; }
Interval hull(Interval a, Interval b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

Interval operator+(Interval a, Interval b) { return {a.low + b.low, a.high + b.high}; }
Interval operator-(Interval a, Interval b) { return {a.low - b.high, a.high - b.low}; }
Interval operator-(Interval a) { return {-a.high, -a.low}; }
Interval operator*(Interval a, Interval b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return clamped(
        Interval{std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))});
}
Interval reciprocal(Interval v) {
    if (v.low > 0 || v.high < 0) return clamped(Interval{1 / v.high, 1 / v.low});
    if (v.low == 0 && v.high > 0) return {clamped(1 / v.high), field_huge};
    if (v.high == 0 && v.low < 0) return {-field_huge, clamped(1 / v.low)};
    return any;
}
Interval square(Interval v) {
    const double a = v.low * v.low, b = v.high * v.high;
    if (v.low > 0 || v.high < 0) return clamped(Interval{std::min(a, b), std::max(a, b)});
    return {0, clamped(std::max(a, b))};
}

// A value and its slope along the line.
struct Dual {
    Interval value, slope;
};

// Of a value that jumps: nothing is known of the slope but where the value stays the same.
Interval slope_of_steps(Interval value) { return is_constant(value) ? Interval{0, 0} : any; }

// A monotone function's values, `slope` being its derivative's values.
Dual monotone(const Dual& a, double (*f)(double), Interval slope) {
    return {clamped(Interval{f(a.value.low), f(a.value.high)}), slope * a.slope};
}

// Whether [low, high] holds a number phase + n * period.
bool holds_one_of(Interval v, double phase, double period) {
    return std::floor((v.high - phase) / period) >= std::ceil((v.low - phase) / period);
}

Interval sine(Interval v) {
    if (!(v.high - v.low < 2 * pi) || std::abs(v.low) > 1e12) return {-1, 1};
    const double a = std::sin(v.low), b = std::sin(v.high);
    return {holds_one_of(v, -0.5 * pi, 2 * pi) ? -1 : std::min(a, b),
            holds_one_of(v, 0.5 * pi, 2 * pi) ? 1 : std::max(a, b)};
}
Interval cosine(Interval v) { return sine({v.low + 0.5 * pi, v.high + 0.5 * pi}); }

Dual absolute(const Dual& a) {
    if (a.value.low >= 0) return a;
    if (a.value.high <= 0) return {-a.value, -a.slope};
    return {{0, std::max(-a.value.low, a.value.high)}, hull(a.slope, -a.slope)};
}

// The part of the argument where the function has values; where there is none, and beside it, the function
// counts as large.
template <class F>
Dual partial(const Dual& a, double low, double high, F f) {
    if (a.value.high < low || a.value.low > high) return {{field_huge, field_huge}, any};
    if (a.value.low >= low && a.value.high <= high) return f(a);
    Dual result = f(Dual{{std::max(a.value.low, low), std::min(a.value.high, high)}, a.slope});
    result.value.high = field_huge;
    result.slope = any;
    return result;
}

Dual root(const Dual& a) {
    return partial(a, 0, field_huge, [](const Dual& v) {
        const Interval r{std::sqrt(v.value.low), std::sqrt(v.value.high)};
        return Dual{r, reciprocal(Interval{2 * r.low, 2 * r.high}) * v.slope};
    });
}

Dual logarithm(const Dual& a, double unit) {
    return partial(a, 0, field_huge, [&](const Dual& v) {
        const Interval value = clamped(Interval{std::log(v.value.low) / unit, std::log(v.value.high) / unit});
        return Dual{value, reciprocal(Interval{unit * v.value.low, unit * v.value.high}) * v.slope};
    });
}

Dual arc_sine(const Dual& a, bool of_cosine) {
    return partial(a, -1, 1, [&](const Dual& v) {
        const Interval value{std::asin(v.value.low), std::asin(v.value.high)};
        const Interval rest = Interval{1, 1} - square(v.value);
        const Interval slope =
            reciprocal(Interval{std::sqrt(std::max(rest.low, 0.0)), std::sqrt(std::max(rest.high, 0.0))}) *
            v.slope;
        return of_cosine ? Dual{Interval{0.5 * pi, 0.5 * pi} - value, -slope} : Dual{value, slope};
    });
}

Dual tangent(const Dual& a) {
    if (holds_one_of(a.value, 0.5 * pi, pi) || std::abs(a.value.low) > 1e12) return {any, any};
    const Interval value = clamped(Interval{std::tan(a.value.low), std::tan(a.value.high)});
    return {value, (Interval{1, 1} + square(value)) * a.slope};
}

Dual exponential(const Dual& a) {
    const Interval value = clamped(Interval{std::exp(a.value.low), std::exp(a.value.high)});
    return {value, value * a.slope};
}

Dual whole_power(const Dual& a, int n) { // n > 0
    const auto raised = [](Interval v, int k) {
        if (k == 0) return Interval{1, 1};
        const double p = std::pow(v.low, k), q = std::pow(v.high, k);
        if (k % 2 == 1 || v.low >= 0) return clamped(Interval{p, q});
        if (v.high <= 0) return clamped(Interval{q, p});
        return clamped(Interval{0, std::max(p, q)});
    };
    const Interval slope = raised(a.value, n - 1) * a.slope;
    return {raised(a.value, n), slope * Interval{double(n), double(n)}};
}

Dual quotient(const Dual& a, const Dual& b) {
    const Interval inverse = reciprocal(b.value);
    const Interval value = a.value * inverse;
    return {value, (a.slope - value * b.slope) * inverse};
}

Dual power(const Dual& a, const Dual& b) {
    if (is_constant(b.value) && std::abs(b.value.low) <= 64 && b.value.low == std::floor(b.value.low)) {
        const int n = static_cast<int>(b.value.low);
        if (n == 0) return {{1, 1}, {0, 0}};
        if (n > 0) return whole_power(a, n);
        return quotient({{1, 1}, {0, 0}}, whole_power(a, -n));
    }
    return partial(a, 0, field_huge, [&](const Dual& v) {
        const double p = std::pow(v.value.low, b.value.low), q = std::pow(v.value.low, b.value.high),
                     r = std::pow(v.value.high, b.value.low), s = std::pow(v.value.high, b.value.high);
        const Interval value = clamped(
            Interval{std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))});
        if (is_constant(b.value)) {
            const double e = b.value.low - 1;
            const double low = std::pow(v.value.low, e), high = std::pow(v.value.high, e);
            return Dual{value, Interval{b.value.low, b.value.low} *
                                   (clamped(Interval{std::min(low, high), std::max(low, high)}) * v.slope)};
        }
        const Interval logs = clamped(Interval{std::log(v.value.low), std::log(v.value.high)});
        return Dual{value, value * (b.slope * logs + b.value * reciprocal(v.value) * v.slope)};
    });
}

Dual arc_tangent(const Dual& a, const Dual& b) { // of a / b, in all four quadrants
    const bool cut = b.value.low < 0 && a.value.low <= 0 && a.value.high >= 0; // where it jumps by 2 pi
    const bool pole = b.value.low <= 0 && b.value.high >= 0 && a.value.low <= 0 && a.value.high >= 0;
    if (cut || pole) return {{-pi, pi}, any};
    Interval value{field_huge, -field_huge};
    for (const double y : {a.value.low, a.value.high})
        for (const double x : {b.value.low, b.value.high}) {
            const double angle = std::atan2(y, x);
            value = hull(value, {angle, angle});
        }
    const Interval size = reciprocal(square(a.value) + square(b.value));
    return {value, (b.value * a.slope - a.value * b.slope) * size};
}

Dual modulo(const Dual& a, const Dual& b) {
    if (is_constant(b.value) && b.value.low != 0) {
        const double m = std::abs(b.value.low), turns = std::trunc(a.value.low / m);
        const bool one_side = a.value.low >= 0 || a.value.high <= 0;
        if (one_side && turns == std::trunc(a.value.high / m))
            return {a.value - Interval{turns * m, turns * m}, a.slope};
    }
    const double most = std::max(std::abs(b.value.low), std::abs(b.value.high));
    return {{a.value.low >= 0 ? 0 : -most, a.value.high <= 0 ? 0 : most}, any};
}

enum class Truth { no, yes, maybe };

Truth truth(Interval v) {
    if (v.low > equal_within || v.high < -equal_within) return Truth::yes;
    return std::max(std::abs(v.low), std::abs(v.high)) <= equal_within ? Truth::no : Truth::maybe;
}
Truth less(Interval a, Interval b, bool or_equal) {
    if (a.high < b.low || (or_equal && a.high == b.low)) return Truth::yes;
    if (a.low > b.high || (!or_equal && a.low == b.high)) return Truth::no;
    return Truth::maybe;
}
Truth equal(Interval a, Interval b) {
    const Interval d = a - b;
    if (d.low >= equal_within || d.high <= -equal_within) return Truth::no;
    return std::max(std::abs(d.low), std::abs(d.high)) < equal_within ? Truth::yes : Truth::maybe;
}
Truth not_of(Truth t) { return t == Truth::maybe ? t : t == Truth::yes ? Truth::no : Truth::yes; }
Truth both(Truth a, Truth b) {
    if (a == Truth::no || b == Truth::no) return Truth::no;
    return a == Truth::yes && b == Truth::yes ? Truth::yes : Truth::maybe;
}

Dual of_truth(Truth t) {
    if (t == Truth::maybe) return {{0, 1}, any};
    const double value = t == Truth::yes ? 1 : 0;
    return {{value, value}, {0, 0}};
}

Dual smaller(const Dual& a, const Dual& b) {
    if (a.value.high <= b.value.low) return a;
    if (b.value.high <= a.value.low) return b;
    return {{std::min(a.value.low, b.value.low), std::min(a.value.high, b.value.high)},
            hull(a.slope, b.slope)};
}
Dual negated(const Dual& a) { return {-a.value, -a.slope}; }

Dual selected(const Dual& a, const Dual& below, const Dual& at_zero, const Dual& above) {
    if (a.value.high < 0) return below;
    if (a.value.low > 0) return above;
    if (a.value.low == 0 && a.value.high == 0) return at_zero;
    Interval value = at_zero.value;
    if (a.value.low < 0) value = hull(value, below.value);
    if (a.value.high > 0) value = hull(value, above.value);
    return {value, slope_of_steps(value)};
}

Dual stepped(const Dual& a, double (*f)(double)) {
    const Interval value{f(a.value.low), f(a.value.high)};
    return {value, slope_of_steps(value)};
}

Dual unary(FieldOp op, const Dual& a) {
    switch (op) {
    case FieldOp::negate:
        return negated(a);
    case FieldOp::invert:
        return of_truth(not_of(truth(a.value)));
    case FieldOp::abs:
        return absolute(a);
    case FieldOp::sqr:
        return {square(a.value), Interval{2, 2} * (a.value * a.slope)};
    case FieldOp::sqrt:
        return root(a);
    case FieldOp::exp:
        return exponential(a);
    case FieldOp::ln:
        return logarithm(a, 1);
    case FieldOp::log:
        return logarithm(a, std::log(10.0));
    case FieldOp::sin:
        return {sine(a.value), cosine(a.value) * a.slope};
    case FieldOp::cos:
        return {cosine(a.value), -(sine(a.value) * a.slope)};
    case FieldOp::tan:
        return tangent(a);
    case FieldOp::asin:
        return arc_sine(a, false);
    case FieldOp::acos:
        return arc_sine(a, true);
    case FieldOp::atan:
        return monotone(a, std::atan, reciprocal(Interval{1, 1} + square(a.value)));
    case FieldOp::sinh:
        return monotone(a, std::sinh, {1, clamped(std::cosh(std::max(-a.value.low, a.value.high)))});
    case FieldOp::cosh: {
        const Dual distance = absolute(a);
        return monotone(distance, std::cosh,
                        clamped(Interval{std::sinh(distance.value.low), std::sinh(distance.value.high)}));
    }
    case FieldOp::tanh:
        return monotone(a, std::tanh, {0, 1});
    case FieldOp::floor:
        return stepped(a, std::floor);
    default:
        return stepped(a, std::ceil);
    }
}

Dual binary(FieldOp op, const Dual& a, const Dual& b) {
    switch (op) {
    case FieldOp::divide:
        return quotient(a, b);
    case FieldOp::power:
        return power(a, b);
    case FieldOp::modulo:
        return modulo(a, b);
    case FieldOp::less:
        return of_truth(less(a.value, b.value, false));
    case FieldOp::greater:
        return of_truth(less(b.value, a.value, false));
    case FieldOp::equal:
        return of_truth(equal(a.value, b.value));
    case FieldOp::less_equal:
        return of_truth(less(a.value, b.value, true));
    case FieldOp::greater_equal:
        return of_truth(less(b.value, a.value, true));
    case FieldOp::unequal:
        return of_truth(not_of(equal(a.value, b.value)));
    case FieldOp::both:
        return of_truth(both(truth(a.value), truth(b.value)));
    case FieldOp::either:
        return of_truth(not_of(both(not_of(truth(a.value)), not_of(truth(b.value)))));
    case FieldOp::minimum:
        return smaller(a, b);
    case FieldOp::maximum:
        return negated(smaller(negated(a), negated(b)));
    default:
        return arc_tangent(a, b);
    }
}

// The numbers of one step: four rows of lanes, so that the commonest steps are loops without branches.
struct Row {
    double low[field_lanes], high[field_lanes], slope_low[field_lanes], slope_high[field_lanes];

    Dual get(int l) const { return {{low[l], high[l]}, {slope_low[l], slope_high[l]}}; }
    void set(int l, const Dual& v) {
        low[l] = v.value.low, high[l] = v.value.high;
        slope_low[l] = v.slope.low, slope_high[l] = v.slope.high;
    }
};

void multiply_rows(const double* al, const double* ah, const double* bl, const double* bh, double* low,
                   double* high) {
    for (int l = 0; l < field_lanes; ++l) {
        const Interval v = Interval{al[l], ah[l]} * Interval{bl[l], bh[l]};
        low[l] = v.low, high[l] = v.high;
    }
}

void multiply(const Row& a, const Row& b, Row& out) {
    double l0[field_lanes], h0[field_lanes];
    multiply_rows(a.low, a.high, b.low, b.high, out.low, out.high);
    multiply_rows(a.slope_low, a.slope_high, b.low, b.high, l0, h0);
    multiply_rows(a.low, a.high, b.slope_low, b.slope_high, out.slope_low, out.slope_high);
    for (int l = 0; l < field_lanes; ++l) {
        out.slope_low[l] = clamped(out.slope_low[l] + l0[l]);
        out.slope_high[l] = clamped(out.slope_high[l] + h0[l]);
    }
}

void square(const Row& a, Row& out) {
    multiply_rows(a.low, a.high, a.slope_low, a.slope_high, out.slope_low, out.slope_high);
    for (int l = 0; l < field_lanes; ++l) {
        const Interval v = square(Interval{a.low[l], a.high[l]});
        out.low[l] = v.low, out.high[l] = v.high;
        out.slope_low[l] = clamped(2 * out.slope_low[l]), out.slope_high[l] = clamped(2 * out.slope_high[l]);
    }
}

void add(const Row& a, const Row& b, Row& out) {
    for (int l = 0; l < field_lanes; ++l) {
        out.low[l] = clamped(a.low[l] + b.low[l]), out.high[l] = clamped(a.high[l] + b.high[l]);
        out.slope_low[l] = clamped(a.slope_low[l] + b.slope_low[l]);
        out.slope_high[l] = clamped(a.slope_high[l] + b.slope_high[l]);
    }
}

void subtract(const Row& a, const Row& b, Row& out) {
    for (int l = 0; l < field_lanes; ++l) {
        out.low[l] = clamped(a.low[l] - b.high[l]), out.high[l] = clamped(a.high[l] - b.low[l]);
        out.slope_low[l] = clamped(a.slope_low[l] - b.slope_high[l]);
        out.slope_high[l] = clamped(a.slope_high[l] - b.slope_low[l]);
    }
}

void fill(Row& out, const double (&low)[field_lanes], const double (&high)[field_lanes],
          const double (&along)[field_lanes]) {
    std::copy_n(low, field_lanes, out.low);
    std::copy_n(high, field_lanes, out.high);
    std::copy_n(along, field_lanes, out.slope_low);
    std::copy_n(along, field_lanes, out.slope_high);
}

// By the middle's value and how fast the function can change.
void enclose_call(const FieldProgram& program, const FieldStep& step, const Row* rows, Row& out) {
    const OpaqueField& callee = program.opaque[step.a];
    boost::container::small_vector<double, 8> middle(callee.parameters);
    for (int l = 0; l < field_lanes; ++l) {
        double reach2 = 0, speed2 = 0;
        for (std::uint32_t k = 0; k < callee.parameters; ++k) {
            const Row& a = rows[program.arguments[step.b + k]];
            middle[k] = 0.5 * (a.low[l] + a.high[l]);
            const double half = 0.5 * (a.high[l] - a.low[l]);
            const double speed = std::max(std::abs(a.slope_low[l]), std::abs(a.slope_high[l]));
            reach2 += half * half, speed2 += speed * speed;
        }
        const double change = callee.lipschitz * std::sqrt(reach2),
                     slope = callee.lipschitz * std::sqrt(speed2);
        Dual v{{callee.low, callee.high}, clamped(Interval{-slope, slope})};
        if (const double value = callee.value(middle.data()); std::isfinite(value))
            v.value = {std::max(callee.low, value - change), std::min(callee.high, value + change)};
        v.value = clamped(v.value);
        out.set(l, v);
    }
}

} // namespace

void field_enclosure(const FieldProgram& program, const FieldBoxes& boxes, FieldEnclosure& enclosure,
                     FieldScratch& scratch) {
    static_assert(sizeof(Row) == 4 * field_lanes * sizeof(double));
    const std::size_t size = program.steps.size() * sizeof(Row) / sizeof(double);
    if (scratch.size() < size) scratch.resize(size, boost::container::default_init);
    Row* rows = reinterpret_cast<Row*>(scratch.data());
    Row* out = rows;
    for (const FieldStep& step : program.steps) {
        const auto of_each = [&](auto f) {
            for (int l = 0; l < field_lanes; ++l) out->set(l, f(l));
        };
        switch (step.op) {
        case FieldOp::constant:
            of_each([&](int) { return Dual{clamped(Interval{step.value, step.value}), {0, 0}}; });
            break;
        case FieldOp::x:
            fill(*out, boxes.low.x, boxes.high.x, boxes.along.x);
            break;
        case FieldOp::y:
            fill(*out, boxes.low.y, boxes.high.y, boxes.along.y);
            break;
        case FieldOp::z:
            fill(*out, boxes.low.z, boxes.high.z, boxes.along.z);
            break;
        case FieldOp::add:
            add(rows[step.a], rows[step.b], *out);
            break;
        case FieldOp::subtract:
            subtract(rows[step.a], rows[step.b], *out);
            break;
        case FieldOp::multiply:
            if (step.a == step.b)
                square(rows[step.a], *out);
            else
                multiply(rows[step.a], rows[step.b], *out);
            break;
        case FieldOp::sqr:
            square(rows[step.a], *out);
            break;
        case FieldOp::select:
            of_each([&](int l) {
                return selected(rows[step.a].get(l), rows[step.b].get(l), rows[step.c].get(l),
                                rows[step.d].get(l));
            });
            break;
        case FieldOp::call:
            enclose_call(program, step, rows, *out);
            break;
        default:
            if (step.op < FieldOp::negate)
                of_each([&](int l) { return binary(step.op, rows[step.a].get(l), rows[step.b].get(l)); });
            else
                of_each([&](int l) { return unary(step.op, rows[step.a].get(l)); });
        }
        ++out;
    }
    --out;
    std::copy_n(out->low, field_lanes, enclosure.low);
    std::copy_n(out->high, field_lanes, enclosure.high);
    std::copy_n(out->slope_low, field_lanes, enclosure.slope_low);
    std::copy_n(out->slope_high, field_lanes, enclosure.slope_high);
}

} // namespace pnr
