// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/function_field.h"

#include "core/internal_functions.h"
#include "parser/keywords.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <tuple>

namespace pnr {

namespace {

using Kind = Instruction::Kind;
using Number = std::uint32_t;

// Beyond this many steps calls are no longer written out but called.
constexpr std::size_t most_steps = 4000;

struct Writer {
    FieldProgram program;
    std::map<std::tuple<FieldOp, Number, Number, Number, Number, std::uint64_t>, Number> known;

    bool is_constant(Number i) const { return program.steps[i].op == FieldOp::constant; }

    Number add(FieldStep step) {
        const bool commutes = step.op == FieldOp::add || step.op == FieldOp::multiply ||
                              step.op == FieldOp::minimum || step.op == FieldOp::maximum;
        if (commutes && step.b < step.a) std::swap(step.a, step.b);
        const auto [entry, is_new] = known.try_emplace(
            {step.op, step.a, step.b, step.c, step.d, std::bit_cast<std::uint64_t>(step.value)},
            static_cast<Number>(program.steps.size()));
        if (is_new) program.steps.push_back(step);
        return entry->second;
    }
    Number constant(double value) { return add({FieldOp::constant, 0, 0, 0, 0, value}); }

    // A step of one or two numbers; done now if they are constant.
    Number apply(FieldOp op, Number a, Number b = 0) {
        const bool unary = op >= FieldOp::negate;
        if (is_constant(a) && (unary || is_constant(b))) {
            FieldProgram one;
            one.steps = {program.steps[a], program.steps[b], {op, 0, 1, 0, 0, 0}};
            FieldScratch scratch;
            return constant(field_value(one, Vec3(0), scratch));
        }
        return add({op, a, b, 0, 0, 0});
    }

