// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rng.h"
#include "npr/paint.h"
#include "tests/core/light_scenes.h"

#include <gtest/gtest.h>

#include <tuple>

namespace pnr {
namespace {

constexpr int size = 64;

struct Picture {
    World world;
    GBuffer gbuffer;
};

Picture see(const Scene& scene) {
    Picture p;
    p.world = build_world(scene, Settings{});
    p.gbuffer = make_gbuffer(p.world, {p.world.camera, size, size}, {0, 0, size, size}, RenderSettings{});
    return p;
}

void add_photon(PhotonMap& map, int object, Vec3 position, Vec3 normal) {
    map.photons.push_back(
        {Vec3f(position), Vec3f(-normal), Color(0.01f), photon_tag(object, true, PhotonPath::direct)});
    map.normals.push_back(Vec3f(glm::normalize(normal)));
}

// A painted ball before the camera, a smaller thing between the two: from the origin along z.
Picture ball_behind_a_ball() {
    Scene scene;
    scene.objects.push_back(test::painted(test::matt(Sphere{{0, 0, 5}, 1}, Color{0.5f})));
    scene.objects.push_back(test::matt(Sphere{{0, 0, 3}, 0.3}, Color{0.5f}));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1});
    return see(scene);
}

// The pixel's centre ray, and a place that the picture's given pixel shows, moved to `depth` times its
// distance.
constexpr int px = size / 2 + 9, py = size / 2 + 3;
Vec3 along_pixel(const Picture& p, double depth) {
    const Ray ray = pixel_ray(p.gbuffer.view, {px + 0.5, py + 0.5});
    return ray.origin + ray.direction * (depth * static_cast<double>(p.gbuffer.seen.at(px, py).z));
}
Vec3 toward_viewer(const Picture& p) { return Vec3(p.gbuffer.seen.at(px, py).toward_viewer); }

int count_sources(const SparseMap& sparse) {
    int count = 0;
    for (const SourcePixel& s : sparse.pixels) count += s.photon >= 0 ? 1 : 0;
    return count;
}

TEST(SparseMap, PhotonsBehindAnotherObjectOrOnTheFarSideDoNotComeThrough) {
    const Picture p = ball_behind_a_ball();
    ASSERT_EQ(p.gbuffer.seen.at(px, py).object, 1u);
    const Vec3 centre = Vec3(0, 0, 5) - p.world.offset;
    PhotonMap map;
    add_photon(map, 1, centre + Vec3(0, 0, -1), {0, 0, -1}); // the small ball stands before it
    const Vec3 far_side = glm::normalize(Vec3(0.9, 0, 0.4));
    add_photon(map, 1, centre + far_side, far_side);  // turned away
    add_photon(map, 1, centre + far_side, -far_side); // on the inside of the far wall
    add_photon(map, 2, along_pixel(p, 1),
               toward_viewer(p)); // another object's, where the painted one is seen
    EXPECT_EQ(count_sources(make_sparse_map(p.world, p.gbuffer, map, {})), 0);
    add_photon(map, 1, along_pixel(p, 1), toward_viewer(p));
    const SparseMap sparse = make_sparse_map(p.world, p.gbuffer, map, {});
    EXPECT_EQ(count_sources(sparse), 1);
    EXPECT_EQ(sparse.at(px, py).photon, 4);
    EXPECT_EQ(sparse.at(px, py).object, 1u);
    EXPECT_EQ(sparse.at(px, py).via, 0u);
}

TEST(SparseMap, TwoPercentOfDepth) {
    const Picture p = ball_behind_a_ball();
    for (const auto& [depth, expected] : {std::pair{0.979, 0}, {0.981, 1}, {1.019, 1}, {1.021, 0}}) {
        PhotonMap map;
        add_photon(map, 1, along_pixel(p, depth), toward_viewer(p));
        EXPECT_EQ(count_sources(make_sparse_map(p.world, p.gbuffer, map, {})), expected) << depth;
    }
}

TEST(SparseMap, TheNearestWinsAndOfEqualsTheLowerIndex) {
    const Picture p = ball_behind_a_ball();
    PhotonMap map;
    for (const double depth : {1.012, 1.004, 1.0, 1.0, 1.008})
        add_photon(map, 1, along_pixel(p, depth), toward_viewer(p));
    const SparseMap sparse = make_sparse_map(p.world, p.gbuffer, map, {});
    EXPECT_EQ(count_sources(sparse), 1);
    EXPECT_EQ(sparse.at(px, py).photon, 2);
    EXPECT_NEAR(sparse.at(px, py).z, p.gbuffer.seen.at(px, py).z, 1e-5);
    EXPECT_NEAR(glm::distance(sparse.at(px, py).at, Vec2f(px + 0.5f, py + 0.5f)), 0, 1e-4);
}

// A mirror before the camera shows a painted ball behind it; a lamp.
constexpr double mirror_z = 4;
const Vec3 ball_centre(0.5, 0.3, -6);
Picture ball_in_a_mirror() {
    Scene scene;
    scene.objects.push_back(test::mirror(Box{{-5, -5, mirror_z}, {5, 5, 5}}, 0.8f));
    scene.objects.push_back(test::painted(test::matt(Sphere{ball_centre, 1.5}, Color{0.5f})));
    scene.lights.push_back(test::emitter(EmitterShape::sphere, {3, 4, 0}, 0.5, 20));
    scene.camera = test::look({0, 0, 0}, {0, 0, 1}, 0.4);
    return see(scene);
}

