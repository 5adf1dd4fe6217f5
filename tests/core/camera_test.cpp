// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera.h"

#include "core/rng.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

PictureView skew_view(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.location = {3, 4, -5};
    camera.direction = {-0.6, -0.3, 1.1};
    camera.right = {1.4, 0.1, 0.6}; // neither orthogonal nor of equal length
    camera.up = {0.1, 1.2, 0.2};
    return {camera, 320, 200};
}

TEST(Project, IsTheInverseOfPixelRay) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const PictureView view = skew_view(projection);
        Rng rng = make_rng(1, Pass::test, 0);
        for (int i = 0; i < 1000; ++i) {
            const Vec2 pixel(320 * (2 * rng.uniform() - 0.5),
                             200 * (2 * rng.uniform() - 0.5)); // also off the picture
            const Ray ray = pixel_ray(view, pixel);
            EXPECT_NEAR(glm::length(ray.direction), 1, 1e-14);
            const double distance = 0.1 + 100 * rng.uniform();
            const auto seen = project(view, ray.origin + distance * ray.direction);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->pixel.x, pixel.x, 1e-8);
            EXPECT_NEAR(seen->pixel.y, pixel.y, 1e-8);
            if (projection == Projection::perspective) {
                EXPECT_NEAR(seen->distance, distance, 1e-10);
            }
            EXPECT_FALSE(project(view, ray.origin - distance * ray.direction)) << "behind the camera";
        }
    }
}

// A camera of a curved type, turned and moved.
PictureView curved_view(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.location = {3, 4, -5};
    camera.direction = {0, 0.6, 0.8};
    camera.right = {4.0 / 3, 0, 0};
    camera.up = {0, 0.8, -0.6};
    camera.h_angle = 150;
    camera.v_angle = projection == Projection::ultra_wide_angle ? 112.5
                     : projection == Projection::spherical      ? 75
                                                                : 150;
    return {camera, 320, 240};
}

TEST(Project, IsTheInverseOfCurvedCamerasToo) {
    for (const Projection projection :
         {Projection::fisheye, Projection::ultra_wide_angle, Projection::omnimax, Projection::panoramic,
          Projection::spherical, Projection::cylinder_1, Projection::cylinder_2, Projection::cylinder_3,
          Projection::cylinder_4}) {
        const PictureView view = curved_view(projection);
        Rng rng = make_rng(3, Pass::test, 0);
        int seen_pixels = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec2 pixel(320 * rng.uniform(), 240 * rng.uniform());
            const Ray ray = pixel_ray(view, pixel);
            if (sees_nothing(ray)) continue;
            ++seen_pixels;
            const double distance = 0.1 + 100 * rng.uniform();
            const Vec3 point = ray.origin + distance * ray.direction;
            const auto seen = project(view, point);
            ASSERT_TRUE(seen) << static_cast<int>(projection);
            EXPECT_LT(glm::length(seen->pixel - pixel), 1e-6) << static_cast<int>(projection);
            EXPECT_NEAR(seen->distance, distance, 1e-9);
            // Sideways: the pixel moves as the point does.
            const Vec3 along = glm::normalize(glm::cross(ray.direction, Vec3(0.3, 0.5, 0.7)));
            const double step = 1e-5 * distance;
            const auto there = project(view, point + step * along), back = project(view, point - step * along);
            if (!there || !back) continue;
            const Vec2 moved = (there->pixel - back->pixel) / (2 * step);
            const Vec2 found = project_direction(view, point, along);
            EXPECT_LT(glm::length(found - moved), 1e-3 * (1 + glm::length(moved)))
                << static_cast<int>(projection);
        }
        EXPECT_GT(seen_pixels, 250) << static_cast<int>(projection);
    }
}

