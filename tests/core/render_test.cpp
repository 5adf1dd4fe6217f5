// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/render.h"

#include "core/irradiance_field.h"
#include "core/trace_photons.h"
#include "light_scenes.h"

#include <cstring>

namespace pnr {
namespace {

struct Rendered {
    World world;
    PhotonMap map;
    GBuffer gbuffer;
    RenderResult result;

    Color at(int x, int y) const { return result.layer.color.at(x, y); }
};

Rendered draw(const Scene& scene, Settings settings, PixelRect window, bool field = false) {
    const int width = settings.render.width, height = settings.render.height;
    Rendered r;
    r.world = build_world(scene, settings);
    if (r.world.illumination == Illumination::photon_mapped) {
        r.map = trace_photons(r.world, settings.photons, settings.render.seed, 0, false);
        build_photon_tree(r.map);
        if (field) r.map.field = make_irradiance_field(r.world, r.map);
    }
    r.gbuffer = make_gbuffer(r.world, {r.world.camera, width, height}, grow(window, 1, width, height),
                             settings.render);
    r.result = render(r.world, r.gbuffer, r.map, settings, window, true);
    return r;
}

Rendered draw(const Scene& scene, const Settings& settings, bool field = false) {
    return draw(scene, settings, {0, 0, settings.render.width, settings.render.height}, field);
}

// The box with a painted ball, a glass one and a matt one.
Scene mixed_scene(double mix = 1) {
    Scene scene = test::paper_box();
    scene.objects.push_back(test::painted(test::matt(Sphere{{-2, 2, 12}, 2}, Color{0.6f}), mix));
    scene.objects.push_back(test::glass(Sphere{{2.2, 1.5, 9}, 1.5}));
    scene.objects.push_back(test::matt(Sphere{{1, 1, 15}, 1}, Color{0.2f, 0.3f, 0.7f}));
    return scene;
}

Settings quick(int size = 40) {
    Settings settings = test::small_settings(size, size);
    settings.photons.count = 20000;
    settings.render.shadow_samples = 4;
    return settings;
}

TEST(Render, ACropHasThePicturesBits) {
    const Settings settings = quick();
    const Rendered all = draw(mixed_scene(), settings, true);
    const PixelRect window{7, 13, 29, 33};
    const Rendered crop = draw(mixed_scene(), settings, window, true);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            EXPECT_EQ(all.at(x, y), crop.at(x, y)) << x << ' ' << y;
            EXPECT_EQ(all.result.layer.alpha.at(x, y), crop.result.layer.alpha.at(x, y));
        }
}

TEST(Render, OneThreadAndTwoGiveTheSameBits) {
    Rendered one, two;
    {
        const ThreadLimit limit(1);
        one = draw(mixed_scene(), quick(), true);
    }
    {
        const ThreadLimit limit(2);
        two = draw(mixed_scene(), quick(), true);
    }
    const std::vector<Color>&a = one.result.layer.color.pixels, &b = two.result.layer.color.pixels;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Color)), 0);
}

TEST(Render, WhollyPaintedPixelsAreLeftOutAndOthersAreWhole) {
    const Rendered r = draw(mixed_scene(), quick());
    int whole = 0, border = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const float coverage = r.gbuffer.coverage.at(x, y);
            const Seen& seen = r.gbuffer.seen.at(x, y);
            if (seen.via != 0) continue;
            const float alpha = r.result.layer.alpha.at(x, y);
            if (coverage == 1) {
                ++whole;
                EXPECT_EQ(r.at(x, y), Color{0});
                EXPECT_EQ(alpha, 0);
            } else if (coverage == 0) {
                EXPECT_NEAR(alpha, 1, 1e-5);
            } else {
                ++border;
                EXPECT_NEAR(alpha, 1 - coverage, 1e-5);
            }
        }
    EXPECT_GT(whole, 30);
    EXPECT_GT(border, 10);
}

TEST(Render, NoPruneGivesTheSamePicture) {
    Settings settings = quick();
    const Rendered pruned = draw(mixed_scene(), settings);
    settings.render.prune = false;
    const Rendered whole = draw(mixed_scene(), settings);
    for (std::size_t i = 0; i < pruned.result.layer.color.pixels.size(); ++i)
        EXPECT_LT(glm::length(pruned.result.layer.color.pixels[i] - whole.result.layer.color.pixels[i]),
                  1e-4f);
    EXPECT_GT(whole.result.camera_rays, pruned.result.camera_rays);
}

