// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/geodesic_field.h"

#include "core/rng.h"
#include "core/scene.h"
#include "npr/orientation.h"

#include <gtest/gtest.h>

#include <functional>

namespace pnr {
namespace {

using Triangle = std::array<Vec3, 3>;

// A surface over [0, 1]^2 as nu x nv cells of two triangles.
std::vector<Triangle> sheet(int nu, int nv, const std::function<Vec3(double, double)>& place) {
    std::vector<Triangle> triangles;
    const auto at = [&](int i, int j) { return place(static_cast<double>(i) / nu, static_cast<double>(j) / nv); };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return triangles;
}

Vec3 on_sphere(double u, double v) {
    const double a = 2 * pi * u, b = pi * v;
    return {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
}

// A strip bent to a U: two sheets 0.1 apart and 2 long that hang together at x = 0 alone.
constexpr double gap = 0.1, arm = 2, width = 0.6;
Vec3 on_u(double u, double v) {
    const double bend = pi * gap / 2, s = u * (2 * arm + bend), z = (v - 0.5) * width;
    if (s < arm) return {arm - s, gap / 2, z};
    if (s > arm + bend) return {s - arm - bend, -gap / 2, z};
    const double a = (s - arm) / (gap / 2);
    return {-gap / 2 * std::sin(a), gap / 2 * std::cos(a), z};
}

World world_of(const std::vector<Triangle>& triangles, const PaintStyle& style) {
    auto data = std::make_shared<MeshData>();
    for (const Triangle& triangle : triangles) {
        const auto first = static_cast<std::uint32_t>(data->positions.size());
        for (const Vec3& p : triangle) data->positions.emplace_back(p);
        data->triangles.push_back({first, first + 1, first + 2});
    }
    Mesh mesh;
    mesh.data = std::move(data);
    Object object;
    object.shape = mesh;
    object.npr.emplace();
    object.npr->on = true;
    object.npr->style = style;
    Scene scene;
    scene.objects.push_back(std::move(object));
    return build_world(scene, {});
}

TEST(SurfaceMesh, SeamsAndPolesAreJoined) {
    for (const int n : {4, 16, 64})
        EXPECT_EQ(join_triangles(sheet(2 * n, n, on_sphere)).corners.size(),
                  static_cast<std::size_t>(2 * n * (n - 1) + 2));
}

TEST(SurfaceMesh, PiecesThatTouchNowhereAreTold) {
    std::vector<Triangle> two = sheet(4, 4, [](double u, double v) { return Vec3(u, v, 0); });
    for (const Triangle& t : sheet(4, 4, [](double u, double v) { return Vec3(u, v, 0.01); })) two.push_back(t);
    const SurfaceMesh mesh = join_triangles(two);
    ASSERT_EQ(mesh.corners.size(), 50u);
    for (std::size_t c = 0; c < mesh.corners.size(); ++c)
        EXPECT_EQ(mesh.piece[c] == mesh.piece[mesh.triangles[0][0]], mesh.corners[c].z < 0.005);
}

// The largest angle, in degrees, by which the strokes of the lower arm's outer half are off x, when seeds on it
// say x and those of the upper arm say z.
double leak(SeedDistance distance) {
    PaintStyle style;
    style.distance = distance;
    for (const double x : {0.3, 1.0, 1.7})
        style.seeds.push_back({{x + 0.1, gap / 2, 0.1}, {0, 0, 1}, 1, {}});
    for (const double x : {0.6, 1.9}) style.seeds.push_back({{x, -gap / 2, -0.2}, {1, 0, 0}, 1, {}});
    const World world = world_of(sheet(120, 12, on_u), style);
    const OrientationFields fields = make_orientation_fields(world);
    EXPECT_LT(fields.reports[0].residual, 1e-6);
    double worst = 0;
    for (double x = 0.6; x <= arm; x += 0.1)
        for (double z = -0.25; z <= 0.25; z += 0.05) {
            const Vec3 t = eval_orientation(*fields.fields[1], Vec3(x, -gap / 2, z) - world.offset, {0, -1, 0});
            worst = std::max(worst, std::acos(std::min(1.0, std::abs(t.x))) * 180 / pi);
        }
    return worst;
}

TEST(GeodesicField, SeedsOfOneArmDoNotTurnTheStrokesOfTheOther) {
    EXPECT_GT(leak(SeedDistance::straight), 45);
    EXPECT_LT(leak(SeedDistance::geodesic), 5);
}

TEST(GeodesicField, AShapeWithoutAMeshTakesTheStraightWayAndSaysSo) {
    PaintStyle style;
    style.seeds = {{{1, 0, 0}, {0, 1, 0}, 1, {}}, {{0, 1, 0}, {1, 0, 0}, 1, {}}, {{0, 0, 1}, {1, 1, 0}, 1, {}}};
    std::vector<Vec3> axes;
    for (const SeedDistance distance : {SeedDistance::straight, SeedDistance::geodesic}) {
        Object object;
        object.shape = Sphere{{0, 0, 0}, 1};
        object.npr.emplace();
        object.npr->on = true;
        object.npr->style = style;
        object.npr->style.distance = distance;
        Scene scene;
        scene.objects.push_back(std::move(object));
        const World world = build_world(scene, {});
        const OrientationFields fields = make_orientation_fields(world);
        EXPECT_EQ(fields.reports[0].notes.size(), distance == SeedDistance::geodesic ? 1u : 0u);
        axes.push_back(eval_orientation(*fields.fields[1], glm::normalize(Vec3(1, 2, 3)), glm::normalize(Vec3(1, 2, 3))));
    }
    EXPECT_EQ(axes[0], axes[1]);
}

TEST(GeodesicField, APieceWithoutSeedsIsStillPainted) {
    PaintStyle style;
    style.distance = SeedDistance::geodesic;
    style.seeds = {{{0.2, 0.5, 0}, {0, 1, 0}, 1, {}}, {{0.8, 0.5, 0}, {0, 1, 0}, 1, {}}};
    std::vector<Triangle> two = sheet(4, 4, [](double u, double v) { return Vec3(u, v, 0); });
    for (const Triangle& t : sheet(4, 4, [](double u, double v) { return Vec3(u, v, 3); })) two.push_back(t);
    const World world = world_of(two, style);
    const OrientationFields fields = make_orientation_fields(world);
    for (const double z : {0.0, 3.0}) {
        const Vec3 t = eval_orientation(*fields.fields[1], Vec3(0.4, 0.4, z) - world.offset, {0, 0, 1});
        EXPECT_NEAR(std::abs(t.y), 1, 1e-9);
    }
}

TEST(GeodesicField, SeedsInOnePlaceAndOfEveryKindGiveFiniteTangents) {
    for (int kind = 0; kind < 4; ++kind) {
        PaintStyle style;
        style.distance = SeedDistance::geodesic;
        if (kind == 3) style.kernel = RbfKernel::triharmonic;
        for (std::uint64_t i = 0; i < 60; ++i) {
            Rng rng = make_rng(9, Pass::test, i);
            const double u = kind == 1 ? 0.5 : rng.uniform(), v = kind == 1 ? 0.5 : rng.uniform(), a = 7 * rng.uniform();
            style.seeds.push_back({on_sphere(u, kind == 2 ? 0.5 : v), {std::cos(a), std::sin(a), std::cos(3 * a)}, 1, {}});
        }
        const World world = world_of(sheet(24, 12, on_sphere), style);
        const OrientationFields fields = make_orientation_fields(world);
        for (std::uint64_t i = 0; i < 40; ++i) {
            Rng rng = make_rng(10, Pass::test, i);
            const double u = rng.uniform(), v = rng.uniform();
            const Vec3 n = on_sphere(u, v), t = eval_orientation(*fields.fields[1], n - world.offset, n);
            ASSERT_NEAR(glm::length(t), 1, 1e-9) << kind;
            ASSERT_NEAR(glm::dot(t, n), 0, 1e-6) << kind;
        }
    }
}

} // namespace
} // namespace pnr
