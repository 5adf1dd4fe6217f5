// SPDX-License-Identifier: GPL-3.0-or-later
// Progressive runs by the built program: the clock, the error, the passes.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "run_pnr.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <csignal>

namespace pnr {
namespace {

constexpr const char* few_photons = "global_settings { photons { count 4000 } }\n";

nlohmann::json error_of(const TemporaryFolder& folder, const std::string& stats) {
    return nlohmann::json::parse(folder.read(stats)).at("error");
}

TEST(Refine, ATimedRunIsRepeatedByItsPasses) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    const auto begin = std::chrono::steady_clock::now();
    const Ran timed = run_pnr(folder, {"render", "box.pnr", "-W", "48", "-H", "48", "--time", "4", "-o", "a.exr",
                                       "--stats", "a.json"});
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ASSERT_EQ(timed.code, 0) << timed.err;
    EXPECT_GT(wall, 3) << "the time is to be used"; // no upper bound here: the machine may be busy
    const int passes = error_of(folder, "a.json").at("passes");
    ASSERT_GT(passes, 0);
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "48", "-H", "48", "--passes", std::to_string(passes), "-o",
                               "b.exr", "--threads", "1"})
                  .code,
              0);
    EXPECT_EQ(read_exr(folder / "a.exr").parts.at(0).data, read_exr(folder / "b.exr").parts.at(0).data);
}

TEST(Refine, ACropOfPassesHasThePicturesBits) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "40", "-H", "40", "--passes", "9", "-o", "all.exr"}).code, 0);
    ASSERT_EQ(run_pnr(folder, {"render", "box.pnr", "-W", "40", "-H", "40", "--passes", "9", "-o", "cut.exr", "--crop",
                               "10,5,30,25"})
                  .code,
              0);
    const ImageFile all = read_exr(folder / "all.exr"), cut = read_exr(folder / "cut.exr");
    for (int y = 5; y < 25; ++y)
        for (int x = 10; x < 30; ++x)
            for (std::size_t c = 0; c < 4; ++c)
                ASSERT_EQ(all.parts[0].data[static_cast<std::size_t>(y * 40 + x) * 4 + c],
                          cut.parts[0].data[static_cast<std::size_t>((y - 5) * 20 + x - 10) * 4 + c]);
}

TEST(Refine, AnErrorThatIsReachedEndsTheRunAndOneThatIsNotIsExitCode5) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    const Ran easy = run_pnr(folder, {"render", "box.pnr", "-W", "32", "-H", "32", "--error", "0.5", "--stats", "a.json",
                                      "-o", "a.png"});
    EXPECT_EQ(easy.code, 0) << easy.err;
    const auto reached = error_of(folder, "a.json");
    EXPECT_LT(reached.at("reached"), 0.5);
    EXPECT_GT(reached.at("reached"), 0);
    EXPECT_EQ(reached.at("asked"), 0.5);
    const Ran hard = run_pnr(folder, {"render", "box.pnr", "-W", "32", "-H", "32", "--error", "1e-6", "--passes", "9",
                                      "-o", "b.png"});
    EXPECT_EQ(hard.code, 5);
    EXPECT_NE(hard.err.find("missed"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder / "b.png")) << "the picture is there all the same";
}

TEST(Refine, ErrorPartsHoldNumbersThatFall) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    const auto noise = [&](const char* passes) {
        const Ran ran = run_pnr(folder, {"render", "box.pnr", "-W", "16", "-H", "16", "--passes", passes, "-o", "e.exr",
                                         "--aov", "error.noise,error.bias", "--stats", "e.json"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        const ImageFile image = read_exr(folder / "e.exr");
        EXPECT_EQ(image.parts.at(1).channel_names.at(0), "error.noise");
        EXPECT_EQ(image.parts.at(2).channel_names.at(0), "error.bias");
        double squares = 0;
        for (const float v : image.parts[1].data) squares += static_cast<double>(v) * static_cast<double>(v);
        EXPECT_NEAR(std::sqrt(squares / 256), error_of(folder, "e.json").at("noise_rms"), 1e-3 * std::sqrt(squares));
        return std::sqrt(squares);
    };
    const double early = noise("13"), late = noise("49"); // 3 and 12 batches
    EXPECT_GT(early, 0);
    EXPECT_LT(late, 0.75 * early); // by sqrt(3 / 12) = 0.5 in expectation
}

TEST(Refine, ASignalWritesThePictureSoFar) {
    const TemporaryFolder folder;
    folder.write("box.pnr", box_scene(few_photons));
    const Ran ran = run_pnr_and_signal(
        folder, {"render", "box.pnr", "-W", "48", "-H", "48", "--passes", "100000", "-o", "a.png", "--stats", "a.json"},
        SIGTERM, "passes: 90 %");
    EXPECT_EQ(ran.code, 143);
    EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
    EXPECT_GE(error_of(folder, "a.json").at("passes"), 8) << "two batches";
}

} // namespace
} // namespace pnr
