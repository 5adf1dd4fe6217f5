// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_io.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace pnr {
namespace {

const SourceRef here{"scene.pnr", 3, 5};

// A pyramid: a square (so a polygon is cut) and four sides, in every format.
const std::vector<Vec3f> corners{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0.5f, 1.25f, 0.5f}};
const std::vector<std::vector<int>> polygons{{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};

std::string number(float x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(x));
    return text;
}

std::string ply_header(const char* format) {
    return std::string("ply\nformat ") + format +
           " 1.0\ncomment a pyramid\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

std::string binary_ply(bool big) {
    std::string out = ply_header(big ? "binary_big_endian" : "binary_little_endian");
    for (const Vec3f& p : corners) {
        for (int k = 0; k < 3; ++k) put(out, p[k], big);
        put(out, static_cast<std::uint8_t>(200), big);
    }
    for (const auto& polygon : polygons) {
        put(out, static_cast<std::uint8_t>(polygon.size()), big);
        for (const int v : polygon) put(out, static_cast<std::int32_t>(v), big);
    }
    return out;
}

std::string text_of(const std::string& head, const char* vertex, const char* vertex_end, const char* face,
                    int base, bool counts) {
    std::string out = head;
    for (const Vec3f& p : corners)
        out += vertex + number(p.x) + " " + number(p.y) + " " + number(p.z) + vertex_end + "\n";
    for (const auto& polygon : polygons) {
        out += face;
        if (counts) out += std::to_string(polygon.size()) + " ";
        for (const int v : polygon) out += std::to_string(v + base) + " ";
        out += "\n";
    }
    return out;
}

std::string ascii_stl() {
    std::string out = "solid pyramid\n";
    for (const auto& polygon : polygons)
        for (std::size_t i = 2; i < polygon.size(); ++i) {
            out += "facet normal 0 0 0\n outer loop\n";
            for (const int v : {polygon[0], polygon[i - 1], polygon[i]}) {
                const Vec3f p = corners[static_cast<std::size_t>(v)];
                out += "  vertex " + number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
            }
            out += " endloop\nendfacet\n";
        }
    return out + "endsolid\n";
}

std::string binary_stl() {
    std::string out(80, ' ');
    out.replace(0, 5, "solid"); // as some programs write, though the file is binary
    put(out, static_cast<std::uint32_t>(6), false);
    for (const auto& polygon : polygons)
        for (std::size_t i = 2; i < polygon.size(); ++i) {
            for (int k = 0; k < 3; ++k) put(out, 0.0f, false);
            for (const int v : {polygon[0], polygon[i - 1], polygon[i]})
                for (int k = 0; k < 3; ++k) put(out, corners[static_cast<std::size_t>(v)][k], false);
            put(out, static_cast<std::uint16_t>(0), false);
        }
    return out;
}

struct File {
    std::string name, bytes;
};
std::vector<File> pyramids() {
    return {{"a.ply", text_of(ply_header("ascii"), "", " 200", "", 0, true)},
            {"l.ply", binary_ply(false)},
            {"b.ply", binary_ply(true)},
            {"p.obj", text_of("# pyramid\no it\n", "v ", "", "f ", 1, false)},
            {"n.obj", text_of("", "v ", "", "f ", -5, false)}, // indices from the end
            {"p.off", text_of("OFF\n# a comment\n5 5 0\n", "", "", "", 0, true)},
            {"a.stl", ascii_stl()},
            {"b.stl", binary_stl()}};
}

TEST(ParseMesh, AllFormatsGiveTheSameMesh) {
    for (const File& file : pyramids()) {
        const MeshData mesh = parse_mesh(file.bytes, file.name, here);
        ASSERT_EQ(mesh.positions.size(), 5u) << file.name;
        ASSERT_EQ(mesh.triangles.size(), 6u) << file.name;
        std::size_t t = 0;
        for (const auto& polygon : polygons)
            for (std::size_t i = 2; i < polygon.size(); ++i, ++t) {
                const int expected[] = {polygon[0], polygon[i - 1], polygon[i]};
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_EQ(mesh.positions[mesh.triangles[t][k]],
                              corners[static_cast<std::size_t>(expected[k])])
                        << file.name;
            }
    }
}

// Every prefix of every file is read or refused, and so is every file with one byte changed: no crash, no
// wild memory.
TEST(ParseMesh, BrokenFilesAreRefused) {
    Rng rng = make_rng(1, Pass::test, 0);
    for (const File& file : pyramids()) {
        const auto attempt = [&](const std::string& bytes) {
            try {
                const MeshData mesh = parse_mesh(bytes, file.name, here);
                for (const auto& t : mesh.triangles)
                    for (const auto v : t) EXPECT_LT(v, mesh.positions.size());
                for (const auto& p : mesh.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
            } catch (const SceneError& error) {
                EXPECT_EQ(error.said_at.line, 3);
                EXPECT_NE(std::string(error.what()).find(file.name), std::string::npos);
            }
        };
        for (std::size_t length = 0; length < file.bytes.size(); ++length)
            attempt(file.bytes.substr(0, length));
        for (int i = 0; i < 5000; ++i) {
            std::string bytes = file.bytes;
            for (int changes = 1 + i % 3; changes > 0; --changes)
                bytes[rng.bits() % bytes.size()] = static_cast<char>(rng.bits());
            attempt(bytes);
        }
    }
}

void expect_refused(const std::string& bytes, const std::string& name, const char* word) {
    try {
        parse_mesh(bytes, name, here);
        FAIL() << name << " was read";
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

TEST(ParseMesh, SaysWhatIsWrong) {
    const auto ply = [](const std::string& counts, const std::string& data) {
        return "ply\nformat ascii 1.0\nelement vertex " + counts +
               "property list uchar int vertex_indices\nend_header\n" + data;
    };
    const std::string xyz = "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
    expect_refused(ply("1000000000000" + xyz + "1\n", "0 0 0"), "a.ply", "promises 1000000000000");
    expect_refused(ply("3" + xyz + "1000000000000\n", "0 0 0 1 0 0 0 1 0 3 0 1 2"), "a.ply",
                   "promises 1000000000000");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 nan 0 0 1 0 3 0 1 2"), "a.ply",
                   "vertex 1 is not a finite");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 1e999 0 0 1 0 3 0 1 2"), "a.ply", "too large");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 1e60 0 0 1 0 3 0 1 2"), "a.ply",
                   "vertex 1 is not a finite");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 0 0 0 1 0 3 0 1 3"), "a.ply", "does not exist");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 0 0 0 1 0 3 0 1 -1"), "a.ply", "does not exist");
    expect_refused(ply("3" + xyz + "1\n", "0 0 0 1 0 0 0 1 0 200 0 1"), "a.ply", "longer than the file");
    expect_refused(binary_ply(false).substr(0, binary_ply(false).size() - 3), "b.ply", "ends");
    expect_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj", "element 4 of 3");
    expect_refused("v 0 0 0\n", "a.obj", "no triangle");
    expect_refused("not a mesh", "a.txt", "none of PLY");
    expect_refused("", "a.ply", "none of PLY");
    EXPECT_THROW(read_mesh("there/is/no/such.ply", here), FileError);
}

