// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pigment.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// A pattern's point and how far rounding may have moved it: a face that lies exactly on a pattern's border
// (the floor y = 0 under a checker, the top y = 1 of a gradient) must not flicker between two colours.
// POV-Ray's own tolerance is of the same kind and size (1e-9 is already on the other side of the border
// there, 1e-12 is not).
struct PatternPoint {
    Vec3 p;
    double tolerance;
};

PatternPoint to_pattern_space(const Transform& transform, Vec3 point) {
    constexpr double rounding = 0x1p-50; // four roundings of the largest term
    double largest = 0;
    for (int row = 0; row < 3; ++row) {
        double sum = std::abs(transform.inverse[3][row]);
        for (int column = 0; column < 3; ++column)
            sum += std::abs(transform.inverse[column][row] * point[column]);
        largest = std::max(largest, sum);
    }
    return {transform_point(transform.inverse, point), 1e-10 + rounding * largest};
}

// The fractional part as POV-Ray takes it: 1 stays 1, every other integer gives 0.
double ramp(double value, double tolerance) {
    const double nearest = std::round(value);
    if (std::abs(value - nearest) <= tolerance) return nearest == 1 ? 1 : 0;
    return value - std::floor(value);
}

ColorFT mix_colors(const ColorFT& a, const ColorFT& b, float t) {
    return {a.rgb + t * (b.rgb - a.rgb), a.filter + t * (b.filter - a.filter),
            a.transmit + t * (b.transmit - a.transmit)};
}

// Linear between stops, constant beyond the first and the last; where two stops share a position the earlier
// one counts there.
ColorFT map_color(const std::vector<ColorStop>& map, double value) {
    std::size_t next = 0;
    while (next < map.size() && map[next].position < value) ++next;
    if (next == 0) return map.front().color;
    if (next == map.size()) return map.back().color;
    const ColorStop& low = map[next - 1];
    const ColorStop& high = map[next];
    const double width = high.position - low.position;
    if (!(width > 0)) return high.color;
    return mix_colors(low.color, high.color, static_cast<float>((value - low.position) / width));
}

// ---- pictures
// -------------------------------------------------------------------------------------------------

// Where a point lies in the picture: u to the right, v up, the picture is the unit square.
struct PictureSpot {
    Vec2 uv{0};
    bool inside = true; // false: outside a picture that is shown once
};

double angle_about_y(Vec3 p) { // in turns, 0 at +x, a quarter at +z
    const double turns = std::atan2(p.z, p.x) / (2 * pi);
    return turns < 0 ? turns + 1 : turns;
}

PictureSpot picture_spot(const ImagePattern& pattern, Vec3 p, Vec2 surface_uv) {
    const auto within = [](double x) { return x >= 0 && x <= 1; };
    switch (pattern.map_type) {
    case ImageMapType::planar:
        return {{p.x, p.y}, !pattern.once || (within(p.x) && within(p.y))};
    case ImageMapType::spherical: {
        const double length = glm::length(p);
        if (!(length > 0)) return {{0, 0}, false};
        return {{angle_about_y(p), 0.5 + std::asin(std::clamp(p.y / length, -1.0, 1.0)) / pi}, true};
    }
    case ImageMapType::cylindrical:
        return {{angle_about_y(p), p.y}, !pattern.once || within(p.y)};
    case ImageMapType::torus: { // about a ring of radius 1 in the xz plane
        const double ring = std::hypot(p.x, p.z) - 1;
        const double around = std::atan2(-p.y, -ring) / (2 * pi);
        return {{angle_about_y(p), around < 0 ? around + 1 : around}, true};
    }
    case ImageMapType::uv:
        return {surface_uv, !pattern.once || (within(surface_uv.x) && within(surface_uv.y))};
    }
    return {};
}

glm::vec4 texel(const Image<glm::vec4>& image, int x, int y, bool once) {
    const auto wrap = [once](int i, int n) { return once ? std::clamp(i, 0, n - 1) : ((i % n) + n) % n; };
    return image.at(wrap(x, image.width), wrap(y, image.height));
}

ColorFT picture_color(const ImagePattern& pattern, Vec3 point, Vec2 uv) {
    const ColorFT clear{Color(1), 0, 1};
    if (!pattern.image || pattern.image->empty()) return clear;
    const Image<glm::vec4>& image = *pattern.image;
    const PictureSpot spot = picture_spot(pattern, point, uv);
    if (!spot.inside || !std::isfinite(spot.uv.x) || !std::isfinite(spot.uv.y)) return clear;
    // Into the unit square first: far tiles would overflow an int.
    const auto tile = [&](double x) { return pattern.once ? x : x - std::floor(x); };
    const double x = tile(spot.uv.x) * image.width;
    const double y = (1 - tile(spot.uv.y)) * image.height;
    glm::vec4 value;
    if (!pattern.interpolate) {
        value = texel(image, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), pattern.once);
    } else { // between the four nearest pixel centres
        const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
        const float s = static_cast<float>(x - 0.5 - left), t = static_cast<float>(y - 0.5 - top);
        const int i = static_cast<int>(left), j = static_cast<int>(top);
        const glm::vec4 upper =
            glm::mix(texel(image, i, j, pattern.once), texel(image, i + 1, j, pattern.once), s);
        const glm::vec4 lower =
            glm::mix(texel(image, i, j + 1, pattern.once), texel(image, i + 1, j + 1, pattern.once), s);
        value = glm::mix(upper, lower, t);
    }
    return {Color(value), 0, 1 - value.w};
}

struct PatternColor {
    const Pigment& pigment;
    Vec3 point;
    Vec2 uv;

    ColorFT operator()(const UniformPattern&) const { return pigment.map.front().color; }
    ColorFT operator()(const CheckerPattern&) const {
        const PatternPoint at = to_pattern_space(pigment.transform, point);
        const Vec3 cell = glm::floor(at.p + Vec3(at.tolerance));
        const bool odd = std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0) == 1;
        return odd && pigment.map.size() > 1 ? pigment.map[1].color : pigment.map.front().color;
    }
    ColorFT operator()(const GradientPattern& gradient) const {
        const double length = glm::length(gradient.axis);
        if (!(length > 0)) return pigment.map.front().color;
        const PatternPoint at = to_pattern_space(pigment.transform, point);
        const double value = ramp(glm::dot(at.p, gradient.axis / length), at.tolerance);
        return map_color(pigment.map, ramp(value * pigment.frequency + pigment.phase, at.tolerance));
    }
    ColorFT operator()(const ImagePattern& pattern) const {
        return picture_color(pattern, transform_point(pigment.transform.inverse, point), uv);
    }
};

} // namespace

ColorFT eval_pigment(const Pigment& pigment, Vec3 point, Vec2 uv) {
    return std::visit(PatternColor{pigment, point, uv}, pigment.pattern);
}

} // namespace pnr
