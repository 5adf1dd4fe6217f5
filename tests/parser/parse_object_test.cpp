// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/parser/scene_text.h"

namespace pnr {
namespace {

const std::string paint = " pigment { rgb 1 } ";

Object object_of(const std::string& text) {
    const Scene scene = scene_of(text);
    EXPECT_EQ(scene.objects.size(), 1u);
    return scene.objects.empty() ? Object{} : scene.objects.front();
}

template <class T>
T shape_of(const std::string& text) {
    const Object object = object_of(text);
    const T* shape = object.shape ? std::get_if<T>(&*object.shape) : nullptr;
    EXPECT_NE(shape, nullptr) << text;
    return shape ? *shape : T{};
}

TEST(ParseShapes, Analytic) {
    const auto sphere = shape_of<Sphere>("sphere { <1, 2, 3>, 4" + paint + "}");
    expect_near(sphere.center, {1, 2, 3});
    EXPECT_EQ(sphere.radius, 4);
    const auto box = shape_of<Box>("box { <1, -2, 3>, <-1, 2, 0>" + paint + "}"); // any two corners
    expect_near(box.low, {-1, -2, 0});
    expect_near(box.high, {1, 2, 3});
    const auto plane =
        shape_of<Plane>("plane { <0, 0, 5>, 2" + paint + "}"); // the distance is along the unit normal
    expect_near(plane.normal, {0, 0, 1});
    EXPECT_EQ(plane.distance, 2);
    EXPECT_TRUE(shape_of<Cylinder>("cylinder { 0, y, 2 open" + paint + "}").open);
    EXPECT_EQ(shape_of<Cone>("cone { 0, 1, y, 0.5" + paint + "}").cap_radius, 0.5);
    EXPECT_EQ(shape_of<Torus>("torus { 2, 0.5" + paint + "}").minor, 0.5);
    EXPECT_EQ(shape_of<Disc>("disc { 0, y, 2, 1" + paint + "}").hole, 1);
}

TEST(ParseShapes, NothingLeftIsAnError) {
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 0 }"), "nothing is seen of it"));
    EXPECT_TRUE(says(diagnostics_of("cylinder { y, y, 1 }"), "two ends of a cylinder must differ"));
    EXPECT_TRUE(says(diagnostics_of("plane { 0, 1 }"), "normal of a plane"));
    EXPECT_TRUE(says(diagnostics_of("disc { 0, y, 1, 2 }"), "hole"));
}

TEST(ParseMesh, TrianglesShareTheirCorners) {
    const auto mesh = shape_of<Mesh>("mesh { triangle { 0, x, y } triangle { x, x + y, y }" + paint + "}");
    EXPECT_EQ(mesh.data->positions.size(), 4u);
    EXPECT_EQ(mesh.data->triangles.size(), 2u);
    EXPECT_TRUE(mesh.data->normals.empty());
}

TEST(ParseMesh, FlatTrianglesInASmoothMeshKeepTheirNormal) {
    const auto mesh = shape_of<Mesh>(
        "mesh { triangle { 0, x, y } smooth_triangle { x, -z, x + y, -x, y, y }" + paint + "}");
    ASSERT_EQ(mesh.data->normal_triangles.size(), 2u);
    expect_near(Vec3(mesh.data->normals[mesh.data->normal_triangles[0][1]]), {0, 0, 1});
    expect_near(Vec3(mesh.data->normals[mesh.data->normal_triangles[1][1]]), {-1, 0, 0});
}

TEST(ParseMesh, Mesh2TakesItsLists) {
    const auto mesh = shape_of<Mesh>(R"(mesh2 {
        vertex_vectors { 4, <0, 0, 0>, <1, 0, 0>, <1, 1, 0>, <0, 1, 0> }
        uv_vectors { 4 <0, 0> <1, 0> <1, 1> <0, 1> }
        face_indices { 2, <0, 1, 2>, <0, 2, 3> } pigment { rgb 1 } })");
    EXPECT_EQ(mesh.data->triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(mesh.data->uv_triangles, mesh.data->triangles); // left out: as the faces
    EXPECT_TRUE(mesh.data->normal_triangles.empty());
}

TEST(ParseMesh, Mesh2SaysWhatIsWrong) {
    const std::string vertices = "mesh2 { vertex_vectors { 3, 0, x, y } ";
    EXPECT_TRUE(says(diagnostics_of(vertices + "face_indices { 1, <0, 1, 3> } }"), "there are only 3"));
    EXPECT_TRUE(
        says(diagnostics_of(vertices + "face_indices { 2, <0, 1, 2> } }"), "says 2 entries, here are 1"));
    EXPECT_TRUE(
        says(diagnostics_of(vertices + "face_indices { 1, <0, 1, 2>, <0, 1, 2> } }"), "here are more"));
    EXPECT_TRUE(says(diagnostics_of(vertices + "}"), "needs `face_indices`"));
}

TEST(ParseMesh, AFileThatIsNotThereIsAnError) {
    EXPECT_TRUE(says(diagnostics_of("mesh { file \"no_such.ply\" }"), "no_such.ply"));
}

TEST(ParseShapes, Teapot) {
    const Object teapot = object_of("#include \"teapot.inc\"\nobject { Teapot" + paint + "}");
    EXPECT_EQ(teapot.name, "Teapot");
    ASSERT_EQ(teapot.children.size(), 32u);
    Bounds bounds;
    double inward = 0;
    for (const Object& child : teapot.children) {
        const auto& patch = std::get<BicubicPatch>(*child.shape);
        for (const Vec3& point : patch.points) bounds = merge(bounds, point);
        // The outside of the belly's patches looks away from the axis.
        const Vec3 normal = glm::cross(patch.points[3] - patch.points[0], patch.points[12] - patch.points[0]);
        const Vec3 middle = (patch.points[5] + patch.points[10]) / 2.0;
        if (std::abs(middle.y - 1.2) < 0.9 && glm::length(Vec3(middle.x, 0, middle.z)) < 2.2)
            inward = std::min(inward, glm::dot(normal, Vec3(middle.x, 0, middle.z)));
    }
    EXPECT_EQ(inward, 0);
    expect_near(bounds.low, {-3, 0, -2});
    expect_near(bounds.high, {3.525, 3.15, 2}, 1e-6);
}

TEST(ParseObject, TransformsApplyToWhatStandsBeforeThem) {
    const Object object = object_of(R"(sphere { 0, 1
        pigment { gradient x color_map { [0 rgb 0] [1 rgb 1] } } translate <1, 2, 3>
        scale 2
        npr { seeds { seed { <0, 1, 0>, x } } }
        rotate 90 * y })");
    // +90 degrees about y takes z to x and x to -z, in the left-handed frame.
    expect_near(transform_point(object.transform->matrix, Vec3(0)), {6, 4, -2});
    expect_near(transform_point(object.texture->pigment.pattern.transform->matrix, Vec3(0)), {6, 4, -2});
    expect_near(object.npr->style.seeds[0].position, {0, 1, 0});
    expect_near(object.npr->style.seeds[0].direction, {0, 0, -1});
}

