// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pigment.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pnr;

namespace {

Pigment black_to_white(PatternKind kind) {
    Pigment pigment;
    set_kind(pigment.pattern, std::move(kind));
    pigment.map = {{0, {Color(0), 0, 0}}, {1, {Color(1), 0, 0}}};
    return pigment;
}

float value(const Pigment& pigment, Vec3 point) { return eval_pigment(pigment, {point}).rgb.x; }

// 2 x 2 pixels: red green above, blue white below.
Pigment picture(ImageMapType type, bool once = false, bool interpolate = false) {
    auto image = std::make_shared<Image<glm::vec4>>(2, 2);
    image->at(0, 0) = {1, 0, 0, 1};
    image->at(1, 0) = {0, 1, 0, 1};
    image->at(0, 1) = {0, 0, 1, 0.25f};
    image->at(1, 1) = {1, 1, 1, 1};
    ImagePattern pattern;
    pattern.map_type = type;
    pattern.once = once;
    pattern.interpolation = interpolate ? Interpolation::bilinear : Interpolation::none;
    pattern.image = image;
    Pigment pigment;
    set_kind(pigment.pattern, pattern);
    return pigment;
}

const Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white{1, 1, 1};

} // namespace

TEST(Pigment, CheckerIsUnitCubes) {
    const Pigment checker = black_to_white(CheckerPattern{});
    EXPECT_EQ(value(checker, {0.5, 0.5, 0.5}), 0);
    EXPECT_EQ(value(checker, {1.5, 0.5, 0.5}), 1);
    EXPECT_EQ(value(checker, {-0.5, 0.5, 0.5}), 1);
    EXPECT_EQ(value(checker, {-0.5, -0.5, 0.5}), 0);
    EXPECT_EQ(value(checker, {-1.5, -0.5, 7.5}), 0);
    EXPECT_EQ(value(checker, {1e9 + 0.5, 0.5, 0.5}), 0);
}

// A floor in the plane y = 0 of a scene far away: rounding must not speckle it.
TEST(Pigment, BordersDoNotFlicker) {
    Pigment checker = black_to_white(CheckerPattern{});
    EXPECT_EQ(value(checker, {0.5, -1e-16, 0.5}), 0);
    EXPECT_EQ(value(checker, {0.5, -1e-9, 0.5}), 1); // POV-Ray 3.7: already the next cube
    Pigment gradient = black_to_white(GradientPattern{{0, 1, 0}});
    EXPECT_EQ(value(gradient, {0, 1 - 1e-16, 0}), 1);
    EXPECT_EQ(value(gradient, {0, 1 + 2e-16, 0}), 1);
    EXPECT_EQ(value(gradient, {0, -1e-17, 0}), 0);
    checker.pattern.transform = translation({0, -1e6, 0});
    for (const double y : {-1e6 - 1e-10, -1e6, -1e6 + 1e-10}) EXPECT_EQ(value(checker, {0.5, y, 0.5}), 0);
}

// Values read from POV-Ray 3.7 by evaluating the pigment as a function.
TEST(Pigment, GradientAsPovray) {
    const Pigment gradient = black_to_white(GradientPattern{{1, 0, 0}});
    const std::pair<double, float> known[] = {{0, 0},       {1, 1},       {1 + 1e-7, 1e-7f},
                                              {2, 0},       {-1, 0},      {-1e-9, 1},
                                              {-0.3, 0.7f}, {-2.3, 0.70002f}, {2.3, 0.3f}};
    for (const auto& [x, truth] : known) EXPECT_NEAR(value(gradient, {x, 0.3, 4}), truth, 1e-6) << x;
    Pigment fast = black_to_white(GradientPattern{{2, 0, 0}}); // the axis' length does not count
    fast.pattern.frequency = 2;
    fast.pattern.phase = 0.25;
    EXPECT_NEAR(value(fast, {0.3, 0, 0}), 0.85, 1e-6);
    EXPECT_NEAR(value(fast, {-0.3, 0, 0}), 0.65, 1e-6);
    EXPECT_NEAR(value(fast, {0.375, 0, 0}), 1, 1e-6);
    const Pigment slanted = black_to_white(GradientPattern{{1, 1, 0}});
    EXPECT_NEAR(value(slanted, {0.5, 0, 0}), std::sqrt(0.125), 1e-6);
    EXPECT_NEAR(value(slanted, {0.75, 0.75, 0}), 0.0606602, 1e-6);
}

