// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_materials.h"

#include "core/mesh_io.h"
#include "core/world.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace pnr {
namespace {

namespace fs = std::filesystem;

TEST(MeshMaterials, BecomeTextures) {
    const auto textures =
        parse_materials("# made by hand\nnewmtl red\nKd 0.8 0.1 0.2\nKs 0.5 0.5 0.5\nNs 120\nd 0.25\n"
                        "newmtl lamp\nKd 0\nKe 3 2 1\nTr 0.5\nillum 2\n"
                        "newmtl picture\nmap_Kd -s 1 1 1 sub\\wood.png\nnewmtl far\nmap_Kd ../up.png\n",
                        "folder", "test.mtl", {});
    ASSERT_EQ(textures.size(), 4u);
    const TextureLayer& red = textures.at("red");
    EXPECT_EQ(red.pigment.map.front().color.rgb, Color(0.8f, 0.1f, 0.2f));
    EXPECT_FLOAT_EQ(red.pigment.map.front().color.transmit, 0.75f);
    EXPECT_DOUBLE_EQ(red.finish.phong, 0.5);
    EXPECT_DOUBLE_EQ(red.finish.phong_size, 120);
    const TextureLayer& lamp = textures.at("lamp");
    EXPECT_EQ(lamp.finish.emission, Color(3, 2, 1));
    EXPECT_FLOAT_EQ(lamp.pigment.map.front().color.transmit, 0.5f);
    const auto* picture =
        std::get_if<ImagePattern>(&textures.at("picture").pigment.pattern.kind);
    ASSERT_TRUE(picture);
    EXPECT_EQ(fs::path(picture->file), fs::path("folder") / "sub" / "wood.png");
    EXPECT_TRUE(textures.at("picture").pigment.pattern.uv_mapping);
    EXPECT_FALSE(std::get_if<ImagePattern>(&textures.at("far").pigment.pattern.kind))
        << "it would leave the folder";
}

// The faces of an OBJ show its materials, unless the object has a texture.
TEST(MeshMaterials, AreShownByTheFacesThatUseThem) {
    const fs::path folder = fs::temp_directory_path() / "pnr_mesh_materials_test";
    fs::create_directories(folder);
    std::ofstream(folder / "two.mtl") << "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n";
    std::ofstream(folder / "two.obj") << "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 0\n"
                                         "usemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\nusemtl unknown\nf 3 4 5\n";
    Scene scene;
    Object& object = scene.objects.emplace_back();
    Mesh mesh;
    mesh.file = (folder / "two.obj").string();
    object.shape = mesh;
    const auto color_at = [&](double x, double y) {
        const World world = build_world(scene, {});
        const auto hit = closest_hit(world, {Vec3(x, y, -5) - world.offset, {0, 0, 1}}, RayKind::camera);
        EXPECT_TRUE(hit);
        const auto& material =
            world.materials[static_cast<std::size_t>(world.surfaces[hit->surface].material)];
        return texture_color(material.texture, {hit->position, hit->uv});
    };
    EXPECT_EQ(color_at(0.2, 0.2), Color(1, 0, 0));
    EXPECT_EQ(color_at(0.8, 0.8), Color(0, 1, 0));
    EXPECT_EQ(color_at(1.0, 1.2), Color(0, 0, 0)); // the object has none: black
    object.texture.emplace();
    object.texture->pigment.map.front().color.rgb = Color(0, 0, 1);
    EXPECT_EQ(color_at(0.2, 0.2), Color(0, 0, 1));
    fs::remove_all(folder);
}

} // namespace
} // namespace pnr
