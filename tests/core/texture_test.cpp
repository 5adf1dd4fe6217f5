// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/texture.h"
#include "tests/core/light_scenes.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

Texture painted(ColorFT color) {
    Texture texture;
    texture.pigment.map = {{0, color}};
    return texture;
}

Texture layered(std::initializer_list<ColorFT> colors) {
    Texture texture = painted(*colors.begin());
    for (auto color = colors.begin() + 1; color != colors.end(); ++color) texture.upper.push_back(painted(*color));
    return texture;
}

// Each layer in even light of 1, as POV-Ray's diffuse and ambient terms add them up.
Color seen(const Texture& texture) {
    Color sum(0);
    for_each_layer(texture, {}, [&](const LayerPoint& layer) { sum += layer.above * layer.color * layer.opacity; });
    return sum;
}

void expect_color(Color a, Color b) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-4);
}

// Values of POV-Ray 3.7's pixels.
TEST(Texture, LayersTintAndThinWhatLiesBelow) {
    const ColorFT ground{{0.8f, 0.5f, 0.2f}, 0, 0};
    expect_color(seen(layered({ground, {{0.5f, 0.9f, 0.3f}, 0.6f, 0}})), {0.44f, 0.63f, 0.156f});
    expect_color(seen(layered({ground, {{0.5f, 0.9f, 0.3f}, 0, 0.6f}})), {0.68f, 0.66f, 0.24f});
    expect_color(seen(layered({ground, {{0.5f, 0.9f, 0.3f}, 0.3f, 0.4f}})), {0.59f, 0.605f, 0.188f});
    expect_color(seen(layered({ground, {{0.5f, 0.9f, 0.3f}, 0.6f, 0}, {{0.9f, 0.8f, 0.6f}, 0.3f, 0.5f}})),
                 {0.5188f, 0.6262f, 0.2261f});
}

TEST(Texture, WhatPassesAllLayersIsTheProduct) {
    const Texture glass = layered({{{0.8f, 0.5f, 0.2f}, 0.7f, 0}, {{0.5f, 0.9f, 0.3f}, 0.6f, 0.2f}});
    const Color passed = for_each_layer(glass, {}, [](const LayerPoint&) {});
    expect_color(passed * Color(0.3f, 0.6f, 0.9f), {0.084f, 0.1554f, 0.0479f});
}

TEST(Texture, AnOpaqueLayerHidesTheRest) {
    int layers = 0;
    for_each_layer(layered({{Color(1), 0, 0}, {Color(0.5f), 0, 0}}), {}, [&](const LayerPoint&) { ++layers; });
    EXPECT_EQ(layers, 1);
}

TEST(Texture, PatternsShareOutThePoint) {
    Texture map;
    set_kind(map.pattern.edit(), GradientPattern{{1, 0, 0}});
    map.textures = {{0, painted({Color(1, 0, 0)})}, {1, painted({Color(0, 1, 0)})}};
    SurfacePoint at;
    at.point = {0.3, 0, 0};
    expect_color(texture_color(map, at), {0.7f, 0.3f, 0});
    set_kind(map.pattern.edit(), AveragePattern{});
    map.textures[0].position = 3;
    expect_color(texture_color(map, at), {0.75f, 0.25f, 0});
    Texture outer; // a map within a checker sees the point as the checker does
    set_kind(outer.pattern.edit(), CheckerPattern{});
    outer.textures = {{0, map}, {1, painted({Color(0, 0, 1)})}};
    transform_texture(outer, translation({10, 0, 0}));
    at.point = {10.3, 0.5, 0.5};
    double shares = 0;
    for_each_texture(outer, at, [&](const Texture&, const SurfacePoint& here, double share) {
        shares += share;
        EXPECT_NEAR(here.point.x, 0.3, 1e-12);
    });
    EXPECT_NEAR(shares, 1, 1e-12);
    at.point = {11.3, 0.5, 0.5};
    expect_color(texture_color(outer, at), {0, 0, 1});
}

} // namespace
} // namespace pnr