    Number call(OpaqueField callee, const std::vector<Number>& arguments) {
        FieldStep step;
        step.op = FieldOp::call;
        step.a = static_cast<Number>(program.opaque.size());
        step.b = static_cast<Number>(program.arguments.size());
        callee.parameters = static_cast<std::uint32_t>(arguments.size());
        program.opaque.push_back(std::move(callee));
        program.arguments.insert(program.arguments.end(), arguments.begin(), arguments.end());
        program.steps.push_back(step);
        return static_cast<Number>(program.steps.size() - 1);
    }
};

FieldOp binary_op(Kind kind) {
    switch (kind) {
    case Kind::add:
        return FieldOp::add;
    case Kind::subtract:
        return FieldOp::subtract;
    case Kind::multiply:
        return FieldOp::multiply;
    case Kind::divide:
        return FieldOp::divide;
    case Kind::power:
        return FieldOp::power;
    case Kind::modulo:
        return FieldOp::modulo;
    case Kind::less:
        return FieldOp::less;
    case Kind::greater:
        return FieldOp::greater;
    case Kind::equal:
        return FieldOp::equal;
    case Kind::less_equal:
        return FieldOp::less_equal;
    case Kind::greater_equal:
        return FieldOp::greater_equal;
    case Kind::unequal:
        return FieldOp::unequal;
    case Kind::both:
        return FieldOp::both;
    case Kind::either:
        return FieldOp::either;
    case Kind::minimum:
        return FieldOp::minimum;
    case Kind::maximum:
        return FieldOp::maximum;
    default:
        return FieldOp::arc;
    }
}

// Of functions that are one step; constant: none.
FieldOp unary_op(Keyword word) {
    switch (word) {
    case "abs"_kw:
        return FieldOp::abs;
    case "sqr"_kw:
        return FieldOp::sqr;
    case "sqrt"_kw:
        return FieldOp::sqrt;
    case "exp"_kw:
        return FieldOp::exp;
    case "ln"_kw:
        return FieldOp::ln;
    case "log"_kw:
        return FieldOp::log;
    case "sin"_kw:
        return FieldOp::sin;
    case "cos"_kw:
        return FieldOp::cos;
    case "tan"_kw:
        return FieldOp::tan;
    case "asin"_kw:
        return FieldOp::asin;
    case "acos"_kw:
        return FieldOp::acos;
    case "atan"_kw:
        return FieldOp::atan;
    case "sinh"_kw:
        return FieldOp::sinh;
    case "cosh"_kw:
        return FieldOp::cosh;
    case "tanh"_kw:
        return FieldOp::tanh;
    case "floor"_kw:
        return FieldOp::floor;
    case "ceil"_kw:
        return FieldOp::ceil;
    default:
        return FieldOp::constant;
    }
}

Number write_unary(Writer& w, const Instruction& step, Number a) {
    const auto word = static_cast<Keyword>(step.index);
    if (const FieldOp op = unary_op(word); op != FieldOp::constant) return w.apply(op, a);
    switch (word) {
    case "radians"_kw:
        return w.apply(FieldOp::multiply, a, w.constant(pi / 180));
    case "degrees"_kw:
        return w.apply(FieldOp::multiply, a, w.constant(180 / pi));
    case "int"_kw: { // towards zero
        const Number below = w.apply(FieldOp::ceil, a), above = w.apply(FieldOp::floor, a);
        return w.add({FieldOp::select, a, below, above, above, 0});
    }
    default:
        return w.call({[f = step.function](const double* v) { return f(v[0]); }}, {a});
    }
}

// Internal functions that are a few steps; the others are called.
std::optional<Number> write_internal(Writer& w, std::string_view name, const std::vector<Number>& a) {
    const auto squares = [&](Number p, Number q) {
        return w.apply(FieldOp::add, w.apply(FieldOp::sqr, p), w.apply(FieldOp::sqr, q));
    };
    const auto distance = [&] {
        return w.apply(FieldOp::sqrt,
                       w.apply(FieldOp::add, squares(a[0], a[1]), w.apply(FieldOp::sqr, a[2])));
    };
    if (name == "f_r") return distance();
    if (name == "f_sphere") return w.apply(FieldOp::subtract, distance(), a[3]);
    if (name == "f_torus") { // about y
        const Number ring = w.apply(FieldOp::subtract, w.apply(FieldOp::sqrt, squares(a[0], a[2])), a[3]);
        return w.apply(FieldOp::subtract, w.apply(FieldOp::sqrt, squares(ring, a[1])), a[4]);
    }
    return std::nullopt;
}

// What is known of the values and the steepness of internal functions.
OpaqueField known_bounds(const Writer& w, std::string_view name, const std::vector<Number>& arguments) {
    OpaqueField field;
    if (name != "f_noise_generator") return field;
    field.low = 0, field.high = 1;
    // The steepest places that searching has found: 2.77 of generator 1, 1.36 of the others.
    const FieldStep& generator = w.program.steps[arguments[3]];
    const bool newer = generator.op == FieldOp::constant && (generator.value == 2 || generator.value == 3);
    field.lipschitz = newer ? 1.5 : 3;
    return field;
}

Number write_function(Writer& w, const std::shared_ptr<const Function>& function,
                      const std::vector<Number>& arguments, std::uint8_t component);

bool has_series(const Function& function) {
    return std::any_of(function.code.begin(), function.code.end(), [](const Instruction& step) {
        return step.kind == Kind::sum || step.kind == Kind::product;
    });
}

Number write_opaque(Writer& w, const std::shared_ptr<const Function>& function,
                    const std::vector<Number>& arguments, std::uint8_t component) {
    OpaqueField field;
    if (function->native)
        field.value = [function, component](const double* v) {
            double results[5] = {};
            function->native(v, results);
            return results[component];
        };
    else
        field.value = [function](const double* v) {
            return evaluate(*function, std::span(v, static_cast<std::size_t>(function->parameters)));
        };
    return w.call(std::move(field), arguments);
}

Number write_step(Writer& w, const Function& function, const Instruction& step, std::vector<Number>& stack) {
    const auto take = [&](int count) {
        std::vector<Number> taken(stack.end() - count, stack.end());
        stack.resize(stack.size() - static_cast<std::size_t>(count));
        return taken;
    };
    switch (step.kind) {
    case Kind::constant:
        return w.constant(step.value);
    case Kind::negate:
        return w.apply(FieldOp::negate, take(1)[0]);
    case Kind::invert:
        return w.apply(FieldOp::invert, take(1)[0]);
    case Kind::unary:
        return write_unary(w, step, take(1)[0]);
    case Kind::select: {
        const auto a = take(4);
        return w.add({FieldOp::select, a[0], a[1], a[2], a[3], 0});
    }
    case Kind::select_of_three: {
        const auto a = take(3);
        return w.add({FieldOp::select, a[0], a[1], a[2], a[2], 0});
    }
    case Kind::call: {
        const auto& callee = function.calls[step.index];
        return write_function(w, callee, take(callee->parameters), step.component);
    }
    case Kind::internal: {
        const InternalFunction& internal = internal_functions()[step.index];
        const auto a = take(internal.parameters);
        if (const auto written = write_internal(w, internal.name, a)) return *written;
        OpaqueField field = known_bounds(w, internal.name, a);
        field.value = internal.evaluate;
        return w.call(std::move(field), a);
    }
    case Kind::quotient: {
        const auto a = take(2);
        const Number ratio = w.apply(FieldOp::divide, a[0], a[1]);
        return write_unary(w, {.kind = Kind::unary, .index = static_cast<std::uint32_t>("int"_kw)}, ratio);
    }
    default: {
        const auto a = take(2);
        return w.apply(binary_op(step.kind), a[0], a[1]);
    }
    }
}

Number write_function(Writer& w, const std::shared_ptr<const Function>& function,
                      const std::vector<Number>& arguments, std::uint8_t component) {
    if (function->native || has_series(*function) || w.program.steps.size() > most_steps)
        return write_opaque(w, function, arguments, component);
    std::vector<Number> stack;
    for (const Instruction& step : function->code)
        stack.push_back(step.kind == Kind::argument ? arguments[step.index]
                                                    : write_step(w, *function, step, stack));
    return stack.back();
}

// Only what the last step needs.
FieldProgram pruned(const FieldProgram& all, Number last) {
    std::vector<bool> needed(all.steps.size());
    needed[last] = true;
    const auto is_used = [&](const FieldStep& step, auto use) {
        if (step.op == FieldOp::call) {
            for (std::uint32_t k = 0; k < all.opaque[step.a].parameters; ++k) use(all.arguments[step.b + k]);
        } else if (step.op > FieldOp::z) {
            use(step.a);
            if (step.op < FieldOp::negate || step.op == FieldOp::select) use(step.b);
            if (step.op == FieldOp::select) use(step.c), use(step.d);
        }
    };
    for (Number i = last + 1; i-- > 0;)
        if (needed[i]) is_used(all.steps[i], [&](Number used) { needed[used] = true; });
    FieldProgram kept;
    std::vector<Number> place(all.steps.size());
    for (Number i = 0; i <= last; ++i) {
        if (!needed[i]) continue;
        FieldStep step = all.steps[i];
        if (step.op == FieldOp::call) {
            const OpaqueField& callee = all.opaque[step.a];
            const auto first = static_cast<Number>(kept.arguments.size());
            for (std::uint32_t k = 0; k < callee.parameters; ++k)
                kept.arguments.push_back(place[all.arguments[step.b + k]]);
            step.a = static_cast<Number>(kept.opaque.size()), step.b = first;
            kept.opaque.push_back(callee);
        } else {
            step.a = place[step.a], step.b = place[step.b], step.c = place[step.c], step.d = place[step.d];
        }
        place[i] = static_cast<Number>(kept.steps.size());
        kept.steps.push_back(step);
    }
    return kept;
}

} // namespace

FieldProgram field_program(const std::shared_ptr<const Function>& function) {
    Writer w;
    std::vector<Number> arguments{w.add({FieldOp::x}), w.add({FieldOp::y}), w.add({FieldOp::z})};
    arguments.resize(static_cast<std::size_t>(std::min(function->parameters, 3)));
    const Number last = write_function(w, function, arguments, 0);
    return pruned(w.program, last);
}

} // namespace pnr
