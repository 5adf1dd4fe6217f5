// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/spline.h"

#include "parser/builtins.h"
#include "parser/expression.h"

#include <fmt/format.h>

#include <algorithm>

namespace pnr {

namespace {

using Knots = std::vector<SplineKnot>;

// On the straight line through the knots i - 1 and i.
double linear_value(const Knots& k, std::size_t i, std::size_t c, double t) {
    const double u = (t - k[i - 1].parameter) / (k[i].parameter - k[i - 1].parameter);
    return k[i - 1].point[c] * (1 - u) + k[i].point[c] * u;
}

// On the parabola through the knots i - 2, i - 1 and i.
double quadratic_value(const Knots& k, std::size_t i, std::size_t c, double t) {
    const SplineKnot &p = k[i - 2], &q = k[i - 1], &r = k[i];
    const double a = t - p.parameter, b = t - q.parameter, d = t - r.parameter;
    const double pq = p.parameter - q.parameter, pr = p.parameter - r.parameter,
                 qr = q.parameter - r.parameter;
    return p.point[c] * b * d / (pq * pr) - q.point[c] * a * d / (pq * qr) + r.point[c] * a * b / (pr * qr);
}

double slope(const Knots& k, std::size_t i, std::size_t c) {
    return (k[i].point[c] - k[i - 1].point[c]) / (k[i].parameter - k[i - 1].parameter);
}

// Hermite's cubic between the knots i - 1 and i; the tangent in a knot is the mean of the slopes beside it.
double cubic_value(const Knots& k, std::size_t i, std::size_t c, double t) {
    const double h = k[i].parameter - k[i - 1].parameter, u = (t - k[i - 1].parameter) / h, w = 1 - u;
    const double before = (slope(k, i - 1, c) + slope(k, i, c)) / 2 * h;
    const double behind = (slope(k, i, c) + slope(k, i + 1, c)) / 2 * h;
    return w * w * (1 + 2 * u) * k[i - 1].point[c] + u * w * w * before +
           u * u * (1 + 2 * w) * k[i].point[c] - u * u * w * behind;
}

double natural_value(const Knots& k, std::size_t i, std::size_t c, double t) {
    const double h = k[i].parameter - k[i - 1].parameter, u = (t - k[i - 1].parameter) / h, w = 1 - u;
    return w * k[i - 1].point[c] + u * k[i].point[c] +
           ((w * w * w - w) * k[i - 1].bend[c] + (u * u * u - u) * k[i].bend[c]) * h * h / 6;
}

} // namespace

void set_bends(Spline& spline) {
    Knots& k = spline.knots;
    if (k.size() < 3) return;
    std::vector<double> upper(k.size()), right(k.size());
    for (std::size_t c = 0; c < static_cast<std::size_t>(spline.components); ++c) {
        upper[0] = right[0] = 0;
        for (std::size_t i = 1; i + 1 < k.size(); ++i) {
            const double h = k[i].parameter - k[i - 1].parameter, next = k[i + 1].parameter - k[i].parameter;
            const double pivot = 2 * (h + next) - h * upper[i - 1];
            upper[i] = next / pivot;
            right[i] = (6 * (slope(k, i + 1, c) - slope(k, i, c)) - h * right[i - 1]) / pivot;
        }
        k.back().bend[c] = 0;
        for (std::size_t i = k.size() - 1; i-- > 1;) k[i].bend[c] = right[i] - upper[i] * k[i + 1].bend[c];
        k[0].bend[c] = 0;
    }
}

void evaluate(const Spline& spline, SplineKind kind, double parameter, double* result) {
    const Knots& k = spline.knots;
    const std::size_t last = k.size() - 1;
    const bool cubic = kind == SplineKind::cubic && k.size() > 2;
    const std::size_t first_used = cubic ? 1 : 0, last_used = cubic ? last - 1 : last;
    const auto above = std::upper_bound(k.begin(), k.end(), parameter,
                                        [](double t, const SplineKnot& knot) { return t < knot.parameter; });
    const auto i = static_cast<std::size_t>(above - k.begin()); // the knot behind the parameter
    for (std::size_t c = 0; c < static_cast<std::size_t>(spline.components); ++c) {
        if (kind == SplineKind::cubic && k.size() == 2)
            result[c] = (k[0].point[c] + k[1].point[c]) / 2; // as POV-Ray does
        else if (i <= first_used)
            result[c] = k[first_used].point[c];
        else if (i > last_used)
            result[c] = k[last_used].point[c];
        else if (kind == SplineKind::linear || k.size() == 2)
            result[c] = linear_value(k, i, c, parameter);
        else if (kind == SplineKind::quadratic)
            result[c] = quadratic_value(k, std::max<std::size_t>(i, 2), c, parameter);
        else if (kind == SplineKind::cubic)
            result[c] = cubic_value(k, i, c, parameter);
        else
            result[c] = natural_value(k, i, c, parameter);
    }
}

// ---- its text

namespace {

std::optional<SplineKind> accept_kind(Parser& p) {
    const auto kind = [&]() -> std::optional<SplineKind> {
        switch (keyword_of(peek(p))) {
        case "linear_spline"_kw:
            return SplineKind::linear;
        case "quadratic_spline"_kw:
            return SplineKind::quadratic;
        case "cubic_spline"_kw:
            return SplineKind::cubic;
        case "natural_spline"_kw:
            return SplineKind::natural;
        default:
            return std::nullopt;
        }
    }();
    if (kind) next(p);
    return kind;
}

// The spline that an identifier, which is next, stands for; taken then.
std::shared_ptr<const Spline> accept_spline(Parser& p) {
    const Token& token = peek(p);
    const Value* value = token.kind == TokenKind::word ? lookup(p.in, token.symbol) : nullptr;
    const auto* spline = value ? std::get_if<std::shared_ptr<const Spline>>(&value->data) : nullptr;
    if (!spline) return nullptr;
    const std::shared_ptr<const Spline> found = *spline;
    next(p);
    tell_thing(p.in, found.get());
    return found;
}

// A later point with the same parameter takes the place of the earlier one.
void insert_knot(Spline& spline, const SplineKnot& knot) {
    const auto place =
        std::lower_bound(spline.knots.begin(), spline.knots.end(), knot,
                         [](const SplineKnot& a, const SplineKnot& b) { return a.parameter < b.parameter; });
    if (place != spline.knots.end() && place->parameter == knot.parameter)
        *place = knot;
    else
        spline.knots.insert(place, knot);
}

void parse_knot(Parser& p, Spline& spline, SplineKnot& knot) {
    knot.parameter = parse_float(p);
    accept_comma(p);
    const Token at = peek(p);
    VectorValue point = parse_operand_expression(p, Angles::bracket);
    promote(point, 2);
    for (const double v : point.v) tell(p.in, v);
    accept_comma(p);
    spline.components = std::max(spline.components, point.size);
    std::copy_n(point.v, point.size,
                knot.point.begin()); // what a shorter point lacks is as in the one before
    charge(p, at, sizeof(SplineKnot));
    charge_work(p, at, static_cast<std::int64_t>(spline.knots.size() / 64));
    insert_knot(spline, knot);
}

} // namespace

std::shared_ptr<const Spline> parse_spline(Parser& p) {
    auto spline = std::make_shared<Spline>();
    SplineKnot knot;
    const Token opener = peek(p);
    block(p, "spline", [&] {
        if (const auto declared = accept_spline(p))
            *spline = *declared;
        else if (const auto kind = accept_kind(p))
            spline->kind = *kind;
        else
            parse_knot(p, *spline, knot);
    });
    if (spline->knots.empty()) fail(p, opener, "a spline needs at least one point");
    set_bends(*spline);
    remember_told(p.in, spline.get());
    return spline;
}

VectorValue call_spline(Parser& p, const Token& name, const std::shared_ptr<const Spline>& spline) {
    const Nesting nesting(p, name);
    open_arguments(p, name);
    const double parameter = number_argument(p);
    SplineKind kind = spline->kind;
    if (accept(p, ',')) {
        const auto other = accept_kind(p);
        if (!other)
            fail(p, peek(p),
                 "expected linear_spline, quadratic_spline, cubic_spline or natural_spline behind the comma");
        kind = *other;
    }
    close_arguments(p, name);
    VectorValue result;
    result.size = spline->components;
    evaluate(*spline, kind, parameter, result.v);
    return result;
}

} // namespace pnr
