// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/cells.h"
#include "npr/seats.h"
#include "synthetic.h"

#include <gtest/gtest.h>

#include <set>

namespace pnr {
namespace {

using namespace test;

std::vector<Vec3f> random_points(int count, std::uint64_t seed) {
    std::vector<Vec3f> points;
    for (int i = 0; i < count; ++i) {
        Rng rng = make_rng(seed, Pass::test, static_cast<std::uint64_t>(i));
        const Vec2 p = rng.uniform2();
        points.emplace_back(10 * p.x, 10 * p.y, 0.3 * std::sin(p.x));
    }
    return points;
}

TEST(Seats, AnyFirstSoManyKeepTheirDistanceAndLeaveNoHole) {
    const std::vector<Vec3f> points = random_points(3000, 1);
    const std::vector<float> spacing = spread_points(points, 5, 0.1f);
    for (const float s : {2.0f, 0.9f, 0.4f, 0.2f, 0.11f}) {
        std::vector<Vec3f> taken;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (spacing[i] >= s) taken.push_back(points[i]);
        for (std::size_t i = 0; i < taken.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) ASSERT_GE(glm::distance(taken[i], taken[j]), s * 0.9999f);
        for (const Vec3f& p : points) {
            float nearest = 100;
            for (const Vec3f& t : taken) nearest = std::min(nearest, glm::distance(p, t));
            ASSERT_LT(nearest, 1.27f * s) << s; // rounds are 2^(1/3) apart
        }
    }
}

TEST(Seats, TheOrderIsThatOfPlacesNotOfTheList) {
    std::vector<Vec3f> points = random_points(500, 2);
    const std::vector<float> spacing = spread_points(points, 5, 0.1f);
    std::vector<Vec3f> turned(points.rbegin(), points.rend());
    const std::vector<float> again = spread_points(turned, 5, 0.1f);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(spacing[i], again[points.size() - 1 - i]);
}

TEST(Seats, OddSets) {
    EXPECT_TRUE(spread_points({}, 1, 0.1f).empty());
    const std::vector<Vec3f> same(10, Vec3f(1, 2, 3));
    int first = 0;
    for (const float s : spread_points(same, 1, 0.1f)) first += s > 0 ? 1 : 0;
    EXPECT_EQ(first, 1);
}

// A plane seen from the front, moved to the left by `shift` pixels.
GBuffer shifted_plane(float shift) {
    GBuffer g = gbuffer_of(160, 120, [](int, int) { return 1; });
    for (Seen& seen : g.seen.pixels) seen.position.x += shift;
    return g;
}

std::vector<CellSite> sites_of(const GBuffer& g, const Seats& seats, double cell) {
    const Region region{1, 0, {0, 0, 160, 120}, 160 * 120};
    const Image<std::uint8_t> mask(160, 120, 1);
    const BrushScale scale = find_brush_scale(g, seats, region, mask);
    return make_cell_sites({g, seats, region, mask, scale, cell, 1, 0});
}

TEST(Cells, SitesStayOnTheObjectWhenTheViewMoves) {
    // With photons, without, and with too few: the sites in what both views show are the same, to rounding.
    for (const double share : {0.0, 0.01, 0.3}) {
        const GBuffer before = shifted_plane(0), after = shifted_plane(7.4f);
        Seats seats = random_seats(before, share, 4);
        if (seats.photons.empty()) seats.photons.resize(2);
        Seats moved = seats;
        std::erase_if(moved.seen, [](const Seat& s) { return s.at.x < 7.4f; });
        for (Seat& seat : moved.seen) seat.at.x -= 7.4f;
        const std::vector<CellSite> a = sites_of(before, seats, 6), b = sites_of(after, moved, 6);
        std::set<std::uint64_t> hashes;
        for (const CellSite& site : b) hashes.insert(site.hash);
        int shown = 0, kept = 0;
        for (const CellSite& site : a) {
            if (site.at.x < 20 || site.at.x > 150) continue;
            ++shown;
            kept += hashes.contains(site.hash) ? 1 : 0;
        }
        EXPECT_GT(shown, 100) << share;
        EXPECT_GE(kept, shown - shown / 50) << share;
    }
}

TEST(Cells, NearestSiteIsTheOneOfThePowerDiagram) {
    const GBuffer g = shifted_plane(0);
    std::vector<CellSite> sites = sites_of(g, random_seats(g, 0.02, 6), 5);
    for (std::size_t i = 0; i < sites.size(); ++i) sites[i].radius2 *= static_cast<float>(i % 3) / 2;
    const SiteGrid grid = build_site_grid(sites, {0, 0, 160, 120}, 5);
    for (int k = 0; k < 2000; ++k) {
        Rng rng = make_rng(3, Pass::test, static_cast<std::uint64_t>(k));
        const Vec2f at(Vec2(160, 120) * rng.uniform2());
        const std::uint32_t found = nearest_site(grid, at, Vec3f(at, 0), 1);
        const auto power = [&](const CellSite& s) {
            const Vec3f d = s.position - Vec3f(at, 0);
            return glm::dot(d, d) - s.radius2;
        };
        for (const CellSite& s : sites) ASSERT_GE(power(s), power(sites[found]) - 1e-4f);
    }
}

} // namespace
} // namespace pnr
