// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/material.h"

#include "core/light.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace pnr;

namespace {

// A world of one surface, its pigment one colour; hits are made by hand.
struct OneSurface {
    World world;
    Hit hit;
    explicit OneSurface(ColorFT color = {Color(1), 0, 0}) {
        world.materials.resize(1);
        world.materials[0].texture.pigment.map = {{0, color}};
        world.surfaces.resize(1);
        world.surfaces[0].object = 0;
        hit.normal = hit.shading_normal = {0, 0, 1};
    }
    Finish& finish() { return world.materials[0].texture.finish; }
    Interior& interior() { return world.materials[0].interior; }
    Bsdf bsdf(Vec3 outgoing) const { return make_bsdf(world, hit, outgoing); }
};

Vec3 direction(double degrees, double around = 0.3) {
    const double a = degrees * pi / 180;
    return {std::sin(a) * std::cos(around), std::sin(a) * std::sin(around), std::cos(a)};
}

// Means over the hemisphere about z: of f cos (the albedo) and of sample_bsdf_pdf (1 if all samples go
// there).
struct Integrals {
    Color albedo{0};
    double pdf = 0;
};
Integrals integrate(const Bsdf& bsdf, Vec3 outgoing, int n = 700) {
    Integrals sum;
    const Frame frame = make_frame({0, 0, 1});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec3 d = square_to_cone({(i + 0.5) / n, (j + 0.5) / n}, frame, 1);
            sum.albedo += eval_bsdf(bsdf, outgoing, d) * static_cast<float>(2 * pi * d.z / (n * n));
            sum.pdf += sample_bsdf_pdf(bsdf, outgoing, d) * 2 * pi / (n * n);
        }
    return sum;
}

Color sampled_albedo(const Bsdf& bsdf, Vec3 outgoing, int n = 60) {
    glm::dvec3 sum(0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k)
                sum += glm::dvec3(
                    sample_bsdf(bsdf, outgoing, {(i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n}).weight);
    return Color(sum / std::pow(n, 3.0));
}

OneSurface glossy_surface(double phong_size = 40) {
    OneSurface s({{0.8f, 0.5f, 0.2f}, 0, 0});
    s.finish().diffuse = 0.5;
    s.finish().phong = 4;
    s.finish().phong_size = phong_size;
    return s;
}

Finish random_finish(Rng& rng) {
    Finish f;
    f.diffuse = 1.5 * rng.uniform();
    f.specular = 2 * rng.uniform();
    f.roughness = 0.001 + rng.uniform();
    f.phong = rng.uniform() < 0.5 ? 0 : 3 * rng.uniform();
    f.phong_size = 1 + 200 * rng.uniform();
    f.metallic = rng.uniform();
    f.reflection.min = Color(static_cast<float>(rng.uniform()), 0.2f, 0.9f);
    f.reflection.max = Color(0.5f, static_cast<float>(1.5 * rng.uniform()), 1);
    f.reflection.falloff = 3 * rng.uniform();
    f.reflection.metallic = rng.uniform();
    f.reflection.fresnel = rng.uniform() < 0.5;
    return f;
}

} // namespace

TEST(Material, FresnelOfADielectric) {
    EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5), 0.04, 1e-12);
    EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-12);
    EXPECT_NEAR(fresnel_dielectric(0, 1 / 1.5), 1, 1e-12);
    EXPECT_EQ(fresnel_dielectric(0.3, 1), 0);
    // Brewster's angle, tan = 1.5: the parallel part vanishes, the rest is sin^2(theta_i - theta_t) / 2.
    const double brewster = std::atan(1.5);
    EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1 / 1.5),
                0.5 * std::pow(std::sin(2 * brewster - pi / 2), 2), 1e-12);
    // Beyond the critical angle everything is reflected.
    EXPECT_EQ(fresnel_dielectric(std::cos(std::asin(1 / 1.5) + 0.01), 1.5), 1);
    EXPECT_LT(fresnel_dielectric(std::cos(std::asin(1 / 1.5) - 0.01), 1.5), 1);
}

TEST(Material, RefractionFollowsSnell) {
    const Vec3 normal{0, 0, 1};
    for (const double eta : {1 / 1.5, 1.5, 1.0}) {
        for (const double degrees : {0.0, 20.0, 41.0, 60.0, 89.0}) {
            const Vec3 outgoing = direction(degrees);
            Vec3 refracted;
            const double sine = eta * std::sin(degrees * pi / 180);
            ASSERT_EQ(refract_direction(outgoing, normal, eta, refracted), sine < 1);
            if (sine >= 1) continue;
            EXPECT_NEAR(std::hypot(refracted.x, refracted.y), sine, 1e-12);
            EXPECT_LT(refracted.z, 0);
            EXPECT_NEAR(glm::dot(glm::cross(outgoing, refracted), normal), 0, 1e-12); // in one plane
        }
    }
}

