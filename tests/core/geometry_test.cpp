// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"

#include "core/mesh_io.h"
#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

// A bumpy closed ball, so large that copies are worth sharing.
std::shared_ptr<const MeshData> ball(int rows, int columns, bool smooth) {
    auto mesh = std::make_shared<MeshData>();
    const auto add = [&](double a, double b) {
        const double r = 1 + 0.1 * std::sin(5 * a) * std::cos(4 * b);
        mesh->positions.emplace_back(r *
                                     Vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
    };
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column < columns; ++column) add(pi * row / rows, 2 * pi * column / columns);
    const auto at = [&](int row, int column) {
        return static_cast<std::uint32_t>(row * columns + column % columns);
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            mesh->triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
            mesh->triangles.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
        }
    if (smooth) {
        mesh->normals = area_weighted_normals(mesh->positions, mesh->triangles);
        mesh->normal_triangles = mesh->triangles;
    }
    return mesh;
}

GeometryItem item_of(std::shared_ptr<const MeshData> mesh, const Transform& place) {
    GeometryItem item;
    item.form = Shape(Mesh{.data = std::move(mesh), .file = {}, .inside_vector = {}, .said_at = {}});
    item.to_world = place;
    return item;
}

Vec3 random_point(Rng& rng, double size) {
    return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

std::vector<Transform> places() {
    return {translation({-4, 0, 0}),
            then(then(scaling({1, 1.5, -0.7}), rotation({20, 50, 70})), translation({0, 1, 0})),
            then(scaling(Vec3(1e-3)), translation({0.5, 3, -2})),
            then(axis_rotation({1, 1, 1}, 77), translation({4, -1, 2}))};
}

// Copies of one mesh are built once and met through their transforms; the same meshes given apart are all put
// into the scene's own BVH. Both must show the same scene.
TEST(Geometry, SharedCopiesAreTheSameAsOnesOfTheirOwn) {
    const auto shared_mesh = ball(160, 200, true);
    std::vector<GeometryItem> shared, own;
    for (const Transform& place : places()) {
        shared.push_back(item_of(shared_mesh, place));
        own.push_back(item_of(ball(160, 200, true), place));
    }
    const auto a = make_geometry(shared), b = make_geometry(own);
    ASSERT_EQ(geometry_stats(*a).instances, 4);
    ASSERT_EQ(geometry_stats(*b).instances, 0);
    EXPECT_LT(geometry_stats(*a).bytes, geometry_stats(*b).bytes / 3);
    Rng rng = make_rng(1, Pass::test, 0);
    int hits = 0, apart = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 from = random_point(rng, 8);
        const Vec3 target =
            transform_point(places()[static_cast<std::size_t>(i) % 4].matrix, random_point(rng, 0.8));
        const Ray ray{from, glm::normalize(target - from), 0, infinity};
        const auto x = closest_hit(*a, ray, RayKind::camera), y = closest_hit(*b, ray, RayKind::camera);
        EXPECT_EQ(x.has_value(), is_occluded(*a, ray, RayKind::shadow));
        if (x.has_value() != y.has_value() || (x && x->surface != y->surface)) {
            ++apart; // along an outline, where the placed vertices' rounding decides
            continue;
        }
        if (!x) continue;
        ++hits;
        EXPECT_LT(glm::length(x->position - y->position), 2e-5);
        EXPECT_GT(glm::dot(x->shading_normal, y->shading_normal), 0.999);
        EXPECT_GT(glm::dot(x->normal, y->normal), 0.95); // the smallest copy's vertices are float too
        EXPECT_NEAR(x->t, glm::length(x->position - from), 1e-9);
        EXPECT_LT(x->error, 1e-9);
    }
    EXPECT_GT(hits, 10000);
    EXPECT_LT(apart, 10);
}

TEST(Geometry, PrimitivesOfCopiesHaveNumbersOfTheirOwn) {
    const auto mesh = ball(160, 200, false);
    std::vector<GeometryItem> items;
    for (const Transform& place : places()) items.push_back(item_of(mesh, place));
    GeometryItem sphere;
    sphere.form = Shape(Sphere{{0, -5, 0}, 1});
    items.push_back(sphere);
    const auto geometry = make_geometry(items);
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < 5; ++i) {
        const Vec3 center = i < 4 ? Vec3(places()[i].matrix[3]) : Vec3(0, -5, 0);
        const auto hit = closest_hit(*geometry, {center, glm::normalize(Vec3(0.3, 0.2, 0.9)), 0, infinity},
                                     RayKind::camera);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->surface, i);
        for (const std::uint32_t other : numbers) EXPECT_NE(hit->primitive, other);
        numbers.push_back(hit->primitive);
    }
}

TEST(Geometry, HiddenCopiesAreNotMet) {
    const auto mesh = ball(160, 200, false);
    std::vector<GeometryItem> items;
    for (const Transform& place : places()) items.push_back(item_of(mesh, place));
    items[0].hidden_from = ray_bit(RayKind::camera);
    const auto geometry = make_geometry(items);
    const Ray ray{{-4, 0, -5}, {0, 0, 1}, 0, infinity};
    EXPECT_FALSE(closest_hit(*geometry, ray, RayKind::camera));
    EXPECT_TRUE(closest_hit(*geometry, ray, RayKind::photon));
}

