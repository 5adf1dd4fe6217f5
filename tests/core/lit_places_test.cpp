// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lit_places.h"

#include "core/rng.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

Object white(Shape shape) {
    Object object;
    object.shape = std::move(shape);
    object.texture = Texture{};
    object.texture->pigment.map = {{0, {Color(1), 0, 0}}};
    return object;
}

constexpr int count = 40000;

// Photons that fall evenly, 1 W/m^2, on a floor of 2 x 2 about the origin; a dark wall may stand on it along
// x = 0.
struct Floor {
    World world;
    PhotonMap map;
};
Floor lit_floor(bool wall) {
    Scene scene;
    scene.objects.push_back(white(Box{Vec3(-1, -0.1, -1), Vec3(1, 0, 1)}));
    if (wall) scene.objects.push_back(white(Box{Vec3(-0.05, 0, -1), Vec3(0, 1, 1)}));
    Floor floor{build_world(scene, {}), {}};
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        const Vec3 at(2 * rng.uniform() - 1, 0, 2 * rng.uniform() - 1);
        if (wall && at.x < 0) continue;
        floor.map.photons.push_back({Vec3f(at - floor.world.offset), Vec3f(0, -1, 0), Color(4.0f / count),
                                     photon_tag(1, false, PhotonPath::indirect)});
    }
    build_photon_tree(floor.map);
    return floor;
}

// Mean irradiance along a line beside x = 0.
double irradiance_beside(const Floor& floor, double x) {
    const LitPlaces lit = make_lit_places(floor.world, floor.map, 50, {});
    std::vector<Neighbour> scratch;
    double sum = 0;
    constexpr int points = 200;
    for (int i = 0; i < points; ++i) {
        const Vec3 at(x, 0, 1.6 * (i + 0.5) / points - 0.8);
        sum +=
            static_cast<double>(lit_irradiance(lit, at - floor.world.offset, Vec3(0, 1, 0), scratch).plain.y);
    }
    return sum / points;
}

TEST(LitPlaces, KnowTheLightOfAnOpenFloor) {
    EXPECT_NEAR(irradiance_beside(lit_floor(false), 0.003), 1, 0.03);
}

// Half of the disc about a place at a wall lies behind it, where no photon can fall.
TEST(LitPlaces, AreNotDarkerBesideAWall) {
    const Floor floor = lit_floor(true);
    EXPECT_NEAR(irradiance_beside(floor, 0.003), 1, 0.06);
    EXPECT_NEAR(irradiance_beside(floor, 0.5), 1, 0.03);
}

} // namespace
} // namespace pnr
