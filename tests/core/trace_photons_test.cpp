// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/trace_photons.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace pnr;

namespace {

Object object_of(Shape shape, Color pigment, double diffuse = 1) {
    Object object;
    object.shape = std::move(shape);
    object.texture = Texture{};
    object.texture->pigment.map = {{0, {pigment, 0, 0}}};
    object.texture->finish.diffuse = diffuse;
    object.texture->finish.ambient = Color(0);
    return object;
}

LightSource emitter_of(Emitter emitter, Vec3 position, Color color = Color(1)) {
    LightSource light;
    light.position = position;
    light.color = color;
    light.emitter = emitter;
    return light;
}

Emitter sphere_emitter(double radius, double radiance) {
    return {EmitterShape::sphere, radius, {}, {}, {}, radiance, {}};
}

PhotonMap trace(const Scene& scene, std::int64_t count, std::uint64_t seed = 1, int pass = 0) {
    PhotonSettings settings;
    settings.count = count;
    return trace_photons(build_world(scene, {}), settings, seed, pass, true);
}

glm::dvec3 stored_flux(const PhotonMap& map, auto&& wanted) {
    glm::dvec3 sum{0};
    for (const Photon& photon : map.photons)
        if (wanted(photon)) sum += glm::dvec3(photon.flux);
    return sum;
}

// The paper's box: width 10, height 10, depth 20, open in front, a hemisphere on the rear half of the
// ceiling.
Scene paper_box(double power) {
    Scene scene;
    const auto wall = [&](Vec3 low, Vec3 high, Color color) {
        scene.objects.push_back(object_of(Box{low, high}, color, 0.8));
    };
    wall({-6, -1, -10}, {6, 0, 11}, Color(1));
    wall({-6, 10, -10}, {6, 11, 11}, Color(1));
    wall({-6, 0, 10}, {6, 10, 11}, Color(1));
    wall({-6, 0, -10}, {-5, 10, 10}, {1, 0.1f, 0.1f});
    wall({5, 0, -10}, {6, 10, 10}, {0.1f, 1, 0.1f});
    Object glass = object_of(Sphere{{2, 1.5, 2}, 1.5}, Color(1), 0);
    glass.texture->pigment.map[0].color.filter = 1;
    glass.interior = Interior{1.5, 0, 0, Color(0)};
    scene.objects.push_back(glass);
    Object metal = object_of(Sphere{{-2, 1.5, 1}, 1.5}, {0.9f, 0.7f, 0.4f}, 0.3);
    metal.texture->finish.specular = 0.8;
    metal.texture->finish.metallic = 1;
    metal.texture->finish.reflection = {Color(0.4f), Color(0.4f), 1, 1, 1, false};
    scene.objects.push_back(metal);
    scene.lights.push_back(emitter_of({EmitterShape::hemisphere, 1.5, {0, -1, 0}, {}, {}, {}, power},
                                      {0, 10, 5}, {1, 0.9f, 0.5f}));
    return scene;
}

void expect_balanced(const PhotonMap& map, double tolerance = 0.01) {
    for (int c = 0; c < 3; ++c) {
        const double given = map.balance.emitted[c];
        EXPECT_NEAR(map.balance.absorbed[c] + map.balance.escaped[c], given, tolerance * given)
            << "channel " << c;
    }
}

} // namespace

TEST(TracePhotons, PowerBalancesInAnOpenBoxOfGlassAndMetal) {
    const PhotonMap map = trace(paper_box(900), 200000);
    EXPECT_EQ(map.emitted, 200000);
    EXPECT_NEAR(map.balance.emitted.x, 900, 1e-2);
    EXPECT_NEAR(map.balance.emitted.y, 810, 1e-2);
    EXPECT_GT(map.balance.escaped.x, 50);
    expect_balanced(map);
}

