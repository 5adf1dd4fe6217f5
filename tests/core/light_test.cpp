// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/light.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pnr;

namespace {

Light emitter(EmitterShape shape, double radius = 1, Vec3 axis = {0, -1, 0}) {
    LightSource said;
    said.position = {0.5, 3, -0.25};
    said.emitter = Emitter{shape, radius, axis, {1.5, 0, 0}, {0, 0, 0.75}, 2.0, {}};
    return make_light(said);
}

// E = integral of L cos over the light's view, by sample_light.
double irradiance(const Light& light, Vec3 position, Vec3 normal, int n = 400) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const LightSample s = sample_light(light, position, {(i + 0.5) / n, (j + 0.5) / n});
            sum += s.irradiance.x * std::max(0.0, glm::dot(s.direction, normal));
        }
    return sum / (n * n);
}

// The same by points of the emitter's area, from its definition alone.
double irradiance_by_area(const Light& light, Vec3 position, Vec3 normal, int n = 400) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const EmissionSample s = sample_emission(light, {(i + 0.5) / n, (j + 0.5) / n}, {0.5, 0.5});
            const Vec3 d = s.point - position;
            const double cos_here = glm::dot(d, normal), cos_there = -glm::dot(d, s.normal);
            if (cos_here > 0 && cos_there > 0) sum += cos_here * cos_there / std::pow(glm::dot(d, d), 2);
        }
    return light.radiance.x * light.area * sum / (n * n);
}

Light povray_light(Vec3 position, Vec3 point_at) {
    Light light;
    light.said.position = position;
    light.said.point_at = point_at;
    return light;
}

// What POV-Ray 3.7 shows of a white plane y = 0 (diffuse 1) at `position`: attenuation times cosine.
double seen(const Light& light, Vec3 position) {
    const LightSample s = sample_light(light, position, {0.5, 0.5});
    return s.irradiance.x / pi * std::max(0.0, s.direction.y);
}

} // namespace

TEST(Light, PowerIsPiTimesAreaTimesRadiance) {
    const double areas[] = {4 * pi * 4, 2 * pi * 4, pi * 4, 1.5 * 0.75};
    const EmitterShape shapes[] = {EmitterShape::sphere, EmitterShape::hemisphere, EmitterShape::disc,
                                   EmitterShape::rectangle};
    for (int i = 0; i < 4; ++i) {
        LightSource said = emitter(shapes[i], 2).said;
        EXPECT_NEAR(make_light(said).area, areas[i], 1e-9);
        EXPECT_NEAR(make_light(said).power.x, pi * areas[i] * 2, 1e-3);
        said.color = {1, 0.5f, 0};
        said.emitter->radiance.reset();
        said.emitter->power = 30;
        const Light light = make_light(said);
        EXPECT_NEAR(light.radiance.x, 30 / (pi * areas[i]), 1e-5);
        EXPECT_NEAR(light.power.y, 15, 1e-5);
        EXPECT_EQ(light.power.z, 0.f);
    }
}

TEST(Light, RefusesEmittersThatCannotBe) {
    LightSource said = emitter(EmitterShape::sphere).said;
    said.emitter->radius = 0;
    EXPECT_THROW(make_light(said), SceneError);
    said.emitter->radius = 1;
    said.emitter->radiance = -1;
    EXPECT_THROW(make_light(said), SceneError);
    said.emitter->radiance = infinity;
    EXPECT_THROW(make_light(said), SceneError);
    said = emitter(EmitterShape::disc).said;
    said.emitter->axis = Vec3(0);
    EXPECT_THROW(make_light(said), SceneError);
    said = emitter(EmitterShape::rectangle).said;
    said.emitter->u = said.emitter->v;
    EXPECT_THROW(make_light(said), SceneError);
}

