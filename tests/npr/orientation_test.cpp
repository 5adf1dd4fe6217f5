// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/orientation.h"

#include "core/closest_point.h"
#include "core/rng.h"
#include "core/scene.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

World painted(Shape shape, PaintStyle style, const Transform& transform = {}) {
    Object object;
    object.shape = std::move(shape);
    object.transform = transform;
    object.npr.emplace();
    object.npr->on = true;
    object.npr->style = std::move(style);
    Scene scene;
    scene.objects.push_back(std::move(object));
    return build_world(scene, {});
}

Vec3 random_vector(Rng& rng) {
    const double x = rng.uniform(), y = rng.uniform();
    return Vec3(x, y, rng.uniform()) * 2.0 - 1.0;
}

double sine_between(Vec3 a, Vec3 b) {
    return glm::length(glm::cross(a, b)) / (glm::length(a) * glm::length(b));
}

void expect_tangent(Vec3 t, Vec3 normal) {
    EXPECT_NEAR(glm::length(t), 1, 1e-9);
    EXPECT_NEAR(glm::dot(t, normal), 0, 1e-9);
}

TEST(Orientation, FieldAtEverySeedIsTheSeedsAxis) {
    for (const RbfKernel kernel : {RbfKernel::biharmonic, RbfKernel::triharmonic}) {
        for (const int count : {2, 3, 4, 12, 300}) {
            PaintStyle style;
            style.kernel = kernel;
            Rng rng = make_rng(static_cast<std::uint64_t>(count), Pass::test, 1);
            for (int i = 0; i < count; ++i) {
                const Vec3 at = random_vector(rng) * 3.0;
                style.seeds.push_back({at, random_vector(rng), 0.5 + rng.uniform(), {}});
            }
            const World world = painted(Torus{1.5, 0.5}, style, rotation({30, 20, 10}));
            const OrientationFields fields = make_orientation_fields(world);
            const OrientationField& field = *fields.fields[1];
            ASSERT_EQ(snapped_seeds(field).size(), static_cast<std::size_t>(count));
            for (const SnappedSeed& seed : snapped_seeds(field)) {
                expect_tangent(seed.axis, seed.normal);
                EXPECT_LT(sine_between(eval_orientation(field, seed.position, seed.normal), seed.axis), 1e-6)
                    << count;
            }
            EXPECT_LT(fields.reports[0].residual, 1e-6);
        }
    }
}

TEST(Orientation, SnapsToTheSurfaceAndLaysTheDirectionIntoIt) {
    PaintStyle style;
    style.seeds.push_back({{0, 5, 0}, {1, 1, 0}, 1, {}});
    const World world = painted(Sphere{{0, 0, 0}, 2}, style);
    const auto fields = make_orientation_fields(world);
    const SnappedSeed& seed = snapped_seeds(*fields.fields[1])[0];
    EXPECT_NEAR(glm::distance(seed.position + world.offset, Vec3(0, 2, 0)), 0, 1e-12);
    EXPECT_NEAR(sine_between(seed.axis, {1, 0, 0}), 0, 1e-12);
}

TEST(Orientation, OneSeedIsAConstantField) {
    PaintStyle style;
    style.seeds.push_back({{0, 2, 0}, {1, 0, 0}, 1, {}});
    const World world = painted(Sphere{{0, 0, 0}, 2}, style);
    const auto fields = make_orientation_fields(world);
    Rng rng = make_rng(3, Pass::test, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 n = glm::normalize(random_vector(rng));
        const Vec3 t = eval_orientation(*fields.fields[1], 2.0 * n, n);
        expect_tangent(t, n);
        // The x axis laid into the tangent plane.
        if (std::abs(n.x) > 0.99) continue;
        EXPECT_LT(sine_between(t, Vec3(1, 0, 0) - n * n.x), 1e-9);
    }
}

TEST(Orientation, AnAxisAndItsReverseAreOne) {
    // Between a seed along +x and one along -x a blend of vectors would vanish or turn; the axis stays.
    PaintStyle style;
    style.seeds.push_back({{-1, 1, 0}, {1, 0, 0}, 1, {}});
    style.seeds.push_back({{1, 1, 0}, {-1, 0, 0}, 1, {}});
    const World world = painted(Box{{-2, -1, -2}, {2, 1, 2}}, style);
    const auto fields = make_orientation_fields(world);
    for (int i = 0; i <= 20; ++i) {
        const Vec3 t =
            eval_orientation(*fields.fields[1], Vec3(-1 + 0.1 * i, 1, 0.3) - world.offset, {0, 1, 0});
        EXPECT_LT(sine_between(t, {1, 0, 0}), 1e-9);
    }
}

