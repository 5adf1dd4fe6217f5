// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/world.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pnr {
namespace {

Object object_of(Shape shape) {
    Object object;
    object.shape = std::move(shape);
    object.texture = Texture{};
    return object;
}

Scene scene_of(std::vector<Object> objects) {
    Scene scene;
    scene.objects = std::move(objects);
    return scene;
}

Mesh mesh_of(std::vector<Vec3f> positions, std::vector<std::array<std::uint32_t, 3>> triangles) {
    auto data = std::make_shared<MeshData>();
    data->positions = std::move(positions);
    data->triangles = std::move(triangles);
    Mesh mesh;
    mesh.data = std::move(data);
    return mesh;
}

Mesh tetrahedron() {
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

TEST(BuildWorld, NumbersObjectsInTheOrderOfTheText) {
    Object first = object_of(Sphere{}), second, third = object_of(Box{});
    PaintWord word;
    word.on = true;
    Object plain = object_of(Sphere{{3, 0, 0}, 1}), painted = object_of(Sphere{{6, 0, 0}, 1}),
           last = object_of(Sphere{{9, 0, 0}, 1});
    painted.npr = word;
    second.children = {plain, painted, last};
    third.transform = translation({-5, 0, 0});
    const World world = build_world(scene_of({first, second, third}), {});
    ASSERT_EQ(world.objects.size(), 5u); // nothing, sphere, union, painted child, box
    EXPECT_EQ(world.objects[2].name, "union");
    EXPECT_TRUE(world.objects[3].npr);
    EXPECT_EQ(world.objects[4].name, "box");
    const int expected[] = {1, 2, 3, 2, 4};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(world.surfaces[i].object, expected[i]) << i;
    EXPECT_TRUE(world.has_paint);
    EXPECT_EQ(world.illumination, Illumination::photon_mapped);
}

TEST(BuildWorld, ChildrenInheritWhatTheyDoNotSay) {
    Object group, child = object_of(Sphere{});
    child.texture.reset();
    Texture red;
    red.pigment.map[0].color.rgb = {1, 0, 0};
    group.texture = red;
    group.interior = Interior{1.5, 0, 0, Color(0)};
    PaintWord on, off;
    on.on = true;
    group.npr = on;
    Object unpainted = child;
    unpainted.npr = off;
    group.children = {child, unpainted};
    const World world = build_world(scene_of({group}), {});
    const Material& material = world.materials[static_cast<std::size_t>(world.surfaces[0].material)];
    EXPECT_EQ(material.texture.pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_EQ(material.interior.ior, 1.5);
    EXPECT_EQ(world.surfaces[0].object, 1);
    EXPECT_EQ(world.surfaces[1].object, 2);
    EXPECT_TRUE(world.objects[1].npr);
    EXPECT_FALSE(world.objects[2].npr);
}

TEST(BuildWorld, CenterAndRadiusHoldWhatIsBounded) {
    Scene scene = scene_of({object_of(Sphere{{100, 0, 0}, 1}), object_of(Plane{})});
    scene.lights.emplace_back();
    scene.lights[0].position = {100, 4, 0};
    const World world = build_world(scene, {});
    EXPECT_NEAR(world.offset.x, 100, 1e-12);
    EXPECT_NEAR(world.offset.y, 1.5, 1e-12);
    EXPECT_NEAR(world.lights[0].said.position.y, 2.5, 1e-12);
    EXPECT_GE(world.radius, glm::length(Vec3(1, 2.5, 1)) - 1e-12);
    EXPECT_LT(world.radius, 3);
}

TEST(BuildWorld, IlluminationFollowsWhatTheSceneSays) {
    Scene scene = scene_of({object_of(Sphere{})});
    Settings settings;
    EXPECT_EQ(build_world(scene, settings).illumination, Illumination::raytraced);
    settings.photons.wanted = true;
    EXPECT_EQ(build_world(scene, settings).illumination, Illumination::caustics);
    settings.photons.global = true;
    EXPECT_EQ(build_world(scene, settings).illumination, Illumination::photon_mapped);
    settings.photons = {};
    scene.radiosity = true;
    EXPECT_EQ(build_world(scene, settings).illumination, Illumination::photon_mapped);
    scene.radiosity = false;
    scene.lights.emplace_back();
    scene.lights[0].position = {0, 5, 0};
    scene.lights[0].emitter = Emitter{};
    EXPECT_EQ(build_world(scene, settings).illumination, Illumination::photon_mapped);
}

TEST(BuildWorld, EmittersAreBlackSurfacesOfTheirLight) {
    Scene scene = scene_of({object_of(Plane{})});
    const Vec3 center(0, 3, 0);
    for (const EmitterShape shape :
         {EmitterShape::sphere, EmitterShape::hemisphere, EmitterShape::disc, EmitterShape::rectangle}) {
        scene.lights.clear();
        LightSource light;
        light.position = center;
        light.emitter = Emitter{};
        light.emitter->shape = shape;
        light.emitter->axis = {0, -1, 0};
        light.emitter->u = {2, 0, 0};
        light.emitter->v = {0, 0, 2}; // cross(u, v) = -y * 4
        light.no_image = true;
        scene.lights = {light};
        const World world = build_world(scene, {});
        const Ray up{Vec3(0.25, 0.5, 0.125) - world.offset, {0, 1, 0}, 0, infinity};
        const auto hit = closest_hit(world, up, RayKind::photon);
        ASSERT_TRUE(hit);
        const Surface& surface = world.surfaces[hit->surface];
        EXPECT_EQ(surface.light, 0);
        EXPECT_EQ(surface.object, 0);
        EXPECT_EQ(surface.material, 0);
        EXPECT_LT(hit->normal.y, -0.5);
        EXPECT_FALSE(closest_hit(world, up, RayKind::camera)) << "no_image hides it from the camera alone";
        EXPECT_TRUE(is_occluded(world, up, RayKind::shadow));
        // From above: a hemisphere has no lid, so the inside of its dome is met; all others at their own
        // place.
        const Ray down{Vec3(0.25, 9, 0.125) - world.offset, {0, -1, 0}, 0, infinity};
        const auto from_above = closest_hit(world, down, RayKind::photon);
        ASSERT_TRUE(from_above);
        const double y = from_above->position.y + world.offset.y;
        const double dome = std::sqrt(1 - 0.25 * 0.25 - 0.125 * 0.125);
        const double expected = shape == EmitterShape::sphere       ? 3 + dome
                                : shape == EmitterShape::hemisphere ? 3 - dome
                                                                    : 3;
        EXPECT_NEAR(y, expected, 1e-12);
    }
}

TEST(BuildWorld, RefusesWhatIsNotFinite) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity}) {
        Object object = object_of(Sphere{{0, bad, 0}, 1});
        object.said_at = {"a.pnr", 7, 3};
        try {
            build_world(scene_of({object}), {});
            FAIL() << "a scene with " << bad << " was built";
        } catch (const SceneError& error) {
            EXPECT_EQ(error.said_at.line, 7);
        }
        object = object_of(Sphere{});
        object.transform.edit().matrix[3][0] = bad;
        EXPECT_THROW(build_world(scene_of({object}), {}), SceneError);
        EXPECT_THROW(
            build_world(scene_of({object_of(mesh_of({{0, 0, 0}, {bad, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}))}), {}),
            SceneError);
    }
    EXPECT_THROW(build_world(scene_of({object_of(mesh_of({{0, 0, 0}}, {{0, 1, 2}}))}), {}), SceneError);
}

TEST(BuildWorld, DegenerateThingsAreNeverHit) {
    const World world = build_world(
        scene_of({object_of(Sphere{{0, 0, 0}, 0}), object_of(Cylinder{{0, 0, 0}, {0, 0, 0}, 1, false}),
                  object_of(Cone{{0, 0, 0}, {0, 1, 0}, 0, 0, false}), object_of(Torus{0, 0}),
                  object_of(Disc{{0, 0, 0}, {0, 1, 0}, 0, 0}), object_of(mesh_of({}, {})),
                  object_of(mesh_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}, {0, 0, 1}})),
                  object_of(BicubicPatch{})}),
        {});
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 origin = 4.0 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
        const Vec3 target = 0.5 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
        EXPECT_FALSE(
            closest_hit(world, {origin, glm::normalize(target - origin), 0, infinity}, RayKind::photon));
    }
    EXPECT_FALSE(closest_hit(build_world({}, {}), {}, RayKind::camera));
}

