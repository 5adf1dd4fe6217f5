// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes given by fields, as scenes say them. Places are those that POV-Ray 3.7 prints with trace() for the
// same objects.
#include <gtest/gtest.h>

#include "core/shape_field.h"
#include "core/world.h"
#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

Vec3 value_of(const std::string& object, const std::string& expression) {
    const Scene scene =
        scene_of("#declare O = " + object + "\n#declare N = <9, 9, 9>;\n#declare V = " + expression +
                 ";\nsphere { V, 1 pigment { rgb 1 } }");
    return scene.objects.empty() ? Vec3(-99) : std::get<Sphere>(*scene.objects.at(0).shape).center;
}

TEST(ParseFieldShapes, BlobsStandWherePovRayHasThem) {
    expect_near(value_of("blob { threshold 0.5 sphere { 0, 1, 1 } }", "trace(O, -5*z, z)"), {0, 0, -0.541196},
                1e-6);
    expect_near(value_of("blob { threshold 0.5 sphere { 0, 1, strength 2 } }", "trace(O, -5*z, z)"),
                {0, 0, -0.707107}, 1e-6);
    expect_near(value_of("blob { threshold 0.5 cylinder { -x, x, 1, 1 } }", "trace(O, -5*x + y*0.3, x)"),
                {-1.450437, 0.3, 0}, 1e-6);
    expect_near(value_of("blob { threshold 0.5 component 2, 0.5, <0,0,0> }", "trace(O, -5*z, z)"),
                {0, 0, -0.353553}, 1e-6);
    expect_near(
        value_of("blob { threshold 0.5 sphere { 0, 1, 1 scale <1,2,3> } sphere { <0,0,3>, 1, -1 } sturm }",
                 "trace(O, -5*z, z)"),
        {0, 0, -1.623588}, 1e-6);
    expect_near(value_of("blob { threshold 0.5 cylinder { -x, x, 1, 1 scale 2 translate y } hierarchy on }",
                         "<min_extent(O).x, inside(O, y), inside(O, 5*y)>"),
                {-4, 1, 0}, 1e-9);
}

TEST(ParseFieldShapes, BlobComponentsKeepTheirTextures) {
    const Scene scene =
        scene_of("blob { threshold 0.3 sphere { 0, 1, 1 pigment { rgb x } } cylinder { 0, x, 1, 1 }"
                 " sphere { x, 1, 1 texture { pigment { rgb y } } translate 0.2*x } pigment { rgb z } }");
    const Blob& blob = std::get<Blob>(*scene.objects.at(0).shape);
    ASSERT_TRUE(blob.textures);
    ASSERT_EQ(blob.data->components.size(), 3u);
    EXPECT_EQ(blob.data->components[0].texture, 0u);
    EXPECT_EQ(blob.data->components[1].texture, no_texture);
    EXPECT_EQ(blob.data->components[2].texture, 1u);
    const World world = build_world(scene, {});
    const auto hit = closest_hit(world, {Vec3(0.55, 0, -5) - world.offset, {0, 0, 1}}, RayKind::camera);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->shares[0] + hit->shares[1] + hit->shares[2], 1, 1e-6);
    EXPECT_GT(hit->shares[0], hit->shares[1]);
    EXPECT_GT(hit->shares[1], hit->shares[2]);
    EXPECT_GT(hit->shares[2], 0);
}

TEST(ParseFieldShapes, IsosurfacesHaveLidsUnlessOpen) {
    const std::string ball = "isosurface { function { x*x + y*y + z*z - 1.44 } max_gradient 4";
    expect_near(value_of(ball + " contained_by { box { -1, 1 } } }", "trace(O, -5*z, z)"), {0, 0, -1}, 1e-9);
    expect_near(value_of(ball + " open }", "trace(O, -5*z, z)"), {0, 0, 0}, 1e-9);
    expect_near(
        value_of(
            "isosurface { function { x*x + y*y + z*z } threshold 1.44 contained_by { sphere { 0, 1.1 } } }",
            "trace(O, -5*z, z)"),
        {0, 0, -1.1}, 1e-9);
    // Where the function has no value is outside.
    expect_near(value_of("isosurface { function { sqrt(x) - 0.5 } }", "trace(O, -5*z + x*0.1, z)"),
                {0.1, 0, -1}, 1e-9);
    expect_near(value_of("isosurface { function { sqrt(x) - 0.5 } }", "trace(O, -5*z - x*0.1, z)"), {0, 0, 0},
                1e-9);
    EXPECT_TRUE(says(diagnostics_of("isosurface { sphere { 0, 1 } }"), "function"));
    EXPECT_TRUE(says(diagnostics_of("isosurface { function { x } accuracy 0 }"), "more than 0"));
    EXPECT_TRUE(
        says(diagnostics_of("isosurface { function { x } contained_by { box { 0, x } } }"), "no volume"));
}

