// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace pnr {
namespace {

using Op = FieldOp;

// cos(u) cos(v), sin(v), sin(u) cos(v): a unit sphere.
Parametric sphere(Vec3 low, Vec3 high, double accuracy) {
    auto data = std::make_shared<ParametricData>();
    const auto product = [](Op first, Op second) {
        FieldProgram f;
        f.steps = {{Op::x}, {Op::y}, {first, 0}, {second, 1}, {Op::multiply, 2, 3}};
        return f;
    };
    data->x = product(Op::cos, Op::cos);
    data->y.steps = {{Op::y}, {Op::sin, 0}};
    data->z = product(Op::sin, Op::cos);
    data->low = {0, -0.5 * pi}, data->high = {2 * pi, 0.5 * pi};
    data->box = {low, high};
    data->accuracy = accuracy;
    return {data};
}

TEST(Parametric, MeshIsAsNearAsTheAccuracySays) {
    const MeshData mesh = tessellate(sphere(Vec3(-2), Vec3(2), 0.001));
    ASSERT_GT(mesh.triangles.size(), 1000u);
    for (const auto& t : mesh.triangles) {
        Vec3 middle(0);
        for (const std::uint32_t v : t) {
            EXPECT_NEAR(glm::length(Vec3(mesh.positions[v])), 1, 1e-6);
            middle += Vec3(mesh.positions[v]) / 3.0;
        }
        EXPECT_NEAR(glm::length(middle), 1, 0.002);
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (mesh.normals[i] == Vec3f(0)) continue; // at a pole
        EXPECT_GT(std::abs(glm::dot(glm::normalize(Vec3(mesh.positions[i])), Vec3(mesh.normals[i]))),
                  1 - 1e-5);
        const Vec2 uv(mesh.uvs[i]);
        EXPECT_NEAR(mesh.positions[i].y, std::sin(uv.y), 1e-6);
    }
}

// Pieces of different sizes leave no gap: inside the square of u and v every edge has two triangles.
TEST(Parametric, HasNoGaps) {
    auto data = std::make_shared<ParametricData>();
    data->x.steps = {{Op::x}};
    data->z.steps = {{Op::y}};
    // exp(-60 (u^2 + v^2)): flat but in one corner
    data->y.steps = {{Op::x},
                     {Op::y},
                     {Op::sqr, 0},
                     {Op::sqr, 1},
                     {Op::add, 2, 3},
                     {Op::constant, 0, 0, 0, 0, -60},
                     {Op::multiply, 4, 5},
                     {Op::exp, 6}};
    data->accuracy = 0.0005;
    const MeshData mesh = tessellate(Parametric{data});
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    for (const auto& [edge, count] : edges) {
        const Vec2 a(mesh.uvs[edge.first]), b(mesh.uvs[edge.second]);
        const bool border = (a.x == b.x && (a.x == 0 || a.x == 1)) || (a.y == b.y && (a.y == 0 || a.y == 1));
        EXPECT_EQ(count, border ? 1 : 2) << a.x << " " << a.y << " - " << b.x << " " << b.y;
    }
}

TEST(Parametric, IsCutByItsContainer) {
    const MeshData mesh = tessellate(sphere({-2, -2, -2}, {2, 0.5, 2}, 0.001));
    double highest = -1;
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) highest = std::max(highest, double(mesh.positions[v].y));
    EXPECT_NEAR(highest, 0.5, 1e-6);
}

} // namespace
} // namespace pnr
