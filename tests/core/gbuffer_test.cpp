// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/gbuffer.h"

#include "light_scenes.h"

namespace pnr {
namespace {

constexpr int size = 32;

struct Picture {
    World world;
    GBuffer gbuffer;
};

Picture see(const Scene& scene, const RenderSettings& settings = {}, PixelRect window = {0, 0, size, size}) {
    Picture p;
    p.world = build_world(scene, Settings{});
    p.gbuffer = make_gbuffer(p.world, {p.world.camera, size, size}, window, settings);
    return p;
}

// A mirror wall at z = 4 that faces the camera at the origin, a painted ball beside the camera's axis behind
// it.
Scene mirror_scene() {
    Scene scene;
    scene.objects.push_back(test::mirror(Box{{-5, -5, 4}, {5, 5, 5}}, 0.8f));
    scene.objects.push_back(test::painted(test::matt(Sphere{{0, 0, -6}, 1.5}, Color{0.5f})));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1}, 0.4);
    return scene;
}

TEST(GBuffer, ABallIsSeenWhereItIs) {
    Scene scene;
    scene.objects.push_back(test::matt(Sphere{{9, 9, 9}, 0.5}, Color{0.5f}));
    scene.objects.push_back(test::matt(Sphere{{0, 0, 5}, 1}, Color{0.5f}));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1});
    const Picture p = see(scene);
    const Seen& centre = p.gbuffer.seen.at(size / 2, size / 2);
    EXPECT_EQ(centre.object, 2u);
    EXPECT_EQ(centre.via, 0u);
    EXPECT_FALSE(centre.npr);
    const Vec3 offset = p.world.offset;
    const Vec3 place = Vec3(centre.position) + offset;
    EXPECT_NEAR(glm::length(place - Vec3(0, 0, 5)), 1, 1e-5);
    EXPECT_NEAR(centre.z, glm::length(place), 1e-5);
    EXPECT_NEAR(glm::length(Vec3(centre.normal) - (place - Vec3(0, 0, 5))), 0, 1e-5);
    EXPECT_NEAR(glm::length(Vec3(centre.toward_viewer) + glm::normalize(place)), 0, 1e-6);
    EXPECT_EQ(p.gbuffer.seen.at(0, 0).z, 0);
    EXPECT_EQ(p.gbuffer.coverage.at(size / 2, size / 2), 0);
}

TEST(GBuffer, AMirrorShowsWhatStandsBehindTheCamera) {
    const Picture p = see(mirror_scene());
    const Seen& s = p.gbuffer.seen.at(size / 2, size / 2);
    EXPECT_EQ(s.object, 2u);
    EXPECT_EQ(s.via, 1u);
    EXPECT_TRUE(s.npr);
    EXPECT_NEAR(s.weight.y, 0.8, 1e-6);
    EXPECT_NEAR(s.z_specular, 4, 0.01);
    EXPECT_NEAR(s.z, 4 + 4 + 4.5, 0.02);
    EXPECT_NEAR(s.last_specular.z + p.world.offset.z, 4, 1e-5);
    EXPECT_GT(s.normal.z, 0.9); // towards the mirror
    EXPECT_EQ(p.gbuffer.coverage.at(size / 2, size / 2), 1);
}

TEST(GBuffer, AWeakMirrorIsSeenItself) {
    Scene scene = mirror_scene();
    scene.objects[0].texture->finish.reflection.min = scene.objects[0].texture->finish.reflection.max =
        Color{0.4f};
    const Picture p = see(scene);
    EXPECT_EQ(p.gbuffer.seen.at(size / 2, size / 2).object, 1u);
    EXPECT_EQ(p.gbuffer.seen.at(size / 2, size / 2).via, 0u);
}

TEST(GBuffer, GlassIsSeenThrough) {
    Scene scene;
    scene.objects.push_back(test::glass(Sphere{{0, 0, 5}, 1}));
    scene.objects.push_back(test::matt(Plane{{0, 0, -1}, -20}, Color{0.5f})); // z = 20
    scene.camera = test::look({0, 0, 0}, {0, 0, 1}, 0.1);
    const Picture p = see(scene);
    const Seen& s = p.gbuffer.seen.at(size / 2, size / 2);
    EXPECT_EQ(s.object, 2u);
    EXPECT_EQ(s.via, 1u);
    EXPECT_NEAR(s.weight.y, 0.96 * 0.96, 0.001); // two interfaces at normal incidence
    EXPECT_NEAR(s.z_specular, 6, 0.01);
}