TEST(ParseFieldShapes, HeightFieldsOfFunctions) {
    const std::string field = "height_field { function 4, 3 { x*0.5 + y*0.25 }";
    expect_near(value_of(field + " }", "trace(O, <0.3, 5, 0.7>, -y)"), {0.3, 0.224991, 0.7}, 2e-5);
    expect_near(
        value_of(field + " }",
                 "<inside(O, <0.5, 0.1, 0.5>), inside(O, <0.5, 0.9, 0.5>), inside(O, <0.5, -0.1, 0.5>)>"),
        {1, 0, 1});
    expect_near(value_of(field + " smooth water_level 0.6 }", "trace(O, <0.3, 5, 0.7>, -y)"), {0, 0, 0});
    EXPECT_TRUE(says(diagnostics_of("height_field { png \"nothing.png\" }"), "nothing.png"));
}

TEST(ParseFieldShapes, JuliaAndParametric) {
    const std::string julia = "julia_fractal { <0.5, 0, 0, 0> quaternion sqr max_iteration 1 precision 50 }";
    expect_near(value_of(julia, "trace(O, -5*z, z)"), {0, 0, -1.5}, 1e-6);
    EXPECT_TRUE(says(diagnostics_of("julia_fractal { <0.5, 0, 0, 0> quaternion exp }"), "hypercomplex"));
    EXPECT_TRUE(says(diagnostics_of("julia_fractal { <0.5, 0, 0, 0> slice <1, 0, 0, 0>, 1 }"), "fourth"));
    const std::string sheet =
        "parametric { function { u*2 }, function { v }, function { u*v } <0,0>, <1,1>"
        " contained_by { box { -1, <1.5, 1, 1> } } precompute 5 x, y, z accuracy 0.001 }";
    expect_near(value_of(sheet, "trace(O, <0.5, 0.5, -5>, z)"), {0.5, 0.5, 0.125}, 2e-3);
    expect_near(value_of(sheet, "trace(O, <1.6, 0.5, -5>, z)"), {0, 0, 0});
}

// ---- textured meshes

Color color_of(const World& world, const Hit& hit) {
    const auto& material = world.materials[static_cast<std::size_t>(world.surfaces[hit.surface].material)];
    return texture_color(material.texture, {hit.position, hit.uv});
}

TEST(ParseFieldShapes, TrianglesShowTheirOwnTextures) {
    const Scene scene =
        scene_of("#declare Red = texture { pigment { rgb x } }\n"
                 "mesh { triangle { 0, x, y texture { Red } } triangle { x, x+y, y }"
                 " triangle { 2*x, 3*x, 2*x+y texture { Red } }"
                 " triangle { 4*x, 5*x, 4*x+y texture_list { Red texture { pigment { rgb y } } Red } }"
                 " pigment { rgb z } }");
    const MeshData& data = *std::get<Mesh>(*scene.objects.at(0).shape).data;
    ASSERT_TRUE(data.textures);
    EXPECT_EQ(data.texture_triangles[0], data.texture_triangles[2]); // one texture for both
    EXPECT_EQ(data.texture_triangles[1][0], no_texture);
    const World world = build_world(scene, {});
    const auto seen = [&](double x, double y) {
        const auto hit = closest_hit(world, {Vec3(x, y, -5) - world.offset, {0, 0, 1}}, RayKind::camera);
        EXPECT_TRUE(hit);
        return hit.value_or(Hit{});
    };
    EXPECT_EQ(color_of(world, seen(0.2, 0.2)), Color(1, 0, 0));
    EXPECT_EQ(color_of(world, seen(0.8, 0.8)), Color(0, 0, 1));
    EXPECT_EQ(color_of(world, seen(2.2, 0.2)), Color(1, 0, 0));
    const Hit mixed = seen(4.5, 0.2); // shares 0.3, 0.5, 0.2 of the corners
    EXPECT_NEAR(mixed.shares[0], 0.5, 1e-5);
    EXPECT_NEAR(mixed.shares[1], 0.3, 1e-5);
    EXPECT_EQ(color_of(world, mixed), Color(0, 1, 0));
}

