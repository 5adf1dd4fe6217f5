// SPDX-License-Identifier: GPL-3.0-or-later
// Against the normals that POV-Ray 3.7's pictures show of a plane that faces -z, read from three lamps' light on it.
#include "core/normal.h"
#include "core/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

SurfacePoint at(double x, double y, double z = 0.37) {
    SurfacePoint point;
    point.point = {x, y, z};
    point.normal = {0, 0, -1};
    return point;
}

Normal gradient(Vec3 axis, double size) {
    Normal n;
    set_kind(n.pattern, GradientPattern{axis});
    n.size = size;
    return n;
}

// How far the normal leans along x and y.
Vec2 lean(const Normal& normal, const SurfacePoint& point) {
    const Vec3 n = perturb_normal(normal, point);
    EXPECT_NEAR(glm::length(n), 1, 1e-12);
    return {n.x / -n.z, n.y / -n.z};
}

void expect_lean(const Normal& normal, const SurfacePoint& point, Vec2 expected, double tolerance = 2e-4) {
    const Vec2 seen = lean(normal, point);
    EXPECT_NEAR(seen.x, expected.x, tolerance);
    EXPECT_NEAR(seen.y, expected.y, tolerance);
}

TEST(Normal, LeansAgainstThePatternsGradient) {
    expect_lean(gradient({1, 0, 0}, 0.3), at(0.3, 0.1), {-0.04, 0});
    expect_lean(gradient({0, 1, 0}, 0.6), at(0.3, 0.1), {0, -0.08});
    Normal fine = gradient({1, 0, 0}, 0.3);
    fine.accuracy = 0.01; // a plane's slope does not depend on it
    expect_lean(fine, at(0.3, 0.1), {-0.04, 0});
    Normal twice = gradient({1, 0, 0}, 0.3);
    twice.pattern.frequency = 2;
    expect_lean(twice, at(0.3, 0.1), {-0.08, 0});
    Normal wave = gradient({1, 0, 0}, 0.3);
    wave.pattern.wave = Wave::sine; // the tetrahedron's own error is POV-Ray's too
    expect_lean(wave, at(0.3, 0.1), {0.0423, -0.0025});
}

TEST(Normal, ScalingKeepsSlopesUnlessToldNotTo) {
    const auto scaled = [](Vec3 factors, bool scale_bumps) {
        Normal n = gradient({1, 0, 0}, 0.3);
        n.scale_bumps = scale_bumps;
        transform_bumps(n, scaling(factors));
        return n;
    };
    expect_lean(scaled(Vec3(2), true), at(0.6, 0.2), {-0.04, 0});
    expect_lean(scaled(Vec3(0.5), true), at(0.15, 0.05), {-0.04, 0});
    expect_lean(scaled(Vec3(2), false), at(0.6, 0.2), {-0.02, 0});
    expect_lean(scaled({2, 1, 1}, true), at(0.6, 0.1), {-0.02, 0});
    expect_lean(scaled({1, 1, 2}, true), at(0.3, 0.1), {-0.08, 0});
    Normal turned = gradient({1, 0, 0}, 0.3);
    transform_bumps(turned, rotation({0, 0, 30}));
    expect_lean(turned, at(0.3, 0.1), {-0.0347, -0.02});
}

TEST(Normal, SlopeMapsShapeTheHeights) {
    Normal n = gradient({1, 0, 0}, 0.3);
    n.slopes = {{0, 0, 0}, {1, 1, 0}};
    expect_lean(n, at(0.3, 0.1), {-0.0508, 0.0003});
    n.slopes = {{0, 0, 1}, {1, 0, 1}};
    expect_lean(n, at(0.3, 0.1), {0.0108, -0.0003});
    n.slopes = {{0, 0, 0}, {0.5, 1, 0}, {1, 0, 0}};
    expect_lean(n, at(0.3, 0.1), {-0.1141, -0.0007});
}

TEST(Normal, MapsBlendNormals) {
    Normal mean;
    set_kind(mean.pattern, AveragePattern{});
    mean.normals = {{1, gradient({1, 0, 0}, 0.3)}, {1, gradient({0, 1, 0}, 0.6)}};
    expect_lean(mean, at(0.3, 0.1), {-0.02, -0.04});
    Normal map = mean;
    set_kind(map.pattern, GradientPattern{{1, 0, 0}});
    map.normals[0].position = 0;
    expect_lean(map, at(0.3, 0.1), {-0.028, -0.024});
    Normal squares = mean;
    set_kind(squares.pattern, CheckerPattern{});
    expect_lean(squares, at(0.3, 0.1), {-0.04, 0});
}

TEST(Normal, BumpsAddTheNoiseVector) {
    Normal n;
    set_kind(n.pattern, PlainPattern{PlainKind::bumps});
    n.size = 0.3;
    expect_lean(n, at(0.3, 0.1, 0), {-0.0814, 0.0160});
    const Vec3 sum = Vec3(0, 0, -1) + 0.3 * noise_vector({0.3, 0.1, 0.37});
    expect_lean(n, at(0.3, 0.1), {sum.x / -sum.z, sum.y / -sum.z}, 1e-12);
}

TEST(Normal, QuiltsRiseFromTheirCellsCentres) {
    Normal n;
    n.size = 0.2;
    set_kind(n.pattern, QuiltedPattern{1, 1});
    expect_lean(n, at(0.3, 0.1), {-0.0382, -0.0763});
    set_kind(n.pattern, QuiltedPattern{0, 0});
    expect_lean(n, at(0.3, 0.1), {-0.0046, -0.0093});
    set_kind(n.pattern, QuiltedPattern{0.5, 0.7});
    expect_lean(n, at(0.3, 0.1), {-0.0247, -0.0494});
}

// Columns of 0 and 100 / 255 that meet between pixels 7 and 8 of 16.
TEST(Normal, PicturesAreHeights) {
    ImagePattern step;
    Image<glm::vec4> image(16, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) image.at(x, y) = glm::vec4(glm::vec3(x >= 8 ? 100 / 255.f : 0.f), 1);
    step.image = std::make_shared<const Image<glm::vec4>>(std::move(image));
    step.interpolation = Interpolation::none;
    Normal n;
    n.size = 1;
    set_kind(n.pattern, step);
    expect_lean(n, at(6.5 / 16, 0.28), {0, 0});
    expect_lean(n, at(7.5 / 16, 0.28), {-0.196, 0.196}, 3e-3);
    expect_lean(n, at(8.5 / 16, 0.28), {-0.196, -0.196}, 3e-3);
    SurfacePoint behind = at(7.5 / 16, 0.28);
    behind.normal = {0, 0, 1}; // the picture's rows run the other way round there
    EXPECT_GT(perturb_normal(n, behind).x, 0);
}

TEST(Normal, NothingSaidTurnsNothing) {
    EXPECT_EQ(perturb_normal(Normal{}, at(1, 2)), Vec3(0, 0, -1));
}

} // namespace
} // namespace pnr
