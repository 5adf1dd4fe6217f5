// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/kdtree.h"
#include "core/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace pnr;

namespace {

constexpr float everywhere = std::numeric_limits<float>::infinity();

bool nearer(const Neighbour& a, const Neighbour& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.index < b.index;
}

std::vector<Neighbour> brute_force(const std::vector<Vec3f>& points, Vec3f p, float radius) {
    std::vector<Neighbour> all;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f d = points[i] - p;
        const float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
        if (d2 <= radius * radius) all.push_back({d2, static_cast<std::uint32_t>(i)});
    }
    std::sort(all.begin(), all.end(), nearer);
    return all;
}

void expect_same(const std::vector<Neighbour>& a, const std::vector<Neighbour>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].index, b[i].index);
        ASSERT_EQ(a[i].distance2, b[i].distance2);
    }
}

Vec3f random_point(Rng& rng) {
    const double x = rng.uniform(), y = rng.uniform();
    return Vec3f(Vec3(x, y, rng.uniform()));
}

// Uniform, on a sheet (a wall), in clusters of very different density, with many equal points.
std::vector<std::vector<Vec3f>> point_sets() {
    std::vector<std::vector<Vec3f>> sets(4);
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < 3000; ++i) {
        const Vec3f p = random_point(rng);
        sets[0].push_back(p);
        sets[1].push_back({p.x, 0.25f, p.z});
        sets[2].push_back(p * std::pow(10.f, -static_cast<float>(i % 7)));
        sets[3].push_back({std::floor(p.x * 4) / 4, std::floor(p.y * 4) / 4, std::floor(p.z * 4) / 4});
    }
    return sets;
}

} // namespace

TEST(KdTree, NearestAgreesWithBruteForce) {
    Rng rng = make_rng(2, Pass::test, 0);
    std::vector<Neighbour> found;
    for (const auto& points : point_sets()) {
        const KdTree tree = build_kdtree(points);
        for (int query = 0; query < 60; ++query) {
            const Vec3f p =
                query % 3 == 0 ? points[static_cast<std::size_t>(query * 37)] : random_point(rng) * 1.5f;
            for (const int k : {1, 7, 50, 100, 1000})
                for (const float radius : {everywhere, 0.2f, 0.01f, 0.f}) {
                    std::vector<Neighbour> truth = brute_force(points, p, radius);
                    if (truth.size() > static_cast<std::size_t>(k)) truth.resize(static_cast<std::size_t>(k));
                    find_nearest(tree, p, k, radius, found);
                    expect_same(found, truth);
                }
        }
    }
}

// Whatever the hint says: the same neighbours, in leaf order.
TEST(KdTree, NearestNearDoesNotDependOnTheHint) {
    Rng rng = make_rng(4, Pass::test, 0);
    std::vector<Neighbour> found;
    for (const auto& given : point_sets()) {
        std::vector<Vec3f> points; // in leaf order, so that ties are by index as everywhere
        for (const std::uint32_t i : build_kdtree(given).order) points.push_back(given[i]);
        const KdTree tree = kdtree_of_leaf_order(points);
        for (int query = 0; query < 60; ++query) {
            const Vec3f p =
                query % 3 == 0 ? points[static_cast<std::size_t>(query * 37)] : random_point(rng) * 1.5f;
            for (const int k : {1, 50, 1000, 5000})
                for (const float radius : {everywhere, 0.2f, 0.f}) {
                    std::vector<Neighbour> truth = brute_force(points, p, radius);
                    if (truth.size() > static_cast<std::size_t>(k)) truth.resize(static_cast<std::size_t>(k));
                    const float largest = truth.empty() ? 0 : truth.back().distance2;
                    std::sort(truth.begin(), truth.end(),
                              [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
                    for (const float distance : {0.f, 1e-6f, 0.05f, 0.5f, 1e4f}) {
                        SearchHint hint{p + Vec3f(0.01f), distance};
                        EXPECT_EQ(find_nearest_near(tree, p, k, radius, hint, found), largest);
                        expect_same(found, truth);
                    }
                }
        }
    }
}

TEST(KdTree, WithinAgreesWithBruteForce) {
    Rng rng = make_rng(3, Pass::test, 0);
    std::vector<Neighbour> found;
    for (const auto& points : point_sets()) {
        const KdTree tree = build_kdtree(points);
        for (int query = 0; query < 40; ++query) {
            const Vec3f p = random_point(rng);
            for (const float radius : {0.f, 0.03f, 0.3f, 5.f}) {
                find_within(tree, p, radius, found);
                std::sort(found.begin(), found.end(), nearer);
                expect_same(found, brute_force(points, p, radius));
            }
        }
    }
}

TEST(KdTree, EmptyOneAndTooFew) {
    std::vector<Neighbour> found{{1, 1}};
    const KdTree none = build_kdtree({});
    find_nearest(none, {0, 0, 0}, 5, everywhere, found);
    EXPECT_TRUE(found.empty());
    find_within(none, {0, 0, 0}, 5, found);
    EXPECT_TRUE(found.empty());

    const std::vector<Vec3f> one{{1, 2, 3}};
    const KdTree tree = build_kdtree(one);
    find_nearest(tree, {1, 2, 5}, 50, everywhere, found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].distance2, 4.f);
    find_nearest(tree, {1, 2, 5}, 0, everywhere, found);
    EXPECT_TRUE(found.empty());
    find_nearest(tree, {1, 2, 5}, 1, 1.9f, found);
    EXPECT_TRUE(found.empty());
    find_within(tree, {1, 2, 5}, 2, found);
    EXPECT_EQ(found.size(), 1u);
}

TEST(KdTree, AllPointsEqual) {
    const std::vector<Vec3f> same(5000, Vec3f(0.5f, -1, 2));
    const KdTree tree = build_kdtree(same);
    std::vector<Neighbour> found;
    find_nearest(tree, {0.5f, -1, 2}, 100, 0, found);
    ASSERT_EQ(found.size(), 100u);
    for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(found[i].index, i);
    find_within(tree, {0, 0, 0}, 10, found);
    EXPECT_EQ(found.size(), same.size());
}