// Normals point outside as modelled also where a mirror turned the winding round, placed or shared.
TEST(Geometry, MirrorsKeepTheOutside) {
    for (const int rows : {8, 200}) {
        const auto mesh = ball(rows, 2 * rows, true);
        const auto mirrored = then(scaling({-1, 1, 1}), translation({3, 0, 0}));
        const auto geometry = make_geometry({item_of(mesh, Transform{}), item_of(mesh, mirrored)});
        for (const double x : {0.0, 3.0}) {
            const auto hit = closest_hit(*geometry, {{x, 0.1, -5}, {0, 0, 1}, 0, infinity}, RayKind::camera);
            ASSERT_TRUE(hit);
            const double outwards = hit->normal.z;
            const auto back = closest_hit(*geometry, {{x, 0.1, 0}, {0, 0, 1}, 0, infinity}, RayKind::camera);
            ASSERT_TRUE(back);
            EXPECT_LT(outwards * back->normal.z, 0);
            const auto reference =
                closest_hit(*geometry, {{0, 0.1, -5}, {0, 0, 1}, 0, infinity}, RayKind::camera);
            EXPECT_GT(outwards * reference->normal.z, 0);
        }
    }
}

// Rays from a million radii away, and those with a negative t_min, see what nearer ones see.
// A scene and its rays, larger or smaller by powers of two, are the same to the last bit.
TEST(Geometry, SizeChangesNoBit) {
    const auto mesh = ball(40, 60, false);
    const auto scene = [&](double size) {
        const auto sized = std::make_shared<MeshData>(*mesh);
        for (Vec3f& p : sized->positions) p *= static_cast<float>(size);
        GeometryItem plain = item_of(sized, {}), sphere;
        sphere.form = Shape(Sphere{Vec3(2 * size, 0, 0), 0.75 * size});
        return make_geometry({plain, sphere});
    };
    const auto one = scene(1);
    for (const double size : {0x1p-20, 0x1p20, 0x1p-50, 0x1p50}) {
        const auto other = scene(size);
        Rng rng = make_rng(7, Pass::test, 0);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 from = random_point(rng, 3), way = random_point(rng, 1) - 0.3 * from;
            const auto a = closest_hit(*one, {from, way, 0, infinity}, RayKind::camera),
                       b = closest_hit(*other, {size * from, way, 0, infinity}, RayKind::camera);
            ASSERT_EQ(a.has_value(), b.has_value()) << size;
            if (!a) continue;
            ++hits;
            EXPECT_EQ(a->primitive, b->primitive);
            EXPECT_EQ(a->t * size, b->t);
            EXPECT_EQ(a->position * size, b->position);
            EXPECT_EQ(a->normal, b->normal);
        }
        EXPECT_GT(hits, 500);
    }
}

TEST(Geometry, RaysMayStartAnywhere) {
    GeometryItem sphere;
    sphere.form = Shape(Sphere{{0, 0, 0}, 1});
    const auto geometry = make_geometry({item_of(ball(40, 60, false), translation({3, 0, 0})), sphere});
    for (const double x : {0.0, 3.0}) {
        const Ray near{{x + 0.1, 0.2, -5}, {0, 0, 1}, 0, infinity};
        const auto expected = closest_hit(*geometry, near, RayKind::camera);
        ASSERT_TRUE(expected);
        Ray far = near;
        far.origin.z -= 1e6;
        const auto hit = closest_hit(*geometry, far, RayKind::camera);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, expected->t + 1e6, 1e-6);
        EXPECT_LT(glm::length(hit->position - expected->position), 1e-6);
        Ray behind = near;
        behind.origin.z += 20;
        EXPECT_FALSE(closest_hit(*geometry, behind, RayKind::camera));
        behind.t_min = -infinity;
        ASSERT_TRUE(closest_hit(*geometry, behind, RayKind::camera));
        EXPECT_NEAR(closest_hit(*geometry, behind, RayKind::camera)->t, expected->t - 20, 1e-9);
        far.t_max = 1e6;
        EXPECT_FALSE(is_occluded(*geometry, far, RayKind::shadow));
    }
    for (const Vec3 nowhere : {Vec3(0), Vec3(infinity), Vec3(std::nan(""))})
        EXPECT_FALSE(closest_hit(*geometry, {{0, 0, -5}, nowhere, 0, infinity}, RayKind::camera));
}

TEST(Tessellate, FlatPatchIsItsPlaneAndSphericalOneIsSmooth) {
    BicubicPatch patch;
    for (std::size_t i = 0; i < 16; ++i)
        patch.points[i] = Vec3(static_cast<double>(i % 4), 1, static_cast<double>(i / 4));
    patch.u_steps = 3, patch.v_steps = 2;
    const MeshData mesh = tessellate(patch);
    EXPECT_EQ(mesh.triangles.size(), 8u * 4u * 2u);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(mesh.positions[i].y, 1, 1e-6f);
        EXPECT_NEAR(std::abs(mesh.normals[i].y), 1, 1e-6f);
        EXPECT_NEAR(mesh.positions[i].x, 3 * mesh.uvs[i].x, 1e-6f);
    }
    for (std::size_t i = 0; i < 4; ++i) patch.points[i] = Vec3(1, 2, 0); // an edge shrunk to a point
    for (const Vec3f& n : tessellate(patch).normals) EXPECT_NEAR(glm::length(n), 1, 1e-5f);
}

} // namespace
} // namespace pnr
