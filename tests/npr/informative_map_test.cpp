// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/paint.h"
#include "synthetic.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

using namespace test;

// Two objects side by side, the right one partly seen through a mirror.
GBuffer two_objects() {
    GBuffer g = gbuffer_of(96, 80, [](int x, int y) { return x < 4 || y < 3 ? 0 : x < 50 ? 1 : 2; });
    for (int y = 40; y < 80; ++y)
        for (int x = 60; x < 96; ++x) g.seen.at(x, y).via = 7;
    return g;
}

TEST(InformativeMap, FollowsTheRuleByBruteForce) {
    PaintStyle style;
    style.radius =
        5.0 * 512 / 80 * 0.8; // 4 pixels of this picture: discs of some pixels hold a source on their rim
    const World world = world_with_objects(2, style);
    const GBuffer g = two_objects();
    const SparseMap sparse = random_sources(g, 0.03, 5);
    const InformativeMap map = make_informative_map(sparse, world, g, 1);
    const double radius = style.radius * 80 / 512;
    int filled = 0, interpolated = 0;
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 96; ++x) {
            const Informed& pixel = map.at(x, y);
            const Seen& seen = g.seen.at(x, y);
            if (seen.object == 0) {
                EXPECT_EQ(pixel.kind, PixelKind::outside);
                continue;
            }
            ASSERT_EQ(pixel.object, seen.object);
            ASSERT_EQ(pixel.via, seen.via);
            double sum = 0, nearest2 = infinity;
            glm::dvec3 color(0), nearest_color(0);
            Vec2 axis(0);
            for (int j = 0; j < 80; ++j) {
                for (int i = 0; i < 96; ++i) {
                    const SourcePixel& s = sparse.at(i, j);
                    if (s.photon < 0 || s.object != seen.object || s.via != seen.via) continue;
                    const double d2 = (i - x) * (i - x) + (j - y) * (j - y);
                    if (d2 < nearest2) {
                        nearest2 = d2;
                        nearest_color = glm::dvec3(s.radiance);
                    }
                    if (d2 == 0 || d2 > radius * radius) continue;
                    const double angle = std::atan2(s.direction.y, s.direction.x);
                    sum += 1 / d2;
                    color += glm::dvec3(s.radiance) / d2;
                    axis += Vec2(std::cos(2 * angle), std::sin(2 * angle)) / d2;
                }
            }
            if (sparse.at(x, y).photon >= 0) {
                EXPECT_EQ(pixel.kind, PixelKind::source);
                EXPECT_EQ(pixel.radiance, sparse.at(x, y).radiance);
                EXPECT_NEAR(glm::distance(axis_direction(pixel.axis), sparse.at(x, y).direction), 0, 1e-5);
            } else if (sum > 0) {
                ++interpolated;
                EXPECT_EQ(pixel.kind, PixelKind::interpolated);
                EXPECT_NEAR(glm::distance(glm::dvec3(pixel.radiance), color / sum), 0, 1e-6);
                EXPECT_NEAR(glm::distance(Vec2(pixel.axis), glm::normalize(axis)), 0, 1e-5);
            } else {
                ++filled;
                EXPECT_EQ(pixel.kind, PixelKind::filled);
                EXPECT_NEAR(glm::distance(glm::dvec3(pixel.radiance), nearest_color), 0, 1e-6)
                    << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(interpolated, 100);
    EXPECT_GT(filled, 10);
}

TEST(InformativeMap, BlendsAxesAcross180Degrees) {
    const World world = world_with_objects(1, {});
    const GBuffer g = gbuffer_of(9, 512, [](int, int) { return 1; });
    SparseMap sparse(9, 512);
    // Directions of 85 and 95 degrees: as plain vectors of the sign rule they point down and up.
    for (const auto& [x, degrees] : {std::pair{2, 85.0}, std::pair{6, 95.0}}) {
        SourcePixel& s = sparse.at(x, 100);
        s.photon = x;
        s.object = 1;
        s.direction = canonical_direction({std::cos(degrees * pi / 180), std::sin(degrees * pi / 180)});
    }
    EXPECT_LT(sparse.at(6, 100).direction.y, 0);
    const InformativeMap map = make_informative_map(sparse, world, g, 1);
    const Vec2f between = axis_direction(map.at(4, 100).axis);
    EXPECT_NEAR(std::abs(between.y), 1, 1e-5);
}

// As BlendsAxesAcross180Degrees, but plain vectors: both of the seeds' field point down, whatever sign rule
// the maps are written by, and so does their mean.
TEST(InformativeMap, PlainVectorsKeepTheSignOfTheField) {
    PaintStyle style;
    style.vectors = true;
    const World world = world_with_objects(1, style);
    const GBuffer g = gbuffer_of(9, 512, [](int, int) { return 1; });
    SparseMap sparse(9, 512);
    for (const auto& [x, degrees] : {std::pair{2, 80.0}, std::pair{6, 100.0}}) {
        const Vec2 direction(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180));
        SourcePixel& s = sparse.at(x, 100);
        s.photon = x;
        s.object = 1;
        s.direction = canonical_direction(direction);
        s.turned = is_turned(direction);
    }
    EXPECT_NE(sparse.at(2, 100).turned, sparse.at(6, 100).turned);
    const InformativeMap map = make_informative_map(sparse, world, g, 1);
    EXPECT_NEAR(std::abs(axis_direction(map.at(4, 100).axis).y), 1, 1e-5);
    EXPECT_FALSE(map.at(4, 100).turned);
}