TEST(ParseFieldShapes, Mesh2FacesNumberTextures) {
    const std::string start =
        "mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <0,1,0>, <1,1,0> }"
        " texture_list { 2, texture { pigment { rgb x } } texture { pigment { rgb y } } }";
    for (const std::string& faces :
         {std::string(" face_indices { 2, <0,1,2>, 0, <1,3,2>, 0, 1, 1 }"),
          std::string(
              " face_indices { 2, <0,1,2>, 0*1, <1,3,2>, 0, 1, 1 }")}) { // as text, and as expressions
        const Scene scene = scene_of(start + faces + " inside_vector z }");
        const Mesh& mesh = std::get<Mesh>(*scene.objects.at(0).shape);
        EXPECT_EQ(mesh.inside_vector, Vec3(0, 0, 1));
        ASSERT_EQ(mesh.data->texture_triangles.size(), 2u);
        EXPECT_EQ(mesh.data->texture_triangles[0], (std::array<std::uint32_t, 3>{0, 0, 0}));
        EXPECT_EQ(mesh.data->texture_triangles[1], (std::array<std::uint32_t, 3>{0, 1, 1}));
        EXPECT_EQ(mesh.data->textures->list.size(), 2u);
    }
    EXPECT_TRUE(says(diagnostics_of(start + " face_indices { 1, <0,1,2>, 2 } }"), "texture 2"));
    EXPECT_TRUE(
        says(diagnostics_of(start + " face_indices { 1, <0,1,2>, 1, 1 } }"), "one texture, or three"));
    EXPECT_TRUE(says(diagnostics_of(start + " face_indices { 3, <0,1,2>, <1,3,2> } }"), "here are 2"));
}

// uv of a sphere, a box and a torus, and of what has none, as pictures by POV-Ray show them.
TEST(ParseFieldShapes, CoordinatesArePovRays) {
    const auto uv = [](const std::string& object, Vec3 from) {
        const World world = build_world(scene_of(object), {});
        const auto hit = closest_hit(world, {from - world.offset, {0, 0, 1}}, RayKind::camera);
        EXPECT_TRUE(hit) << object;
        return hit ? Vec3(hit->uv, 0) : Vec3(0);
    };
    const Vec3 at(0.45, -0.05, -5), above(0.05, 0.45, -5), corner(0.35, 0.35, -5);
    const std::string shown = " pigment { rgb 1 } ";
    expect_near(uv("sphere { 0, 1" + shown + "}", at), {0.8244, 0.4841, 0}, 1e-3);
    expect_near(uv("box { -1, 1" + shown + "}", at), {0.8188, 0.4917, 0}, 1e-4);
    expect_near(uv("box { -1, 1" + shown + "rotate -90*x }", above), {0.3812, 0.7583, 0}, 1e-4);
    expect_near(uv("box { -1, 1" + shown + "rotate 90*x }", above), {0.3812, 0.0917, 0}, 1e-4);
    expect_near(uv("box { -1, 1" + shown + "rotate 90*y }", at), {0.5687, 0.4917, 0}, 1e-4);
    expect_near(uv("box { -1, 1" + shown + "rotate -90*y }", at), {0.0688, 0.4917, 0}, 1e-4);
    expect_near(uv("box { -1, 1" + shown + "rotate 180*y }", at), {0.3187, 0.4917, 0}, 1e-4);
    expect_near(uv("torus { 0.7, 0.3" + shown + "rotate -90*x }", above), {0.2676, 0.9042, 0}, 1e-4);
    expect_near(uv("torus { 0.7, 0.3" + shown + "rotate -90*x }", corner), {0.375, 0.8697, 0}, 1e-4);
    expect_near(uv("cylinder { -y, y, 1" + shown + "scale 0.8 translate 0.1 }", corner), {0.35, 0.35, 0},
                1e-9);
}

} // namespace
} // namespace pnr