// A wall of albedo rho round a concentric black sphere emitter: with q = (r / R)^2 all power ends on the
// emitter or in the wall, and the wall's irradiance is pi Le q / (1 - rho (1 - q)).
TEST(TracePhotons, ClosedFurnaceHasItsAnalyticIrradiance) {
    for (const float rho : {0.01f, 0.5f, 0.9f}) {
        Scene scene;
        scene.objects.push_back(object_of(Sphere{{1, 2, 3}, 2}, Color(rho)));
        scene.lights.push_back(emitter_of(sphere_emitter(1, 3), {1, 2, 3}));
        const PhotonMap map = trace(scene, 200000);
        expect_balanced(map);
        EXPECT_EQ(map.balance.escaped.x, 0);
        const double q = 0.25, area = 4 * pi * 4;
        const double truth = pi * 3 * q / (1 - rho * (1 - q));
        EXPECT_NEAR(stored_flux(map, [](const Photon&) { return true; }).x / area, truth, 0.01 * truth);
    }
}

TEST(TracePhotons, WhiteFurnaceEndsAndLosesNothing) {
    Scene scene;
    scene.objects.push_back(object_of(Sphere{{0, 0, 0}, 2}, Color(1)));
    scene.lights.push_back(emitter_of(sphere_emitter(0.5, 1), {0.5, 0.2, 0}));
    expect_balanced(trace(scene, 50000), 0.02);
}

// E on a plane under a disc (on its axis), and under a sphere (everywhere).
TEST(TracePhotons, FluxOnAPlaneIsTheAnalyticIrradiance) {
    Scene scene;
    scene.objects.push_back(object_of(Box{{-20, -1, -20}, {20, 0, 20}}, Color(0), 1));
    scene.objects.back().texture->pigment.map[0].color.rgb = Color(1e-7f);
    scene.lights.push_back(emitter_of({EmitterShape::disc, 1, {0, -1, 0}, {}, {}, 5, {}}, {0, 3, 0}));
    const PhotonMap disc = trace(scene, 200000);
    const double spot = 0.3;
    const auto near_axis = [&](const Photon& p) { return std::hypot(p.position.x, p.position.z) < spot; };
    const double flux = stored_flux(disc, near_axis).x / (pi * spot * spot);
    EXPECT_NEAR(flux, pi * 5 / (1 + 9.0), 0.04 * flux);

    scene.lights[0] = emitter_of(sphere_emitter(0.5, 5), {0, 3, 0});
    const PhotonMap ball = trace(scene, 200000);
    // The flux within a radius a: the share of the power in the cone it spans.
    for (const double a : {1.0, 3.0, 8.0}) {
        const double truth = pi * pi * 5 * 4 * 0.25 * 0.5 * (1 - 3 / std::hypot(3, a));
        const double got =
            stored_flux(ball, [&](const Photon& p) { return std::hypot(p.position.x, p.position.z) < a; }).x;
        EXPECT_NEAR(got, truth, 0.02 * truth);
    }
}

// Irradiance pi c cos at any distance, without fading.
TEST(TracePhotons, PovrayLightsGiveTheirIrradiance) {
    Scene scene;
    scene.objects.push_back(object_of(Plane{{0, 1, 0}, 0}, Color(1e-7f)));
    scene.objects.push_back(object_of(Sphere{{3, 5, 0}, 0.1}, Color(1e-7f)));
    PhotonSettings settings;
    settings.count = 400000;
    LightSource light;
    light.position = {0, 2, 0};
    light.point_at = {0, 0, 0};
    light.color = Color(0.8f);
    const auto irradiance = [&](const LightSource& l, Vec3 at, double spot) {
        scene.lights = {l};
        const World world = build_world(scene, {});
        World lit = world;
        lit.illumination = Illumination::photon_mapped;
        const PhotonMap map = trace_photons(lit, settings, 1, 0, false);
        double sum = 0;
        for (const Photon& p : map.photons)
            if (glm::distance(Vec3(p.position) + world.offset, at) < spot) sum += p.flux.x;
        return sum / (pi * spot * spot);
    };
    EXPECT_NEAR(irradiance(light, {1, 0, 0}, 0.2), pi * 0.8 * 2 / std::sqrt(5), 0.05);
    EXPECT_NEAR(irradiance(light, {-4, 0, 0}, 0.3), pi * 0.8 * 2 / std::sqrt(20), 0.05);
    LightSource fading = light;
    fading.fade_distance = 1;
    fading.fade_power = 2;
    EXPECT_NEAR(irradiance(fading, {1, 0, 0}, 0.2), pi * 0.8 * 2 / std::sqrt(5) * 2 / (1 + 5.0), 0.05);
    LightSource spot = light;
    spot.spotlight = true;
    spot.radius = 30;
    spot.falloff = 60;
    EXPECT_NEAR(irradiance(spot, {0.5, 0, 0}, 0.2), pi * 0.8 * 2 / std::hypot(2, 0.5), 0.05);
    EXPECT_EQ(irradiance(spot, {4, 0, 0}, 0.3), 0);
    LightSource parallel = light;
    parallel.parallel = true;
    parallel.point_at = {1, 0, 0};
    EXPECT_NEAR(irradiance(parallel, {-1, 0, 1}, 0.3), pi * 0.8 * 2 / std::sqrt(5), 0.06);
    LightSource far = light; // aimed at the scene from far away
    far.position = {0, 5000, 0};
    EXPECT_NEAR(irradiance(far, {1, 0, 1}, 0.3), pi * 0.8, 0.06);
}

