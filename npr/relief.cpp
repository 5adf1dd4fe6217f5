// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/relief.h"

#include "npr/masked_blur.h"

namespace pnr {

namespace {
constexpr float largest_change = 0.12f; // more looks like embossed metal
} // namespace

Image<float> light_relief(Image<float> height, const Image<std::uint8_t>& mask, double strength,
                          double pixel) {
    masked_blur(height, mask, 0.5 * pixel);
    Image<float> light(height.width, height.height, 0.0f);
    const auto inside = [&](int x, int y) { return mask.contains(x, y) && mask.at(x, y) != 0; };
    const float scale = static_cast<float>(strength * 0.7071 * pixel);
    parallel_for(height.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < height.width; ++x) {
                if (!inside(x, y)) continue;
                const auto slope = [&](int dx, int dy) {
                    if (!inside(x - dx, y - dy) || !inside(x + dx, y + dy)) return 0.0f;
                    return 0.5f * (height.at(x + dx, y + dy) - height.at(x - dx, y - dy));
                };
                // Paint that rises to the right and down faces the light.
                light.at(x, y) =
                    std::clamp(scale * (slope(1, 0) + slope(0, 1)), -largest_change, largest_change);
            }
        }
    });
    return light;
}

} // namespace pnr
