// SPDX-License-Identifier: GPL-3.0-or-later
// The files of --maps are held against one another by the rules of the file contract, from the files alone.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "run_pnr.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <sstream>

namespace pnr {
namespace {

// One channel of a single-part EXR by name.
struct Map {
    explicit Map(const std::filesystem::path& path) : file(read_exr(path)) {
        EXPECT_EQ(file.parts.size(), 1u);
    }
    float at(const std::string& channel, int x, int y) const {
        const auto& names = file.parts[0].channel_names;
        const auto found = std::find(names.begin(), names.end(), channel);
        if (found == names.end()) throw std::runtime_error("no channel " + channel);
        return file.parts[0].data[(static_cast<std::size_t>(y) * static_cast<std::size_t>(file.width) +
                                   static_cast<std::size_t>(x)) *
                                      names.size() +
                                  static_cast<std::size_t>(found - names.begin())];
    }
    float number(const std::string& key) const {
        for (const auto& [name, value] : file.metadata)
            if (name == key) return std::get<float>(value);
        throw std::runtime_error("no metadata " + key);
    }
    ImageFile file;
};

struct PlyPhoton {
    float p[3], n[3], d[3], c[3];
    std::int32_t object;
    std::uint8_t npr, path;
    float t[3];
};
struct PlyPhotons {
    std::int64_t emitted = -1;
    std::vector<PlyPhoton> photons;
};

PlyPhotons read_ply(const std::string& bytes) {
    PlyPhotons ply;
    std::istringstream header(bytes.substr(0, bytes.find("end_header")));
    std::size_t count = 0;
    std::string line, properties;
    while (std::getline(header, line)) {
        long long number = 0;
        if (std::sscanf(line.c_str(), "comment emitted %lld", &number) == 1) ply.emitted = number;
        if (std::sscanf(line.c_str(), "element vertex %lld", &number) == 1)
            count = static_cast<std::size_t>(number);
        if (line.starts_with("property ")) properties += line.substr(9) + ";";
    }
    EXPECT_EQ(properties,
              "float x;float y;float z;float nx;float ny;float nz;float dx;float dy;float dz;float r;float g;"
              "float b;int object;uchar npr;uchar path;float tx;float ty;float tz;");
    const char* at = bytes.data() + bytes.find("end_header\n") + 11;
    EXPECT_EQ(bytes.data() + bytes.size() - at, static_cast<std::ptrdiff_t>(count * 66));
    for (std::size_t i = 0; i < count; ++i, at += 66) {
        PlyPhoton photon;
        std::memcpy(photon.p, at, 48);
        std::memcpy(&photon.object, at + 48, 4);
        std::memcpy(&photon.npr, at + 52, 1);
        std::memcpy(&photon.path, at + 53, 1);
        std::memcpy(photon.t, at + 54, 12);
        ply.photons.push_back(photon);
    }
    return ply;
}

Vec3f vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// One rendering for all tests of this file.
class Maps : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder = new TemporaryFolder;
        folder->write("box.pnr", box_scene("global_settings { photons { count 15000 } }\n"));
        ran = run_pnr(*folder, {"render", "box.pnr", "-W", "80", "--maps", "made/maps", "--stats", "s.json",
                                "-o", "box.exr", "--aov", "N,id,indirect,informative"});
    }
    static void TearDownTestSuite() {
        delete folder;
        folder = nullptr;
    }
    void SetUp() override { ASSERT_EQ(ran.code, 0) << ran.err; }
    static std::filesystem::path map(const std::string& name) { return *folder / ("made/maps/" + name); }
    static inline TemporaryFolder* folder = nullptr;
    static inline Ran ran;
};

