// SPDX-License-Identifier: GPL-3.0-or-later
// Height fields against their triangles, and against what POV-Ray 3.7 prints of the same fields.
#include "core/rng.h"
#include "core/shape_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

HeightField field_of(ScalarField f, int width, int height, bool smooth = false, double water_level = 0) {
    auto data = std::make_shared<HeightFieldData>();
    data->function = std::move(f);
    data->width = width, data->height = height;
    data->smooth = smooth, data->water_level = water_level;
    return prepare_height_field({data, nullptr});
}

// Moeller and Trumbore's test, in plain doubles.
bool meets_triangle(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, double& t) {
    const Vec3 e = b - a, f = c - a, p = glm::cross(ray.direction, f);
    const double det = glm::dot(e, p);
    if (det == 0) return false;
    const Vec3 s = ray.origin - a, q = glm::cross(s, e);
    const double u = glm::dot(s, p) / det, v = glm::dot(ray.direction, q) / det;
    t = glm::dot(f, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t > ray.t_min && t < ray.t_max;
}

TEST(HeightField, IsItsTriangles) {
    Rng noise = make_rng(1, Pass::test, 0);
    std::vector<double> random;
    for (int i = 0; i < 200; ++i) random.push_back(noise.uniform());
    const int w = 13, h = 9;
    const auto shape = field_of(
        [&](Vec3 p) {
            const auto i =
                static_cast<std::size_t>(std::lround(p.x * (w - 1)) + w * std::lround(p.y * (h - 1)));
            return random[i];
        },
        w, h);
    const auto corner = [&](int i, int k) {
        const auto n = static_cast<std::size_t>(k * w + i);
        return Vec3(i / (w - 1.0), shape.grid->heights[n], k / (h - 1.0));
    };
    Rng rng = make_rng(2, Pass::test, 0);
    int met = 0;
    for (int n = 0; n < 3000; ++n) {
        const auto point = [&] {
            return Vec3(1.6 * rng.uniform() - 0.3, 1.4 * rng.uniform() - 0.2, 1.6 * rng.uniform() - 0.3);
        };
        Ray ray{point(), {}, 0, infinity};
        ray.direction = point() - ray.origin;
        if (n % 5 == 0) ray.direction = Vec3(0, n % 2 ? 1 : -1, 0);
        if (n % 5 == 1) ray.direction.x = 0;
        if (n % 5 == 2) ray.direction.z = 0;
        std::vector<double> expected;
        for (int k = 0; k + 1 < h; ++k)
            for (int i = 0; i + 1 < w; ++i) {
                double t = 0;
                if (meets_triangle(ray, corner(i, k), corner(i + 1, k), corner(i, k + 1), t))
                    expected.push_back(t);
                if (meets_triangle(ray, corner(i + 1, k + 1), corner(i, k + 1), corner(i + 1, k), t))
                    expected.push_back(t);
            }
        std::sort(expected.begin(), expected.end());
        HitList hits;
        intersect(shape, ray, hits, all_hits);
        ASSERT_EQ(hits.size(), expected.size()) << "ray " << n;
        for (std::size_t i = 0; i < hits.size(); ++i)
            EXPECT_NEAR(hits[i].t, expected[i], 1e-9) << "ray " << n;
        met += !hits.empty();
        if (!hits.empty()) {
            const Vec3 p = ray.origin + hits[0].t * ray.direction;
            EXPECT_TRUE(is_inside(shape, p - Vec3(0, 1e-6, 0)));
            EXPECT_FALSE(is_inside(shape, p + Vec3(0, 1e-6, 0)));
        }
    }
    EXPECT_GT(met, 1000);
}

// trace() of height_field { function 4,4 { x*x*0.9 + y*x*0.1 } } and of the same with `smooth`.
TEST(HeightField, StandsWherePovRayHasIt) {
    const auto f = [](Vec3 p) { return p.x * p.x * 0.9 + p.y * p.x * 0.1; };
    const HeightField flat = field_of(f, 4, 4), smooth = field_of(f, 4, 4, true);
    struct Known {
        double x, z, y;
        Vec3 flat, smooth;
    };
    const Known known[] = {
        {0.5, 0.5, 0.277763, {-0.6815, 0.7302, 0.0487}, {-0.6939, 0.7189, 0.0415}},
        {0.45, 0.4, 0.232763, {-0.6948, 0.7188, 0.0240}, {-0.6720, 0.7395, 0.0405}},
        {0.55, 0.6, 0.317765, {-0.6815, 0.7302, 0.0487}, {-0.7266, 0.6857, 0.0431}},
        {0.6, 0.4, 0.377762, {-0.6815, 0.7302, 0.0487}, {-0.7874, 0.6147, 0.0450}},
    };
    for (const Known& k : known) {
        HitList hits;
        intersect(flat, {{k.x, 5, k.z}, {0, -1, 0}, 0, infinity}, hits, all_hits);
        ASSERT_EQ(hits.size(), 1u);
        EXPECT_NEAR(5 - hits[0].t, k.y, 2e-5);
        // On the diagonal either half may be met.
        if (k.x + k.z != 1) {
            EXPECT_GT(glm::dot(glm::normalize(hits[0].normal), glm::normalize(k.flat)), 1 - 1e-6);
        }
        EXPECT_EQ(hits[0].shading, Vec3(0));
        hits.clear();
        intersect(smooth, {{k.x, 5, k.z}, {0, -1, 0}, 0, infinity}, hits, all_hits);
        ASSERT_EQ(hits.size(), 1u);
        // POV-Ray cuts its normals to 16 bits, which is coarse for so steep a field.
        EXPECT_GT(glm::dot(glm::normalize(hits[0].shading), glm::normalize(k.smooth)), 0.97) << k.x;
    }
}

TEST(HeightField, NothingIsSeenUnderWater) {
    const HeightField shape = field_of([](Vec3 p) { return p.x; }, 5, 5, false, 0.5);
    EXPECT_NEAR(bounds_of(shape).low.y, 0.5, 1e-12);
    HitList hits;
    intersect(shape, {{0.3, 5, 0.3}, {0, -1, 0}, 0, infinity}, hits, all_hits);
    EXPECT_TRUE(hits.empty());
    intersect(shape, {{0.7, 5, 0.3}, {0, -1, 0}, 0, infinity}, hits, all_hits);
    EXPECT_EQ(hits.size(), 1u);
    EXPECT_TRUE(is_inside(shape, {0.3, 0.1, 0.3})); // as in POV-Ray
}

} // namespace
} // namespace pnr
