// SPDX-License-Identifier: GPL-3.0-or-later
// Photons and paths, which share rays and materials alone, find the same light: on a dozen scenes the photon
// map's pictures agree with path-traced ones within the error that both state.
#include <gtest/gtest.h>

#include "library_file.h"
#include "light_scenes.h"
#include "run_passes.h"

#include <boost/math/distributions/students_t.hpp>

namespace pnr {
namespace {

using namespace pnr::test;

constexpr int side = 24;

struct Case {
    const char* name;
    Scene (*scene)();
    int paths = 400; // passes of the path tracer
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Object rough(Shape shape, Color color) {
    Object object = matt(std::move(shape), color);
    object.texture->finish.diffuse = 0.3;
    object.texture->finish.specular = 3;
    object.texture->finish.roughness = 0.02;
    object.texture->finish.metallic = 1;
    return object;
}

Scene bunny() {
    Scene scene = paper_box();
    Mesh mesh;
    mesh.file = library_file("bunny_1979.ply").string();
    Object object = matt(mesh, Color{0.75f});
    object.transform = then(scaling(Vec3(38.951)), translation({0.65, -1.29, 12}));
    scene.objects.push_back(object);
    return scene;
}

Scene caustic() {
    Scene scene = paper_box();
    scene.objects.push_back(matt(Sphere{{-2.2, 1.9, 13.5}, 1.9}, Color{0.75f}));
    scene.objects.push_back(glass(Sphere{{2, 1.7, 10.5}, 1.7}));
    return scene;
}

Scene rough_metal() {
    Scene scene = paper_box();
    scene.objects.push_back(rough(Sphere{{0, 2.5, 12}, 2.5}, {0.9f, 0.7f, 0.4f}));
    return scene;
}

Scene coloured_glass() {
    Scene scene = paper_box();
    Object block = glass(Box{{-2, 0.5, 11}, {2, 4, 13}}, 1.3);
    block.texture->pigment = plain({0.9f, 0.5f, 0.4f}, 0.8f);
    block.interior->fade_distance = 3;
    block.interior->fade_power = 1001;
    block.interior->fade_color = {0.8f, 0.4f, 0.4f};
    scene.objects.push_back(block);
    return scene;
}

// Without fall-off.
Scene povray_light() {
    Scene scene = paper_box();
    LightSource light;
    light.position = {2, 8, 4};
    light.color = {0.9f, 0.8f, 0.7f};
    scene.lights = {light};
    scene.objects.push_back(matt(Sphere{{0, 2, 12}, 2}, Color{0.5f}));
    return scene;
}

Scene sun() {
    Scene scene = povray_light();
    scene.lights[0].position = {0, 9, -20};
    scene.lights[0].point_at = {0, 0, 14};
    scene.lights[0].parallel = true;
    return scene;
}

Scene many_lights() {
    Scene scene = paper_box();
    scene.lights.clear();
    for (int i = 0; i < 12; ++i) {
        const double x = -4 + 8.0 * (i % 4) / 3, z = 8 + 4.0 * (i / 4);
        scene.lights.push_back(emitter(EmitterShape::sphere, {x, 6 + i % 3, z}, 0.15 + 0.02 * i, 20));
        scene.lights.back().color = {i % 2 ? 1.f : 0.4f, 0.7f, i % 3 ? 0.3f : 1.f};
    }
    scene.objects.push_back(matt(Box{{-1.5, 0, 11}, {1.5, 3, 14}}, Color{0.6f}));
    return scene;
}

Scene closed_furnace() {
    Scene scene = furnace(4, 1, 0.7f, 1);
    return scene;
}

Scene mirror_wall() {
    Scene scene = paper_box();
    scene.objects.push_back(mirror(Box{{-4, 0.5, 19}, {4, 9, 19.5}}, 0.8f));
    scene.objects.push_back(matt(Sphere{{1, 2, 12}, 2}, Color{0.3f, 0.4f, 0.8f}));
    return scene;
}

// Light that reaches what is seen only round a screen.
Scene hidden_lamp() {
    Scene scene = paper_box();
    scene.objects.push_back(matt(Box{{-3, 8, 11}, {3, 8.2, 17}}, Color{0.7f}));
    return scene;
}

Scene narrow_gap() {
    Scene scene = paper_box();
    scene.objects.push_back(matt(Box{{-3, 0, 10}, {-0.2, 4, 14}}, {0.8f, 0.7f, 0.3f}));
    scene.objects.push_back(matt(Box{{0.2, 0, 10}, {3, 4, 14}}, {0.3f, 0.7f, 0.8f}));
    return scene;
}

Scene half_mirrors() {
    Scene scene = paper_box();
    scene.lights[0] = emitter(EmitterShape::hemisphere, {0, 10, 12}, 1.5, 20);
    Object ring = matt(Torus{2, 0.8}, Color{0.8f, 0.5f, 0.3f});
    ring.texture->finish.diffuse = 0.6;
    ring.texture->finish.reflection.min = ring.texture->finish.reflection.max = Color{0.35f};
    ring.transform = then(rotation({90, 0, 0}), translation({0, 3, 12}));
    scene.objects.push_back(ring);
    return scene;
}

const Case cases[] = {{"bunny", bunny},
                      {"caustic", caustic, 1000},
                      {"rough_metal", rough_metal},
                      {"coloured_glass", coloured_glass, 1000},
                      {"povray_light", povray_light},
                      {"sun", sun},
                      {"many_lights", many_lights},
                      {"closed_furnace", closed_furnace},
                      {"mirror_wall", mirror_wall, 800},
                      {"hidden_lamp", hidden_lamp},
                      {"narrow_gap", narrow_gap},
                      {"half_mirrors", half_mirrors, 800}};

struct Agreement : testing::TestWithParam<Case> {};

TEST_P(Agreement, PhotonsAndPathsFindTheSameLight) {
    const Case& c = GetParam();
    if (std::string(c.name) == "bunny" && library_file("bunny_1979.ply").empty())
        GTEST_SKIP() << "skipped: no bunny_1979.ply";
    Settings settings = small_settings(side, side);
    settings.photons.count = 30000;
    settings.photons.global = true;
    Scene scene = c.scene();
    for (LightSource& light : scene.lights)
        light.no_image = true; // far brighter than all else, its borders would be all the noise
    const World world = build_world(scene, settings);
    ASSERT_EQ(world.illumination, Illumination::photon_mapped);
    const ProgressiveSum photons = run_passes(world, settings, 12);
    settings.render.integrator = Integrator::path;
    settings.render.seed = 77;
    const ProgressiveSum paths = run_passes(world, settings, c.paths);
    const PixelRect window{0, 0, side, side};
    const ErrorEstimate mine = estimate_error(photons, window), theirs = estimate_error(paths, window);
    const double t =
        boost::math::quantile(boost::math::students_t_distribution<double>(2.0 * (mine.batches - 1)), 0.95);
    glm::dvec3 sum{0}, other{0};
    double noise2 = 0;
    int inside = 0, all = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Color a = photons.mean.color.at(x, y), b = paths.mean.color.at(x, y);
            const auto noise = static_cast<double>(std::hypot(mine.noise.at(x, y), theirs.noise.at(x, y)));
            const double off = std::abs(static_cast<double>(luminance(a) - luminance(b)));
            inside += off <= t * noise + static_cast<double>(std::abs(mine.bias.at(x, y))) ? 1 : 0;
            ++all;
            sum += glm::dvec3(a);
            other += glm::dvec3(b);
            noise2 += noise * noise;
        }
    const double unsure = 3 * std::sqrt(noise2) / glm::dot(other, glm::dvec3(0.2126, 0.7152, 0.0722));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(sum[i] / other[i], 1, 0.01 + unsure) << "channel " << i;
    EXPECT_GE(static_cast<double>(inside) / all, 0.85);
    RecordProperty("inside", std::to_string(static_cast<double>(inside) / all));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

} // namespace
} // namespace pnr
