// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/parser/scene_text.h"

#include <array>

namespace pnr {
namespace {

Camera camera_of(const std::string& items) { return scene_of("camera { " + items + " }").camera; }

TEST(ParseCamera, DefaultsArePovRays) {
    const Camera c = camera_of("");
    expect_near(c.location, {0, 0, 0});
    expect_near(c.direction, {0, 0, 1});
    expect_near(c.right, {1.33, 0, 0});
    expect_near(c.up, {0, 1, 0});
}

TEST(ParseCamera, LookAtTurnsTheFrameAboutTheSky) { // 3-4-5 triangle, by hand
    const Camera c = camera_of("location <0, 3, -4> look_at 0");
    expect_near(c.direction, {0, -0.6, 0.8});
    expect_near(c.right, {1.33, 0, 0});
    expect_near(c.up, {0, 0.8, 0.6});
}

TEST(ParseCamera, AngleIsAcrossTheWholeWidth) {
    expect_near(camera_of("angle 90 right 2*x").direction, {0, 0, 1});
    expect_near(camera_of("right 2*x angle 90 direction 7*z").direction, {0, 0, 1});
}

TEST(ParseCamera, OrderOfItemsDoesNotMatter) {
    const Camera a =
        camera_of("location <1, 2, -3> sky <0.2, 1, 0> right 1.6*x angle 40 look_at <-1, 0.5, 2>");
    const Camera b =
        camera_of("look_at <-1, 0.5, 2> angle 40 right 1.6*x sky <0.2, 1, 0> location <1, 2, -3>");
    expect_near(a.direction, b.direction);
    expect_near(a.right, b.right);
    expect_near(a.up, b.up);
}

TEST(ParseCamera, AMirroredFrameStaysMirrored) {
    expect_near(camera_of("right -2*x location -5*z look_at 0").right, {-2, 0, 0});
}

// Where rays through three pixels of a 4 x 3 picture meet the walls of the room [-10, 10]^3: measured with
// POV-Ray 3.7.0.10, to 16 bits of 20 units.
struct Measured {
    const char* items;
    std::array<Vec3, 3> hits; // pixels (0, 0), (3, 0), (1, 2)
};

Vec3 room_hit(const Ray& ray) {
    double t = infinity;
    for (int i = 0; i < 3; ++i)
        if (ray.direction[i] != 0)
            t = std::min(t, ((ray.direction[i] > 0 ? 10 : -10) - ray.origin[i]) / ray.direction[i]);
    return ray.origin + t * ray.direction;
}

// Not pixel_ray: this is the definition.
Ray ray_of(const Camera& c, double x, double y) {
    const Vec3 offset = c.right * (x / 4 - 0.5) + c.up * (0.5 - y / 3);
    if (c.projection == Projection::orthographic) return {c.location + offset, c.direction};
    return {c.location, c.direction + offset};
}

TEST(ParseCamera, SeesWhatPovRaySees) {
    const Measured cases[] = {
        {"look_at <-1, 0.5, 2> rotate <10, 20, 30> location <1.5, 2, -3> angle 40 right 1.6*x up <0, 1.2, "
         "0.1> "
         "sky <0.2, 1, 0.1> translate <0.5, -0.7, 0.3>",
         {Vec3(-3.08278, -2.42573, 10), Vec3(3.74899, -0.74022, 10), Vec3(0.33707, -7.45022, 10)}},
        {"orthographic location <1, 2, -3> look_at <2, 1, 2> angle 40 right -1.6*x",
         {Vec3(5.04662, 0.14725, 10), Vec3(2.15351, 0.25864, 10), Vec3(4.08225, -1.42168, 10)}},
        {"orthographic location <1, 2, -3> direction <0.1, 0, 2>",
         {Vec3(0.50858, 2.76295, 10), Vec3(2.79133, 2.76295, 10), Vec3(1.26940, 1.23705, 10)}},
    };
    const Vec2 pixels[] = {{0.5, 0.5}, {3.5, 0.5}, {1.5, 2.5}};
    for (const Measured& m : cases) {
        const Camera c = camera_of(m.items);
        for (std::size_t i = 0; i < 3; ++i)
            expect_near(room_hit(ray_of(c, pixels[i].x, pixels[i].y)), m.hits[i], 1e-3);
    }
}

TEST(ParseCamera, SizeOfAnOrthographicCameraIsWhatWasSaid) {
    expect_near(camera_of("orthographic location -7*z right 4*x up 3*y look_at 0").right, {4, 0, 0});
    expect_near(camera_of("orthographic location -7*z look_at 0").right, {1.33 * 7, 0, 0});
}

TEST(ParseCamera, SaysWhatIsWrong) {
    EXPECT_TRUE(says(diagnostics_of("camera { angle 180 }"), "`angle` must lie between 0 and 180"));
    EXPECT_TRUE(says(diagnostics_of("camera { location 1 look_at 1 }"), "must differ"));
    EXPECT_TRUE(says(diagnostics_of("camera { loction <1, 2, 3> }"), "location"));
    EXPECT_FALSE(says(diagnostics_of("camera { fisheye angle 120 }"), "camera takes its place"));
}

} // namespace
} // namespace pnr
