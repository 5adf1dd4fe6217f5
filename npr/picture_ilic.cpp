// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/picture_ilic.h"

#include "npr/color_space.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"

#include <array>

namespace pnr {
namespace {

// Neighbourhoods over which axes are blended: standard deviation in pixels at 512, and its say. The wide ones speak where
// the narrow are silent.
struct Reach {
    double sigma;
    float say;
};
constexpr std::array<Reach, 4> reaches{{{1.5, 1}, {5, 0.1f}, {16, 0.01f}, {48, 0.001f}}};

Image<float> lightness_of(const Image<Color>& picture) {
    Image<float> lightness(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) lightness.pixels[i] = oklab_from_linear(picture.pixels[i]).x;
    return lightness;
}

// The axis across the gradient, times the gradient's square; pixels beyond the border are as on it.
Image<Vec2f> axes_across(const Image<float>& lightness) {
    Image<Vec2f> axes(lightness.width, lightness.height);
    const auto at = [&](int x, int y) {
        return lightness.at(std::clamp(x, 0, lightness.width - 1), std::clamp(y, 0, lightness.height - 1));
    };
    for (int y = 0; y < axes.height; ++y)
        for (int x = 0; x < axes.width; ++x) {
            float gx = 0, gy = 0;
            for (int k = -1; k <= 1; ++k) {
                const float weight = k == 0 ? 2.0f : 1.0f;
                gx += weight * (at(x + 1, y + k) - at(x - 1, y + k));
                gy += weight * (at(x + k, y + 1) - at(x + k, y - 1));
            }
            axes.at(x, y) = {gy * gy - gx * gx, -2 * gx * gy};
        }
    return axes;
}

} // namespace

InformativeMap inform_by_gradient(const Image<Color>& picture) {
    const Image<Vec2f> sharp = axes_across(lightness_of(picture));
    const Image<std::uint8_t> everywhere(picture.width, picture.height, 1);
    Image<Vec2f> axes(picture.width, picture.height, Vec2f(0));
    for (const Reach& reach : reaches) {
        Image<Vec2f> blurred = sharp;
        masked_blur(blurred, everywhere, scaled(reach.sigma, picture.height));
        for (std::size_t i = 0; i < axes.pixels.size(); ++i) axes.pixels[i] += reach.say * blurred.pixels[i];
    }
    InformativeMap map(picture.width, picture.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        Informed& pixel = map.pixels[i];
        pixel.kind = PixelKind::interpolated;
        pixel.object = 1;
        pixel.radiance = picture.pixels[i];
        const float strength = glm::length(axes.pixels[i]);
        // Squares of gradients that 8 bits could not hold are rounding, not edges.
        pixel.axis = strength > 1e-10f ? axes.pixels[i] / strength : Vec2f(1, 0);
    }
    return map;
}

Image<Color> paint_picture(const Image<Color>& picture, const Image<std::uint8_t>& mask, const PaintStyle& style,
                           std::uint64_t seed, const Progress& progress) {
    World world;
    world.objects.resize(2);
    world.objects[1].npr = true;
    world.objects[1].paint = style;
    world.objects[1].paint.mix = 1;
    GBuffer gbuffer;
    gbuffer.view.width = picture.width;
    gbuffer.view.height = picture.height;
    gbuffer.window = {0, 0, picture.width, picture.height};
    gbuffer.seen = Image<Seen>(picture.width, picture.height);
    gbuffer.coverage = Image<float>(picture.width, picture.height, 0.0f);
    const auto width = static_cast<std::size_t>(picture.width);
    InformativeMap informative = inform_by_gradient(picture);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] == 0) {
            informative.pixels[i] = {};
            continue;
        }
        Seen& seen = gbuffer.seen.pixels[i];
        seen.object = 1, seen.npr = true, seen.z = 1;
        seen.position = Vec3f(static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f, 0); // a flat thing that faces the viewer
        seen.normal = {0, 0, -1};
        seen.dpdx = {1, 0, 0}, seen.dpdy = {0, 1, 0};
        gbuffer.coverage.pixels[i] = 1;
    }
    return convolve(informative, Seats{}, world, gbuffer, seed, progress).color;
}

Image<Color> paint_picture(const Image<Color>& picture, const PaintStyle& style, std::uint64_t seed,
                           const Progress& progress) {
    return paint_picture(picture, Image<std::uint8_t>(picture.width, picture.height, 1), style, seed, progress);
}

} // namespace pnr