PhotonMap photons_on_ball(const Picture& p, int count) {
    PhotonMap map;
    Rng rng = make_rng(5, Pass::test, 0);
    for (int i = 0; i < count; ++i) {
        const double z = 2 * rng.uniform() - 1, angle = 2 * pi * rng.uniform(), r = std::sqrt(1 - z * z);
        const Vec3 n(r * std::cos(angle), r * std::sin(angle), z);
        add_photon(map, 2, ball_centre - p.world.offset + 1.5 * n, n);
    }
    return map;
}

// Where the camera sees the mirrored copy of a place.
Projected see_mirrored(const Picture& p, Vec3 place) {
    const double plane = mirror_z - p.world.offset.z;
    return project(p.gbuffer.view, {place.x, place.y, 2 * plane - place.z}).value();
}

TEST(SparseMap, AMirrorShowsSourcesAndStrokesOfTheMirroredBall) {
    const Picture p = ball_in_a_mirror();
    const PhotonMap map = photons_on_ball(p, 6000);
    SparseMap sparse = make_sparse_map(p.world, p.gbuffer, map, {});
    std::vector<Vec3f> oriented; // tangents of every slant
    for (std::size_t i = 0; i < map.normals.size(); ++i) {
        Rng rng = make_rng(6, Pass::test, i);
        const Frame frame = make_frame(Vec3(map.normals[i]));
        const double angle = 2 * pi * rng.uniform();
        oriented.emplace_back(frame.x * std::cos(angle) + frame.y * std::sin(angle));
    }
    orient_strokes(sparse, p.world, p.gbuffer, map, oriented);
    int sources = 0, lit = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const SourcePixel& s = sparse.at(x, y);
            if (s.photon < 0) continue;
            ++sources;
            lit += s.radiance.y > 0 ? 1 : 0;
            EXPECT_EQ(s.object, 2u);
            EXPECT_EQ(s.via, 1u);
            const auto photon = static_cast<std::size_t>(s.photon);
            const Vec3 place(map.photons[photon].position), axis(oriented[photon]);
            const Projected mirrored = see_mirrored(p, place);
            // On slanted places the ball bends away from the footprint's plane, and "nearest seen point" is
            // not quite the pixel.
            const Seen& seen = p.gbuffer.seen.at(x, y);
            if (glm::dot(seen.normal, seen.toward_viewer) < 0.5f) continue;
            EXPECT_NEAR(glm::distance(mirrored.pixel, Vec2(s.at)), 0, 0.05);
            EXPECT_NEAR(s.z, mirrored.distance, 0.01);
            const double e = 1e-5;
            const Vec2 step = (see_mirrored(p, place + e * axis).pixel - mirrored.pixel) / e;
            const Vec2 direction = glm::normalize(step);
            EXPECT_GT(std::abs(glm::dot(direction, Vec2(s.direction))), std::cos(3 * pi / 180))
                << x << ' ' << y;
            EXPECT_TRUE(s.direction.x > 0 || (s.direction.x == 0 && s.direction.y > 0));
        }
    }
    EXPECT_GT(sources, 500);
    EXPECT_GT(lit, 100);
}

TEST(SparseMap, ARegionWithoutAPhotonCarriesItsOwnLight) {
    const Picture p = ball_in_a_mirror();
    for (const bool some : {false, true}) {
        const PhotonMap map = some ? photons_on_ball(p, 6000) : PhotonMap{};
        const SparseMap sparse = make_sparse_map(p.world, p.gbuffer, map, {});
        EXPECT_EQ(count_sources(sparse) > 0, some);
        int carried = 0, painted = 0;
        for (std::size_t i = 0; i < sparse.pixels.size(); ++i) {
            painted += is_painted(p.gbuffer.seen.pixels[i]) ? 1 : 0;
            if (sparse.pixels[i].photon >= 0 || sparse.pixels[i].object == 0) continue;
            ++carried;
            EXPECT_TRUE(is_painted(p.gbuffer.seen.pixels[i]));
        }
        EXPECT_EQ(carried, some ? 0 : painted);
        float brightest = 0;
        for (const SourcePixel& s : sparse.pixels) brightest = std::max(brightest, s.radiance.y);
        EXPECT_GT(brightest, 0);
    }
}

TEST(SparseMap, TheSameForAnyNumberOfThreads) {
    const Picture p = ball_in_a_mirror();
    PhotonMap map = photons_on_ball(p, 9000); // more than one chunk
    build_photon_tree(map);
    const auto make = [&](int threads) {
        const ThreadLimit limit(threads);
        return make_sparse_map(p.world, p.gbuffer, map, {});
    };
    const SparseMap one = make(1), two = make(2);
    EXPECT_GT(count_sources(one), 500);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        const SourcePixel &a = one.pixels[i], &b = two.pixels[i];
        EXPECT_EQ(std::tie(a.photon, a.radiance, a.at, a.z), std::tie(b.photon, b.radiance, b.at, b.z));
    }
}

} // namespace
} // namespace pnr
