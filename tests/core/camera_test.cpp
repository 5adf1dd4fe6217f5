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