TEST(Light, SphereIrradianceIsAnalytic) {
    const Light light = emitter(EmitterShape::sphere, 0.8);
    for (const Vec3 below : {Vec3(0, -1.2, 0), Vec3(0, -3, 0), Vec3(0, -1000, 0)}) {
        const double distance = glm::length(below);
        const double truth = pi * 2 * 0.64 / (distance * distance);
        EXPECT_NEAR(irradiance(light, light.said.position + below, {0, 1, 0}), truth, 1e-4 * truth);
        // Tilted by 30 degrees, as long as all of the sphere is above the horizon.
        if (distance < 2) continue;
        EXPECT_NEAR(irradiance(light, light.said.position + below, {0.5, std::sqrt(0.75), 0}),
                    truth * std::sqrt(0.75), 1e-4 * truth);
    }
    EXPECT_EQ(irradiance(light, light.said.position + Vec3(0.3, 0, 0), {0, 1, 0}, 20), 0);
    EXPECT_EQ(irradiance(light, light.said.position, {0, 1, 0}, 20), 0);
}

TEST(Light, DiscIrradianceOnItsAxisIsAnalytic) {
    const Light light = emitter(EmitterShape::disc, 1.2);
    for (const double d : {0.5, 2.0, 30.0}) {
        const double truth = pi * 2 * 1.44 / (1.44 + d * d);
        EXPECT_NEAR(irradiance(light, light.said.position - Vec3(0, d, 0), {0, 1, 0}), truth, 2e-3 * truth);
    }
    EXPECT_EQ(irradiance(light, light.said.position + Vec3(0, 1, 0), {0, -1, 0}, 20), 0); // its back
}

TEST(Light, SamplingBySolidAngleAgreesWithSamplingByArea) {
    for (const EmitterShape shape :
         {EmitterShape::hemisphere, EmitterShape::rectangle, EmitterShape::sphere}) {
        const Light light = emitter(shape, 0.8, glm::normalize(Vec3(0.3, -1, 0.2)));
        for (const Vec3 d : {Vec3(0.2, -1.5, 0.3), Vec3(3, -0.5, 1), Vec3(-1, 2, 0.5), Vec3(2, -40, 3)}) {
            const Vec3 normal = glm::normalize(Vec3(0.2, 0.1, 0) - d);
            const double truth = irradiance_by_area(light, light.said.position + d, normal);
            EXPECT_NEAR(irradiance(light, light.said.position + d, normal), truth, 3e-3 * truth + 1e-4)
                << static_cast<int>(shape) << " at " << d.x << ", " << d.y << ", " << d.z;
        }
    }
}

TEST(Light, SamplesCarryTheirDensity) {
    Rng rng = make_rng(1, Pass::test, 0);
    for (const EmitterShape shape :
         {EmitterShape::sphere, EmitterShape::hemisphere, EmitterShape::disc, EmitterShape::rectangle}) {
        const Light light = emitter(shape, 0.8);
        for (int i = 0; i < 500; ++i) {
            const Vec3 position{rng.uniform() * 4 - 2, rng.uniform() * 2, rng.uniform() * 4 - 2};
            const LightSample s = sample_light(light, position, rng.uniform2());
            if (is_black(s.irradiance)) continue;
            Vec3 normal{0, -1, 0};
            if (shape == EmitterShape::sphere || shape == EmitterShape::hemisphere)
                normal = glm::normalize(s.point - light.said.position);
            if (shape == EmitterShape::rectangle)
                normal = glm::normalize(glm::cross(light.said.emitter->u, light.said.emitter->v));
            EXPECT_NEAR(sample_light_pdf(light, position, s.point, normal) / s.pdf, 1, 1e-6);
            EXPECT_NEAR(s.irradiance.x, light.radiance.x / s.pdf, 1e-4 * s.irradiance.x);
            EXPECT_NEAR(glm::distance(position + s.distance * s.direction, s.point), 0, 1e-9);
        }
    }
}

