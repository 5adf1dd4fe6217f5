// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr render --show`: pixels whose colour is known from the scene alone.
#include "cli/show.h"

#include "cli/drawing.h"
#include "core/image_io.h"
#include "run_pnr.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace pnr {
namespace {

using Words = std::vector<std::string>;
using Bytes = std::array<int, 3>;

// 2 x 2 seen in 100 x 100 pixels from the front: a painted ball of radius 0.4 at the left, a mesh's square of
// 0.8 at the right, nothing above 0.4.
const char* const scene = R"(camera { orthographic location <0, 0, -5> look_at 0 right 2*x up 2*y }
global_settings { photons { count 200000 } }
light_source { <0, 1, -9>, rgb 1 emitter { sphere 0.5 } power 3000 }
sphere { <-0.5, 0, 0>, 0.4 pigment { rgb <0.9, 0.5, 0.2> }
    npr { seeds { seed { <-0.5, 0, -0.4>, x } seed { <-0.5, 0, 0.4>, x } } field along x } }
mesh { triangle { <0.1, -0.4, 0>, <0.9, -0.4, 0>, <0.9, 0.4, 0> } triangle { <0.1, -0.4, 0>, <0.9, 0.4, 0>, <0.1, 0.4, 0> }
    pigment { rgb 0.5 } }
)";

Bytes bytes_of(Color c) {
    return {static_cast<int>(std::lround(255 * srgb_encode(c.x))),
            static_cast<int>(std::lround(255 * srgb_encode(c.y))),
            static_cast<int>(std::lround(255 * srgb_encode(c.z)))};
}

struct Picture {
    Image<glm::vec4> image;
    explicit Picture(const std::filesystem::path& file) : image(read_image(file)) {}
    Bytes at(int x, int y) const { return bytes_of(Color(image.at(x, y))); }
    int count(Bytes color) const {
        int n = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) n += at(x, y) == color;
        return n;
    }
};