TEST(ParseMesh, KeepsNormalsAndTexturePoints) {
    const MeshData obj = parse_mesh(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 2\nf 1/1/1 2/2/1 3/1/1\n", "a.obj", here);
    ASSERT_EQ(obj.uv_triangles.size(), 1u);
    EXPECT_EQ(obj.uvs[obj.uv_triangles[0][1]], Vec2f(1, 0.5f));
    EXPECT_EQ(obj.normals[obj.normal_triangles[0][2]], Vec3f(0, 0, 2));
    const MeshData without =
        parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n", "a.obj", here);
    EXPECT_TRUE(without.normals.empty()) << "a normal of no length is no normal";
}

TEST(AreaWeightedNormals, WeighByAreaAndSurviveDegenerateTriangles) {
    // A right angle of two faces that share the edge 0-1: the second has three times the area of the first.
    const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 3}, {5, 5, 5}};
    const std::vector<std::array<std::uint32_t, 3>> t{{0, 1, 2}, {0, 1, 3}, {4, 4, 0}, {4, 4, 4}};
    const auto n = area_weighted_normals(p, t);
    const Vec3f expected = glm::normalize(Vec3f(0, -3, 1)); // cross(x, y) + cross(x, 3 z)
    EXPECT_LT(glm::length(n[0] - expected), 1e-6f);
    EXPECT_EQ(n[2], Vec3f(0, 0, 1));
    EXPECT_EQ(n[4], Vec3f(0));
    const float tiny = 1e-30f; // areas far below what squares of floats can hold
    const std::vector<Vec3f> small{{0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}};
    EXPECT_EQ(area_weighted_normals(small, std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}})[0],
              Vec3f(0, 0, 1));
}

} // namespace
} // namespace pnr
