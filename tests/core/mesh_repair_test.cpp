// SPDX-License-Identifier: GPL-3.0-or-later
#include "library_file.h"

#include "core/mesh_repair.h"

#include "core/mesh_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

namespace pnr {
namespace {

// The cube [0, 1]^3, windings outwards.
MeshData cube() {
    MeshData mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                                    static_cast<float>(i >> 2 & 1));
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

double volume(const MeshData& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += glm::dot(Vec3(mesh.positions[t[0]]),
                        glm::cross(Vec3(mesh.positions[t[1]]), Vec3(mesh.positions[t[2]])));
    return sum / 6;
}

// Directed edges that have no partner, or more than one.
int open_edges(const MeshData& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    int open = 0;
    for (const auto& [edge, uses] : edges) {
        const auto partner = edges.find({edge.second, edge.first});
        open += uses != 1 || partner == edges.end();
    }
    return open;
}

Mesh asked(bool repair, int subdivide = 0, int simplify = 0) {
    Mesh mesh;
    mesh.file = "folder/thing.ply";
    mesh.repair = repair;
    mesh.subdivide = subdivide;
    mesh.simplify = simplify;
    mesh.said_at = {"scene.pnr", 3, 5};
    return mesh;
}

struct Worked {
    MeshData mesh;
    std::string note;
};
Worked work(const MeshData& mesh, const Mesh& said) {
    std::vector<std::string> notes;
    Worked worked{work_on_mesh(mesh, said, notes), {}};
    EXPECT_EQ(notes.size(), 1u);
    if (!notes.empty()) worked.note = notes[0];
    return worked;
}

void expect_cube(const Worked& worked) {
    EXPECT_EQ(worked.mesh.triangles.size(), 12u) << worked.note;
    EXPECT_EQ(worked.mesh.positions.size(), 8u) << worked.note;
    EXPECT_EQ(open_edges(worked.mesh), 0) << worked.note;
    EXPECT_NEAR(volume(worked.mesh), 1, 1e-12) << worked.note;
    EXPECT_EQ(worked.note.rfind("thing.ply: ", 0), 0u) << worked.note;
}

TEST(MeshRepair, LeavesAWholeMeshAsItIs) {
    const Worked worked = work(cube(), asked(true));
    expect_cube(worked);
    EXPECT_NE(worked.note.find("nothing to mend"), std::string::npos) << worked.note;
}

TEST(MeshRepair, ClosesHoles) {
    for (const std::size_t missing : {1u, 2u, 3u}) {
        MeshData mesh = cube();
        mesh.triangles.resize(12 - missing);
        const Worked worked = work(mesh, asked(true));
        expect_cube(worked);
        EXPECT_NE(worked.note.find("closed"), std::string::npos) << worked.note;
    }
}

TEST(MeshRepair, JoinsEqualVertices) {
    MeshData soup;
    const MeshData whole = cube();
    for (const auto& t : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t v : t) soup.positions.push_back(whole.positions[v]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    EXPECT_EQ(open_edges(soup), 36);
    expect_cube(work(soup, asked(true)));
}

TEST(MeshRepair, TurnsFlippedFaces) {
    MeshData mesh = cube();
    for (const std::size_t i : {0u, 3u, 7u}) std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
    expect_cube(work(mesh, asked(true)));
    mesh = cube();
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    EXPECT_LT(volume(mesh), 0);
    expect_cube(work(mesh, asked(true)));
}

TEST(MeshRepair, TakesOutWhatHasNoArea) {
    MeshData mesh = cube();
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back(mesh.triangles[4]);
    mesh.positions.emplace_back(7.0f); // named by none
    expect_cube(work(mesh, asked(true)));

    // An edge's middle, used on one side only: the other side gets a triangle without area.
    mesh = cube();
    mesh.positions.emplace_back(0.5f, 0.0f, 0.0f);
    mesh.triangles[4] = {8, 1, 5};
    mesh.triangles.push_back({0, 8, 5});
    mesh.triangles.push_back({0, 1, 8});
    EXPECT_EQ(open_edges(mesh), 0);
    const Worked worked = work(mesh, asked(true));
    EXPECT_EQ(open_edges(worked.mesh), 0) << worked.note;
    EXPECT_NEAR(volume(worked.mesh), 1, 1e-12) << worked.note;
    for (const auto& t : worked.mesh.triangles) {
        const Vec3 a(worked.mesh.positions[t[0]]), b(worked.mesh.positions[t[1]]),
            c(worked.mesh.positions[t[2]]);
        EXPECT_GT(glm::length(glm::cross(b - a, c - a)), 0) << worked.note;
    }
}

TEST(MeshRepair, TurnsACavityInwards) {
    MeshData mesh = cube();
    for (const auto& t : cube().triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    for (const Vec3f& p : cube().positions) mesh.positions.push_back(0.25f + 0.5f * p);
    const Worked worked = work(mesh, asked(true));
    EXPECT_EQ(open_edges(worked.mesh), 0);
    EXPECT_NEAR(volume(worked.mesh), 1 - 0.125, 1e-12) << worked.note;
}

// Loop's own masks at a vertex of the tetrahedron: valence 3, beta = 3/16; at an edge 3/8, 3/8, 1/8, 1/8.
TEST(MeshRepair, SubdividesByLoopsScheme) {
    MeshData mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const Worked worked = work(mesh, asked(false, 1));
    ASSERT_EQ(worked.mesh.triangles.size(), 16u);
    ASSERT_EQ(worked.mesh.positions.size(), 10u);
    EXPECT_EQ(open_edges(worked.mesh), 0);
    std::vector<Vec3> expected;
    for (std::size_t i = 0; i < 4; ++i) {
        Vec3 around{0};
        for (std::size_t k = 0; k < 4; ++k)
            if (k != i) around += Vec3(mesh.positions[k]);
        expected.push_back(7.0 / 16 * Vec3(mesh.positions[i]) + 3.0 / 16 * around);
        for (std::size_t k = 0; k < i; ++k) {
            Vec3 middle{0};
            for (std::size_t j = 0; j < 4; ++j)
                middle += (j == i || j == k ? 3.0 / 8 : 1.0 / 8) * Vec3(mesh.positions[j]);
            expected.push_back(middle);
        }
    }
    for (const Vec3& e : expected)
        EXPECT_TRUE(std::any_of(worked.mesh.positions.begin(), worked.mesh.positions.end(),
                                [&](Vec3f p) { return glm::length(Vec3(p) - e) < 1e-6; }))
            << e.x << ' ' << e.y << ' ' << e.z;
    EXPECT_EQ(work(mesh, asked(false, 4)).mesh.triangles.size(), 1024u);
}

TEST(MeshRepair, SimplifiesAFlatFaceWithoutLoss) {
    // A cube's faces cut fine: all but 12 triangles can go.
    MeshData fine;
    const MeshData coarse = cube();
    const int n = 8;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const auto corner = [&](int u, int v) {
                    Vec3f p;
                    const int axis = face / 2;
                    p[axis] = static_cast<float>(face & 1);
                    p[(axis + 1) % 3] = static_cast<float>(u) / n;
                    p[(axis + 2) % 3] = static_cast<float>(v) / n;
                    fine.positions.push_back(p);
                    return static_cast<std::uint32_t>(fine.positions.size() - 1);
                };
                const std::uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                                    d = corner(i, j + 1);
                fine.triangles.push_back({a, b, c});
                fine.triangles.push_back({a, c, d});
            }
    const Worked worked = work(fine, asked(true, 0, 100));
    EXPECT_LE(worked.mesh.triangles.size(), 100u) << worked.note;
    EXPECT_GE(worked.mesh.triangles.size(), 90u) << worked.note;
    EXPECT_EQ(open_edges(worked.mesh), 0);
    EXPECT_NEAR(volume(worked.mesh), 1, 1e-6) << worked.note;
    EXPECT_NE(worked.note.find("768 triangles before"), std::string::npos) << worked.note;
}

TEST(MeshRepair, RefusesWhatIsTooMuch) {
    std::vector<std::string> notes;
    EXPECT_THROW(work_on_mesh(cube(), asked(false, 12), notes), SceneError);
}

TEST(MeshRepair, AMeshOfNothingStaysNothing) {
    MeshData mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 1}};
    mesh.triangles = {{0, 0, 1}};
    EXPECT_TRUE(work(mesh, asked(true, 2, 4)).mesh.triangles.empty());
}

class RepairedModel : public testing::TestWithParam<const char*> {};

TEST_P(RepairedModel, IsClosedAndBoundsAVolume) {
    const std::filesystem::path file = library_file(GetParam());
    if (file.empty()) GTEST_SKIP() << "skipped: no " << GetParam();
    const Worked worked = work(read_mesh(file, {}), asked(true));
    std::printf("%s\n", worked.note.c_str());
    EXPECT_EQ(open_edges(worked.mesh), 0) << worked.note;
    EXPECT_GT(volume(worked.mesh), 0);
}
INSTANTIATE_TEST_SUITE_P(Models, RepairedModel,
                         testing::Values("degenerate_131.ply", "triple_vierbein_108.ply", "bunny_1979.ply",
                                         "hourglass_ico_40.ply", "moebius_448.ply", "teapot_604.ply"));

} // namespace
} // namespace pnr
