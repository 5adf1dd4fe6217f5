// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pattern.h"

#include "core/density_grid.h"
#include "core/noise.h"
#include "core/pattern_values.h"
#include "core/picture.h"
#include "core/pigment.h"

#include <cmath>

namespace pnr {

namespace {

template <class... F>
struct Overload : F... {
    using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>; // clang 14 does not find it by itself

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

// 1 stays 1, every other positive integer gives 0.
double reduced(double value) { return value > 1 ? std::fmod(value, 1.0) : value; }

double gradient(const GradientPattern& pattern, const SurfacePoint& at) {
    const double length = glm::length(pattern.axis);
    if (!(length > 0)) return 0;
    const double value = glm::dot(at.point, pattern.axis / length), nearest = std::round(value);
    return reduced(std::abs(value - nearest) <= at.tolerance ? nearest : value);
}

// How far a direction leans from another, as POV-Ray's slope: 0 against it, 1 along it, linear in the angle.
double lean(Vec3 direction, Vec3 normal) {
    const double length = glm::length(direction) * glm::length(normal);
    if (!(length > 0)) return 0;
    return 1 - std::acos(std::clamp(glm::dot(direction, normal) / length, -1.0, 1.0)) / pi;
}

double stretched(double value, double low, double high) {
    return high > low ? (value - low) / (high - low) : value;
}

double slope(const SlopePattern& kind, const SurfacePoint& at) {
    const Vec3 direction = kind.toward_point ? kind.direction - at.point : kind.direction;
    double value = stretched(lean(direction, at.normal), kind.low_slope, kind.high_slope);
    const double length = glm::length(kind.altitude);
    if (length > 0)
        value = 0.5 * value + 0.5 * stretched(glm::dot(at.point, kind.altitude / length), kind.low_altitude,
                                              kind.high_altitude);
    return value;
}

// 1 where the ray meets the surface head on, 0.5 where it grazes it.
double angle_of_incidence(const SurfacePoint& at) {
    return std::acos(std::clamp(glm::dot(at.normal, at.direction), -1.0, 1.0)) / pi;
}

double brightness(const ColorFT& c) { return 0.297 * c.rgb.x + 0.589 * c.rgb.y + 0.114 * c.rgb.z; }

double picture_value(const ImagePattern& kind, Vec3 point) {
    const auto pixel = picture_at(kind, point);
    if (!pixel) return 0;
    if (pixel->w < 1 && !kind.use_color) return static_cast<double>(pixel->w);
    return brightness({Color(*pixel)});
}

struct RawValue {
    const Pattern& pattern;
    const SurfacePoint& at;

    double operator()(const UniformPattern&) const { return 0; }
    double operator()(const AveragePattern&) const { return 0; }
    double operator()(const FacetsPattern&) const { return 0; }
    double operator()(const ImagePattern& kind) const { return picture_value(kind, at.point); }
    double operator()(const DensityFilePattern& kind) const {
        return kind.grid ? density_at(*kind.grid, at.point, kind.interpolate) : 0;
    }
    double operator()(const GradientPattern& kind) const { return gradient(kind, at); }
    double operator()(const PlainPattern& kind) const { return value_of(kind, pattern, at); }
    double operator()(const AgatePattern& kind) const { return value_of(kind, pattern, at); }
    double operator()(const SpiralPattern& kind) const { return value_of(kind, pattern, at); }
    double operator()(const CracklePattern& kind) const { return value_of(kind, pattern, at); }
    double operator()(const SlopePattern& kind) const { return slope(kind, at); }
    double operator()(const AoiPattern&) const { return angle_of_incidence(at); }
    double operator()(const ObjectPattern& kind) const { return kind.inside && kind.inside(at.point); }
    double operator()(const PigmentPattern& kind) const {
        return brightness(eval_pigment(*kind.pigment, at));
    }
    double operator()(const FunctionPattern& kind) const {
        return kind.value ? reduced(kind.value(at.point)) : 0;
    }
    double operator()(const auto& kind) const { return value_of(kind, at); }
};

// Frequency, phase and wave. The remainder is POV-Ray's: a little above 1, so that 1 itself stays 1.
double shaped(const Pattern& pattern, double value) {
    if (pattern.frequency != 0) value = std::fmod(value * pattern.frequency + pattern.phase, 1.00001);
    if (value < 0) value -= std::floor(value);
    switch (pattern.wave) {
    case Wave::ramp:
        return value;
    case Wave::triangle:
        return triangle_wave(value);
    case Wave::sine:
        return 0.5 * (1 + cycloid(value));
    case Wave::scallop:
        return std::abs(cycloid(value * 0.5));
    case Wave::cubic:
        return value * value * (3 - 2 * value);
    case Wave::poly:
        return std::pow(value, pattern.exponent);
    }
    return value;
}

// Marble and wood, whose wave is a triangle, too.
bool uses_turbulence_itself(const Pattern& pattern) {
    const auto* plain = std::get_if<PlainPattern>(&pattern.kind);
    return plain && (plain->kind == PlainKind::marble || plain->kind == PlainKind::wood);
}

} // namespace

void set_kind(Pattern& pattern, PatternKind kind) {
    pattern.kind = std::move(kind);
    const bool triangle =
        uses_turbulence_itself(pattern) || std::holds_alternative<SpiralPattern>(pattern.kind);
    pattern.wave = triangle ? Wave::triangle : Wave::ramp;
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
    if (pattern.turbulence && !uses_turbulence_itself(pattern))
        here.point = warp_point(*pattern.turbulence, here.point);
    return here;
}

double eval_pattern_here(const Pattern& pattern, const SurfacePoint& warped) {
    const double value = std::visit(RawValue{pattern, warped}, pattern.kind);
    if (!std::isfinite(value)) return 0;
    return is_list_pattern(pattern) ? value : shaped(pattern, value);
}

double eval_pattern(const Pattern& pattern, const SurfacePoint& at) {
    return eval_pattern_here(pattern, to_pattern_space(pattern, at));
}

} // namespace pnr
