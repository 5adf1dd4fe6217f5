// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/curvature.h"

#include "core/rng.h"
#include "core/scene.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

World world_of(Shape shape, const Transform& transform = {}) {
    Object object;
    object.shape = std::move(shape);
    object.transform = transform;
    Scene scene;
    scene.objects.push_back(std::move(object));
    return build_world(scene, {});
}

// A torus about y as triangles.
Mesh torus_mesh(double major, double minor, std::uint32_t rounds, std::uint32_t sides) {
    auto data = std::make_shared<MeshData>();
    for (std::uint32_t i = 0; i < rounds; ++i) {
        for (std::uint32_t j = 0; j < sides; ++j) {
            const double u = 2 * pi * i / rounds, v = 2 * pi * j / sides, r = major + minor * std::cos(v);
            data->positions.emplace_back(r * std::cos(u), minor * std::sin(v), r * std::sin(u));
            const auto at = [&](std::uint32_t a, std::uint32_t b) {
                return (a % rounds) * sides + b % sides;
            };
            data->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            data->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    Mesh mesh;
    mesh.data = data;
    return mesh;
}

double sine_between(Vec3 a, Vec3 b) {
    return glm::length(glm::cross(a, b)) / (glm::length(a) * glm::length(b));
}

TEST(Curvature, LeastRunsAlongATube) {
    // Outside and on top of a thin torus the least curvature runs the long way round.
    const Transform turned = rotation({30, 40, 0});
    for (const bool as_mesh : {false, true}) {
        const World world =
            as_mesh ? world_of(torus_mesh(3, 0.5, 160, 40), turned) : world_of(Torus{3, 0.5}, turned);
        const CurvatureField field = make_curvature_field(world, 1);
        for (int k = 0; k < 50; ++k) {
            const double u = 2 * pi * k / 50, v = 1.5 * std::sin(7.0 * k);
            const Vec3 normal(std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u));
            const Vec3 place = Vec3(3 * std::cos(u), 0, 3 * std::sin(u)) + 0.5 * normal;
            const Vec3 p = transform_point(turned.matrix, place) - world.offset;
            const Vec3 n = transform_vector(turned.matrix, normal);
            const Vec3 round = transform_vector(turned.matrix, Vec3(-std::sin(u), 0, std::cos(u)));
            EXPECT_LT(sine_between(eval_curvature_axis(field, p, n, false), round), as_mesh ? 0.03 : 1e-6);
            EXPECT_NEAR(glm::dot(glm::normalize(eval_curvature_axis(field, p, n, true)), round), 0,
                        as_mesh ? 0.03 : 1e-6);
        }
    }
}

TEST(Curvature, OnAnEllipsoidRunsTowardsItsLongEnds) {
    // At the middle of a long ellipsoid of three axes the principal directions are the other two axes [do
    // Carmo 1976, 3.3].
    const World world = world_of(Sphere{}, scaling({1, 2, 4}));
    const CurvatureField field = make_curvature_field(world, 1);
    EXPECT_LT(sine_between(eval_curvature_axis(field, {1, 0, 0}, {1, 0, 0}, false), {0, 0, 1}), 1e-9);
    EXPECT_LT(sine_between(eval_curvature_axis(field, {0, 2, 0}, {0, 1, 0}, false), {0, 0, 1}), 1e-9);
    EXPECT_LT(sine_between(eval_curvature_axis(field, {0, 0, 4}, {0, 0, 1}, false), {0, 1, 0}), 1e-9);
}

TEST(Curvature, SaysNothingOnPlanesAndSpheres) {
    const World ball = world_of(Sphere{});
    const CurvatureField on_ball = make_curvature_field(ball, 1);
    EXPECT_LT(glm::length(eval_curvature_axis(on_ball, {0, 0, 1}, {0, 0, 1}, false)), 1e-9);
    const World box = world_of(Box{{-1, -1, -1}, {1, 1, 1}});
    const CurvatureField on_box = make_curvature_field(box, 1);
    EXPECT_EQ(eval_curvature_axis(on_box, {0.2, 1, 0.3}, {0, 1, 0}, false), Vec3(0));
}

TEST(Curvature, ConesAreStraightAlongTheirSides) {
    const World world = world_of(Cone{{0, 0, 0}, {0, 2, 0}, 1, 0, true});
    const CurvatureField field = make_curvature_field(world, 1);
    const Vec3 normal = glm::normalize(Vec3(2, 1, 0));
    EXPECT_LT(
        sine_between(eval_curvature_axis(field, Vec3(0.5, 1, 0) - world.offset, normal, false), {-1, 2, 0}),
        1e-9);
}

TEST(Curvature, BrokenMeshesGiveFiniteAxes) {
    auto data = std::make_shared<MeshData>();
    Rng rng = make_rng(5, Pass::test, 0);
    for (int i = 0; i < 60; ++i)
        data->positions.emplace_back(rng.uniform(), rng.uniform(), i % 7 ? rng.uniform() : 0.0);
    for (int i = 0; i < 80; ++i) { // edges of many triangles, slivers, repeated vertices
        const auto pick = [&] { return static_cast<std::uint32_t>(rng.uniform() * 60); };
        const std::uint32_t a = pick(), b = pick();
        data->triangles.push_back({a, b, i % 5 ? pick() : a});
    }
    Mesh mesh;
    mesh.data = data;
    const World world = world_of(mesh);
    const CurvatureField field = make_curvature_field(world, 1);
    for (int i = 0; i < 100; ++i) {
        const double x = rng.uniform(), y = rng.uniform();
        const ClosestPoint at = closest_point(*field.surface, Vec3(x, y, rng.uniform()) - world.offset);
        const Vec3 axis = eval_curvature_axis(field, at.position, at.normal, false);
        EXPECT_TRUE(std::isfinite(axis.x + axis.y + axis.z));
    }
}

} // namespace
} // namespace pnr
