// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/field_program.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

constexpr double equal_within = 1e-10; // as in the language's expressions

bool is_true(double v) { return std::abs(v) > equal_within; }

// The result of a step for `lanes` numbers at once.
template <int lanes, class F>
void each(double* out, const double* a, F f) {
    for (int l = 0; l < lanes; ++l) out[l] = f(a[l]);
}
template <int lanes, class F>
void each(double* out, const double* a, const double* b, F f) {
    for (int l = 0; l < lanes; ++l) out[l] = f(a[l], b[l]);
}

template <int lanes>
void run_call(const FieldProgram& program, const FieldStep& step, const double* numbers, double* out) {
    const OpaqueField& callee = program.opaque[step.a];
    boost::container::small_vector<double, 8> arguments(callee.parameters);
    for (int l = 0; l < lanes; ++l) {
        for (std::uint32_t k = 0; k < callee.parameters; ++k)
            arguments[k] =
                numbers[program.arguments[step.b + k] * std::uint32_t{lanes} + static_cast<std::uint32_t>(l)];
        out[l] = callee.value(arguments.data());
    }
}

template <int lanes>
void run_unary(FieldOp op, double* out, const double* a) {
    switch (op) {
    case FieldOp::negate:
        return each<lanes>(out, a, [](double v) { return -v; });
    case FieldOp::invert:
        return each<lanes>(out, a, [](double v) { return is_true(v) ? 0.0 : 1.0; });
    case FieldOp::abs:
        return each<lanes>(out, a, [](double v) { return std::abs(v); });
    case FieldOp::sqr:
        return each<lanes>(out, a, [](double v) { return v * v; });
    case FieldOp::sqrt:
        return each<lanes>(out, a, [](double v) { return std::sqrt(v); });
    case FieldOp::exp:
        return each<lanes>(out, a, [](double v) { return std::exp(v); });
    case FieldOp::ln:
        return each<lanes>(out, a, [](double v) { return std::log(v); });
    case FieldOp::log:
        return each<lanes>(out, a, [](double v) { return std::log10(v); });
    case FieldOp::sin:
        return each<lanes>(out, a, [](double v) { return std::sin(v); });
    case FieldOp::cos:
        return each<lanes>(out, a, [](double v) { return std::cos(v); });
    case FieldOp::tan:
        return each<lanes>(out, a, [](double v) { return std::tan(v); });
    case FieldOp::asin:
        return each<lanes>(out, a, [](double v) { return std::asin(v); });
    case FieldOp::acos:
        return each<lanes>(out, a, [](double v) { return std::acos(v); });
    case FieldOp::atan:
        return each<lanes>(out, a, [](double v) { return std::atan(v); });
    case FieldOp::sinh:
        return each<lanes>(out, a, [](double v) { return std::sinh(v); });
    case FieldOp::cosh:
        return each<lanes>(out, a, [](double v) { return std::cosh(v); });
    case FieldOp::tanh:
        return each<lanes>(out, a, [](double v) { return std::tanh(v); });
    case FieldOp::floor:
        return each<lanes>(out, a, [](double v) { return std::floor(v); });
    default: // ceil
        return each<lanes>(out, a, [](double v) { return std::ceil(v); });
    }
}