TEST(Render, HalfMixedIsHalfOfThePhotograph) { // a painted object of mix m leaves 1 - m of itself
    const Settings settings = quick();
    const Rendered photograph = draw(mixed_scene(0), settings), half = draw(mixed_scene(0.5), settings);
    int pixels = 0;
    Color whole{0}, left{0};
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            if (half.gbuffer.coverage.at(x, y) < 1 || half.gbuffer.seen.at(x, y).via != 0) continue;
            ++pixels;
            whole += photograph.at(x, y);
            left += half.at(x, y);
        }
    EXPECT_GT(pixels, 30);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(left[c] / whole[c], 0.5, 0.01);
}

TEST(Render, ThePathTracerAndThePhotonMapAgreeOnTheBox) {
    Settings settings = quick(20);
    settings.photons.count = 100000;
    Scene scene = test::paper_box();
    scene.objects.push_back(test::matt(Sphere{{-2, 2, 12}, 2}, Color{0.6f}));
    const Rendered photons = draw(scene, settings, true);
    settings.render.integrator = Integrator::path;
    settings.render.samples_max = 64;
    const Rendered paths = draw(scene, settings);
    for (const SampleFaults& faults : {photons.result.faults, paths.result.faults})
        EXPECT_EQ(faults.nan + faults.inf + faults.negative, 0);
    glm::dvec3 a{0}, b{0};
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            // The lamp, 150 times as bright as the rest, and pixels on its border.
            bool lamp = false;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (photons.gbuffer.seen.contains(x + dx, y + dy))
                        lamp = lamp || max_component(paths.at(x + dx, y + dy)) > 2;
            if (lamp) continue;
            a += glm::dvec3(photons.at(x, y));
            b += glm::dvec3(paths.at(x, y));
        }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, 0.02);
}

TEST(Render, ARaytracedPixelIsAmbientAndDiffuseAndHighlightAsInPovRay) {
    Scene scene;
    Object floor = test::matt(Plane{{0, 0, -1}, -4}, Color{0.8f, 0.4f, 0.2f}); // z = 4
    floor.texture->finish.ambient = Color{0.1f};
    floor.texture->finish.diffuse = 0.6;
    floor.texture->finish.phong = 0.5;
    floor.texture->finish.phong_size = 10;
    scene.objects.push_back(floor);
    LightSource light;
    light.position = {3, 0, 0};
    light.color = Color{0.9f};
    scene.lights.push_back(light);
    scene.camera = test::look({0, 0, 0}, {0, 0, 1}, 1e-3);
    const Rendered r = draw(scene, test::small_settings(3, 3));
    const double cosine = 4.0 / 5;
    const double highlight = 0.5 * std::pow(cosine, 10); // the mirror direction looks back at the camera
    for (int c = 0; c < 3; ++c) {
        const double pigment = floor.texture->pigment.map[0].color.rgb[c];
        EXPECT_NEAR(r.at(1, 1)[c], 0.1 * pigment + 0.9 * (0.6 * pigment * cosine + highlight), 1e-3);
    }
}

TEST(Render, FilteredShadowsTakeThePigmentsColour) {
    Scene scene;
    scene.objects.push_back(test::matt(Plane{{0, 0, -1}, -4}, Color{1}));
    Object pane = test::matt(Box{{0.5, -5, 1.9}, {0.6, 5, 2.1}}, Color{1});
    pane.texture->pigment = test::plain({1, 0.5f, 0.25f}, 1);
    scene.objects.push_back(pane);
    LightSource light;
    light.position = {3, 0, 0};
    scene.lights.push_back(light);
    scene.camera = test::look({0, 0, 0}, {0, 0, 1}, 1e-3);
    const Rendered shadowless = draw(
        [&] {
            Scene open = scene;
            open.objects.pop_back();
            return open;
        }(),
        test::small_settings(3, 3));
    // The ray from (0, 0, 4) to the light passes x 0.5 .. 0.6 at z 3.3 .. 3.2: not through the pane; move it
    // there.
    scene.objects[1].shape = Box{{0.5, -5, 2.5}, {0.6, 5, 3.9}};
    const Rendered tinted = draw(scene, test::small_settings(3, 3));
    const Color open = shadowless.at(1, 1), seen = tinted.at(1, 1);
    EXPECT_NEAR(seen.x / open.x, 1, 1e-3); // two surfaces, each tints
    EXPECT_NEAR(seen.y / open.y, 0.25, 1e-3);
    EXPECT_NEAR(seen.z / open.z, 0.0625, 1e-3);
}

} // namespace
} // namespace pnr
