// SPDX-License-Identifier: GPL-3.0-or-later
// The command line's contract, by the built program.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "run_pnr.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <set>

namespace pnr {
namespace {

using Words = std::vector<std::string>;

constexpr const char* plain_scene = R"(camera { location <0, 1, -4> look_at 0 right x angle 40 }
light_source { <3, 5, -4>, rgb 1 }
sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } }
plane { y, -1 pigment { checker rgb 1, rgb 0.3 } }
)";
constexpr const char* few_photons = "global_settings { photons { count 20000 } }\n";

std::vector<float> beauty(const TemporaryFolder& folder, const std::string& name) {
    return read_exr(folder / name).parts.at(0).data;
}

TEST(Program, AnswersGoToStandardOutputAlone) {
    const TemporaryFolder folder;
    for (const Words& words :
         {Words{"--version"}, Words{"help"}, Words{"help", "render"}, Words{"render", "--help"}}) {
        const Ran ran = run_pnr(folder, words);
        EXPECT_EQ(ran.code, 0) << words[0];
        EXPECT_FALSE(ran.out.empty());
        EXPECT_EQ(ran.err, "");
    }
    EXPECT_NE(run_pnr(folder, {"help", "render"}).out.find("--crop"), std::string::npos);
    for (const char* command : {"render", "check", "plan", "pick"})
        EXPECT_NE(run_pnr(folder, {"help"}).out.find(command), std::string::npos) << command;
    EXPECT_EQ(run_pnr(folder, {"help", "pick"}).out, run_pnr(folder, {"pick", "--help"}).out);
}

TEST(Program, CommandsWithoutPicturesDoNotNeedTheImageModule) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    const Environment nowhere{{"PNR_IMAGE_MODULE", "/nowhere/libpnr_image.so"}};
    EXPECT_EQ(run_pnr(folder, {"--version"}, nowhere).code, 0);
    EXPECT_EQ(run_pnr(folder, {"help"}, nowhere).code, 0);
    EXPECT_EQ(run_pnr(folder, {"check", "a.pnr"}, nowhere).code, 0);
    EXPECT_EQ(run_pnr(folder, {"plan", "a.pnr"}, nowhere).code, 0);
    const Ran exr = run_pnr(folder, {"render", "a.pnr", "-W", "8", "-o", "a.exr"}, nowhere);
    EXPECT_EQ(exr.code, 4);
    EXPECT_NE(exr.err.find("/nowhere/libpnr_image.so"), std::string::npos);
    EXPECT_EQ(folder.names(), Words{"a.pnr"});
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "-o", "a.png"}, nowhere).code, 0); // PNG is our own
}

TEST(Program, ExitCodesTellWhoIsToBlame) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    folder.write("broken.pnr", "sphere { 0, 1 }\nspere { 0, 1 }\n");
    EXPECT_EQ(run_pnr(folder, {}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "--frobnicate"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-o", "a.jpg"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "--aov", "Nx"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "--crop", "0,0,9,9"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"render", "broken.pnr"}).code, 3);
    EXPECT_EQ(run_pnr(folder, {"check", "a.pnr", "broken.pnr"}).code, 3);
    EXPECT_EQ(run_pnr(folder, {"render", "absent.pnr"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"check", "absent.pnr"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "-o", "no/such/folder.png"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "--stats", "/dev/full"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "--stats", "no/such/folder.json"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "--load-photons", "absent"}).code, 4);
}

TEST(Program, ErrorsInAScenePointAtTheirPlace) {
    const TemporaryFolder folder;
    folder.write("broken.pnr", "sphere { 0, 1 }\nspere { 0, 1 }\n");
    const Ran ran = run_pnr(folder, {"check", "broken.pnr"});
    EXPECT_EQ(ran.out, "");
    EXPECT_NE(ran.err.find("broken.pnr:2:1: error:"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("spere { 0, 1 }"), std::string::npos);
    EXPECT_NE(ran.err.find("^"), std::string::npos);
    EXPECT_NE(ran.err.find("sphere"), std::string::npos);
    EXPECT_EQ(ran.err.find("\x1b["), std::string::npos); // no colour off a terminal
    const Ran json = run_pnr(folder, {"check", "broken.pnr", "--format", "json"});
    EXPECT_EQ(json.code, 3);
    EXPECT_TRUE(nlohmann::json::accept(json.out)) << json.out;
    const Ran both = run_pnr(folder, {"check", "broken.pnr", "broken.pnr", "--format", "json"});
    EXPECT_EQ(nlohmann::json::parse(both.out).size(), 2 * nlohmann::json::parse(json.out).size());
}

TEST(Program, PicturesHaveTheSizeOfTheContract) {
    const TemporaryFolder folder;
    folder.write("a.pov",
                 "camera { location -4*z look_at 0 }\nlight_source { <3,5,-4>, 1 }\nsphere { 0, 1 }\n");
    ASSERT_EQ(run_pnr(folder, {"render", "a.pov", "-A"}).code, 0);
    Image<glm::vec4> picture = read_image(folder / "a.png");
    EXPECT_EQ(picture.width, 512);
    EXPECT_EQ(picture.height, 385); // 512 / 1.33, the camera's default `right`
    ASSERT_EQ(run_pnr(folder, {"render", "a.pov", "-H", "30", "-o", "b.png"}).code, 0);
    picture = read_image(folder / "b.png");
    EXPECT_EQ(picture.width, 40);
    EXPECT_EQ(picture.height, 30);
}

TEST(Program, ReadsStandardInputAndWritesStandardOutput) {
    const TemporaryFolder folder;
    const Ran ran =
        run_pnr(folder, {"render", "-", "-W", "8", "-o", "-", "--progress", "off"}, {}, plain_scene);
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_EQ(ran.out.substr(1, 3), "PNG");
    EXPECT_TRUE(folder.names().empty());
}

TEST(Program, ExistingPicturesAreReplacedOrKeptAsAsked) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    folder.write("a.png", "old");
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "--skip-existing"}).code, 0);
    EXPECT_EQ(folder.read("a.png"), "old");
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8", "--no-overwrite"}).code, 4);
    EXPECT_EQ(folder.read("a.png"), "old");
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "8"}).code, 0);
    EXPECT_EQ(folder.read("a.png").substr(1, 3), "PNG");
    EXPECT_EQ(folder.names(), (Words{"a.png", "a.pnr"}));
}