TEST(ClosestHit, FlagsHideSurfacesFromTheirRays) {
    for (int flag = 0; flag < 3; ++flag) {
        for (const bool mesh : {false, true}) {
            Object object = mesh ? object_of(tetrahedron()) : object_of(Box{});
            object.no_image = flag == 0;
            object.no_reflection = flag == 1;
            object.no_shadow = flag == 2;
            const World world = build_world(scene_of({object, object_of(Plane{})}), {});
            const Ray ray{Vec3(0.2, 5, 0.2) - world.offset, {0, -1, 0}, 0, 4.9};
            EXPECT_EQ(closest_hit(world, ray, RayKind::camera).has_value(), flag != 0);
            EXPECT_EQ(closest_hit(world, ray, RayKind::specular).has_value(), flag != 1);
            EXPECT_EQ(is_occluded(world, ray, RayKind::shadow), flag != 2);
            EXPECT_TRUE(closest_hit(world, ray, RayKind::photon).has_value());
        }
    }
}

// The same small scene in the middle, far away, tiny and huge: each kind of surface, seen from random places.
TEST(ClosestHit, IsTheSameSceneAtAnyPlaceAndSize) {
    struct Placed {
        double scale;
        Vec3 shift;
    };
    const auto build = [](Placed p) {
        Scene scene;
        for (const Shape& shape : {Shape(Sphere{}), Shape(Box{{2, 0, 0}, {3, 1, 2}}), Shape(Torus{1, 0.25}),
                                   Shape(Cone{{0, 0, 3}, {0, 2, 3}, 1, 0.5, false}), Shape(tetrahedron())}) {
            Object object = object_of(shape);
            if (std::holds_alternative<Torus>(shape)) object.transform = translation({0, 2, 0});
            if (std::holds_alternative<Mesh>(shape)) object.transform = translation({-3, 0, 0});
            object.transform = then(then(object.transform, scaling(Vec3(p.scale))), translation(p.shift));
            scene.objects.push_back(object);
        }
        return build_world(scene, {});
    };
    const World reference = build({1, {0, 0, 0}});
    for (const Placed p : {Placed{1e-6, {0, 0, 0}}, Placed{1e6, {0, 0, 0}}, Placed{1, {1e6, -1e6, 1e6}}}) {
        const World world = build(p);
        EXPECT_NEAR(world.radius / p.scale, reference.radius, 1e-6);
        Rng rng = make_rng(2, Pass::test, 0);
        int hits = 0;
        for (int i = 0; i < 4000; ++i) {
            const auto point = [&] {
                return 6.0 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
            };
            const Vec3 from = 2.0 * point();
            const Vec3 direction = glm::normalize(point() - from);
            const auto expected = closest_hit(reference, {from, direction, 0, infinity}, RayKind::camera);
            const auto got = closest_hit(world, {from * p.scale, direction, 0, infinity}, RayKind::camera);
            if (expected.has_value() != got.has_value()) continue; // a ray along an outline: counted below
            if (!expected) continue;
            ++hits;
            if (expected->primitive != got->primitive) continue;
            EXPECT_NEAR(got->t / p.scale, expected->t, 2e-6);
            EXPECT_LT(glm::length(got->position / p.scale - expected->position), 4e-6);
        }
        EXPECT_GT(hits, 500);
    }
}

