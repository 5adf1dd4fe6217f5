// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/color_space.h"
#include "npr/paint.h"
#include "synthetic.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

using namespace test;

int disc(int x, int y) { return (x - 64) * (x - 64) + (y - 64) * (y - 64) < 50 * 50 ? 1 : 0; }

// Every painted pixel interpolated, with the given colour and direction.
template <class ColorAt, class DirectionAt>
InformativeMap informed(const GBuffer& g, ColorAt&& color_at, DirectionAt&& direction_at) {
    InformativeMap map(g.seen.width, g.seen.height);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            if (g.seen.at(x, y).object == 0) continue;
            Informed& pixel = map.at(x, y);
            pixel.kind = PixelKind::interpolated;
            pixel.object = g.seen.at(x, y).object;
            pixel.via = g.seen.at(x, y).via;
            pixel.radiance = color_at(x, y);
            pixel.axis = direction_axis(direction_at(x, y));
        }
    }
    return map;
}

const auto diagonal = [](int, int) { return Vec2f(1, 1); };

TEST(Ilic, OfAConstantWithoutNoiseIsThatConstant) {
    for (const double edge : {0.0, 40.0, 200.0}) {
        PaintStyle style;
        style.noise_lightness = style.noise_chroma = 0;
        style.edge = edge;
        const World world = world_with_objects(1, style);
        const GBuffer g = gbuffer_of(128, 128, disc);
        const Color constant(0.7f, 0.3f, 0.1f);
        const Layer layer = convolve(informed(
                                         g, [&](int, int) { return constant; }, diagonal),
                                     random_seats(g, 0.2, 1), world, g, 1);
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                const Color expected = disc(x, y) ? constant : Color(0);
                EXPECT_NEAR(glm::distance(layer.color.at(x, y), expected), 0, 2e-5) << x << ' ' << y;
                EXPECT_EQ(layer.alpha.at(x, y), disc(x, y) ? 1.0f : 0.0f);
            }
        }
    }
}

TEST(Ilic, NoiseHasTheStandardDeviationAskedFor) {
    for (const double edge : {0.0, 10.0, 40.0}) {
        PaintStyle style;
        style.noise_lightness = 0.035;
        style.noise_chroma = 0.02;
        style.edge = edge;
        const World world = world_with_objects(1, style);
        const GBuffer g = gbuffer_of(512, 512, [](int x, int y) { return x > 3 && y > 3 ? 1 : 0; });
        const Color grey(0.3f);
        const Layer layer = convolve(informed(
                                         g, [&](int, int) { return grey; }, diagonal),
                                     random_seats(g, 0.3, 2), world, g, 1);
        double sum = 0, square = 0, count = 0;
        for (int y = 10; y < 500; ++y) {
            for (int x = 10; x < 500; ++x) {
                const double l = static_cast<double>(oklab_from_linear(layer.color.at(x, y)).x);
                sum += l;
                square += l * l;
                ++count;
            }
        }
        const double deviation = std::sqrt(square / count - (sum / count) * (sum / count));
        // A tenth less is lost where canvas pixels of two strokes share a picture pixel.
        EXPECT_NEAR(deviation, 0.035, 0.0045) << edge;
        EXPECT_NEAR(sum / count, static_cast<double>(oklab_from_linear(grey).x), 0.003);
    }
}

TEST(Ilic, SmearsAlongTheAxisOnly) {
    PaintStyle style;
    style.noise_lightness = style.noise_chroma = 0;
    style.edge = 0;
    style.cell = 1; // colours a pixel, so that nothing else spreads them
    style.length = 20;
    const World world = world_with_objects(1, style);
    const GBuffer g = gbuffer_of(512, 512, [](int x, int y) { return x > 3 && y > 3 ? 1 : 0; });
    const auto spot = [](int x, int y) { return x == 250 && y == 260 ? Color(1) : Color(0.1f); };
    for (const Vec2f direction : {Vec2f(1, 0), Vec2f(0, 1)}) {
        const Layer layer = convolve(informed(g, spot, [&](int, int) { return direction; }),
                                     Seats{}, world, g, 1);
        for (int y = 200; y < 320; ++y) {
            for (int x = 200; x < 320; ++x) {
                const bool lit = layer.color.at(x, y).x > 0.1005f;
                const Vec2 offset(x - 250, y - 260);
                const double along = std::abs(glm::dot(offset, Vec2(direction)));
                const double across = std::abs(offset.x * static_cast<double>(direction.y) -
                                               offset.y * static_cast<double>(direction.x));
                if (across > 0.5 || along > 11) {
                    EXPECT_FALSE(lit) << x << ' ' << y;
                } else if (along < 7) {
                    EXPECT_TRUE(lit) << x << ' ' << y;
                }
            }
        }
    }
}

