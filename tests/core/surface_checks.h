// SPDX-License-Identifier: GPL-3.0-or-later
// What is true of every solid: its hits are where a line changes between outside and inside.
#pragma once

#include "core/rng.h"
#include "core/shape_hits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace pnr {

inline Vec3 point_in_cube(Rng& rng, double half) {
    return half * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

// `inside` is said by the test, independently of the shape's own; `near` keeps places out where rounding
// decides.
struct CheckedSolid {
    Shape shape;
    std::function<bool(Vec3)> inside;
    double reach = 2;   // rays start and end in a cube of this half width
    double step = 1e-6; // how far off the surface is clearly off it
    int rays = 2000;
};

// Along rays, some of them along the axes: the inside at random places is what the parity of hits before them
// says, and changes at each hit; normals point to the outside and are across the surface; everything lies in
// the bounds.
inline void expect_solid(const CheckedSolid& solid) {
    Rng rng = make_rng(11, Pass::test, 0);
    const Bounds box = shape_bounds(solid.shape);
    int met = 0, unclear = 0;
    for (int i = 0; i < solid.rays; ++i) {
        const Vec3 from = point_in_cube(rng, solid.reach), to = point_in_cube(rng, 0.5 * solid.reach);
        Vec3 direction = (0.2 + rng.uniform()) * (to - from);
        if (i % 5 == 0) direction[static_cast<int>(3 * rng.uniform())] = 0;
        if (i % 11 == 0) direction = i % 2 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        if (i % 13 == 0) direction = Vec3(0, 0, -2);
        HitList hits;
        const int count = intersect_shape(solid.shape, {from, direction, 0, infinity}, hits);
        ASSERT_EQ(static_cast<std::size_t>(count), hits.size());
        met += count > 0;
        const double speed = glm::length(direction);
        for (int k = 0; k < count; ++k) {
            const ShapeHit& hit = hits[static_cast<std::size_t>(k)];
            const Vec3 p = from + hit.t * direction;
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], box.low[axis] - 1e-9);
                ASSERT_LE(p[axis], box.high[axis] + 1e-9);
            }
            ASSERT_TRUE(k == 0 || hits[static_cast<std::size_t>(k) - 1].t <= hit.t);
            ASSERT_GT(glm::length(hit.normal), 0);
            const Vec3 n = glm::normalize(hit.normal);
            // Close to an edge both sides of a face may be outside.
            const bool below = solid.inside(p - solid.step * n), above = solid.inside(p + solid.step * n);
            unclear += below == above;
            EXPECT_TRUE(below || !above) << "the normal of hit " << k << " points inwards, ray " << i;
        }
        for (int k = 0; k < 12; ++k) {
            const double t = 2.5 * solid.reach / speed * rng.uniform();
            int before = 0;
            bool close = false;
            for (const ShapeHit& hit : hits)
                before += hit.t < t, close |= std::abs(hit.t - t) * speed < solid.step;
            if (close) continue;
            const Vec3 p = from + t * direction;
            const bool starts = solid.inside(from), here = solid.inside(p);
            EXPECT_EQ((before % 2 != 0) != starts, here) << "ray " << i << " at " << t << " of " << count;
            EXPECT_EQ(inside_shape(solid.shape, p), here) << "ray " << i << " at " << t;
        }
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(met, solid.rays / 50);
    EXPECT_LE(unclear, 2 + met / 50);
}

} // namespace pnr