TEST_F(Maps, EveryFileIsThereWithItsChannels) {
    const auto channels = [](const char* name) {
        std::vector<std::string> names = read_exr(map(name)).parts.at(0).channel_names;
        std::sort(names.begin(), names.end());
        return names;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(channels("gbuffer.exr"),
              (Names{"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "Z", "id.object", "id.via", "npr"}));
    EXPECT_EQ(channels("sparse.exr"),
              (Names{"B", "G", "R", "Z", "dir.X", "dir.Y", "id.object", "id.via", "source"}));
    EXPECT_EQ(channels("informative.exr"),
              (Names{"B", "G", "R", "coverage", "dir.X", "dir.Y", "id.object", "id.via", "kind"}));
    EXPECT_EQ(channels("partial.exr"), (Names{"A", "B", "G", "R"}));
    EXPECT_EQ(channels("photoreal.exr"), (Names{"A", "B", "G", "R"}));
    EXPECT_EQ(read_image(map("orientation.png")).width, 80);
    for (const char* name : {"gbuffer.exr", "sparse.exr", "informative.exr", "partial.exr", "photoreal.exr"})
        EXPECT_FALSE(read_exr(map(name)).parts.at(0).half) << name;
}

TEST_F(Maps, OrientedVectorsAreUnitAndTangent) {
    const PlyPhotons ply = read_ply(folder->read("made/maps/photons.ply"));
    EXPECT_EQ(ply.emitted, 15000);
    int painted = 0;
    for (const PlyPhoton& photon : ply.photons) {
        ASSERT_NEAR(glm::length(vec(photon.n)), 1, 1e-5);
        ASSERT_NEAR(glm::length(vec(photon.d)), 1, 1e-5);
        ASSERT_LT(glm::dot(vec(photon.n), vec(photon.d)), 1e-5); // the normal of the side hit
        if (photon.npr == 0) {
            ASSERT_EQ(vec(photon.t), Vec3f(0));
            continue;
        }
        ++painted;
        ASSERT_EQ(photon.object, 7); // six walls, then the painted ball
        ASSERT_NEAR(glm::length(vec(photon.t)), 1, 1e-5);
        ASSERT_NEAR(glm::dot(vec(photon.t), vec(photon.n)), 0, 1e-5);
        ASSERT_NEAR(glm::length(vec(photon.p) - Vec3f(-0.35f, 0.5f, 0.1f)), 0.5, 1e-4); // scene coordinates
    }
    EXPECT_GT(painted, 500);
}

TEST_F(Maps, SourcesAreVisibleInTheGBuffer) {
    const Map g(map("gbuffer.exr")), sparse(map("sparse.exr"));
    int sources = 0;
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 80; ++x) {
            if (sparse.at("source", x, y) == 0) {
                for (const std::string& name : sparse.file.parts[0].channel_names)
                    ASSERT_EQ(sparse.at(name, x, y), 0);
                continue;
            }
            ++sources;
            ASSERT_EQ(sparse.at("source", x, y), 1);
            ASSERT_EQ(g.at("npr", x, y), 1);
            ASSERT_EQ(sparse.at("id.object", x, y), g.at("id.object", x, y));
            ASSERT_EQ(sparse.at("id.via", x, y), g.at("id.via", x, y));
            ASSERT_NEAR(sparse.at("Z", x, y), g.at("Z", x, y), 0.02f * g.at("Z", x, y));
            const float dx = sparse.at("dir.X", x, y), dy = sparse.at("dir.Y", x, y);
            ASSERT_NEAR(std::hypot(dx, dy), 1, 1e-5);
            ASSERT_TRUE(dx > 0 || (dx == 0 && dy > 0));
        }
    }
    EXPECT_GT(sources, 200);
}

// The contract's rule by brute force over all sources.
TEST_F(Maps, InformativeFollowsFromSparse) {
    const Map g(map("gbuffer.exr")), sparse(map("sparse.exr")), informative(map("informative.exr"));
    const float radius = informative.number("pnr:radius.7");
    EXPECT_EQ(radius, informative.number("pnr:radius"));
    EXPECT_NEAR(radius, 20 * 80 / 512.0, 1e-6);
    int kinds[4] = {0, 0, 0, 0};
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 80; ++x) {
            const int kind = static_cast<int>(informative.at("kind", x, y));
            ++kinds[kind];
            ASSERT_EQ(kind != 0, g.at("npr", x, y) == 1);
            if (kind == 0) continue;
            Vec3 color(0);
            Vec2 axis(0);
            double weights = 0;
            for (int v = 0; v < 80; ++v) {
                for (int u = 0; u < 80; ++u) {
                    const double d2 = (u - x) * (u - x) + (v - y) * (v - y);
                    if (sparse.at("source", u, v) == 0 || d2 > radius * radius) continue;
                    if (sparse.at("id.object", u, v) != g.at("id.object", x, y)) continue;
                    if (d2 > 0 && kind == 1) continue; // a source is copied
                    const double w = d2 > 0 ? 1 / d2 : 1;
                    const Vec2 dir(sparse.at("dir.X", u, v), sparse.at("dir.Y", u, v));
                    color += w * Vec3(sparse.at("R", u, v), sparse.at("G", u, v), sparse.at("B", u, v));
                    axis += w * Vec2(dir.x * dir.x - dir.y * dir.y, 2 * dir.x * dir.y);
                    weights += w;
                }
            }
            ASSERT_EQ(kind == 1, sparse.at("source", x, y) == 1);
            ASSERT_EQ(kind == 3, weights == 0) << x << "," << y;
            if (weights == 0) continue;
            color /= weights;
            ASSERT_NEAR(informative.at("R", x, y), color.x, 1e-3 * (1e-3 + color.x));
            ASSERT_NEAR(informative.at("B", x, y), color.z, 1e-3 * (1e-3 + color.z));
            if (glm::length(axis) < 1e-2 * weights) continue; // directions that cancel have no axis
            const Vec2 dir(informative.at("dir.X", x, y), informative.at("dir.Y", x, y));
            const Vec2 doubled(dir.x * dir.x - dir.y * dir.y, 2 * dir.x * dir.y);
            ASSERT_NEAR(glm::length(doubled - axis / glm::length(axis)), 0, 1e-3);
        }
    }
    EXPECT_GT(kinds[1], 200);
    EXPECT_GT(kinds[2], 50);
    const nlohmann::json stats = nlohmann::json::parse(folder->read("s.json"));
    EXPECT_EQ(stats["npr"]["source_pixels"], kinds[1]);
    EXPECT_EQ(stats["npr"]["filled_pixels"], kinds[3]);
    EXPECT_EQ(stats["npr"]["painted_pixels"], kinds[1] + kinds[2] + kinds[3]);
}