TEST(Program, ThreadsAndCropDoNotChangeABit) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    ASSERT_EQ(run_pnr(folder,
                      {"render", "box.pnr", "-W", "64", "--threads", "2", "-o", "full.exr", "-o", "full.png"})
                  .code,
              0);
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "64", "--threads", "1", "-o", "one.exr"}).code, 0);
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "64", "--crop", "12,20,45,50", "-o", "crop.exr",
                               "-o", "crop.png"})
                  .code,
              0);
    const std::vector<float> full = beauty(folder, "full.exr");
    EXPECT_EQ(full, beauty(folder, "one.exr"));
    const ImageFile crop = read_exr(folder / "crop.exr");
    EXPECT_EQ(crop.width, 64);
    EXPECT_EQ(crop.height, 64);
    EXPECT_EQ(crop.data_window.x0, 12);
    EXPECT_EQ(crop.data_window.y1, 50);
    const int width = 45 - 12;
    int different = 0;
    for (int y = 20; y < 50; ++y)
        for (int x = 12; x < 45; ++x)
            for (int c = 0; c < 4; ++c)
                different +=
                    crop.parts[0].data[static_cast<std::size_t>(((y - 20) * width + x - 12) * 4 + c)] !=
                    full[static_cast<std::size_t>((y * 64 + x) * 4 + c)];
    EXPECT_EQ(different, 0);
    EXPECT_EQ(read_image(folder / "crop.png").width, width);
}

TEST(Program, SavedPhotonsGiveTheSamePictureAndFitTheirSceneAlone) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    folder.write("other.pnr", box_scene(few_photons) + "sphere { <0, 1.5, 0>, 0.1 }\n");
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "32", "-o", "a.exr", "--save-photons", "map"}).code,
              0);
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "32", "-o", "b.exr", "--load-photons", "map"}).code,
              0);
    EXPECT_EQ(beauty(folder, "a.exr"), beauty(folder, "b.exr"));
    EXPECT_EQ(run_pnr(folder, {"render", "other.pnr", "-W", "32", "--load-photons", "map"}).code, 3);
}

TEST(Program, PrunedAndUnprunedPicturesAgree) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "32", "-o", "a.exr"}).code, 0);
    ASSERT_EQ(
        run_pnr(folder, {"render", "box.pnr", "-W", "32", "-o", "b.exr", "--no-prune", "--stats", "s.json"})
            .code,
        0);
    const std::vector<float> a = beauty(folder, "a.exr"), b = beauty(folder, "b.exr");
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-4 * (1 + std::abs(a[i]))) << i;
    EXPECT_TRUE(nlohmann::json::parse(folder.read("s.json"))["plan"]["left_out"].empty());
}