Ran show_kinds(const TemporaryFolder& folder, const std::string& kinds, const Words& more = {}) {
    folder.write("a.pnr", scene);
    Words words{"render", "a.pnr", "-W",         "100", "-H",      "100",
                "--show", kinds,   "--progress", "off", "--stats", "stats.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_pnr(folder, words);
}

double cpu_of(const TemporaryFolder& folder, const std::string& pass) {
    const nlohmann::json stats = nlohmann::json::parse(folder.read("stats.json"));
    for (const auto& each : stats["passes"])
        if (each["name"] == pass) return each["cpu_s"];
    return -1;
}

TEST(Show, IdsHaveTheirColours) {
    const TemporaryFolder folder;
    const Ran ran = show_kinds(folder, "ids", {"-o", "ids.png"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Picture picture(folder / "ids.png");
    EXPECT_EQ(picture.at(25, 50), bytes_of(number_color(1)));
    EXPECT_EQ(picture.at(75, 50), bytes_of(number_color(2)));
    EXPECT_EQ(picture.at(50, 5), (Bytes{0, 0, 0}));
    EXPECT_NEAR(picture.count(bytes_of(number_color(1))), pi * 20 * 20, 60);
    EXPECT_NEAR(picture.count(bytes_of(number_color(2))), 1600, 90);
    EXPECT_NE(ran.err.find("ids: object 1 #"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("sphere a.pnr:4:1, painted"), std::string::npos) << ran.err;
    for (const char* pass : {"photons", "kdtree", "sparse", "ilic", "render"})
        EXPECT_EQ(cpu_of(folder, pass), 0) << pass;
    EXPECT_NE(folder.read("stats.json").find("what is shown does not need it"), std::string::npos);
}

TEST(Show, NormalsAreTheSphere) {
    const TemporaryFolder folder;
    ASSERT_EQ(show_kinds(folder, "normals", {"-o", "n.png"}).code, 0);
    const Picture picture(folder / "n.png");
    for (const auto& [x, y] : {std::pair{25, 50}, {35, 50}, {20, 60}, {30, 38}}) {
        const double nx = ((x + 0.5) / 50 - 1 + 0.5) / 0.4, ny = (1 - (y + 0.5) / 50) / 0.4;
        const double nz = -std::sqrt(1 - nx * nx - ny * ny);
        const double n[] = {nx, ny, nz};
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(picture.at(x, y)[c], 255 * (0.5 + 0.5 * n[c]), 1.01) << x << " " << y;
    }
    EXPECT_EQ(picture.at(75, 50), (Bytes{128, 128, 0})); // flat, towards the viewer
}

TEST(Show, PhotonsLieWhereLightFalls) {
    const TemporaryFolder folder;
    const Ran ran = show_kinds(folder, "photons", {"-o", "p.png"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Picture picture(folder / "p.png");
    const int direct = picture.count(bytes_of(displayed(1, 0.85f, 0.25f)));
    EXPECT_GT(direct, 100);
    EXPECT_EQ(picture.count(bytes_of(displayed(1, 0.25f, 0.3f))), 0); // nothing throws caustics
    const nlohmann::json stats = nlohmann::json::parse(folder.read("stats.json"));
    EXPECT_GE(stats["photons"]["stored"].get<int>(), direct);
    EXPECT_EQ(cpu_of(folder, "kdtree"), 0);
    EXPECT_EQ(cpu_of(folder, "render"), 0);
}

TEST(Show, FieldHasStrokesAlongItAndNumberedSeeds) {
    const TemporaryFolder folder;
    const Ran ran = show_kinds(folder, "field", {"-o", "f.png"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("field: seed 1 a.pnr:5:24 of object 1 at <-0.5, 0, -0.4>\n"), std::string::npos)
        << ran.err;
    EXPECT_NE(ran.err.find("field: seed 2 a.pnr:5:52 of object 1 at <-0.5, 0, 0.4>, not seen\n"),
              std::string::npos)
        << ran.err;
    // Strokes of a field along x are rows; between them the ground stays.
    const Picture picture(folder / "f.png");
    const Bytes stroke = bytes_of(displayed(0.75f, 0.9f, 1));
    int alike_across = 0, alike_down = 0;
    for (int y = 1; y < 99; ++y)
        for (int x = 1; x < 99; ++x) {
            if (picture.at(x, y) != stroke) continue;
            alike_across += picture.at(x - 1, y) == stroke || picture.at(x + 1, y) == stroke;
            alike_down += picture.at(x, y - 1) == stroke || picture.at(x, y + 1) == stroke;
        }
    EXPECT_GT(alike_across, 50);
    EXPECT_LT(alike_down, alike_across / 20);
    EXPECT_EQ(cpu_of(folder, "photons"), 0);
}

TEST(Show, WireHasSilhouettesAndEdges) {
    const TemporaryFolder folder;
    ASSERT_EQ(show_kinds(folder, "wire", {"-o", "w.png"}).code, 0);
    const Picture picture(folder / "w.png");
    const Bytes white{255, 255, 255};
    EXPECT_NEAR(picture.count(white), 2 * pi * 20 + 160, 60);
    EXPECT_TRUE(picture.at(5, 50) == white || picture.at(4, 50) == white); // the ball's left end
    const Bytes blue = bytes_of(displayed(0.45f, 0.65f, 1));
    EXPECT_EQ(picture.at(75, 49), blue);       // the diagonal from <0.1, -0.4> to <0.9, 0.4>
    EXPECT_NEAR(picture.count(blue), 120, 12); // and the two sides whose silhouette lies outside
}

TEST(Show, MapsOfThePainting) {
    const TemporaryFolder folder;
    const Ran ran = show_kinds(folder, "sparse,informative,partial", {"-o", "m.png"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const nlohmann::json stats = nlohmann::json::parse(folder.read("stats.json"));
    EXPECT_NE(ran.err.find(std::to_string(stats["npr"]["source_pixels"].get<int>()) + " source photons"),
              std::string::npos);
    for (const char* name : {"m_informative.png", "m_partial.png"}) {
        const Picture picture(folder / name);
        const Bytes ball = picture.at(25, 50), ground = picture.at(75, 50);
        EXPECT_GT(ball[0], ball[2] + 30) << name; // of the ball's orange
        EXPECT_EQ(ground, bytes_of(displayed(0.08f, 0.08f, 0.1f))) << name;
    }
    EXPECT_EQ(cpu_of(folder, "render"), 0);
}

TEST(Show, ErrorIsHeatWithALegend) {
    const TemporaryFolder folder;
    const Ran ran = show_kinds(folder, "error", {"-o", "e.png", "-W", "64", "-H", "64"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("after 13 passes"), std::string::npos) << ran.err;
    const Picture picture(folder / "e.png");
    EXPECT_LT(picture.at(0, 63)[2], 20);
    EXPECT_GT(picture.at(63, 63)[0], 240);
    EXPECT_GT(picture.at(63, 63)[2], 230);
    EXPECT_EQ(picture.at(32, 2), (Bytes{0, 0, 0})); // nothing is seen there: no error
}

TEST(Show, OnePictureForEachKind) {
    const TemporaryFolder folder;
    ASSERT_EQ(show_kinds(folder, "ids,normals", {"-o", "i.png", "-o", "n.exr"}).code, 0);
    ASSERT_EQ(show_kinds(folder, "ids,wire").code, 0);
    EXPECT_EQ(folder.names(), (Words{"a.pnr", "a_ids.png", "a_wire.png", "i.png", "n.exr", "stats.json"}));
    EXPECT_EQ(folder.read("i.png"), folder.read("a_ids.png"));
    EXPECT_EQ(show_kinds(folder, "ids,normals,wire", {"-o", "i.png", "-o", "n.exr"}).code, 2);
    const Ran wrong = show_kinds(folder, "idz");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("kinds are field, photons, sparse"), std::string::npos) << wrong.err;
    ASSERT_EQ(show_kinds(folder, "ids", {"-o", "crop.png", "--crop", "20,40,30,60"}).code, 0);
    const Picture crop(folder / "crop.png");
    EXPECT_EQ(crop.image.width, 10);
    EXPECT_EQ(crop.at(5, 10), bytes_of(number_color(1)));
}

TEST(Drawing, HeatGrowsLighter) {
    float before = -1;
    for (int i = 0; i <= 100; ++i) {
        const float light = luminance(heat(i / 100.0));
        EXPECT_GT(light, before) << i;
        before = light;
    }
    EXPECT_EQ(heat(std::numeric_limits<double>::quiet_NaN()), Color(0));
    EXPECT_EQ(heat(7), heat(1));
}

TEST(Drawing, NumbersAreReadable) {
    Image<Color> picture(8, 7, Color(0.5f));
    draw_number(picture, 0, 0, "17", 1, Color(1));
    std::string rows;
    for (int y = 1; y < 6; ++y) {
        for (int x = 1; x < 8; ++x) rows += picture.at(x, y).x > 0.9f ? '#' : '.';
        rows += '\n';
    }
    EXPECT_EQ(rows, ".#..###\n##....#\n.#...#.\n.#...#.\n###..#.\n");
    draw_number(picture, 6, 5, "888", 3, Color(1)); // cut at the picture's edge
}

} // namespace
} // namespace pnr
