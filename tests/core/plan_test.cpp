// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/plan.h"

namespace pnr {
namespace {

World painted_world(std::size_t seeds, double mix, double length) {
    World world;
    world.objects.resize(2);
    world.objects[1].npr = true;
    world.objects[1].paint.mix = mix;
    world.objects[1].paint.length = length;
    world.objects[1].paint.seeds.resize(seeds);
    world.illumination = Illumination::photon_mapped;
    world.has_paint = mix > 0;
    return world;
}

TEST(Plan, ARaytracedSceneNeedsNeitherPhotonsNorPaint) {
    World world;
    world.objects.resize(1);
    const Plan plan = make_plan(world, Settings{}, false);
    EXPECT_FALSE(plan.photons || plan.kdtree || plan.normals || plan.paint || plan.rbf || plan.ilic ||
                 plan.caustic_map);
    EXPECT_TRUE(plan.render_rays);
    EXPECT_EQ(plan.used, std::vector<std::string>{"rendering pass"});
    EXPECT_EQ(plan.left_out.size(), 7u);
    for (const LeftOut& left : plan.left_out) EXPECT_FALSE(left.why.empty());
}

TEST(Plan, PaintNeedsWhatItsSeedsAndStrokesNeed) {
    Plan plan = make_plan(painted_world(2, 1, 26), Settings{}, false);
    EXPECT_TRUE(plan.photons && plan.kdtree && plan.normals && plan.paint && plan.rbf && plan.ilic);
    EXPECT_FALSE(plan.caustic_map);
    EXPECT_FALSE(make_plan(painted_world(1, 1, 26), Settings{}, false).rbf);
    EXPECT_FALSE(make_plan(painted_world(2, 1, 0), Settings{}, false).ilic);
    plan = make_plan(painted_world(2, 0, 26), Settings{}, false);
    EXPECT_TRUE(plan.photons);
    EXPECT_FALSE(plan.paint || plan.ilic || plan.normals);
    EXPECT_TRUE(make_plan(painted_world(2, 0, 26), Settings{}, true).normals); // --maps shows them
}

TEST(Plan, PathsNeedPhotonsOnlyForPaint) {
    Settings settings;
    settings.render.integrator = Integrator::path;
    EXPECT_FALSE(make_plan(painted_world(0, 0, 26), settings, false).photons);
    EXPECT_TRUE(make_plan(painted_world(0, 1, 26), settings, false).photons);
}

TEST(Plan, NoPruneLeavesNothingOut) {
    World world;
    world.objects.resize(1);
    Settings settings;
    settings.render.prune = false;
    const Plan plan = make_plan(world, settings, false);
    EXPECT_TRUE(plan.left_out.empty());
    EXPECT_EQ(plan.used.size(), 8u);
}

} // namespace
} // namespace pnr