// Read from pictures of POV-Ray 3.7.0.10: a sphere about the camera whose colour is the direction, 16 x 12,
// angle 150.
TEST(PixelRay, CurvedCamerasSeeWherePovRaysDo) {
    struct Case {
        Projection projection;
        Vec2 pixel;
        Vec3 direction;
    };
    const Case cases[] = {
        {Projection::fisheye, {4.5, 3.5}, {-0.6564, 0.4688, 0.5911}},
        {Projection::ultra_wide_angle, {15.5, 0.5}, {0.7577, 0.6304, 0.1685}},
        {Projection::omnimax, {4.5, 6.5}, {-0.5905, 0.2026, 0.7812}},
        {Projection::omnimax, {8.5, 0.5}, {0.0686, 0.9879, 0.1395}},
        {Projection::panoramic, {11.5, 0.5}, {0.1101, 0.9888, 0.1006}},
        {Projection::spherical, {15.5, 3.5}, {0.9067, 0.2693, 0.3245}},
        {Projection::cylinder_1, {0.5, 0.5}, {-0.8559, 0.4166, 0.3063}},
        {Projection::cylinder_2, {11.5, 3.5}, {0.2800, 0.4980, 0.8207}},
    };
    for (const Case& c : cases) {
        PictureView view = curved_view(c.projection);
        view.camera.location = Vec3(0);
        view.camera.direction = {0, 0, 1}, view.camera.up = {0, 1, 0};
        view.width = 16, view.height = 12;
        const Ray ray = pixel_ray(view, c.pixel);
        ASSERT_FALSE(sees_nothing(ray));
        EXPECT_LT(glm::length(ray.direction - c.direction), 3e-3) << static_cast<int>(c.projection);
    }
    EXPECT_TRUE(sees_nothing(pixel_ray(curved_view(Projection::fisheye), {0.5, 0.5})))
        << "outside the circle";
}

TEST(LensRay, MeetsThePinholesRayOnTheFocalPlane) {
    PictureView view;
    view.width = 40, view.height = 30;
    view.camera.lens.aperture = 0.8;
    view.camera.lens.distance = 7;
    const Ray pinhole = pixel_ray(view, {31, 4});
    const Vec3 sharp = pinhole.origin + pinhole.direction * (7 / pinhole.direction.z);
    for (const Vec2 u : {Vec2(1, 0), Vec2(-0.3, 0.6), Vec2(0, -1)}) {
        const Ray ray = lens_ray(view, {31, 4}, u);
        EXPECT_NEAR(glm::length(ray.origin), 0.2 * glm::length(u), 1e-12) << "the radius is aperture / 4";
        EXPECT_NEAR(glm::length(ray.origin + ray.direction * ((7 - ray.origin.z) / ray.direction.z) - sharp), 0,
                    1e-12);
    }
}

TEST(PixelRay, CornersAndAxesArePovRays) {
    PictureView view;
    view.width = 40, view.height = 30;
    const auto passes = [&](Vec2 pixel, Vec3 expected) {
        const Vec3 d = pixel_ray(view, pixel).direction;
        EXPECT_NEAR(glm::length(d - glm::normalize(expected)), 0, 1e-15);
    };
    passes({20, 15}, {0, 0, 1});
    passes({0, 0}, {-0.665, 0.5, 1}); // top left: y goes up in space, down in the picture
    passes({40, 30}, {0.665, -0.5, 1});
}

TEST(ProjectDirection, IsTheDerivativeOfProject) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const PictureView view = skew_view(projection);
        Rng rng = make_rng(2, Pass::test, 0);
        for (int i = 0; i < 200; ++i) {
            const Ray ray = pixel_ray(view, {320 * rng.uniform(), 200 * rng.uniform()});
            const Vec3 point = ray.origin + (1 + 10 * rng.uniform()) * ray.direction;
            const Vec3 along(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
            const double h = 1e-5;
            const Vec2 difference =
                (project(view, point + h * along)->pixel - project(view, point - h * along)->pixel) / (2 * h);
            const Vec2 derivative = project_direction(view, point, along);
            EXPECT_LT(glm::length(difference - derivative), 1e-5 * (1 + glm::length(derivative)));
        }
    }
}

TEST(Project, DegenerateCameraSeesNothing) {
    PictureView view;
    view.camera.right = view.camera.up;
    EXPECT_FALSE(project(view, {0, 0, 5}));
    EXPECT_EQ(project_direction(view, {0, 0, 5}, {1, 0, 0}), Vec2(0));
}

TEST(DefaultSize, Is512WideWithTheCamerasRatio) {
    Camera camera;
    EXPECT_EQ(default_size(camera).width, 512);
    EXPECT_EQ(default_size(camera).height, 385); // 512 / 1.33
    camera.right = {1, 0, 0};
    EXPECT_EQ(default_size(camera).height, 512);
    camera.right = {0, 0, 0};
    EXPECT_EQ(default_size(camera).height, 512);
}

} // namespace
} // namespace pnr