TEST(Program, StatisticsHaveEveryKey) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    ASSERT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "16", "--stats", "s.json"}).code, 0);
    const nlohmann::json s = nlohmann::json::parse(folder.read("s.json"));
    EXPECT_EQ(s["schema"], 1);
    EXPECT_EQ(s["program"], "pnr");
    for (const char* key : {"version", "scene", "threads", "seed", "image", "passes", "photons", "npr",
                            "rays", "memory", "numbers", "plan", "error", "warnings"})
        EXPECT_TRUE(s.contains(key)) << key;
    EXPECT_EQ(s["image"]["width"], 16);
    const Words names{"parse",  "build",       "photons", "kdtree", "gbuffer", "sparse",
                      "orient", "informative", "ilic",    "render", "write"};
    ASSERT_EQ(s["passes"].size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(s["passes"][i]["name"], names[i]);
        EXPECT_GE(s["passes"][i]["wall_s"], 0.0);
        EXPECT_GE(s["passes"][i]["cpu_s"], 0.0);
        EXPECT_GE(s["passes"][i]["peak_rss_mb"], 0.0);
    }
    for (const char* key : {"emitted", "stored", "npr", "caustic"}) EXPECT_EQ(s["photons"][key], 0) << key;
    for (const char* key : {"emitted_power", "absorbed_power", "escaped_power"})
        EXPECT_EQ(s["photons"][key].size(), 3u);
    for (const char* key : {"source_pixels", "painted_pixels", "filled_pixels"}) EXPECT_EQ(s["npr"][key], 0);
    for (const char* key : {"nan", "inf", "negative"}) EXPECT_EQ(s["numbers"][key], 0);
    EXPECT_FALSE(s["plan"]["left_out"].empty());
    EXPECT_TRUE(s["plan"]["left_out"][0].contains("why"));
}

TEST(Program, ASignalSavesWhatThereIsAndIsTold) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    const Ran ran =
        run_pnr_and_signal(folder, {"render", "box.pnr", "-W", "1500", "--stats", "s.json"}, SIGTERM, "ilic");
    EXPECT_EQ(ran.code, 143) << ran.err;
    EXPECT_EQ(folder.names(), (Words{"box.png", "box.pnr", "s.json"}));
    EXPECT_EQ(read_image(folder / "box.png").width, 1500);
    const Ran interrupted = run_pnr_and_signal(folder, {"render", "box.pnr", "-W", "1500"}, SIGINT, "parse");
    EXPECT_EQ(interrupted.code, 130);
}

TEST(Program, FramesMoveTheClockAndGoOnWhereTheyStopped) {
    const TemporaryFolder folder;
    folder.write("move.pnr",
                 std::string(plain_scene) + "sphere { <4 * clock - 2, 0, -1.5>, 0.4 pigment { rgb z } }\n");
    const Words words{"render", "move.pnr",       "-W", "24", "--frames", "1-3", "--stats",
                      "s.json", "--skip-existing"};
    ASSERT_EQ(run_pnr(folder, words).code, 0);
    EXPECT_EQ(folder.names(), (Words{"move.pnr", "move0001.png", "move0002.png", "move0003.png", "s0001.json",
                                     "s0002.json", "s0003.json"}));
    ASSERT_EQ(run_pnr(folder, {"render", "move.pnr", "-W", "24", "-o", "still.png"}).code, 0);
    EXPECT_EQ(folder.read("still.png"), folder.read("move0001.png")); // clock 0
    EXPECT_NE(folder.read("move0001.png"), folder.read("move0002.png"));
    const std::string second = folder.read("move0002.png");
    folder.write("move0001.png", "kept");
    std::filesystem::remove(folder / "move0002.png");
    ASSERT_EQ(run_pnr(folder, words).code, 0);
    EXPECT_EQ(folder.read("move0001.png"), "kept");
    EXPECT_EQ(folder.read("move0002.png"), second);
}