template <int lanes>
void run_binary(FieldOp op, double* out, const double* a, const double* b) {
    switch (op) {
    case FieldOp::add:
        return each<lanes>(out, a, b, [](double v, double w) { return v + w; });
    case FieldOp::subtract:
        return each<lanes>(out, a, b, [](double v, double w) { return v - w; });
    case FieldOp::multiply:
        return each<lanes>(out, a, b, [](double v, double w) { return v * w; });
    case FieldOp::divide:
        return each<lanes>(out, a, b, [](double v, double w) { return v / w; });
    case FieldOp::power:
        return each<lanes>(out, a, b, [](double v, double w) { return std::pow(v, w); });
    case FieldOp::modulo:
        return each<lanes>(out, a, b, [](double v, double w) { return std::fmod(v, w); });
    case FieldOp::less:
        return each<lanes>(out, a, b, [](double v, double w) { return v < w ? 1.0 : 0.0; });
    case FieldOp::greater:
        return each<lanes>(out, a, b, [](double v, double w) { return v > w ? 1.0 : 0.0; });
    case FieldOp::equal:
        return each<lanes>(out, a, b,
                           [](double v, double w) { return std::abs(v - w) < equal_within ? 1.0 : 0.0; });
    case FieldOp::less_equal:
        return each<lanes>(out, a, b, [](double v, double w) { return v <= w ? 1.0 : 0.0; });
    case FieldOp::greater_equal:
        return each<lanes>(out, a, b, [](double v, double w) { return v >= w ? 1.0 : 0.0; });
    case FieldOp::unequal:
        return each<lanes>(out, a, b,
                           [](double v, double w) { return std::abs(v - w) >= equal_within ? 1.0 : 0.0; });
    case FieldOp::both:
        return each<lanes>(out, a, b,
                           [](double v, double w) { return is_true(v) && is_true(w) ? 1.0 : 0.0; });
    case FieldOp::either:
        return each<lanes>(out, a, b,
                           [](double v, double w) { return is_true(v) || is_true(w) ? 1.0 : 0.0; });
    case FieldOp::minimum:
        return each<lanes>(out, a, b, [](double v, double w) { return std::min(v, w); });
    case FieldOp::maximum:
        return each<lanes>(out, a, b, [](double v, double w) { return std::max(v, w); });
    default: // arc
        return each<lanes>(out, a, b,
                           [](double v, double w) { return v == 0 && w == 0 ? 0.0 : std::atan2(v, w); });
    }
}

// `numbers` has room for `lanes` results of every step.
template <int lanes>
const double* run(const FieldProgram& program, const double* x, const double* y, const double* z,
                  double* numbers) {
    double* out = numbers;
    const auto number = [&](std::uint32_t i) { return numbers + i * std::uint32_t{lanes}; };
    for (const FieldStep& step : program.steps) {
        switch (step.op) {
        case FieldOp::constant:
            std::fill_n(out, lanes, step.value);
            break;
        case FieldOp::x:
            std::copy_n(x, lanes, out);
            break;
        case FieldOp::y:
            std::copy_n(y, lanes, out);
            break;
        case FieldOp::z:
            std::copy_n(z, lanes, out);
            break;
        case FieldOp::select: {
            const double *a = number(step.a), *b = number(step.b), *c = number(step.c), *d = number(step.d);
            for (int l = 0; l < lanes; ++l) out[l] = a[l] < 0 ? b[l] : a[l] == 0 ? c[l] : d[l];
            break;
        }
        case FieldOp::call:
            run_call<lanes>(program, step, numbers, out);
            break;
        default:
            if (step.op < FieldOp::negate)
                run_binary<lanes>(step.op, out, number(step.a), number(step.b));
            else
                run_unary<lanes>(step.op, out, number(step.a));
        }
        out += lanes;
    }
    return out - lanes;
}

} // namespace

bool has_enclosures(const FieldProgram& program) {
    return std::all_of(program.opaque.begin(), program.opaque.end(),
                       [](const OpaqueField& f) { return std::isfinite(f.lipschitz); });
}

double field_value(const FieldProgram& program, Vec3 p, FieldScratch& scratch) {
    if (scratch.size() < program.steps.size()) scratch.resize(program.steps.size(), boost::container::default_init);
    return *run<1>(program, &p.x, &p.y, &p.z, scratch.data());
}

void field_values(const FieldProgram& program, const FieldPoints& points, double (&values)[field_lanes],
                  FieldScratch& scratch) {
    const std::size_t size = program.steps.size() * field_lanes;
    if (scratch.size() < size) scratch.resize(size, boost::container::default_init);
    std::copy_n(run<field_lanes>(program, points.x, points.y, points.z, scratch.data()), field_lanes, values);
}

} // namespace pnr
