// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/picture_ilic.h"

#include "core/settings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

template <class Value>
Image<Color> picture_of(int width, int height, Value&& value) {
    Image<Color> picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) picture.at(x, y) = Color(static_cast<float>(value(x, y)));
    return picture;
}

// Degrees between an axis and a direction, 0 to 90.
double angle_between(Vec2f axis, Vec2 direction) {
    const Vec2 d = glm::normalize(direction);
    const double cosine = static_cast<double>(axis.x) * (d.x * d.x - d.y * d.y) + static_cast<double>(axis.y) * 2 * d.x * d.y;
    return std::acos(std::clamp(cosine, -1.0, 1.0)) / 2 * 180 / pi;
}

TEST(PictureIlic, StrokesRunAlongEdges) {
    const auto stripes = picture_of(96, 64, [](int x, int) { return 0.5 + 0.4 * std::sin(x * 0.3); });
    const InformativeMap map = inform_by_gradient(stripes);
    for (int y = 0; y < 64; y += 7)
        for (int x = 0; x < 96; x += 5) EXPECT_LT(angle_between(map.at(x, y).axis, {0, 1}), 0.5) << x << ' ' << y;
}

TEST(PictureIlic, StrokesRunRoundADisc) {
    const auto disc = picture_of(128, 128, [](int x, int y) {
        return 0.9 / (1 + std::exp(0.5 * (std::hypot(x + 0.5 - 64, y + 0.5 - 64) - 40)));
    });
    const InformativeMap map = inform_by_gradient(disc);
    for (int k = 0; k < 72; ++k) {
        const double a = 2 * pi * k / 72;
        for (const double r : {36.0, 40.0, 44.0}) {
            const int x = static_cast<int>(64 + r * std::cos(a)), y = static_cast<int>(64 + r * std::sin(a));
            const Vec2 out(x + 0.5 - 64, y + 0.5 - 64);
            EXPECT_LT(angle_between(map.at(x, y).axis, {-out.y, out.x}), 3) << "at " << k * 5 << " degrees, radius " << r;
        }
    }
}

TEST(PictureIlic, AFlatPictureStaysFlatWithoutNoise) {
    PaintStyle style;
    style.noise_lightness = style.noise_chroma = 0;
    const Image<Color> flat(40, 30, Color(0.2f, 0.5f, 0.7f));
    const Image<Color> painted = paint_picture(flat, style, 1);
    ASSERT_EQ(painted.width, 40);
    ASSERT_EQ(painted.height, 30);
    for (const Color c : painted.pixels) EXPECT_NEAR(glm::distance(c, flat.pixels[0]), 0, 2e-5);
}

TEST(PictureIlic, OnePixelAndOneRowArePaintedToo) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{9, 1}, std::pair{1, 9}}) {
        const Image<Color> painted = paint_picture(Image<Color>(width, height, Color(0.3f)), PaintStyle{}, 1);
        for (const Color c : painted.pixels) EXPECT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
    }
}

} // namespace
} // namespace pnr