// A mirror at 45 degrees: d is the path's whole length to the first diffuse hit, so the floor's image is as
// bright as the floor would be.
TEST(TracePhotons, PovrayLightsCountTheWholePathOverMirrors) {
    Scene scene;
    scene.objects.push_back(object_of(Plane{{0, 1, 0}, 0}, Color(1e-7f)));
    Object mirror = object_of(Box{{-2, -2, -0.05}, {2, 2, 0.05}}, Color(1), 0);
    mirror.texture->finish.reflection = {Color(1), Color(1), 1, 1, 0, false};
    mirror.transform = then(rotation({-45, 0, 0}), translation({0, 4, 0}));
    scene.objects.push_back(mirror);
    LightSource light;
    light.position = {0, 4, -5};
    light.point_at = {0, 4, 0};
    light.spotlight = true;
    light.radius = 10;
    light.falloff = 12;
    scene.lights = {light};
    World world = build_world(scene, {});
    world.illumination = Illumination::photon_mapped;
    PhotonSettings settings;
    settings.count = 300000;
    const PhotonMap map = trace_photons(world, settings, 1, 0, false);
    double sum = 0;
    for (const Photon& p : map.photons) {
        if (p.path() != PhotonPath::caustic) continue;
        if (glm::distance(Vec3(p.position) + world.offset, Vec3(0, 0, 0)) < 0.4) sum += p.flux.x;
    }
    EXPECT_NEAR(sum / (pi * 0.16), pi, 0.1); // the mirror sends the beam straight down
}

// `photons {}` alone: caustics only, and every photon aims at what throws them. A ball of ior 1 bends
// nothing, so that the flux behind it is the light's own irradiance over its shadow.
TEST(TracePhotons, CausticsAloneAimAtTheirTargets) {
    Scene scene;
    scene.objects.push_back(object_of(Plane{{0, 1, 0}, 0}, Color(0.5f)));
    for (const double x : {0.0, 3.0}) {
        Object ball = object_of(Sphere{{x, 2, 0}, 0.25}, Color(1), 0);
        ball.texture->pigment.map[0].color.transmit = 1;
        scene.objects.push_back(ball);
    }
    LightSource light;
    light.position = {0, 50, 0};
    light.color = Color(0.8f);
    scene.lights = {light};
    Settings settings;
    settings.photons.wanted = true;
    settings.photons.count = 20000;
    const auto flux_at = [&](double x) {
        const World world = build_world(scene, settings);
        EXPECT_EQ(world.illumination, Illumination::caustics);
        const PhotonMap map = trace_photons(world, settings.photons, 1, 0, false);
        double sum = 0;
        for (const Photon& p : map.photons) {
            EXPECT_EQ(p.path(), PhotonPath::caustic);
            if (glm::distance(Vec3(p.position) + world.offset, Vec3(x, 0, 0)) < 1) sum += p.flux.x;
        }
        // A tenth of the photons at least: the spheres about the balls' boxes are three times their section.
        EXPECT_GT(map.photons.size(), 2000u);
        return sum;
    };
    // The shadow of the ball on the floor: radius 0.25 seen from 48 away, at 50.
    const double truth = pi * 0.8 * pi * std::pow(0.25 * 50 / 48.0, 2);
    EXPECT_NEAR(flux_at(0), truth, 0.03 * truth);
    EXPECT_GT(flux_at(3.125), 0.9 * truth); // shifted and a little stretched
    scene.objects[1].photons = PhotonRoles{};
    scene.objects[1].photons->target = true;
    EXPECT_NEAR(flux_at(0), truth, 0.03 * truth);
    EXPECT_EQ(flux_at(3.125), 0);                // no target, no caustic
    scene.objects[1].photons->reflection = true; // and not by refraction
    const World world = build_world(scene, settings);
    EXPECT_TRUE(trace_photons(world, settings.photons, 1, 0, false).photons.empty());
}

