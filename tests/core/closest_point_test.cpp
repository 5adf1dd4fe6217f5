// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/closest_point.h"

#include "core/rng.h"
#include "core/scene.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

Vec3 random_point(Rng& rng, double extent) {
    const double x = rng.uniform(), y = rng.uniform();
    return (Vec3(x, y, rng.uniform()) * 2.0 - 1.0) * extent;
}

Object object_of(Shape shape, const Transform& transform = {}) {
    Object object;
    object.shape = std::move(shape);
    object.transform = transform;
    return object;
}

World world_of(std::vector<Object> objects) {
    Scene scene;
    scene.objects = std::move(objects);
    return build_world(scene, {});
}

MeshData random_triangles(int count, std::uint64_t seed) {
    MeshData data;
    Rng rng = make_rng(seed, Pass::test, 0);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        const Vec3 corner = random_point(rng, 2);
        for (int k = 0; k < 3; ++k) data.positions.emplace_back(corner + random_point(rng, 0.3));
        data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return data;
}

// Least distance to a triangle by exhaustion of its features.
double distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = glm::cross(b - a, c - a);
    const Vec3 foot = p - n * (glm::dot(p - a, n) / glm::dot(n, n));
    const bool inside = glm::dot(glm::cross(b - a, foot - a), n) >= 0 &&
                        glm::dot(glm::cross(c - b, foot - b), n) >= 0 &&
                        glm::dot(glm::cross(a - c, foot - c), n) >= 0;
    if (inside) return glm::distance(p, foot);
    const auto to_edge = [&](Vec3 q, Vec3 r) {
        const double t = std::clamp(glm::dot(p - q, r - q) / glm::dot(r - q, r - q), 0.0, 1.0);
        return glm::distance(p, q + t * (r - q));
    };
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(ClosestPoint, OnTrianglesByBruteForce) {
    const auto data = std::make_shared<MeshData>(random_triangles(300, 3));
    Mesh mesh;
    mesh.data = data;
    const World world = world_of({object_of(mesh)});
    const auto index = index_surface(world, 1);
    Rng rng = make_rng(1, Pass::test, 1);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random_point(rng, 3);
        const ClosestPoint found = closest_point(*index, p);
        double least = infinity;
        const auto place = [&](std::uint32_t v) { return Vec3(data->positions[v]) - world.offset; };
        for (const auto& [a, b, c] : data->triangles)
            least = std::min(least, distance_to_triangle(p, place(a), place(b), place(c)));
        EXPECT_NEAR(found.distance, least, 1e-6);
        const auto& [a, b, c] = data->triangles[found.triangle];
        const Vec3 again =
            found.weights.x * place(a) + found.weights.y * place(b) + found.weights.z * place(c);
        EXPECT_NEAR(glm::distance(again, found.position), 0, 1e-6);
    }
}

// At the nearest point of a smooth surface the way to the query is along the normal, and a dense set of other
// points of the surface (rays through it) holds none that is nearer.
void check_shape(const Shape& shape, const Transform& transform, std::uint64_t seed) {
    const World world = world_of({object_of(shape, transform)});
    const auto index = index_surface(world, 1);
    Rng rng = make_rng(seed, Pass::test, 2);
    std::vector<Vec3> surface;
    while (surface.size() < 4000) {
        const Vec3 from = random_point(rng, 3 * world.radius);
        const Vec3 to = random_point(rng, world.radius);
        if (const auto hit = closest_hit(world, {from, glm::normalize(to - from)}, RayKind::camera))
            surface.push_back(hit->position);
    }
    int met = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec3 p = random_point(rng, 1.5 * world.radius);
        const ClosestPoint found = closest_point(*index, p);
        double least = infinity;
        for (const Vec3& q : surface) least = std::min(least, glm::distance(p, q));
        EXPECT_LE(found.distance, least + 1e-6 * world.radius) << shape_name(shape);
        EXPECT_GE(found.distance, least - 0.3 * world.radius) << shape_name(shape);
        EXPECT_NEAR(glm::length(found.normal), 1, 1e-12);
        // On the surface: a ray along the normal meets it there.
        const auto hit = closest_hit(
            world, {found.position + 1e-3 * world.radius * found.normal, -found.normal}, RayKind::camera);
        // Beside a point of an edge the ray may pass, or meet another side.
        if (hit && glm::distance(hit->position, found.position) < 2e-5 * world.radius) ++met;
    }
    EXPECT_GT(met, 30) << shape_name(shape);
}

TEST(ClosestPoint, OnShapes) {
    const Transform placed = then(rotation({20, 40, 60}), translation({3, -2, 5}));
    check_shape(Sphere{{1, 2, 3}, 1.5}, placed, 1);
    check_shape(Box{{-1, -2, -0.5}, {1, 1, 2}}, placed, 2);
    check_shape(Cylinder{{0, 0, 0}, {1, 2, 0}, 0.7, false}, placed, 3);
    check_shape(Cone{{0, 0, 0}, {1, 2, 0}, 0.9, 0.3, false}, placed, 4);
    check_shape(Torus{1.5, 0.4}, placed, 5);
}

TEST(ClosestPoint, OnAnEllipsoidTheWayIsAlongTheNormal) {
    const World world = world_of({object_of(Sphere{}, scaling({1, 2, 3}))});
    const auto index = index_surface(world, 1);
    Rng rng = make_rng(7, Pass::test, 3);
    for (int i = 0; i < 50; ++i) {
        const Vec3 p = glm::normalize(random_point(rng, 1)) * (3.5 + rng.uniform());
        const ClosestPoint found = closest_point(*index, p);
        const Vec3 on = found.position / Vec3(1, 2, 3);
        EXPECT_NEAR(glm::length(on), 1, 1e-9);
        EXPECT_NEAR(glm::dot(glm::normalize(p - found.position), found.normal), 1, 1e-6);
    }
}

TEST(ClosestPoint, OfAnObjectWithoutSurfaceIsInfinitelyFar) {
    const World world = world_of({object_of(Sphere{})});
    EXPECT_EQ(closest_point_on_object(world, 0, Vec3(0)).distance, infinity);
}

} // namespace
} // namespace pnr
