// SPDX-License-Identifier: GPL-3.0-or-later
// Against what pixels of POV-Ray 3.7 show: a plane of pigment <0.8, 0.5, 0.2> seen straight from the front.
#include "core/finish.h"
#include "core/povray_finish.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

const Color pigment(0.8f, 0.5f, 0.2f);
const Color wavelengths(0.70f, 0.52f, 0.48f);

Finish dark() {
    Finish f;
    f.ambient = Color(0);
    f.diffuse = 0;
    return f;
}

// A lamp at this angle from the normal.
LampView at(double degrees) {
    const double a = degrees * pi / 180;
    LampView view;
    view.normal = view.outgoing = {0, 0, -1};
    view.toward = {std::sin(a), 0, -std::cos(a)};
    return view;
}

void expect_color(Color seen, Color expected, double tolerance = 1e-4) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], tolerance);
}

TEST(Finish, BothSidesHaveTheirDiffuse) {
    Finish f = dark();
    f.diffuse = 0.3, f.diffuse_back = 0.7;
    expect_color(lamp_light(f, pigment, 1, at(30), wavelengths), {0.2078f, 0.1299f, 0.052f});
    expect_color(lamp_light(f, pigment, 1, at(150), wavelengths), {0.485f, 0.3031f, 0.1212f});
    LampView view = at(150);
    view.both_sides = true; // double_illuminate: the front's
    expect_color(lamp_light(f, pigment, 1, view, wavelengths), {0.2078f, 0.1299f, 0.052f});
}

TEST(Finish, BrillianceIsAPowerOfTheCosine) {
    Finish f = dark();
    f.diffuse = 0.2;
    for (const auto& [brilliance, red] : {std::pair{0.0, 0.16f}, {0.5, 0.1489f}, {2.0, 0.12f}, {5.0, 0.0779f}}) {
        f.brilliance = brilliance;
        EXPECT_NEAR(lamp_light(f, pigment, 1, at(30), wavelengths).x, red, 1e-4);
    }
}

TEST(Finish, HighlightsAreNotThinnedByTransparencyButAreTintedByMetals) {
    Finish f = dark();
    f.specular = 0.5, f.roughness = 0.01;
    expect_color(lamp_light(f, pigment, 0.4f, at(0), wavelengths), Color(0.5f));
    f.roughness = 3;
    f.metallic = 1;
    expect_color(lamp_light(f, pigment, 1, at(0), wavelengths), {0.4f, 0.25f, 0.1f});
    expect_color(lamp_light(f, pigment, 1, at(80), wavelengths), {0.3899f, 0.2885f, 0.1871f});
    f.specular = 0, f.phong = 0.5, f.phong_size = 0.2;
    expect_color(lamp_light(f, pigment, 1, at(40), wavelengths), {0.3812f, 0.2418f, 0.1025f});
}

TEST(Finish, ThinFilmsColourWhatALampGives) {
    Finish f = dark();
    f.diffuse = 0.2;
    f.irid.amount = 0.2;
    for (const auto& [thickness, degrees, change] :
         {std::tuple{0.1, 0.0, Color(-0.0071f, -0.015f, -0.0069f)}, {0.25, 30.0, Color(-0.0139f, 0.0138f, 0.0069f)},
          {3.0, 60.0, Color(-0.0144f, -0.0057f, -0.0028f)}}) {
        f.irid.thickness = thickness;
        const Color plain = pigment * static_cast<float>(0.2 * std::cos(degrees * pi / 180));
        expect_color(lamp_light(f, pigment, 1, at(degrees), wavelengths) - plain, change, 2e-4);
    }
}

TEST(Finish, FilmsAreTurbulentAsPovRays) {
    Iridescence irid;
    irid.turbulence = 1;
    EXPECT_NEAR(film_thickness(irid, {-0.625, 0.375, 0}), 1.1942, 5e-4);
    EXPECT_NEAR(film_thickness(irid, {0.375, 0.375, 0}), 0.9477, 5e-4);
    EXPECT_NEAR(film_thickness(irid, {-0.125, -0.625, 0}), 1.8639, 5e-4);
    irid.turbulence = 0.2;
    EXPECT_NEAR(film_thickness(irid, {0.625, 0.625, 0}), 1.0873, 5e-4);
    irid.turbulence = 0;
    EXPECT_EQ(film_thickness(irid, {0.625, 0.625, 0}), 1);
}

TEST(Finish, ReflectionGoesFromMinToMax) {
    Reflection r;
    r.min = Color(0.1f), r.max = Color(0.9f);
    expect_color(reflectance(r, pigment, 1, 0.04), Color(0.1f));
    expect_color(reflectance(r, pigment, 0, 0.04), Color(0.9f));
    r.falloff = 2;
    expect_color(reflectance(r, pigment, 0.5, 0.04), Color(0.3f));
    r.fresnel = true;
    expect_color(reflectance(r, pigment, 0.5, 0.25), Color(0.3f));
    r.min = r.max = Color(0.5f);
    r.metallic = 1;
    expect_color(reflectance(r, pigment, 1, 0), {0.4f, 0.25f, 0.1f});
}

} // namespace
} // namespace pnr