TEST(InformativeMap, ARegionWithoutASourceHasItsOwnLightAndTheObjectsDirection) {
    const World world = world_with_objects(1, {});
    GBuffer g = gbuffer_of(32, 32, [](int, int) { return 1; });
    for (int y = 0; y < 32; ++y) g.seen.at(31, y).via = 3;
    SparseMap sparse(32, 32);
    sparse.at(5, 5) = {0, Color(0.25f), {0, 1}, {5.5f, 5.5f}, 1, 1, 0};
    sparse.at(31, 9).radiance = Color(0.75f); // the sparse map's word for it
    const InformativeMap map = make_informative_map(sparse, world, g, 1);
    EXPECT_EQ(map.at(31, 9).kind, PixelKind::filled);
    EXPECT_EQ(map.at(31, 9).radiance, Color(0.75f));
    EXPECT_NEAR(glm::distance(axis_direction(map.at(31, 9).axis), Vec2f(0, 1)), 0, 1e-6);
}

TEST(InformativeMap, RandomFillIsTheSameForAnyNumberOfThreads) {
    PaintStyle style;
    style.fill = Fill::random;
    const World world = world_with_objects(1, style);
    const GBuffer g = gbuffer_of(64, 64, [](int, int) { return 1; });
    const SparseMap sparse = random_sources(g, 0.01, 9);
    InformativeMap one, two;
    {
        const ThreadLimit limit(1);
        one = make_informative_map(sparse, world, g, 4);
    }
    {
        const ThreadLimit limit(2);
        two = make_informative_map(sparse, world, g, 4);
    }
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        EXPECT_EQ(one.pixels[i].radiance, two.pixels[i].radiance);
        EXPECT_EQ(one.pixels[i].axis, two.pixels[i].axis);
    }
}

TEST(InformativeMap, WithFoldsOnNothingComesOverAFold) {
    // The right half lies far behind the left one and has other colours.
    for (const bool folds : {true, false}) {
        PaintStyle style;
        style.radius = 6.0 * 512 / 80;
        style.folds = folds;
        GBuffer g = gbuffer_of(96, 80, [](int, int) { return 1; });
        for (int y = 0; y < 80; ++y)
            for (int x = 48; x < 96; ++x) g.seen.at(x, y).position.z = 50;
        SparseMap sparse = random_sources(g, 0.1, 8);
        for (int y = 0; y < 80; ++y)
            for (int x = 0; x < 96; ++x) sparse.at(x, y).radiance = x < 48 ? Color(1, 0, 0) : Color(0, 1, 0);
        const InformativeMap map = make_informative_map(sparse, world_with_objects(1, style), g, 1);
        int mixed = 0;
        for (int y = 0; y < 80; ++y)
            for (int x = 0; x < 96; ++x) {
                const Informed& pixel = map.at(x, y);
                if (pixel.kind != PixelKind::interpolated) continue;
                if ((x < 48 ? pixel.radiance.y : pixel.radiance.x) > 0) ++mixed;
            }
        if (folds)
            EXPECT_EQ(mixed, 0);
        else
            EXPECT_GT(mixed, 100);
    }
}

} // namespace
} // namespace pnr
