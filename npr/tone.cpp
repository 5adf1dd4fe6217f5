// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/tone.h"

#include "npr/color_space.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"

namespace pnr {

namespace {

float median_lightness(const Image<Color>& colors, const Image<std::uint8_t>& mask) {
    std::vector<float> values;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        if (mask.pixels[i] != 0) values.push_back(colors.pixels[i].x);
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Cool shadows and warm lights [Gooch et al. 1998], by the lightness against the object's median.
constexpr float warm_range = 0.15f;

Color apply_tone(Color lab, const PaintStyle& style, float median) {
    lab.y *= static_cast<float>(style.saturation);
    lab.z *= static_cast<float>(style.saturation);
    const float t = std::clamp((lab.x - median) / warm_range, -1.0f, 1.0f) * static_cast<float>(style.warm);
    lab.z += t;
    lab.y += 0.25f * t;
    lab.x = median + (lab.x - median) * static_cast<float>(style.contrast);
    return lab;
}

} // namespace

Color to_paint_space(Color linear, const PaintStyle& style) {
    return style.paper_mode ? display_from_linear(linear) : oklab_from_linear(linear);
}

Color from_paint_space(Color paint, const PaintStyle& style) {
    return glm::max(style.paper_mode ? linear_from_display(paint) : linear_from_oklab(paint), Color(0));
}

Image<Color> tone_region(const InformativeMap& informative, const Regions& regions, std::uint32_t label,
                         const Image<std::uint8_t>& mask, const PaintStyle& style) {
    const PixelRect box = regions.regions[label - 1].box;
    Image<Color> colors(mask.width, mask.height, Color(0));
    parallel_for(mask.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < mask.width; ++x)
                if (mask.at(x, y) != 0)
                    colors.at(x, y) = to_paint_space(informative.at(box.x0 + x, box.y0 + y).radiance, style);
    });
    const bool plain = style.paper_mode || (style.contrast == 1 && style.saturation == 1 && style.warm == 0);
    if (plain) return colors;
    const float median = median_lightness(colors, mask);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        if (mask.pixels[i] != 0) colors.pixels[i] = apply_tone(colors.pixels[i], style, median);
    return colors;
}

Image<float> find_detail(const Image<Color>& toned, const Image<std::uint8_t>& mask, int height) {
    const int w = mask.width, h = mask.height;
    Image<float> lightness(w, h), detail(w, h, 0.0f);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) lightness.pixels[i] = toned.pixels[i].x;
    masked_blur(lightness, mask, scaled(1.5, height));
    const auto inside = [&](int x, int y) { return mask.contains(x, y) && mask.at(x, y) != 0; };
    std::vector<float> gradients;
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            if (!inside(x, y)) continue;
            const auto difference = [&](int dx, int dy) { // one-sided at the silhouette
                const bool before = inside(x - dx, y - dy), after = inside(x + dx, y + dy);
                const float low = lightness.at(before ? x - dx : x, before ? y - dy : y);
                const float high = lightness.at(after ? x + dx : x, after ? y + dy : y);
                return before && after ? 0.5f * (high - low) : high - low;
            };
            detail.at(x, y) = std::hypot(difference(1, 0), difference(0, 1));
            gradients.push_back(detail.at(x, y));
        }
    }
    if (gradients.empty()) return detail;
    masked_blur(detail, mask, scaled(1.5, height));
    const auto high = gradients.begin() + static_cast<std::ptrdiff_t>(gradients.size() * 9 / 10);
    std::nth_element(gradients.begin(), high, gradients.end());
    const float unit = *high > 1e-6f ? 1 / *high : 0;

    // Nearness to the silhouette: how much of a blurred copy of the mask is missing here.
    Image<float> cover(w, h);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) cover.pixels[i] = mask.pixels[i] != 0 ? 1.0f : 0.0f;
    const Image<std::uint8_t> everywhere(w, h, 1);
    masked_blur(cover, everywhere, scaled(4, height));
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] == 0) continue;
        const float rim = std::clamp(2 * (1 - cover.pixels[i]), 0.0f, 1.0f);
        detail.pixels[i] = std::max(std::min(1.0f, detail.pixels[i] * unit), rim);
    }
    return detail;
}

} // namespace pnr