TEST(Ilic, PathsStayInsideTheirRegion) {
    // A red and a green object touch; strokes run straight across the border.
    PaintStyle style;
    style.length = 60;
    const World world = world_with_objects(2, style);
    const GBuffer g = gbuffer_of(128, 512, [](int x, int y) { return y < 8 ? 0 : x < 64 ? 1 : 2; });
    const auto color = [](int x, int) { return x < 64 ? Color(0.8f, 0.1f, 0.1f) : Color(0.1f, 0.8f, 0.1f); };
    const Layer layer = convolve(informed(g, color, [](int, int) { return Vec2f(1, 0); }),
                                 random_seats(g, 0.2, 3), world, g, 1);
    for (int y = 8; y < 512; ++y) {
        for (int x = 0; x < 128; ++x) {
            const Color c = layer.color.at(x, y);
            EXPECT_EQ(c.x > c.y, x < 64) << x << ' ' << y;
        }
    }
}

TEST(Ilic, PathsStopAtAFoldOfTheirObject) {
    // One object whose right half lies far behind its left one; strokes run straight across.
    PaintStyle style;
    style.length = 60;
    style.noise_lightness = style.noise_chroma = 0;
    for (const bool deep : {true, false}) {
        GBuffer g = gbuffer_of(128, 512, [](int, int y) { return y < 8 ? 0 : 1; });
        if (deep)
            for (int y = 8; y < 512; ++y)
                for (int x = 64; x < 128; ++x) g.seen.at(x, y).position.z = 100;
        const auto color = [](int x, int) { return x < 64 ? Color(0.8f, 0.1f, 0.1f) : Color(0.1f, 0.8f, 0.1f); };
        const Layer layer = convolve(informed(g, color, [](int, int) { return Vec2f(1, 0); }), Seats{},
                                     world_with_objects(1, style), g, 1);
        int crossed = 0;
        for (int y = 8; y < 512; ++y)
            for (int x = 0; x < 128; ++x)
                if ((layer.color.at(x, y).x > layer.color.at(x, y).y) != (x < 64)) ++crossed;
        if (deep)
            EXPECT_EQ(crossed, 0);
        else
            EXPECT_GT(crossed, 1000);
    }
}

TEST(Ilic, BorderPixelsTakeTheNearestPaintedColour) {
    PaintStyle style;
    style.noise_lightness = style.noise_chroma = 0;
    style.mix = 0.5;
    const World world = world_with_objects(1, style);
    GBuffer g = gbuffer_of(64, 64, [](int x, int) { return x < 30 ? 1 : 0; });
    g.coverage.at(29, 20) = 0.75f;
    g.coverage.at(30, 20) = 0.25f;
    g.seen.at(29, 20).weight = Color(0.5f, 0.5f, 0.2f);
    const Layer layer = convolve(informed(
                                     g, [](int, int) { return Color(0.4f); }, diagonal),
                                 Seats{}, world, g, 1);
    EXPECT_NEAR(layer.color.at(30, 20).x, 0.25f * 0.5f * 0.5f * 0.4f, 1e-5);
    EXPECT_NEAR(layer.alpha.at(30, 20), 0.25f * 0.5f * 0.4f, 1e-6);
    EXPECT_NEAR(layer.color.at(29, 20).z, 0.75f * 0.5f * 0.2f * 0.4f, 1e-5);
    EXPECT_EQ(layer.alpha.at(32, 20), 0);
}

TEST(Ilic, SameBitsForAnyNumberOfThreads) {
    PaintStyle style;
    set_style(style, "oil");
    const World world = world_with_objects(1, style);
    const GBuffer g = gbuffer_of(128, 128, disc);
    const Seats seats = random_seats(g, 0.1, 6);
    const InformativeMap map = make_informative_map(random_sources(g, 0.1, 6), world, g, 1);
    Layer one, two;
    {
        const ThreadLimit limit(1);
        one = convolve(map, seats, world, g, 1);
    }
    {
        const ThreadLimit limit(2);
        two = convolve(map, seats, world, g, 1);
    }
    for (std::size_t i = 0; i < one.color.pixels.size(); ++i) {
        ASSERT_EQ(one.color.pixels[i], two.color.pixels[i]);
        ASSERT_TRUE(std::isfinite(one.color.pixels[i].x + one.color.pixels[i].y + one.color.pixels[i].z));
    }
}

} // namespace
} // namespace pnr
