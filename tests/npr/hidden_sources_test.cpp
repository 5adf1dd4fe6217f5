// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/hidden_sources.h"

#include "synthetic.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

using namespace test;

// A flat thing a pixel a unit, whose every fourth pixel has a source: the photon itself, or one that lies
// `depth` units behind it.
struct Picture {
    World world;
    GBuffer gbuffer;
    SparseMap sparse;
    PhotonMap map;
};

Picture make_picture(float depth, bool all_behind, bool paper_mode) {
    PaintStyle style;
    style.paper_mode = paper_mode;
    Picture p{world_with_objects(1, style), gbuffer_of(32, 32, [](int, int) { return 1; }), {}, {}};
    p.sparse = random_sources(p.gbuffer, 0.25, 1);
    for (const SourcePixel& s : p.sparse.pixels) {
        if (s.photon < 0) continue;
        const bool behind = all_behind || s.photon % 3 == 0;
        Photon photon;
        photon.position = Vec3f(s.at, behind ? depth : 0.0f);
        p.map.photons.push_back(photon);
        p.map.normals.emplace_back(0.0f, 0.0f, -1.0f);
    }
    return p;
}

std::optional<SparseMap> shown(const Picture& p) {
    return without_hidden(p.sparse, p.world, p.gbuffer, p.map);
}

TEST(HiddenSources, WhatLiesBehindIsNoSourceOfPaintAndTheOthersStay) {
    const Picture p = make_picture(10, false, false);
    const auto left = shown(p);
    ASSERT_TRUE(left);
    for (std::size_t i = 0; i < p.sparse.pixels.size(); ++i) {
        const std::int32_t photon = p.sparse.pixels[i].photon;
        EXPECT_EQ(left->pixels[i].photon, photon % 3 == 0 ? -1 : photon);
    }
}

TEST(HiddenSources, NothingIsRefusedOnTheSurfaceInPaperModeOrWhereAllWouldGo) {
    EXPECT_FALSE(shown(make_picture(1, false, false)));
    EXPECT_FALSE(shown(make_picture(10, false, true)));
    EXPECT_FALSE(shown(make_picture(10, true, false)));
}

TEST(HiddenSources, ACurvedSurfaceHidesNoneOfItsOwnUpToTheSilhouette) {
    // A sphere of 100 pixels' radius seen in parallel: places of a pixel's square against its middle.
    constexpr float radius = 100;
    for (float x = 0; x < 99.5f; x += 0.5f) {
        Seen seen;
        const auto at = [](float along) {
            return Vec3f(along, 0, -std::sqrt(std::max(0.0f, radius * radius - along * along)));
        };
        seen.position = at(x);
        seen.normal = seen.position / radius;
        seen.dpdx = Vec3f(1, 0, -seen.normal.x / seen.normal.z);
        seen.dpdy = Vec3f(0, 1, 0);
        for (const float off : {-0.5f, 0.5f}) {
            const Vec3f place = at(std::min(x + off, radius));
            EXPECT_FALSE(is_hidden(seen, place, place / radius)) << x;
        }
    }
}

} // namespace
} // namespace pnr