// A ray that leaves a surface outwards does not meet it again at once, and one that goes through meets the
// far side.
TEST(Leave, NeverMeetsTheSurfaceItLeaves) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (const Shape& shape :
             {Shape(Sphere{}), Shape(Box{{-1, -1, -1}, {1, 1, 1}}),
              Shape(Cylinder{{0, -1, 0}, {0, 1, 0}, 1, false}),
              Shape(Cone{{0, -1, 0}, {0, 1, 0}, 1, 0.2, false}), Shape(tetrahedron())}) { // all convex
            Object object = object_of(shape);
            object.transform = then(rotation({10, 20, 30}), scaling(Vec3(scale)));
            const World world = build_world(scene_of({object}), {});
            Rng rng = make_rng(3, Pass::test, 0);
            int left = 0;
            for (int i = 0; i < 5000; ++i) {
                const auto point = [&] {
                    return Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
                };
                const Vec3 from = 10 * world.radius * glm::normalize(point());
                const Vec3 to = world.radius * point();
                const auto hit =
                    closest_hit(world, {from, glm::normalize(to - from), 0, infinity}, RayKind::camera);
                if (!hit) continue;
                ++left;
                Vec3 direction = glm::normalize(point());
                if (glm::dot(direction, hit->normal) < 0) direction = -direction;
                if (i % 2)
                    direction = glm::normalize(direction -
                                               (1 - 1e-9) * glm::dot(direction, hit->normal) * hit->normal);
                EXPECT_FALSE(closest_hit(world, leave(*hit, direction), RayKind::photon))
                    << shape_name(shape) << i;
                const Ray inwards = leave(*hit, glm::normalize(to - from));
                EXPECT_TRUE(closest_hit(world, inwards, RayKind::photon).has_value() ||
                            glm::dot(direction, hit->normal) > 0);
            }
            EXPECT_GT(left, 500) << shape_name(shape);
        }
    }
}

TEST(Connect, EndsShortOfThePoint) {
    const World world =
        build_world(scene_of({object_of(Sphere{{0, 0, 0}, 1}), object_of(Sphere{{4, 0, 0}, 1})}), {});
    const auto a =
        closest_hit(world, {Vec3(2, 0, 0) - world.offset, {-1, 0, 0}, 0, infinity}, RayKind::camera);
    const auto b =
        closest_hit(world, {Vec3(2, 0, 0) - world.offset, {1, 0, 0}, 0, infinity}, RayKind::camera);
    ASSERT_TRUE(a && b);
    const Ray between = connect(*a, b->position, b->error);
    EXPECT_NEAR(between.t_max, 2, 1e-9);
    EXPECT_LT(between.t_max, 2);
    EXPECT_FALSE(is_occluded(world, between, RayKind::shadow));
    const Ray through = connect(*a, Vec3(6, 0, 0) - world.offset);
    EXPECT_TRUE(is_occluded(world, through, RayKind::shadow));
}

} // namespace
} // namespace pnr