TEST(Material, PdfIsTheDensityOfTheSamples) {
    for (const OneSurface& s : {OneSurface(), glossy_surface(40), glossy_surface(3)}) {
        for (const double degrees : {5.0, 45.0, 75.0}) {
            const Vec3 outgoing = direction(degrees);
            const Bsdf bsdf = s.bsdf(outgoing);
            // Cells of equal solid angle: counts against the density's integral over each.
            constexpr int rings = 8, sectors = 12, n = 48;
            std::array<double, rings * sectors> counted{}, expected{};
            const auto cell = [](Vec3 d) {
                const double turn = std::atan2(d.y, d.x) / (2 * pi) + 0.5;
                return std::min(rings - 1, static_cast<int>(d.z * rings)) * sectors +
                       std::min(sectors - 1, static_cast<int>(turn * sectors));
            };
            int above = 0;
            for (int i = 0; i < n * n * n; ++i) {
                const Vec3 u{(i % n + 0.5) / n, (i / n % n + 0.5) / n, (i / n / n + 0.5) / n};
                const Vec3 d = sample_bsdf(bsdf, outgoing, u).incoming;
                if (d.z <= 0) continue;
                ++above;
                counted[static_cast<std::size_t>(cell(d))] += 1.0 / (n * n * n);
            }
            constexpr int m = 600;
            const Frame frame = make_frame({0, 0, 1});
            double whole = 0;
            for (int i = 0; i < m * m; ++i) {
                const Vec3 d = square_to_cone({(i % m + 0.5) / m, (i / m + 0.5) / m}, frame, 1);
                const double p = sample_bsdf_pdf(bsdf, outgoing, d) * 2 * pi / (m * m);
                expected[static_cast<std::size_t>(cell(d))] += p;
                whole += p;
            }
            EXPECT_NEAR(static_cast<double>(above) / (n * n * n), whole, 0.005);
            for (std::size_t i = 0; i < counted.size(); ++i) EXPECT_NEAR(counted[i], expected[i], 0.006);
        }
    }
}

TEST(Material, WeightsSumToTheAlbedo) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const Vec3 outgoing = direction(degrees);
        const Bsdf bsdf = glossy_surface().bsdf(outgoing);
        const Color by_area = integrate(bsdf, outgoing).albedo, by_samples = sampled_albedo(bsdf, outgoing);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(by_samples[c], by_area[c], 0.005);
    }
    // Facing, the lobes have the albedos they say.
    const Bsdf facing = glossy_surface().bsdf({0, 0, 1});
    const Color albedo = integrate(facing, {0, 0, 1}).albedo;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], facing.diffuse[c] + facing.glossy[c], 0.005);
}

TEST(Material, ScatteringIsReciprocal) {
    const OneSurface s = glossy_surface(10);
    Rng rng = make_rng(4, Pass::test, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = direction(85 * rng.uniform(), 6 * rng.uniform());
        const Vec3 b = direction(85 * rng.uniform(), 6 * rng.uniform());
        EXPECT_NEAR(eval_bsdf(s.bsdf(a), a, b).y, eval_bsdf(s.bsdf(b), b, a).y, 1e-6);
    }
}

TEST(Material, NoFinishReflectsMoreThanItGets) {
    Rng rng = make_rng(3, Pass::test, 0);
    for (int i = 0; i < 300; ++i) {
        OneSurface s({Color(static_cast<float>(1.3 * rng.uniform()), 0.9f, 0.3f),
                      static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform())});
        s.finish() = random_finish(rng);
        s.interior().ior = 1 + rng.uniform();
        for (const double degrees : {0.0, 30.0, 50.0, 85.0, 95.0, 120.0, 170.0}) {
            const Bsdf b = s.bsdf(direction(degrees));
            for (int c = 0; c < 3; ++c) {
                for (const float part : {b.diffuse[c], b.glossy[c], b.mirror[c], b.transmit[c]})
                    EXPECT_GE(part, 0);
                EXPECT_LE(b.diffuse[c] + b.glossy[c] + b.mirror[c] + b.transmit[c], 1 + 1e-5f);
            }
        }
    }
}

