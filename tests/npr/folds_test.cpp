// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene.h"
#include "npr/folds.h"
#include "npr/footprint.h"
#include "synthetic.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

using namespace test;

GBuffer look_at(Shape shape, Vec3 from) {
    Object object;
    object.shape = std::move(shape);
    object.npr.emplace();
    object.npr->on = true;
    Scene scene;
    scene.objects.push_back(std::move(object));
    scene.camera.location = from;
    scene.camera.direction = -glm::normalize(from) * 1.5;
    scene.camera.right = glm::normalize(glm::cross(Vec3(0, 1, 0), -from));
    scene.camera.up = glm::cross(glm::normalize(-from), scene.camera.right);
    const World world = build_world(scene, {});
    return make_gbuffer(world, {world.camera, 200, 200}, {0, 0, 200, 200}, {});
}

int walled_pixels(const Folds& folds) {
    return static_cast<int>(std::count_if(folds.walls.pixels.begin(), folds.walls.pixels.end(),
                                          [](std::uint8_t w) { return w != 0; }));
}

TEST(Folds, ASphereHasNone) {
    const GBuffer g = look_at(Sphere{{0, 0, 0}, 1}, {0, 1, -4});
    EXPECT_FALSE(find_folds(g).any);
}

TEST(Folds, EdgesOfABoxAre) {
    const GBuffer g = look_at(Box{{-1, -1, -1}, {1, 1, 1}}, {2, 3, -5});
    const Folds folds = find_folds(g);
    EXPECT_TRUE(folds.any);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 199; ++x) {
            const Seen &a = g.seen.at(x, y), &b = g.seen.at(x + 1, y);
            if (a.object == 0 || b.object == 0) continue;
            const bool edge = glm::dot(a.normal, b.normal) < 0.5f;
            EXPECT_EQ((folds.walls.at(x, y) & wall_bit(1, 0)) != 0, edge);
            EXPECT_EQ((folds.walls.at(x + 1, y) & wall_bit(-1, 0)) != 0, edge);
            EXPECT_EQ(is_folded_between(folds, x, y, x + 1, y), edge);
        }
}

TEST(Folds, ATorusFoldsWhereItHidesItself) {
    // Seen low, its near side hides a part of the far one: a line of walls across its hole's rim.
    const Folds low = find_folds(look_at(Torus{1, 0.4}, {0, 1.0, -5}));
    EXPECT_GT(walled_pixels(low), 40);
    const Folds above = find_folds(look_at(Torus{1, 0.4}, {0, 5, -0.01}));
    EXPECT_EQ(walled_pixels(above), 0);
}

TEST(Folds, FootprintIsThatOfTheMapOfAPixel) {
    Seen seen;
    seen.dpdx = {2, 0, 0};
    seen.dpdy = {0, 0.5f, 0};
    EXPECT_NEAR(footprint_of(seen).least, 0.5f, 1e-6f);
    EXPECT_NEAR(footprint_of(seen).most, 2, 1e-6f);
    seen.dpdx = seen.dpdy = {1, 1, 0}; // degenerate
    EXPECT_NEAR(footprint_of(seen).least, 0, 1e-6f);
    EXPECT_NEAR(footprint_of(seen).most, 2, 1e-5f);
}

} // namespace
} // namespace pnr