// [LW10 Table 1] in sequence: specular with PSR, else absorbed with PA, else diffuse, in the pigment's colour
// over its largest component.
TEST(TracePhotons, ProbabilitiesOfTable1) {
    const double psr = 0.2, pa = 0.7;
    Scene scene;
    scene.objects.push_back(object_of(Box{{-5000, -1, -5000}, {5000, 0, 5000}}, {0.4f, 0.2f, 0.1f}));
    scene.objects.back().photons = PhotonRoles{psr, pa, false, false, false, true};
    scene.lights.push_back(emitter_of({EmitterShape::disc, 0.01, {0, -1, 0}, {}, {}, {}, 1.0}, {0, 10, 0}));
    const std::int64_t n = 100000;
    const PhotonMap map = trace(scene, n);
    const glm::dvec3 floor = stored_flux(map, [](const Photon& p) { return p.path() == PhotonPath::direct; });
    EXPECT_NEAR(floor.x, 1, 1e-3); // all that arrives is stored, whatever becomes of it
    const glm::dvec3 albedo = glm::dvec3(psr) + (1 - psr) * (1 - pa) * glm::dvec3(1, 0.5, 0.25);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(map.balance.escaped[c], albedo[c], 0.006);
        EXPECT_NEAR(map.balance.absorbed[c], 1 - albedo[c], 1e-4);
    }
    // A ceiling shows what the survivors carry: the flux they had, diffuse ones in the pigment's hue.
    scene.objects.push_back(object_of(Box{{-5000, 20, -5000}, {5000, 21, 5000}}, Color(1e-7f)));
    std::size_t specular = 0, diffuse = 0;
    const PhotonMap seen = trace(scene, n);
    for (const Photon& p : seen.photons) {
        if (p.object() != 2) continue;
        const bool mirrored = p.path() == PhotonPath::caustic;
        ++(mirrored ? specular : diffuse);
        EXPECT_NEAR(p.flux.x * static_cast<double>(n), 1, 1e-4);
        EXPECT_NEAR(p.flux.y * static_cast<double>(n), mirrored ? 1 : 0.5, 1e-4);
        EXPECT_NEAR(p.flux.z * static_cast<double>(n), mirrored ? 1 : 0.25, 1e-4);
    }
    EXPECT_NEAR(static_cast<double>(specular) / static_cast<double>(n), psr, 0.005);
    EXPECT_NEAR(static_cast<double>(diffuse) / static_cast<double>(n), (1 - psr) * (1 - pa), 0.005);
}

TEST(TracePhotons, SameBitsForAnyNumberOfThreads) {
    const Scene scene = paper_box(100);
    PhotonMap maps[2];
    for (int threads = 1; threads <= 2; ++threads) {
        const ThreadLimit limit(threads);
        maps[threads - 1] = trace(scene, 20000);
        build_photon_tree(maps[threads - 1]);
    }
    ASSERT_EQ(maps[0].photons.size(), maps[1].photons.size());
    EXPECT_EQ(
        std::memcmp(maps[0].photons.data(), maps[1].photons.data(), maps[0].photons.size() * sizeof(Photon)),
        0);
    EXPECT_EQ(maps[0].normals, maps[1].normals);
    EXPECT_EQ(maps[0].balance.absorbed, maps[1].balance.absorbed);
    EXPECT_EQ(maps[0].tree.x, maps[1].tree.x);
}

