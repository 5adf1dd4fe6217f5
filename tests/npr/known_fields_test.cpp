// SPDX-License-Identifier: GPL-3.0-or-later
// Fields that are known on sphere, torus, cylinder and saddle: what seeds taken from them give back
// elsewhere.
#include "core/closest_point.h"
#include "core/rng.h"
#include "core/scene.h"
#include "npr/orientation.h"

#include <gtest/gtest.h>

#include <functional>

namespace pnr {
namespace {

struct KnownField {
    std::string name;
    Shape shape;
    std::function<Vec3(Vec3)> axis; // of a place on the shape; any length, zero where there is none
};

Mesh saddle() {
    auto data = std::make_shared<MeshData>();
    constexpr int n = 80;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
            data->positions.emplace_back(x, y, 0.7 * x * y);
        }
    const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            data->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            data->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    Mesh mesh;
    mesh.data = std::move(data);
    return mesh;
}

// Circles of latitude on the sphere, winding lines on the torus, helices on the cylinder, straight lines on
// the saddle.
std::vector<KnownField> known_fields() {
    return {{"sphere", Sphere{{0, 0, 0}, 1},
             [](Vec3 p) { return std::abs(p.y) < 0.9 ? glm::cross(Vec3(0, 1, 0), p) : Vec3(0); }},
            {"torus", Torus{1.5, 0.5},
             [](Vec3 p) {
                 const Vec3 round = glm::normalize(Vec3(-p.z, 0, p.x)),
                            out = glm::normalize(Vec3(p.x, 0, p.z));
                 const double across = (glm::length(Vec2(p.x, p.z)) - 1.5) / 0.5, up = p.y / 0.5;
                 return round + up * out - across * Vec3(0, 1, 0);
             }},
            {"cylinder", Cylinder{{0, -1, 0}, {0, 1, 0}, 0.7, true},
             [](Vec3 p) { return Vec3(0, 1, 0) + Vec3(-p.z, 0, p.x) / 0.7; }},
            {"saddle", saddle(), [](Vec3 p) { return Vec3(1, 0, 0.7 * p.y); }}};
}

World world_of(const KnownField& known, const PaintStyle& style) {
    Object object;
    object.shape = known.shape;
    object.npr.emplace();
    object.npr->on = true;
    object.npr->style = style;
    Scene scene;
    scene.objects.push_back(std::move(object));
    return build_world(scene, {});
}

// Places spread over the shape by their number alone.
ClosestPoint place(const World& world, std::uint64_t number) {
    Rng rng = make_rng(77, Pass::test, number);
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    return closest_point_on_object(world, 1, (Vec3(x, y, z) * 2.0 - 1.0) * Vec3(2, 1, 2) - world.offset);
}

struct FieldError {
    double mean = 0, residual = 0; // radians
};

FieldError measure(const KnownField& known, RbfKernel kernel, int count) {
    const World plain = world_of(known, {});
    PaintStyle style;
    style.kernel = kernel;
    for (std::uint64_t i = 0; static_cast<int>(style.seeds.size()) < count; ++i) {
        const Vec3 p = place(plain, i).position + plain.offset;
        if (glm::length(known.axis(p)) > 0) style.seeds.push_back({p, known.axis(p), 1, {}});
    }
    const World world = world_of(known, style);
    const OrientationFields fields = make_orientation_fields(world);
    FieldError error{0, fields.reports[0].residual};
    int measured = 0;
    for (std::uint64_t i = 1'000'000; measured < 400; ++i) {
        const ClosestPoint on = place(world, i);
        const Vec3 axis = known.axis(on.position + world.offset);
        if (!(glm::length(axis) > 0)) continue;
        const Vec3 right = glm::normalize(axis - on.normal * glm::dot(axis, on.normal));
        const Vec3 found = eval_orientation(*fields.fields[1], on.position, on.normal);
        error.mean += std::asin(std::min(1.0, glm::length(glm::cross(found, right)))) / 400;
        ++measured;
    }
    return error;
}

TEST(KnownFields, TheErrorFallsWithTheNumberOfSeedsAndTheSeedsAreMet) {
    for (const KnownField& known : known_fields()) {
        for (const RbfKernel kernel : {RbfKernel::biharmonic, RbfKernel::triharmonic}) {
            double before = 1;
            for (const int count : {8, 32, 128}) {
                const FieldError error = measure(known, kernel, count);
                EXPECT_LT(error.residual, 1e-6) << known.name << ' ' << count;
                EXPECT_LT(error.mean, 0.8 * before)
                    << known.name << ' ' << static_cast<int>(kernel) << ' ' << count;
                before = error.mean;
            }
            EXPECT_LT(before, 0.05) << known.name << ' '
                                    << static_cast<int>(kernel); // less than three degrees
        }
    }
}

TEST(KnownFields, AThousandSeedsOfEveryKindGiveFiniteTangents) {
    for (int kind = 0; kind < 4; ++kind) {
        for (const KnownField& known : known_fields()) {
            PaintStyle style;
            for (std::uint64_t i = 0; i < 1000; ++i) {
                Rng rng = make_rng(5, Pass::test, i);
                const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
                Vec3 at = Vec3(x, y, z) * 2.0 - 1.0, way = Vec3(y, z, x) - 0.5;
                if (kind == 1) at.y = 0;                                              // coplanar
                if (kind == 2) way = i % 2 ? way : -way;                              // opposite ways
                if (kind == 3) at = Vec3(0.1, 0.2, 0.3) * static_cast<double>(i % 2); // two places, many axes
                style.seeds.push_back({at, way, 1, {}});
            }
            const World world = world_of(known, style);
            const OrientationFields fields = make_orientation_fields(world);
            for (std::uint64_t i = 0; i < 60; ++i) {
                const ClosestPoint on = place(world, i);
                const Vec3 t = eval_orientation(*fields.fields[1], on.position, on.normal);
                ASSERT_NEAR(glm::length(t), 1, 1e-9) << known.name << ' ' << kind;
                ASSERT_NEAR(glm::dot(t, on.normal), 0, 1e-9) << known.name << ' ' << kind;
            }
        }
    }
}

} // namespace
} // namespace pnr