TEST(Orientation, SeedAlongTheNormalIsNotedAndGetsATangent) {
    PaintStyle style;
    style.seeds.push_back({{0, 3, 0}, {0, 1, 0}, 1, {"here.pnr", 7, 3}});
    const World world = painted(Sphere{{0, 0, 0}, 2}, style);
    const auto fields = make_orientation_fields(world);
    expect_tangent(snapped_seeds(*fields.fields[1])[0].axis, {0, 1, 0});
    ASSERT_EQ(fields.reports[0].notes.size(), 1u);
    EXPECT_NE(fields.reports[0].notes[0].find("here.pnr:7:3"), std::string::npos);
    EXPECT_NE(fields.reports[0].notes[0].find("normal"), std::string::npos);
}

TEST(Orientation, NoSeedSetGivesNaN) {
    // Sets of each awkward kind: few, equal, opposite, collinear, coplanar, clustered, along the normal,
    // degenerate.
    for (int round = 0; round < 400; ++round) {
        Rng rng = make_rng(11, Pass::test, static_cast<std::uint64_t>(round));
        PaintStyle style;
        style.kernel = static_cast<RbfKernel>(round % 2);
        style.smooth = round % 5 == 0 ? rng.uniform() : 0;
        style.neighbours = round % 4 == 0 ? 1 + round % 3 : 0;
        style.vectors = round % 7 == 0;
        const int count = 1 + static_cast<int>(rng.uniform() * 9);
        const Vec3 base = random_vector(rng), way = random_vector(rng), across = random_vector(rng);
        for (int i = 0; i < count; ++i) {
            Vec3 at = random_vector(rng) * 2.0, direction = random_vector(rng);
            switch (round % 8) {
            case 0:
                at = base;
                break;
            case 1:
                at = base + way * (0.1 * i);
                break;
            case 2:
                at = base + way * rng.uniform() + across * rng.uniform();
                break;
            case 3:
                at = base + 1e-10 * at;
                break;
            case 4:
                direction = i % 2 ? way : -way;
                break;
            case 5:
                direction = at;
                break;
            case 6:
                direction = i == 0 ? Vec3(0) : direction;
                break;
            default:
                break;
            }
            style.seeds.push_back({at, direction, round % 9 == 0 ? rng.uniform() * 1e6 : 1.0, {}});
        }
        const World world =
            round % 2 ? painted(Sphere{{0, 0, 0}, 1}, style) : painted(Box{{-1, -1, -1}, {1, 1, 1}}, style);
        const auto fields = make_orientation_fields(world);
        ASSERT_TRUE(std::isfinite(fields.reports[0].residual));
        for (int i = 0; i < 40; ++i) {
            const ClosestPoint on = closest_point_on_object(world, 1, random_vector(rng) * 2.0);
            const Vec3 t = eval_orientation(*fields.fields[1], on.position, on.normal);
            ASSERT_TRUE(std::isfinite(t.x + t.y + t.z)) << round;
            expect_tangent(t, on.normal);
        }
    }
}

PhotonMap photons_on_sphere(int count) {
    PhotonMap map;
    Rng rng = make_rng(21, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        const Vec3f n(glm::normalize(random_vector(rng)));
        map.photons.push_back({n, -n, Color(1), photon_tag(1, i % 10 != 0, PhotonPath::direct)});
        map.normals.push_back(n);
    }
    return map;
}

TEST(Orientation, PhotonsAreTangentInFloatAndTheSameForAnyNumberOfThreads) {
    for (const bool paper : {false, true}) {
        PaintStyle style;
        style.paper_mode = style.vectors = paper;
        Rng rng = make_rng(31, Pass::test, 0);
        for (int i = 0; i < 8; ++i) {
            const Vec3 at = random_vector(rng);
            style.seeds.push_back({at, random_vector(rng), 1, {}});
        }
        const World world = painted(Sphere{{0, 0, 0}, 1}, style);
        const auto fields = make_orientation_fields(world);
        const PhotonMap map = photons_on_sphere(3000);
        std::vector<Vec3f> one, two;
        {
            const ThreadLimit limit(1);
            one = orient_photons(world, map, fields);
        }
        {
            const ThreadLimit limit(2);
            two = orient_photons(world, map, fields);
        }
        EXPECT_EQ(one, two);
        for (std::size_t i = 0; i < one.size(); ++i) {
            if (!map.photons[i].npr()) {
                EXPECT_EQ(one[i], Vec3f(0));
                continue;
            }
            EXPECT_NEAR(glm::length(one[i]), 1, 1e-6);
            EXPECT_NEAR(glm::dot(one[i], map.normals[i]), 0, 1e-6);
        }
    }
}

} // namespace
} // namespace pnr
