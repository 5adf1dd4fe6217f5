// SPDX-License-Identifier: GPL-3.0-or-later
// Small scenes whose light is known, for the tests of the passes.
#pragma once

#include "core/scene.h"
#include "core/settings.h"
#include "core/world.h"

namespace pnr::test {

inline Pigment plain(Color rgb, float filter = 0) {
    Pigment pigment;
    pigment.map = {{0, {rgb, filter, 0}}};
    return pigment;
}

inline Object matt(Shape shape, Color albedo) {
    Object object;
    object.shape = std::move(shape);
    Texture texture;
    texture.pigment = plain(albedo);
    texture.finish.ambient = Color{0};
    texture.finish.diffuse = 1;
    object.texture = texture;
    return object;
}

inline Object mirror(Shape shape, float reflectance) {
    Object object = matt(std::move(shape), Color{0});
    object.texture->finish.diffuse = 0;
    object.texture->finish.reflection.min = object.texture->finish.reflection.max = Color{reflectance};
    return object;
}

inline Object glass(Shape shape, double ior = 1.5) {
    Object object = matt(std::move(shape), Color{1});
    object.texture->pigment = plain(Color{1}, 1);
    object.texture->finish.diffuse = 0;
    object.interior = Interior{};
    object.interior->ior = ior;
    return object;
}

inline LightSource emitter(EmitterShape shape, Vec3 position, double size, double radiance,
                           Vec3 axis = {0, -1, 0}) {
    LightSource light;
    light.position = position;
    light.emitter = Emitter{};
    light.emitter->shape = shape;
    light.emitter->radius = size;
    light.emitter->axis = axis;
    light.emitter->radiance = radiance;
    return light;
}

// A rectangle of edges 2 a (along x) and 2 b (along z) that shines down.
inline LightSource ceiling_lamp(Vec3 position, double a, double b, double radiance) {
    LightSource light = emitter(EmitterShape::rectangle, position, 1, radiance);
    light.emitter->u = {2 * a, 0, 0};
    light.emitter->v = {0, 0, 2 * b};
    if (glm::cross(light.emitter->u, light.emitter->v).y > 0) std::swap(light.emitter->u, light.emitter->v);
    return light;
}

inline Object painted(Object object, double mix = 1) {
    object.npr = PaintWord{};
    object.npr->on = true;
    object.npr->style.mix = mix;
    return object;
}

inline Camera look(Vec3 from, Vec3 to, double width_over_distance = 1) {
    Camera camera;
    camera.location = from;
    camera.direction = glm::normalize(to - from);
    const Vec3 sky = std::abs(camera.direction.y) > 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    camera.right = glm::normalize(glm::cross(sky, camera.direction)) * width_over_distance;
    camera.up = glm::normalize(glm::cross(camera.direction, camera.right)) * width_over_distance;
    return camera;
}

// The inside of a white sphere of radius R about an emitter of radius r: the radiance of the wall is
// rho Le q / (1 - rho (1 - q)), q = (r / R)^2, everywhere.
inline Scene furnace(double wall_radius, double emitter_radius, float albedo, double radiance) {
    Scene scene;
    scene.objects.push_back(matt(Sphere{{0, 0, 0}, wall_radius}, Color{albedo}));
    scene.lights.push_back(emitter(EmitterShape::sphere, {0, 0, 0}, emitter_radius, radiance));
    scene.camera = look({0, 0, -0.75 * wall_radius}, {0.6 * wall_radius, 0, 0});
    return scene;
}
inline double furnace_radiance(double wall_radius, double emitter_radius, double albedo, double radiance) {
    const double q = emitter_radius * emitter_radius / (wall_radius * wall_radius);
    return albedo * radiance * q / (1 - albedo * (1 - q));
}

// A box 10 x 10 x 20 without its front wall, a lamp of 2 x 2 under its ceiling (radiance 40), one red and one
// green wall.
inline Scene paper_box() {
    Scene scene;
    const Color white{0.75f}, red{0.75f, 0.1f, 0.1f}, green{0.1f, 0.75f, 0.1f};
    const auto wall = [&](Vec3 low, Vec3 high, Color c) { scene.objects.push_back(matt(Box{low, high}, c)); };
    wall({-5.1, -0.1, 0}, {5.1, 0, 20}, white);  // floor
    wall({-5.1, 10, 0}, {5.1, 10.1, 20}, white); // ceiling
    wall({-5.1, 0, 20}, {5.1, 10, 20.1}, white); // back
    wall({-5.1, 0, 0}, {-5, 10, 20}, red);       // left
    wall({5, 0, 0}, {5.1, 10, 20}, green);       // right
    scene.lights.push_back(ceiling_lamp({0, 9.9, 14}, 1, 1, 40));
    scene.camera = look({0, 5, -13}, {0, 5, 10}, 0.75);
    return scene;
}

inline Settings small_settings(int width, int height) {
    Settings settings;
    settings.render.width = width;
    settings.render.height = height;
    return settings;
}

} // namespace pnr::test