TEST(ParseObject, ATextureSaidAfterATransformStaysBehind) {
    const Object object = object_of("sphere { 0, 1 translate x pigment { checker rgb 0, rgb 1 } }");
    EXPECT_TRUE(is_identity(object.texture->pigment.pattern.transform));
}

TEST(ParseObject, UnionTransformsReachTheChildren) {
    const Object object =
        object_of("union { sphere { x, 1 scale 2 } sphere { 0, 1 } translate y" + paint + "}");
    expect_near(transform_point(object.children[0].transform->matrix, {1, 0, 0}), {2, 1, 0});
    EXPECT_FALSE(object.children[0].texture); // it takes the union's
    EXPECT_TRUE(object.texture);
}

TEST(ParseObject, ACopyKeepsWhatWasSaidAndAddsToIt) {
    const Scene scene = scene_of(R"(
        #declare Ball = sphere { 0, 1 pigment { rgb <1, 0, 0> } finish { phong 0.7 } }
        object { Ball translate x }
        object { Ball pigment { rgb <0, 1, 0> } })");
    EXPECT_EQ(scene.objects[0].texture->pigment.map[0].color.rgb, Color(1, 0, 0));
    EXPECT_EQ(scene.objects[1].texture->pigment.map[0].color.rgb, Color(0, 1, 0));
    EXPECT_EQ(scene.objects[1].texture->finish.phong, 0.7);
    EXPECT_EQ(scene.objects[1].name, "Ball");
}

TEST(ParseObject, DefaultTextureAndTheWarningWithoutPigment) {
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 }"), "warning: this object has no pigment"));
    EXPECT_FALSE(says(diagnostics_of("#default { pigment { rgb 1 } } sphere { 0, 1 }"), "no pigment"));
    EXPECT_FALSE(says(diagnostics_of("union { sphere { 0, 1 } pigment { rgb 1 } }"), "no pigment"));
    EXPECT_EQ(scene_of("#default { finish { ambient 0 } } sphere { 0, 1 pigment { rgb 1 } }")
                  .objects[0]
                  .texture->finish.ambient,
              Color(0));
}

TEST(ParseObject, Flags) {
    const Object object =
        object_of("sphere { 0, 1 no_shadow no_image no_reflection hollow off inverse" + paint + "}");
    EXPECT_TRUE(object.no_shadow && object.no_image && object.no_reflection && object.inverse);
    EXPECT_FALSE(object.hollow);
}

TEST(ParseObject, PhotonRoles) {
    const Object object = object_of(
        "sphere { 0, 1 photons { specular_probability 0.2 absorption_probability 0.7 target refraction on }" +
        paint + "}");
    EXPECT_EQ(*object.photons->specular_probability, 0.2);
    EXPECT_EQ(*object.photons->absorption_probability, 0.7);
    EXPECT_TRUE(object.photons->target && object.photons->refraction && !object.photons->reflection);
    EXPECT_TRUE(
        says(diagnostics_of("sphere { 0, 1 photons { specular_probability 1.5 } }"), "specular_probability"));
}

TEST(ParseObject, WhatWeLackIsNamedAndSkipped) {
    const std::string all =
        diagnostics_of("media { } sphere { 0, 1 finish { subsurface { translucency 1 } } pigment { rgb 1 } }" +
                       std::string("sphere { 0, 1") + paint +
                       "interior { media { } } } light_source { y, 1 } camera { }");
    EXPECT_TRUE(says(all, "warning: `subsurface` is not supported"));
    EXPECT_TRUE(says(all, "warning: `media` is not supported"));
    EXPECT_FALSE(says(all, "error"));
}

TEST(ParseObject, UnknownWordsGetASuggestion) {
    EXPECT_TRUE(says(diagnostics_of("sphre { 0, 1 }"), "sphere"));
    EXPECT_TRUE(says(diagnostics_of("sphere { 0, 1 pigmnt { rgb 1 } }"), "pigment"));
    EXPECT_TRUE(says(diagnostics_of("object { Nothing }"), "error"));
}

} // namespace
} // namespace pnr
