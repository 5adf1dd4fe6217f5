// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pattern.h"

#include <cmath>

namespace pnr {

namespace {

template <class... F>
struct Overload : F... {
    using F::operator()...;
};

// The fractional part as POV-Ray takes it: 1 stays 1, every other integer gives 0.
double ramp(double value, double tolerance) {
    const double nearest = std::round(value);
    if (std::abs(value - nearest) <= tolerance) return nearest == 1 ? 1 : 0;
    return value - std::floor(value);
}

// A transform's inverse, and how far rounding may move the result: a face that lies exactly on a pattern's
// border (the floor y = 0 under a checker, the top y = 1 of a gradient) must not flicker between two colours.
// POV-Ray's own tolerance is of the same kind and size (1e-9 is already on the other side of the border
// there, 1e-12 is not).
void go_back(const Transform& transform, SurfacePoint& at) {
    constexpr double rounding = 0x1p-50; // four roundings of the largest term
    double largest = 0;
    for (int row = 0; row < 3; ++row) {
        double sum = std::abs(transform.inverse[3][row]);
        for (int column = 0; column < 3; ++column)
            sum += std::abs(transform.inverse[column][row] * at.point[column]);
        largest = std::max(largest, sum);
    }
    at.point = transform_point(transform.inverse, at.point);
    at.tolerance = std::max(at.tolerance, 1e-10 + rounding * largest);
}

double checker(const SurfacePoint& at) {
    const Vec3 cell = glm::floor(at.point + Vec3(at.tolerance));
    return std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0);
}

double gradient(const GradientPattern& pattern, const SurfacePoint& at) {
    const double length = glm::length(pattern.axis);
    return length > 0 ? ramp(glm::dot(at.point, pattern.axis / length), at.tolerance) : 0;
}

double value_of(const Pattern& pattern, const SurfacePoint& at) {
    return std::visit(Overload{[&](const CheckerPattern&) { return checker(at); },
                               [&](const GradientPattern& kind) { return gradient(kind, at); },
                               [&](const FunctionPattern& kind) { return kind.value(at.point); },
                               [](const auto&) { return 0.0; }},
                      pattern.kind);
}

double shaped(const Pattern& pattern, double value, double tolerance) {
    return ramp(value * pattern.frequency + pattern.phase, tolerance);
}

} // namespace

void set_kind(Pattern& pattern, PatternKind kind) {
    pattern.kind = std::move(kind);
    pattern.wave = Wave::ramp;
}

void add_warp(Pattern& pattern, Warp warp) {
    if (!is_identity(pattern.transform)) {
        pattern.warps.push_back(TransformWarp{pattern.transform});
        pattern.transform = {};
    }
    pattern.warps.push_back(std::move(warp));
}

int list_size(const Pattern& pattern) {
    return std::visit(
        Overload{[](const CheckerPattern&) { return 2; }, [](const HexagonPattern&) { return 3; },
                 [](const CubicPattern&) { return 6; }, [](const SquarePattern&) { return 4; },
                 [](const TriangularPattern&) { return 6; }, [](const BrickPattern&) { return 2; },
                 [](const ObjectPattern&) { return 2; }, [](const auto&) { return 0; }},
        pattern.kind);
}

SurfacePoint to_pattern_space(const Pattern& pattern, const SurfacePoint& at) {
    SurfacePoint here = at;
    here.tolerance = 1e-10;
    if (pattern.uv_mapping) here.point = Vec3(at.uv, 0);
    go_back(pattern.transform, here);
    for (auto warp = pattern.warps.rbegin(); warp != pattern.warps.rend(); ++warp) {
        if (const auto* transform = std::get_if<TransformWarp>(&*warp))
            go_back(transform->transform, here);
        else
            here.point = warp_point(*warp, here.point);
    }
    return here;
}

double eval_pattern_here(const Pattern& pattern, const SurfacePoint& warped) {
    const double value = value_of(pattern, warped);
    if (!std::isfinite(value)) return 0;
    return is_list_pattern(pattern) ? value : shaped(pattern, value, warped.tolerance);
}

double eval_pattern(const Pattern& pattern, const SurfacePoint& at) {
    return eval_pattern_here(pattern, to_pattern_space(pattern, at));
}

} // namespace pnr