TEST_F(Maps, MainPictureHoldsTheSumOfTheLayersAndTheAovs) {
    const ImageFile main = read_exr(*folder / "box.exr");
    ASSERT_EQ(main.parts.size(), 5u);
    EXPECT_EQ(main.parts[0].name, "beauty");
    EXPECT_EQ(main.parts[0].channel_names, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_TRUE(main.parts[0].half);
    EXPECT_EQ(main.parts[2].name, "id");
    EXPECT_FALSE(main.parts[2].half);
    const Map partial(map("partial.exr")), photoreal(map("photoreal.exr")), g(map("gbuffer.exr"));
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 80; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y * 80 + x);
            const float sum = partial.at("G", x, y) + photoreal.at("G", x, y);
            ASSERT_NEAR(main.parts[0].data[4 * pixel + 1], sum, 1e-3 * (0.01 + sum)); // half has 11 bits
            ASSERT_EQ(main.parts[2].data[2 * pixel], g.at("id.object", x, y));
        }
    }
}

TEST_F(Maps, PassTimesAddUpToTheProcess) {
    const nlohmann::json stats = nlohmann::json::parse(folder->read("s.json"));
    double cpu = 0;
    for (const auto& pass : stats["passes"]) {
        EXPECT_GT(pass["peak_rss_mb"], 0.0) << pass["name"];
        cpu += pass["cpu_s"].get<double>();
    }
    EXPECT_NEAR(cpu, ran.cpu_s, 0.05 * ran.cpu_s);
    EXPECT_GT(stats["photons"]["npr"], 500);
    EXPECT_EQ(stats["photons"]["emitted"], 15000);
}

TEST(PowerBalance, EmittedIsAbsorbedAndEscaped) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene("global_settings { photons { count 200000 } }\n"));
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "8", "--stats", "s.json"}).code, 0);
    const nlohmann::json photons = nlohmann::json::parse(folder.read("s.json"))["photons"];
    for (std::size_t c = 0; c < 3; ++c) {
        const double emitted = photons["emitted_power"][c];
        EXPECT_NEAR(emitted, 60, 1e-3);
        EXPECT_NEAR(photons["absorbed_power"][c].get<double>() + photons["escaped_power"][c].get<double>(),
                    emitted, 0.01 * emitted);
    }
}

} // namespace
} // namespace pnr