// The footprint against the difference of the neighbours' own points, on a plane seen directly and in a
// mirror.
TEST(GBuffer, FootprintsAreTheStepToTheNextPixel) {
    Scene direct;
    direct.objects.push_back(test::matt(Plane{glm::normalize(Vec3{0.3, 1, -0.5}), -4}, Color{0.5f}));
    direct.camera = test::look({0, 0, 0}, {0.2, -0.6, 1}, 0.3);
    Scene mirrored = mirror_scene();
    mirrored.objects[1] = test::matt(Plane{glm::normalize(Vec3{0.3, 0.2, 1}), -6}, Color{0.5f});
    for (const Scene& scene : {direct, mirrored}) {
        const Picture p = see(scene);
        const int m = size / 2;
        const Seen& here = p.gbuffer.seen.at(m, m);
        ASSERT_GT(here.z, 0);
        const Vec3f right =
            (p.gbuffer.seen.at(m + 1, m).position - p.gbuffer.seen.at(m - 1, m).position) / 2.f;
        const Vec3f down =
            (p.gbuffer.seen.at(m, m + 1).position - p.gbuffer.seen.at(m, m - 1).position) / 2.f;
        EXPECT_LT(glm::length(here.dpdx - right), 0.01f * glm::length(right));
        EXPECT_LT(glm::length(here.dpdy - down), 0.01f * glm::length(down));
    }
}

TEST(GBuffer, CoverageIsTheShareOfThePixel) {
    // A painted disc of known area: the coverages sum to its area in pixels.
    Scene scene;
    scene.objects.push_back(test::painted(test::matt(Disc{{0, 0, 1}, {0, 0, -1}, 0.31, 0}, Color{0.5f})));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1});
    const Picture p = see(scene);
    double sum = 0;
    bool borders = false;
    for (const float c : p.gbuffer.coverage.pixels) {
        sum += c;
        borders = borders || (c > 0 && c < 1);
    }
    EXPECT_NEAR(sum / (pi * 0.31 * 0.31 * size * size), 1, 0.01);
    EXPECT_TRUE(borders);
}

TEST(GBuffer, EmittersHaveAPlaceAndNoNumberAndCanHideFromTheCamera) {
    Scene scene;
    scene.objects.push_back(test::matt(Plane{{0, 0, -1}, -20}, Color{0.5f}));
    scene.lights.push_back(test::emitter(EmitterShape::sphere, {0, 0, 5}, 1, 1));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1});
    const Picture shown = see(scene);
    EXPECT_EQ(shown.gbuffer.seen.at(size / 2, size / 2).object, 0u);
    EXPECT_NEAR(shown.gbuffer.seen.at(size / 2, size / 2).z, 4, 0.01);
    scene.lights[0].no_image = true;
    const Picture hidden = see(scene);
    EXPECT_EQ(hidden.gbuffer.seen.at(size / 2, size / 2).object, 1u);
}

TEST(GBuffer, AWindowHasThePicturesBits) {
    const Picture all = see(mirror_scene());
    const PixelRect window{9, 11, 20, 18};
    const Picture part = see(mirror_scene(), {}, window);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Seen& a = all.gbuffer.seen.at(x, y);
            const Seen& b = part.gbuffer.seen.at(x, y);
            if (!window.contains(x, y)) {
                EXPECT_EQ(b.z, 0);
                continue;
            }
            EXPECT_EQ(a.position, b.position);
            EXPECT_EQ(a.dpdx, b.dpdx);
            EXPECT_EQ(all.gbuffer.coverage.at(x, y), part.gbuffer.coverage.at(x, y));
        }
}

TEST(PixelSample, PowersOfTwoAreStratified) {
    for (int pixel = 0; pixel < 20; ++pixel)
        for (const int n : {4, 16}) {
            std::vector<bool> hit(static_cast<std::size_t>(n));
            const int side = n == 4 ? 2 : 4;
            for (int i = 0; i < n; ++i) {
                const Vec2 p = pixel_sample(1, pixel, 3, i) - Vec2(pixel, 3);
                ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
                hit[static_cast<std::size_t>(static_cast<int>(p.x * side) * side +
                                             static_cast<int>(p.y * side))] = true;
            }
            EXPECT_EQ(std::count(hit.begin(), hit.end(), true), n);
        }
}

} // namespace
} // namespace pnr
