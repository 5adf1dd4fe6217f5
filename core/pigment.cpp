// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pigment.h"

#include "core/picture.h"

#include <algorithm>

namespace pnr {

namespace {

ColorFT mix_colors(const ColorFT& a, const ColorFT& b, float t) {
    return {a.rgb + t * (b.rgb - a.rgb), a.filter + t * (b.filter - a.filter),
            a.transmit + t * (b.transmit - a.transmit)};
}

ColorFT picture_color(const ImagePattern& pattern, Vec3 point) {
    const auto value = picture_at(pattern, point);
    if (!value) return {Color(1), 0, 1};
    return {Color(*value), pattern.filter, value->w < 1 ? 1 - value->w : pattern.transmit};
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
    if (const auto* picture = std::get_if<ImagePattern>(&pattern.kind); picture && picture->is_map)
        return picture_color(*picture, here.point);
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
    if (const auto* picture = std::get_if<ImagePattern>(&pigment.pattern.kind); picture && picture->is_map)
        return picture->once || picture->filter > 0 || picture->transmit > 0 ||
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