// Read from pictures of POV-Ray 3.7: an orthographic camera above the plane, 16 pixels over x = -8 .. 8.
TEST(Light, PovrayFormulas) {
    Light spot = povray_light({0, 5, 0}, {0, 0, 0});
    EXPECT_NEAR(seen(spot, {7.5, 0, 0}), 0.5547, 1e-4);
    spot.said.spotlight = true;
    EXPECT_NEAR(seen(spot, {0.5, 0, 0}), 0.9950, 1e-4);
    EXPECT_NEAR(seen(spot, {3.5, 0, 0}), 0.6480, 1e-4);
    EXPECT_NEAR(seen(spot, {4.5, 0, 0}), 0.0981, 1e-4);
    EXPECT_EQ(seen(spot, {5.5, 0, 0}), 0);
    spot.said.radius = 20;
    spot.said.falloff = 60;
    spot.said.tightness = 10;
    EXPECT_NEAR(seen(spot, {1.5, 0, 0}), 0.6225, 1e-4);
    EXPECT_NEAR(seen(spot, {4.5, 0, 0}), 0.0222, 1e-4);
    EXPECT_NEAR(seen(spot, {6.5, 0, 0}), 0.0007, 1e-4);

    Light cylinder = povray_light({0, 5, 0}, {0, 0, 0});
    cylinder.said.cylinder = true;
    cylinder.said.radius = 2;
    cylinder.said.falloff = 5;
    cylinder.said.tightness = 2;
    EXPECT_NEAR(seen(cylinder, {0.5, 0, 0}), 0.81, 1e-4);
    EXPECT_NEAR(seen(cylinder, {2.5, 0, 0}), 0.2315, 1e-4);
    EXPECT_NEAR(seen(cylinder, {4.5, 0, 0}), 0.0007, 1e-4);
    EXPECT_EQ(seen(cylinder, {5.5, 0, 0}), 0);

    Light fading = povray_light({0, 5, 0}, {0, 0, 0});
    fading.said.fade_distance = 4;
    fading.said.fade_power = 2;
    EXPECT_NEAR(seen(fading, {0.5, 0, 0}), 0.7719, 1e-4);
    EXPECT_NEAR(seen(fading, {7.5, 0, 0}), 0.1825, 1e-4);

    Light parallel = povray_light({0, 5, 0}, {3, 0, 0});
    parallel.said.parallel = true;
    EXPECT_NEAR(seen(parallel, {-7.5, 0, 0}), 0.8575, 1e-4);
    EXPECT_NEAR(seen(parallel, {7.5, 0, 0}), 0.8575, 1e-4);
    parallel.said.fade_distance = 4;
    parallel.said.fade_power = 2;
    EXPECT_NEAR(seen(parallel, {7.5, 0, 0}), 0.3332, 1e-4);
    // Behind its plane it shines as well, at the depth's distance.
    Light behind = povray_light({0, -3, 0}, {0, -5, 0});
    behind.said.parallel = true;
    behind.said.color = Color(0.5f);
    behind.said.fade_distance = 4;
    behind.said.fade_power = 2;
    EXPECT_NEAR(seen(behind, {1, 0, 0}), 0.64, 1e-4);
}

TEST(Light, EmissionCoversAreaAndCosineEvenly) {
    const Light light = emitter(EmitterShape::hemisphere, 1, {0, -1, 0});
    const int n = 200;
    double height = 0, cosine = 0;
    for (int i = 0; i < n * n; ++i) {
        const EmissionSample s = sample_emission(light, {(i % n + 0.5) / n, (i / n + 0.5) / n},
                                                 {(i / n + 0.5) / n, (i % n + 0.5) / n});
        height += glm::dot(s.point - light.said.position, Vec3(0, -1, 0)) / (n * n);
        cosine += glm::dot(s.direction, s.normal) / (n * n);
        ASSERT_GE(glm::dot(s.direction, s.normal), 0);
        ASSERT_GE(glm::dot(s.normal, Vec3(0, -1, 0)), 0); // it bulges along its axis
    }
    EXPECT_NEAR(height, 0.5, 1e-3);     // Archimedes: heights are uniform
    EXPECT_NEAR(cosine, 2.0 / 3, 1e-3); // of a cosine distribution
}