// A clear glass loses nothing at any angle, inside and outside.
TEST(Material, ClearGlassIsAWhiteFurnace) {
    OneSurface s({Color(1), 0, 1});
    s.interior().ior = 1.5;
    s.finish().diffuse = 0;
    for (double degrees = 1; degrees < 180; degrees += 7) {
        const Bsdf b = s.bsdf(direction(degrees));
        EXPECT_NEAR(b.mirror.x + b.transmit.x, 1, 1e-6);
        EXPECT_FALSE(has_diffuse(b));
        EXPECT_TRUE(has_specular(b));
        EXPECT_EQ(b.inside, degrees > 90);
        EXPECT_NEAR(b.eta, degrees > 90 ? 1.5 : 1 / 1.5, 1e-12);
    }
    EXPECT_EQ(s.bsdf(direction(130)).transmit, Color(0)); // total reflection at 50 degrees inside
    EXPECT_NEAR(s.bsdf({0, 0, 1}).mirror.x, 0.04, 1e-6);
}

TEST(Material, HighlightsPeakAsPovraysDo) {
    // POV-Ray adds phong * light colour in the mirror direction: f_r cos of light pi c must be phong / pi
    // there.
    OneSurface s;
    s.finish().diffuse = 0;
    s.finish().phong = 0.9;
    s.finish().phong_size = 30;
    const Bsdf b = s.bsdf({0, 0, 1});
    EXPECT_NEAR(eval_bsdf(b, {0, 0, 1}, {0, 0, 1}).x * pi, 0.9, 1e-5);
    s.finish().phong = 0;
    s.finish().specular = 0.7;
    const Bsdf c = s.bsdf({0, 0, 1});
    EXPECT_NEAR(eval_bsdf(c, {0, 0, 1}, {0, 0, 1}).x * pi, 0.7, 1e-5);
}

TEST(Material, MetalsTintTheirReflections) {
    OneSurface s({{0.9f, 0.6f, 0.2f}, 0, 0});
    s.finish().reflection = {Color(0.5f), Color(0.5f), 1, 1, 1, false};
    const Color facing = s.bsdf({0, 0, 1}).mirror, grazing = s.bsdf(direction(89.9)).mirror;
    EXPECT_NEAR(facing.y, 0.3, 1e-3);
    EXPECT_NEAR(grazing.y, 0.5, 0.02);
    s.finish().reflection.metallic = 0;
    EXPECT_EQ(s.bsdf({0, 0, 1}).mirror, Color(0.5f));
}

TEST(Material, EmittersAreBlackAndShineFromOneSide) {
    OneSurface s;
    s.world.surfaces[0].light = 0;
    s.world.lights.resize(1);
    s.world.lights[0].radiance = {3, 2, 1};
    EXPECT_EQ(s.bsdf({0, 0, 1}).emission, Color(3, 2, 1));
    EXPECT_EQ(s.bsdf({0, 0, -1}).emission, Color(0));
    EXPECT_FALSE(has_diffuse(s.bsdf({0, 0, 1})) || has_specular(s.bsdf({0, 0, 1})));
}

TEST(Material, NothingGoesThroughTheBackOrTheTrueSurface) {
    OneSurface s = glossy_surface();
    s.hit.shading_normal = glm::normalize(Vec3(0.6, 0, 0.8));
    const Vec3 outgoing = direction(20);
    const Bsdf b = s.bsdf(outgoing);
    EXPECT_EQ(eval_bsdf(b, outgoing, glm::normalize(Vec3(1, 0, -0.05))), Color(0));
    EXPECT_EQ(eval_bsdf(b, outgoing, glm::normalize(Vec3(-1, 0, 0.05))), Color(0));
    EXPECT_EQ(b.geometric, Vec3(0, 0, 1));
    // Seen against its shading normal it falls back to the true one.
    EXPECT_EQ(s.bsdf(glm::normalize(Vec3(-1, 0, 0.1))).normal, Vec3(0, 0, 1));
}

// Read from pictures of POV-Ray 3.7: a slab before a white background.
TEST(Material, InteriorsFadeAsPovraysDo) {
    const Color fade(0.5f, 0.2f, 0);
    const auto expect = [](Color got, Color truth) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], truth[c], 1e-4);
    };
    expect(interior_transmittance({1, 1, 1, fade}, 2), {0.6667f, 0.4667f, 0.3333f});
    expect(interior_transmittance({1, 1, 2, fade}, 3), {0.55f, 0.28f, 0.1f});
    expect(interior_transmittance({1, 1, 1001, fade}, 2), {0.3679f, 0.2019f, 0.1353f});
    expect(interior_transmittance({1, 2, 1000, {0.5f, 0.2f, 0.9f}}, 3), {0.4724f, 0.3012f, 0.8607f});
    EXPECT_EQ(interior_transmittance({1, 0, 2, fade}, 3), Color(1));
}
