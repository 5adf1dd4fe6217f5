// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/area_light.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

Light area(int columns, int rows) {
    Light light;
    light.said.position = {1, 5, 2};
    light.said.area = AreaGrid{};
    light.said.area->u = {4, 0, 0}, light.said.area->v = {0, 0, 2};
    light.said.area->columns = columns, light.said.area->rows = rows;
    return light;
}

TEST(AreaMean, OfAnEvenGridIsTheMeanOfItsPoints) {
    const Light light = area(4, 8);
    const auto half = [](Vec3 p) { return Color(p.x < 0 ? 1.0f : 0.0f, p.z < 2.2 ? 1.0f : 0.0f, 0.5f); };
    int looked_at = 0;
    const Color mean = area_mean(view_area(light, Vec3(0), 1), [&](Vec3 p) { return ++looked_at, half(p); });
    Color sum(0);
    for (int r = 0; r < 8; ++r)
        for (int c = 0; c < 4; ++c) sum += half({-1 + c * 4 / 3.0, 5, 1 + r * 2 / 7.0});
    EXPECT_EQ(looked_at, 32) << "each point once";
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i], sum[i] / 32, 1e-6);
}

TEST(AreaMean, AdaptiveLooksWhereCornersDiffer) {
    Light light = area(17, 17);
    light.said.area->adaptive = 1;
    int looked_at = 0;
    const AreaView view = view_area(light, Vec3(0), 1);
    EXPECT_EQ(area_mean(view, [&](Vec3) { return ++looked_at, Color(1); }), Color(1));
    EXPECT_EQ(looked_at, 9) << "one level is halved in any case";
    looked_at = 0;
    const Color edge = area_mean(view, [&](Vec3 p) { return ++looked_at, Color(p.x < 0.3 ? 1.0f : 0.0f); });
    EXPECT_GT(looked_at, 9);
    EXPECT_LT(looked_at, 17 * 17 / 2);
    EXPECT_NEAR(edge.x, 1.3 / 4, 0.04);
}

TEST(AreaView, CircularStaysInTheDiscAndOrientFacesThePoint) {
    Light light = area(9, 9);
    light.said.area->v = {0, 0, 4};
    light.said.area->circular = true;
    light.said.area->orient = true;
    const Vec3 lit(7, 1, -3);
    const AreaView view = view_area(light, lit, 1);
    double farthest = 0;
    for (int r = 0; r < 9; ++r)
        for (int c = 0; c < 9; ++c) {
            const Vec3 from = area_point(view, c, r) - light.said.position;
            EXPECT_NEAR(glm::dot(from, lit - light.said.position), 0, 1e-9);
            farthest = std::max(farthest, glm::length(from));
        }
    EXPECT_NEAR(farthest, 2, 1e-9);
}

TEST(AreaView, JitterStaysInTheSquareAndIsTheKeysOwn) {
    Light light = area(4, 4);
    light.said.area->jitter = true;
    const Vec3 a = area_point(view_area(light, Vec3(0), 1), 2, 1);
    const Vec3 b = area_point(view_area(light, Vec3(0), 2), 2, 1);
    EXPECT_EQ(a, area_point(view_area(light, Vec3(0), 1), 2, 1));
    EXPECT_NE(a, b);
    const Vec3 middle(1 + 4 * (2 / 3.0 - 0.5), 5, 2 + 2 * (1 / 3.0 - 0.5));
    for (const Vec3 p : {a, b}) {
        EXPECT_LE(std::abs(p.x - middle.x), 2 / 3.0);
        EXPECT_LE(std::abs(p.z - middle.z), 1 / 3.0);
    }
}

} // namespace
} // namespace pnr
