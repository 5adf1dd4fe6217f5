// SPDX-License-Identifier: GPL-3.0-or-later
// Julia sets against values that POV-Ray 3.7 gives with inside(), and against themselves.
#include "core/rng.h"
#include "core/shape_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

using Data = JuliaFractalData;

JuliaFractal julia(double a, double b, double c, double d, int iterations, Data::Algebra algebra,
                   Data::Map map = Data::Map::square) {
    auto data = std::make_shared<Data>();
    data->parameter[0] = a, data->parameter[1] = b, data->parameter[2] = c, data->parameter[3] = d;
    data->max_iteration = iterations, data->algebra = algebra, data->map = map;
    return {data};
}

// How far along a direction points are inside.
double edge(const JuliaFractal& shape, Vec3 direction) {
    double low = 0.001, high = 5;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (is_inside(shape, middle * direction) ? low : high) = middle;
    }
    return low;
}

TEST(JuliaFractal, EdgesArePovRays) {
    const Vec3 x(1, 0, 0);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 1, Data::Algebra::quaternion), x), 1.5, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 2, Data::Algebra::quaternion), x), 1.0, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 3, Data::Algebra::quaternion), x), 0.70711, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 2, Data::Algebra::quaternion, Data::Map::cube), x), 1.0, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 2, Data::Algebra::hypercomplex), x), 1.87083, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 3, Data::Algebra::hypercomplex, Data::Map::cube), x), 1.17082, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0.3, 0.2, 0.1, 4, Data::Algebra::hypercomplex), 0.5 * x), 1.48283, 1e-5);
    EXPECT_NEAR(edge(julia(0.5, 0, 0, 0, 2, Data::Algebra::hypercomplex, Data::Map::exp), x), 1.25276, 1e-5);
}

TEST(JuliaFractal, HitsAreOnItsBorderAndNormalsPointOut) {
    const JuliaFractal shapes[] = {
        julia(-0.083, 0, -0.83, -0.025, 8, Data::Algebra::quaternion),
        julia(0.33, 0.54, 0.52, 0.32, 7, Data::Algebra::quaternion, Data::Map::cube),
        julia(0.2, 0.1, 0.59, -0.2, 7, Data::Algebra::hypercomplex),
    };
    Rng rng = make_rng(1, Pass::test, 0);
    for (const JuliaFractal& shape : shapes) {
        int met = 0, outward = 0;
        for (int i = 0; i < 400; ++i) {
            const auto point = [&](double size) {
                return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
            };
            const Vec3 origin = 5.0 * glm::normalize(point(1)), direction = glm::normalize(point(1) - origin);
            HitList hits;
            intersect(shape, {origin, direction, 0, infinity}, hits, 1);
            if (hits.empty()) continue;
            ++met;
            const Vec3 p = origin + hits[0].t * direction;
            EXPECT_FALSE(is_inside(shape, p - 1e-7 * direction));
            EXPECT_TRUE(is_inside(shape, p + 1e-7 * direction));
            outward +=
                !is_inside(shape, p + 1e-7 * hits[0].normal) && is_inside(shape, p - 1e-7 * hits[0].normal);
        }
        EXPECT_GT(met, 80);
        EXPECT_EQ(outward, met);
    }
}

} // namespace
} // namespace pnr