TEST(Program, PickNamesTheObjectAndGivesASeed) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene("#declare Pearl = sphere { <0, 1.5, 0>, 0.3 }\nobject { Pearl }\n"));
    const Ran ran = run_pnr(folder, {"pick", "box.pnr", "-W", "100", "--at", "30,58", "--to", "33,58"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    double p[3], n[3], s[3], d[3];
    char name[64] = "";
    int number = 0;
    ASSERT_EQ(std::sscanf(ran.out.c_str(), "object %d %63s", &number, name), 2) << ran.out;
    EXPECT_EQ(number, 7);
    ASSERT_EQ(std::sscanf(ran.out.c_str() + ran.out.find("point"), "point <%lf, %lf, %lf>", p, p + 1, p + 2),
              3);
    ASSERT_EQ(
        std::sscanf(ran.out.c_str() + ran.out.find("normal"), "normal <%lf, %lf, %lf>", n, n + 1, n + 2), 3);
    ASSERT_EQ(std::sscanf(ran.out.c_str() + ran.out.find("seed"), "seed { <%lf, %lf, %lf>, <%lf, %lf, %lf> }",
                          s, s + 1, s + 2, d, d + 1, d + 2),
              6)
        << ran.out;
    const Vec3 centre(-0.35, 0.5, 0.1), point(p[0], p[1], p[2]), normal(n[0], n[1], n[2]),
        direction(d[0], d[1], d[2]);
    EXPECT_NEAR(glm::length(point - centre), 0.5, 1e-4);
    EXPECT_NEAR(glm::length((point - centre) / 0.5 - normal), 0, 1e-3);
    EXPECT_NEAR(glm::dot(direction, normal), 0, 1e-4);
    EXPECT_GT(direction.x, 0.5); // to the right
    EXPECT_NE(run_pnr(folder, {"pick", "box.pnr", "-W", "100", "--at", "50,12"}).out.find("Pearl"),
              std::string::npos);
}

TEST(Program, IlicPaintsAFlatPicture) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    ASSERT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "48", "-o", "a.png"}).code, 0);
    const Ran ran = run_pnr(folder, {"ilic", "a.png", "--length", "20", "--style", "oil"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(read_image(folder / "a_painted.png").width, 48);
    EXPECT_EQ(run_pnr(folder, {"ilic", "a.png", "--style", "watercolour"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"ilic", "absent.png"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"ilic", "a.pnr"}).code, 4) << "no picture";
}

TEST(Program, PlanSaysWhatIsLeftOut) {
    const TemporaryFolder folder;
    folder.write("a.pnr", plain_scene);
    const Ran text = run_pnr(folder, {"plan", "a.pnr"});
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.out.find("nothing is painted"), std::string::npos) << text.out;
    const nlohmann::json plan =
        nlohmann::json::parse(run_pnr(folder, {"plan", "a.pnr", "--format", "json"}).out);
    EXPECT_TRUE(plan["used"].is_array());
    EXPECT_FALSE(plan["left_out"].empty());
}

// A ball in the middle that sends more light than a float can hold, and is seen in a mirror too.
TEST(Program, TracesSamplesThatAreNoLightToTheirObject) {
    const TemporaryFolder folder;
    folder.write("a.pov", R"(#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 0, -4> look_at 0 right x }
light_source { <3, 5, -4>, rgb 1 }
box { <-9, -9, 5>, <9, 9, 6> pigment { rgb 0.5 } finish { reflection 0.5 } }
sphere { 0, 0.3 pigment { rgb 1 } finish { ambient 1e38 * 100 diffuse 0 } }
)");
    const Ran ran = run_pnr(folder, {"render", "a.pov", "-W", "32", "-H", "32", "-o", "a.exr", "--aov", "numbers", "--stats", "s.json"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("object 2, `sphere` at a.pov:5:1"), std::string::npos) << ran.err;
    const nlohmann::json numbers = nlohmann::json::parse(folder.read("s.json"))["numbers"];
    EXPECT_GT(numbers["inf"], 0);
    ASSERT_EQ(numbers["objects"].size(), 1u);
    EXPECT_EQ(numbers["objects"][0]["samples"], numbers["inf"]);
    const ImageFile file = read_exr(folder / "a.exr");
    for (const ImagePart& part : file.parts) {
        if (part.name != "numbers") continue;
        const auto inf = std::find(part.channel_names.begin(), part.channel_names.end(), "numbers.inf");
        const auto channel = static_cast<std::size_t>(inf - part.channel_names.begin());
        EXPECT_GT(part.data.at((16 * 32 + 16) * 3 + channel), 0) << "the ball";
        EXPECT_EQ(part.data.at(channel), 0) << "the wall beside it";
    }
    const Image<glm::vec4> picture = read_image(folder / "a.exr");
    for (const glm::vec4& pixel : picture.pixels) EXPECT_TRUE(std::isfinite(pixel.x + pixel.y + pixel.z + pixel.w));
}

TEST(Program, WarningsAreErrorsIfAsked) {
    const TemporaryFolder folder;
    folder.write("a.pov", std::string(plain_scene) + "#warning \"careful\\n\"\n");
    EXPECT_EQ(run_pnr(folder, {"check", "a.pov"}).code, 0);
    EXPECT_EQ(run_pnr(folder, {"check", "a.pov", "--werror"}).code, 3);
}

} // namespace
} // namespace pnr