TEST(Pigment, MapsInterpolateBetweenStops) {
    Pigment gradient = black_to_white(GradientPattern{{1, 0, 0}});
    gradient.map = {{0.2, {red, 0, 0.5f}}, {0.4, {blue, 1, 0}}, {0.4, {green, 0, 0}}, {0.6, {white, 0, 0}}};
    const ColorFT half = eval_pigment(gradient, {{0.3, 0, 0}});
    EXPECT_NEAR(half.rgb.x, 0.5, 1e-6);
    EXPECT_NEAR(half.filter, 0.5, 1e-6);
    EXPECT_NEAR(half.transmit, 0.25, 1e-6);
    EXPECT_EQ(eval_pigment(gradient, {{0.1, 0, 0}}).rgb, red);
    EXPECT_EQ(eval_pigment(gradient, {{0.9, 0, 0}}).rgb, white);
    EXPECT_NEAR(eval_pigment(gradient, {{0.4 + 1e-6, 0, 0}}).rgb.y, 1, 1e-4); // a jump
    EXPECT_NEAR(eval_pigment(gradient, {{0.4 - 1e-6, 0, 0}}).rgb.z, 1, 1e-4);
}

TEST(Pigment, PatternsFollowTheirTransform) {
    Pigment checker = black_to_white(CheckerPattern{});
    checker.pattern.transform = then(scaling({2, 2, 2}), translation({10, 0, 0}));
    EXPECT_EQ(value(checker, {11, 1, 1}), 0);
    EXPECT_EQ(value(checker, {13, 1, 1}), 1);
}

TEST(Pigment, PicturesStandUpright) {
    const Pigment planar = picture(ImageMapType::planar);
    EXPECT_EQ(eval_pigment(planar, {{0.2, 0.8, 5}}).rgb, red); // row 0 on top, y up
    EXPECT_EQ(eval_pigment(planar, {{0.8, 0.8, -5}}).rgb, green);
    EXPECT_EQ(eval_pigment(planar, {{0.2, 0.2, 0}}).rgb, blue);
    EXPECT_NEAR(eval_pigment(planar, {{0.2, 0.2, 0}}).transmit, 0.75, 1e-6);
    EXPECT_EQ(eval_pigment(planar, {{-0.8, 3.8, 0}}).rgb, red); // tiled
    const Pigment once = picture(ImageMapType::planar, true);
    EXPECT_EQ(eval_pigment(once, {{1.2, 0.8, 0}}).transmit, 1.f);
    EXPECT_EQ(eval_pigment(once, {{1, 1, 0}}).rgb, green);
    Pigment uv = picture(ImageMapType::planar);
    uv.pattern.uv_mapping = true;
    EXPECT_EQ(eval_pigment(uv, {{9, 9, 9}, {0.2, 0.2}}).rgb, blue);
}

TEST(Pigment, PicturesWrapRoundSpheresAndCylinders) {
    const Pigment ball = picture(ImageMapType::spherical);
    EXPECT_EQ(eval_pigment(ball, {{1, 1, 1}}).rgb, red);     // from +x towards +z, upper half
    EXPECT_EQ(eval_pigment(ball, {{-1, 1, -1}}).rgb, green); // three quarters round
    EXPECT_EQ(eval_pigment(ball, {{0.1, -3, 0.1}}).rgb, blue);
    const Pigment tube = picture(ImageMapType::cylindrical);
    EXPECT_EQ(eval_pigment(tube, {{5, 0.8, 5}}).rgb, red);
    EXPECT_EQ(eval_pigment(tube, {{5, 0.2, -5}}).rgb, white);
}

TEST(Pigment, PicturesInterpolateBetweenPixelCentres) {
    const Pigment smooth = picture(ImageMapType::planar, false, true);
    EXPECT_EQ(eval_pigment(smooth, {{0.25, 0.75, 0}}).rgb, red);
    const Color between = eval_pigment(smooth, {{0.5, 0.75, 0}}).rgb;
    EXPECT_NEAR(between.x, 0.5, 1e-6);
    EXPECT_NEAR(between.y, 0.5, 1e-6);
    const Color middle = eval_pigment(smooth, {{0.5, 0.5, 0}}).rgb;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[c], 0.5, 1e-6);
}

