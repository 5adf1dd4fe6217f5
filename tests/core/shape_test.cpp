// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_hits.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace pnr {
namespace {

// A solid said twice: as a shape, and as a function that is negative inside, about the distance to the
// surface near it.
struct Solid {
    Shape shape;
    std::function<double(Vec3)> distance;
};

double cone_distance(const Cone& c, Vec3 p) {
    const double height = glm::length(c.cap - c.base);
    const Vec3 axis = (c.cap - c.base) / height;
    const double z = glm::dot(p - c.base, axis);
    const double r = glm::length(p - c.base - z * axis);
    const double slope = (c.cap_radius - c.base_radius) / height;
    return std::max({-z, z - height, (r - c.base_radius - slope * z) / std::hypot(1, slope)});
}

std::vector<Solid> solids() {
    const Sphere sphere{{0.3, -0.2, 0.1}, 1.1};
    const Box box{{-1, -0.5, -0.7}, {0.8, 0.9, 1.2}};
    const Plane plane{glm::normalize(Vec3(1, 2, -1)), 0.3};
    const Cylinder cylinder{{-0.5, -1, 0.2}, {0.7, 0.9, -0.3}, 0.6, false};
    const Cone frustum{{0, -1, 0}, {0.4, 1, 0.2}, 1, 0.4, false}, tip{{0, 1, 0}, {0.2, -1, 0}, 1.2, 0, false};
    const Torus ring{1, 0.3}, thin{1.4, 0.01};
    const auto torus = [](Torus t, Vec3 p) {
        return std::hypot(std::hypot(p.x, p.z) - t.major, p.y) - t.minor;
    };
    return {
        {sphere, [=](Vec3 p) { return glm::length(p - sphere.center) - sphere.radius; }},
        {box,
         [=](Vec3 p) {
             const Vec3 d = glm::max(box.low - p, p - box.high);
             return std::max({d.x, d.y, d.z});
         }},
        {plane, [=](Vec3 p) { return glm::dot(plane.normal, p) - plane.distance; }},
        {cylinder,
         [=](Vec3 p) {
             return cone_distance({cylinder.base, cylinder.cap, cylinder.radius, cylinder.radius, false}, p);
         }},
        {frustum, [=](Vec3 p) { return cone_distance(frustum, p); }},
        {tip, [=](Vec3 p) { return cone_distance(tip, p); }},
        {ring, [=](Vec3 p) { return torus(ring, p); }},
        {thin, [=](Vec3 p) { return torus(thin, p); }},
    };
}

Vec3 random_point(Rng& rng, double size) {
    return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

class AnySolid : public testing::TestWithParam<int> {
protected:
    const Solid solid = solids()[static_cast<std::size_t>(GetParam())];
};

// Points along a ray are inside exactly where an odd number of crossings lies before them (or even, if it
// starts inside).
TEST_P(AnySolid, HitsAreTheCrossingsOfItsSurface) {
    Rng rng = make_rng(1, Pass::test, static_cast<std::uint64_t>(GetParam()));
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 origin = random_point(rng, 3);
        Vec3 direction = (0.1 + 3 * rng.uniform()) * glm::normalize(random_point(rng, 1.5) - origin);
        if (i % 7 == 0) direction[static_cast<int>(rng.uniform() * 3)] = i % 2 ? 0.0 : -0.0;
        if (i % 11 == 0) direction = i % 2 ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
        HitList hits;
        const int count = intersect_shape(solid.shape, {origin, direction, 0, infinity}, hits);
        met += count > 0;
        for (int k = 0; k < count; ++k) {
            const ShapeHit& hit = hits[static_cast<std::size_t>(k)];
            const Vec3 p = origin + hit.t * direction;
            EXPECT_LT(std::abs(solid.distance(p)), 1e-13 * (1 + glm::length(p))) << i;
            if (k > 0) {
                EXPECT_LE(hits[static_cast<std::size_t>(k) - 1].t, hit.t);
            }
            const Vec3 n = glm::normalize(hit.normal); // points to where the distance grows
            EXPECT_GT(solid.distance(p + 1e-6 * n), -1e-12) << i;
            EXPECT_LT(solid.distance(p - 1e-6 * n), 1e-12) << i;
        }
        const bool starts_inside = solid.distance(origin) < 0;
        for (int k = 0; k < 8; ++k) {
            const double t = 8 * rng.uniform();
            const double d = solid.distance(origin + t * direction);
            if (std::abs(d) < 1e-9 || std::abs(solid.distance(origin)) < 1e-9) continue;
            int before = 0;
            while (before < count && hits[static_cast<std::size_t>(before)].t < t) ++before;
            EXPECT_EQ((before % 2 != 0) != starts_inside, d < 0) << "ray " << i << " at " << t;
            EXPECT_EQ(inside_shape(solid.shape, origin + t * direction), d < 0) << "ray " << i << " at " << t;
        }
    }
    EXPECT_GT(met, 200);
}

TEST_P(AnySolid, BoundsHoldItAndAreTight) {
    const Bounds b = shape_bounds(solid.shape);
    if (!std::isfinite(b.low.x)) return; // a plane
    Rng rng = make_rng(2, Pass::test, 0);
    Bounds seen;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 from = random_point(rng, 2.5), to = random_point(rng, 2.5);
        HitList hits;
        const int count = intersect_shape(solid.shape, {from, to - from, -infinity, infinity}, hits);
        for (int k = 0; k < count; ++k)
            seen = merge(seen, from + hits[static_cast<std::size_t>(k)].t * (to - from));
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(seen.low[axis], b.low[axis] - 1e-12);
        EXPECT_LE(seen.high[axis], b.high[axis] + 1e-12);
        EXPECT_NEAR(seen.low[axis], b.low[axis], 0.02);
        EXPECT_NEAR(seen.high[axis], b.high[axis], 0.02);
    }
}