TEST(TracePhotons, PassesAndSeedsDiffer) {
    const Scene scene = paper_box(100);
    const PhotonMap a = trace(scene, 1000, 1, 0), b = trace(scene, 1000, 1, 1), c = trace(scene, 1000, 2, 0);
    EXPECT_NE(a.photons[0].position, b.photons[0].position);
    EXPECT_NE(a.photons[0].position, c.photons[0].position);
}

TEST(TracePhotons, PathsNormalsAndTags) {
    const PhotonMap map = trace(paper_box(100), 50000);
    ASSERT_EQ(map.normals.size(), map.photons.size());
    std::size_t paths[3] = {};
    for (std::size_t i = 0; i < map.photons.size(); ++i) {
        const Photon& p = map.photons[i];
        ++paths[static_cast<int>(p.path())];
        EXPECT_NEAR(glm::length(map.normals[i]), 1, 1e-5);
        EXPECT_NEAR(glm::length(p.direction), 1, 1e-5);
        EXPECT_LT(glm::dot(p.direction, map.normals[i]), 0); // the side hit
        EXPECT_NE(p.object(), 6);                            // nothing is stored on glass
        EXPECT_FALSE(p.npr());
    }
    for (const std::size_t n : paths) EXPECT_GT(n, 300u);
}

TEST(TracePhotons, NothingToTrace) {
    Scene scene = paper_box(0);
    EXPECT_TRUE(trace(scene, 1000).photons.empty());
    scene.lights.clear();
    EXPECT_TRUE(trace(scene, 1000).photons.empty());
    EXPECT_TRUE(trace(paper_box(1), 0).photons.empty());
    EXPECT_EQ(trace(paper_box(1), 1).emitted, 1);
}

TEST(TracePhotons, StopsWhenAsked) {
    PhotonSettings settings;
    settings.count = 100000;
    const World world = build_world(paper_box(1), {});
    EXPECT_THROW(
        trace_photons(world, settings, 1, 0, false, [](std::int64_t, std::int64_t) { return false; }),
        Interrupted);
}

// Photons that aim at glass bring what the lamp sends there: balls of ior 1 bend and reflect nothing, so that the flux
// behind them is the lamp's power times the form factors from it to the balls.
TEST(TracePhotons, AimedPhotonsBringTheLampsOwnLightThroughGlassThatBendsNothing) {
    Scene scene;
    scene.objects.push_back(object_of(Box{{-50, -1, -50}, {50, 0, 50}}, Color(0.5f)));
    for (const double x : {0.0, 1.5}) {
        Object ball = object_of(Sphere{{x, 2, 0}, 0.25}, Color(1), 0);
        ball.texture->pigment.map[0].color.transmit = 1;
        scene.objects.push_back(ball);
    }
    scene.lights.push_back(emitter_of({EmitterShape::disc, 0.5, {0, -1, 0}, {}, {}, 8.0, {}}, {0.3, 6, 0.2}));
    const PhotonMap map = trace(scene, 40000);
    EXPECT_EQ(map.emitted, 40000);
    std::size_t caustic = 0;
    for (const Photon& p : map.photons) caustic += p.path() == PhotonPath::caustic;
    EXPECT_GT(caustic, 30000u); // nearly all that were aimed
    // The share of the lamp's power that meets each ball: by rays from its points to the ball's discs.
    double truth = 0;
    const int n = 400;
    for (int i = 0; i < n * n; ++i) {
        const Vec2 u((i % n + 0.5) / n, (i / n + 0.5) / n);
        const Vec3 from = Vec3(0.3, 6, 0.2) + 0.5 * Vec3(square_to_disc(u).x, 0, square_to_disc(u).y);
        for (const double x : {0.0, 1.5}) { // form factor from a small area to a sphere: (r / d)^2 cos
            const Vec3 to = Vec3(x, 2, 0) - from;
            const double d2 = glm::dot(to, to);
            truth += 0.0625 / d2 * (-to.y / std::sqrt(d2)) / (n * n);
        }
    }
    truth *= pi * 8 * pi * 0.25; // the lamp's power
    const double found = stored_flux(map, [](const Photon& p) { return p.path() == PhotonPath::caustic; }).x;
    EXPECT_NEAR(found, truth, 0.005 * truth);
}
