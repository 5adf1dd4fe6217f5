// SPDX-License-Identifier: GPL-3.0-or-later
// Blobs against their formula: the sum of strength (1 - d^2 / r^2)^2.
#include "core/closest_point.h"
#include "core/rng.h"
#include "core/shape_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

Vec3 random_point(Rng& rng, double size) {
    return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

BlobData mixed_blob() {
    BlobData blob;
    blob.threshold = 0.4;
    Rng rng = make_rng(3, Pass::test, 0);
    for (int i = 0; i < 12; ++i) {
        BlobComponent c;
        c.kind = i % 3 == 2 ? BlobComponent::Kind::cylinder : BlobComponent::Kind::sphere;
        c.base = c.cap = random_point(rng, 0.8);
        if (i % 3 == 2) c.cap = random_point(rng, 0.8);
        c.radius = 0.3 + 0.4 * rng.uniform();
        c.strength = i % 4 == 3 ? -0.7 : 0.5 + rng.uniform();
        if (i % 5 == 4) c.transform = then(scaling({1, 1.5, 0.7}), rotation({20, 40, 0}));
        blob.components.push_back(c);
    }
    finish_blob(blob);
    return blob;
}

double density_by_formula(const BlobData& blob, Vec3 p) {
    double sum = 0;
    for (const BlobComponent& c : blob.components) {
        const Vec3 own = transform_point(c.transform.inverse, p), axis = c.cap - c.base;
        const double h = glm::dot(axis, axis);
        const double t = h > 0 ? std::clamp(glm::dot(own - c.base, axis) / h, 0.0, 1.0) : 0;
        const double d = glm::distance(own, c.base + t * axis) / c.radius;
        if (d < 1) sum += c.strength * (1 - d * d) * (1 - d * d);
    }
    return sum;
}

TEST(Blob, DensityIsItsFormula) {
    const BlobData blob = mixed_blob();
    Rng rng = make_rng(4, Pass::test, 0);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random_point(rng, 1.4);
        EXPECT_NEAR(blob_density(blob, p), density_by_formula(blob, p), 1e-12);
    }
}

TEST(Blob, HitsAreOnTheThresholdAndNoneIsMissing) {
    const auto blob = std::make_shared<const BlobData>(mixed_blob());
    const Shape shape = Blob{blob, nullptr};
    Rng rng = make_rng(5, Pass::test, 0);
    int met = 0;
    for (int i = 0; i < 1500; ++i) {
        const Vec3 origin = random_point(rng, 2),
                   direction = 1.7 * glm::normalize(random_point(rng, 0.8) - origin);
        HitList hits;
        intersect_shape(shape, {origin, direction, 0, infinity}, hits);
        met += !hits.empty();
        bool inside = density_by_formula(*blob, origin) > blob->threshold;
        for (const ShapeHit& hit : hits) {
            const Vec3 p = origin + hit.t * direction;
            EXPECT_NEAR(density_by_formula(*blob, p), blob->threshold, 1e-9) << i;
            EXPECT_EQ(glm::dot(hit.normal, direction) > 0, inside) << i; // out of it, or into it
            inside = !inside;
            const Vec3 n = glm::normalize(hit.normal);
            EXPECT_LT(density_by_formula(*blob, p + 1e-6 * n), density_by_formula(*blob, p - 1e-6 * n));
        }
        std::size_t next = 0;
        bool expected = density_by_formula(*blob, origin) > blob->threshold;
        for (double t = 0.002; t < 2.4; t += 0.002) {
            while (next < hits.size() && hits[next].t < t) expected = !expected, ++next;
            const double d = density_by_formula(*blob, origin + t * direction);
            if (std::abs(d - blob->threshold) < 1e-9) continue;
            EXPECT_EQ(d > blob->threshold, expected) << i << " at " << t;
        }
    }
    EXPECT_GT(met, 400);
}

// sphere { 0, 1, 1 } at threshold 0.5: radius sqrt(1 - sqrt(0.5)), as POV-Ray prints it (0.541196).
TEST(Blob, OneSphereIsASphere) {
    BlobData blob;
    blob.threshold = 0.5;
    blob.components.emplace_back();
    finish_blob(blob);
    const Shape shape = Blob{std::make_shared<const BlobData>(blob), nullptr};
    HitList hits;
    ASSERT_EQ(intersect_shape(shape, {{0, 0, -5}, {0, 0, 1}, 0, infinity}, hits), 2);
    EXPECT_NEAR(hits[0].t, 5 - std::sqrt(1 - std::sqrt(0.5)), 1e-13);
    const ClosestPoint nearest = closest_point_on_shape(shape, {0.3, 2, -1});
    EXPECT_NEAR(nearest.distance, std::sqrt(0.09 + 4 + 1) - std::sqrt(1 - std::sqrt(0.5)), 1e-7);
    EXPECT_GT(glm::dot(nearest.normal, glm::normalize(Vec3(0.3, 2, -1))), 1 - 1e-6);
}

TEST(Blob, SharesAreTheDensitiesOfItsTextures) {
    BlobData blob;
    for (int i = 0; i < 4; ++i) {
        BlobComponent c;
        c.base = c.cap = Vec3(0.3 * i, 0, 0);
        c.texture = i == 3 ? 0u : static_cast<std::uint32_t>(i); // the first and the last share one
        blob.components.push_back(c);
    }
    finish_blob(blob);
    const auto density = [](double d) { return (1 - d * d) * (1 - d * d); };
    const BlobShares shares = blob_shares(blob, {0, 0, 0});
    EXPECT_EQ(shares[0].texture, 0u);
    EXPECT_NEAR(shares[0].share, density(0) + density(0.9), 1e-12);
    EXPECT_EQ(shares[1].texture, 1u);
    EXPECT_NEAR(shares[1].share, density(0.3), 1e-12);
    EXPECT_NEAR(shares[2].share, density(0.6), 1e-12);
}

} // namespace
} // namespace pnr
