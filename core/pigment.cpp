// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pigment.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

ColorFT mix_colors(const ColorFT& a, const ColorFT& b, float t) {
    return {a.rgb + t * (b.rgb - a.rgb), a.filter + t * (b.filter - a.filter),
            a.transmit + t * (b.transmit - a.transmit)};
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

ColorFT average(const Pigment& pigment, const SurfacePoint& here) {
    ColorFT sum;
    double weights = 0;
    const auto add = [&](const ColorFT& c, double weight) {
        const float w = static_cast<float>(weight);
        sum.rgb += w * c.rgb, sum.filter += w * c.filter, sum.transmit += w * c.transmit;
        weights += weight;
    };
    for (const auto& entry : pigment.pigments) add(eval_pigment(entry.value, here), entry.position);
    if (pigment.pigments.empty())
        for (const ColorStop& stop : pigment.map) add(stop.color, stop.position);
    if (!(weights > 0)) return pigment.map.front().color;
    const float scale = static_cast<float>(1 / weights);
    return {sum.rgb * scale, sum.filter * scale, sum.transmit * scale};
}

} // namespace

ColorFT eval_pigment(const Pigment& pigment, const SurfacePoint& at) {
    const Pattern& pattern = pigment.pattern;
    if (std::holds_alternative<UniformPattern>(pattern.kind)) return pigment.map.front().color;
    const SurfacePoint here = to_pattern_space(pattern, at);
    if (const auto* picture = std::get_if<ImagePattern>(&pattern.kind))
        return picture_color(*picture, here.point, at.uv);
    if (std::holds_alternative<AveragePattern>(pattern.kind)) return average(pigment, here);
    const double value = eval_pattern_here(pattern, here);
    const bool list = is_list_pattern(pattern);
    if (!pigment.pigments.empty()) {
        const BlendSpot spot = look_up(pigment.pigments, value, list);
        const ColorFT low = eval_pigment(pigment.pigments[spot.low].value, here);
        if (spot.low == spot.high) return low;
        return mix_colors(low, eval_pigment(pigment.pigments[spot.high].value, here),
                          static_cast<float>(spot.weight));
    }
    const BlendSpot spot = look_up(pigment.map, value, list);
    return mix_colors(pigment.map[spot.low].color, pigment.map[spot.high].color,
                      static_cast<float>(spot.weight));
}

bool is_see_through(const Pigment& pigment) {
    if (const auto* picture = std::get_if<ImagePattern>(&pigment.pattern.kind))
        return picture->once ||
               (picture->image && std::any_of(picture->image->pixels.begin(), picture->image->pixels.end(),
                                              [](const glm::vec4& p) { return p.w < 1; }));
    if (!pigment.pigments.empty())
        return std::any_of(pigment.pigments.begin(), pigment.pigments.end(),
                           [](const auto& entry) { return is_see_through(entry.value); });
    return std::any_of(pigment.map.begin(), pigment.map.end(), [](const ColorStop& stop) {
        return stop.color.filter > 0 || stop.color.transmit > 0;
    });
}

void transform_pattern(Pattern& pattern, const Transform& by) {
    if (!std::holds_alternative<UniformPattern>(pattern.kind) && !pattern.uv_mapping)
        pattern.transform = then(pattern.transform, by);
}

void transform_pigment(Pigment& pigment, const Transform& by) { transform_pattern(pigment.pattern, by); }

} // namespace pnr
