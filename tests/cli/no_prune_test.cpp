// SPDX-License-Identifier: GPL-3.0-or-later
// Leaving out what a scene does not need changes no picture: every scene of the project, with and without.
#include "core/image_io.h"
#include "run_pnr.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace pnr {
namespace {

namespace fs = std::filesystem;

// Those of a folder, in the order of their names.
std::vector<fs::path> scenes_of(const std::string& folder) {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator(std::string(PNR_SOURCE_DIR "/scenes/") + folder))
        if (const std::string end = entry.path().extension(); end == ".pnr" || end == ".pov")
            scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

// Largest difference of two pictures in a channel; infinite where one holds what is no number.
double largest_difference(const fs::path& a, const fs::path& b) {
    const Image<glm::vec4> first = read_image(a), second = read_image(b);
    if (first.width != second.width || first.height != second.height) return INFINITY;
    double most = 0;
    for (std::size_t i = 0; i < first.pixels.size(); ++i)
        for (int c = 0; c < 4; ++c) {
            const double off = std::abs(static_cast<double>(first.pixels[i][c]) - static_cast<double>(second.pixels[i][c]));
            most = std::isfinite(off) ? std::max(most, off) : INFINITY;
        }
    return most;
}

// Renders a scene both ways and compares; false, and nothing said, if it needs a file that is not there.
bool compare(const TemporaryFolder& folder, const fs::path& scene) {
    const std::vector<std::string> words{"render", scene.string(), "--size", "96x64", "--quality", "draft", "--progress", "off",
                                         "-L", PNR_SOURCE_DIR "/scenes/paper"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), words.begin(), words.end());
        return run_pnr(folder, more);
    };
    const Ran pruned = with({"-o", "a.exr"});
    if (pruned.code == 3 && pruned.err.find("there is no file") != std::string::npos) return false;
    const Ran whole = with({"--no-prune", "-o", "b.exr", "--stats", "b.json"});
    EXPECT_EQ(pruned.code, 0) << pruned.err;
    EXPECT_EQ(whole.code, 0) << whole.err;
    if (pruned.code != 0 || whole.code != 0) return true;
    EXPECT_LE(largest_difference(folder / "a.exr", folder / "b.exr"), 1e-4);
    EXPECT_TRUE(nlohmann::json::parse(folder.read("b.json"))["plan"]["left_out"].empty());
    return true;
}

class NoPrune : public testing::TestWithParam<const char*> {};

TEST_P(NoPrune, GivesTheSamePicture) {
    const TemporaryFolder folder;
    int compared = 0;
    for (const fs::path& scene : scenes_of(GetParam())) {
        SCOPED_TRACE(scene.filename().string());
        if (compare(folder, scene))
            ++compared;
        else
            std::printf("skipped: %s needs a mesh that is not there\n", scene.filename().c_str());
    }
    if (compared == 0) GTEST_SKIP() << "skipped: no meshes";
}

INSTANTIATE_TEST_SUITE_P(Scenes, NoPrune, testing::Values("", "course", "gallery", "paper"),
                         [](const auto& chosen) {
                             const std::string name = chosen.param;
                             return name.empty() ? std::string("own") : name;
                         });

} // namespace
} // namespace pnr
