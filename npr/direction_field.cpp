// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/direction_field.h"

#include "npr/masked_blur.h"
#include "npr/paint.h"

namespace pnr {

Image<Vec2f> smooth_directions(const InformativeMap& informative, const Regions& regions, std::uint32_t label,
                               const Image<std::uint8_t>& mask, const PaintStyle& style, int height) {
    const PixelRect box = regions.regions[label - 1].box;
    Image<Vec2f> axes(mask.width, mask.height, Vec2f(0));
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (mask.at(x, y) == 0) continue;
            const Informed& pixel = informative.at(box.x0 + x, box.y0 + y);
            axes.at(x, y) =
                style.vectors ? axis_direction(pixel.axis) * (pixel.turned ? -1.0f : 1.0f) : pixel.axis;
        }
    }
    const Vec2 windows = field_windows(style);
    for (const double window : {windows.x, windows.y})
        masked_blur(axes, mask, scaled((window - 1) / 6, height));
    if (style.vectors) {
        for (Vec2f& v : axes.pixels) v = direction_axis(v) * std::min(1.0f, glm::length(v));
    }
    return axes;
}

Vec2f direction_at(const Image<Vec2f>& axes, const Image<std::uint8_t>& mask, Vec2f at) {
    const float fx = std::floor(at.x - 0.5f), fy = std::floor(at.y - 0.5f);
    const float u = at.x - 0.5f - fx, v = at.y - 0.5f - fy;
    Vec2f sum(0);
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const int x = static_cast<int>(fx) + i, y = static_cast<int>(fy) + j;
            if (!axes.contains(x, y) || mask.at(x, y) == 0) continue;
            sum += (i ? u : 1 - u) * (j ? v : 1 - v) * axes.at(x, y);
        }
    }
    return axis_direction(sum);
}

} // namespace pnr