TEST_P(AnySolid, KeepsItsPrecisionFromAfar) {
    if (std::holds_alternative<Plane>(solid.shape)) return;
    Rng rng = make_rng(3, Pass::test, 0);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 away = 1e6 * glm::normalize(random_point(rng, 1));
        const Vec3 direction = glm::normalize(random_point(rng, 0.5) - away);
        HitList hits;
        const int count = intersect_shape(solid.shape, {away, direction, 0, infinity}, hits);
        for (int k = 0; k < count; ++k)
            EXPECT_LT(std::abs(solid.distance(away + hits[static_cast<std::size_t>(k)].t * direction)), 2e-9);
        EXPECT_EQ(count % 2, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Solids, AnySolid, testing::Range(0, 8), [](const auto& param) {
    return std::string(shape_name(solids()[static_cast<std::size_t>(param.param)].shape)) +
           std::to_string(param.param);
});

TEST(IntersectShape, KnownDistances) {
    HitList h;
    ASSERT_EQ(intersect_shape(Sphere{{0, 0, 5}, 2}, {{0, 0, 0}, {0, 0, 2}, 0, infinity}, h), 2);
    EXPECT_DOUBLE_EQ(h[0].t, 1.5); // in units of the direction
    EXPECT_DOUBLE_EQ(h[1].t, 3.5);
    ASSERT_EQ(intersect_shape(Torus{2, 0.5}, {{-5, 0, 0}, {1, 0, 0}, 0, infinity}, h), 4);
    const double expected[] = {2.5, 3.5, 6.5, 7.5};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(h[i].t, expected[i], 1e-14);
    ASSERT_EQ(intersect_shape(Torus{2, 0.5}, {{-5, 0, 0}, {1, 0, 0}, 3, 7}, h), 2)
        << "only inside (t_min, t_max)";
    EXPECT_NEAR(h[0].t, 3.5, 1e-14);
    EXPECT_EQ(intersect_shape(Torus{2, 0.5}, {{0, -5, 0}, {0, 1, 0}, 0, infinity}, h), 0)
        << "through the hole";
    EXPECT_EQ(intersect_shape(Disc{{0, 1, 0}, {0, 1, 0}, 1, 0.25}, {{0.1, 5, 0}, {0, -1, 0}, 0, infinity}, h),
              0);
    ASSERT_EQ(intersect_shape(Disc{{0, 1, 0}, {0, 1, 0}, 1, 0.25}, {{0.5, 5, 0}, {0, -1, 0}, 0, infinity}, h),
              1);
    EXPECT_DOUBLE_EQ(h[0].t, 4);
    EXPECT_EQ(intersect_shape(Plane{{0, 1, 0}, 1}, {{0, 3, 0}, {1, 0, 0}, 0, infinity}, h), 0) << "parallel";
}

TEST(IntersectShape, OpenCylinderHasNoLids) {
    HitList h;
    const Ray along{{0.5, 5, 0}, {0, -1, 0}, 0, infinity};
    EXPECT_EQ(intersect_shape(Cylinder{{0, 0, 0}, {0, 1, 0}, 1, true}, along, h), 0);
    EXPECT_EQ(intersect_shape(Cylinder{{0, 0, 0}, {0, 1, 0}, 1, false}, along, h), 2);
    EXPECT_EQ(intersect_shape(Cone{{0, 0, 0}, {0, 1, 0}, 1, 0, true}, along, h), 1) << "the side alone";
    EXPECT_EQ(intersect_shape(Cone{{0, 0, 0}, {0, 1, 0}, 1, 0, false}, along, h), 2);
    EXPECT_EQ(
        intersect_shape(Cylinder{{0, 0, 0}, {0, 1, 0}, 1, true}, {{-5, 0.5, 0}, {1, 0, 0}, 0, infinity}, h),
        2);
}

// What POV-Ray 3.7's inside() prints.
TEST(InsideShape, IsPovraysForOpenShapesAndDiscs) {
    const Cylinder pipe{{0, 0, 0}, {0, 1, 0}, 1, true};
    EXPECT_TRUE(inside_shape(pipe, {0, 0.5, 0}));
    EXPECT_FALSE(inside_shape(pipe, {0, 1.5, 0}));
    const Cone funnel{{0, 0, 0}, {0, 1, 0}, 1, 0, true};
    EXPECT_TRUE(inside_shape(funnel, {0, 0.5, 0}));
    EXPECT_FALSE(inside_shape(funnel, {0, 1.5, 0})) << "the mirrored half of the double cone";
    EXPECT_FALSE(inside_shape(funnel, {0, -0.5, 0}));
    const Disc disc{{0, 0, 0}, {0, 1, 0}, 1, 0.3};
    EXPECT_TRUE(inside_shape(disc, {5, -0.5, 0})) << "a half space";
    EXPECT_FALSE(inside_shape(disc, {0, 0.5, 0}));
}

// Rays aimed exactly at the rims, where the side ends and the lid begins, from outside into the solid.
TEST(IntersectShape, RimsDoNotLeak) {
    Rng rng = make_rng(4, Pass::test, 0);
    for (const bool cone : {false, true}) {
        const Vec3 base(0.1, -0.9, 0.3), cap(-0.3, 1.1, 0.2);
        const double r1 = 0.8, r2 = cone ? 0.3 : 0.8;
        const Frame frame = make_frame(glm::normalize(cap - base));
        for (int i = 0; i < 20000; ++i) {
            const double a = 2 * pi * rng.uniform();
            const Vec3 rim = base + r1 * (std::cos(a) * frame.x + std::sin(a) * frame.y);
            const Vec3 inside = 0.5 * (base + cap) + random_point(rng, 0.1);
            const Vec3 from = inside + 4.0 * (rim - inside);
            HitList h;
            const Ray ray{from, inside - from, 0, infinity};
            EXPECT_EQ(intersect_shape(Cone{base, cap, r1, r2, false}, ray, h), 2);
        }
    }
}

TEST(IntersectShape, ZeroAndMinusZeroDirectionsAreOne) {
    HitList h;
    for (const double zero : {0.0, -0.0}) {
        for (const Vec3 origin : {Vec3(0, 0, -3), Vec3(1, 0, -3), Vec3(0, -1, -3)}) { // also along a face
            EXPECT_EQ(
                intersect_shape(Box{{-1, -1, -1}, {1, 1, 1}}, {origin, {zero, zero, 1}, 0, infinity}, h), 2);
            EXPECT_DOUBLE_EQ(h[0].t, 2);
        }
    }
}

} // namespace
} // namespace pnr
