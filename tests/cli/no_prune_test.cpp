// SPDX-License-Identifier: GPL-3.0-or-later
// Leaving out what a scene does not need changes no picture: every scene of the project, with and without.
#include "cli/load.h"
#include "cli/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace pnr {
namespace {

namespace fs = std::filesystem;

// Those of a folder, in the order of their names.
std::vector<fs::path> scenes_of(const std::string& folder) {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator(std::string(PNR_SOURCE_DIR "/") + folder))
        if (const std::string end = entry.path().extension(); end == ".pnr" || end == ".pov")
            scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

Rendering rendered(const LoadResult& loaded, bool prune) {
    Settings settings = loaded.settings;
    settings.render.width = 96;
    settings.render.height = 64;
    settings.render.samples_min = 1, settings.render.samples_max = 4;
    settings.render.shadow_samples = 4;
    settings.photons.count = std::min<std::int64_t>(settings.photons.count, 20'000);
    settings.photons.spacing = 0;
    settings.render.prune = prune;
    Passes passes(ProgressMode::off, false);
    Reuse none;
    return render_scene(*loaded.scene, settings, {}, none, passes);
}

// In a channel; infinite where one holds what is no number.
double largest_difference(const Layer& a, const Layer& b) {
    double most = 0;
    const auto take = [&](float u, float v) {
        const double off = std::abs(static_cast<double>(u) - static_cast<double>(v));
        most = std::isfinite(off) ? std::max(most, off) : INFINITY;
    };
    for (std::size_t i = 0; i < a.color.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) take(a.color.pixels[i][c], b.color.pixels[i][c]);
        take(a.alpha.pixels[i], b.alpha.pixels[i]);
    }
    return most;
}

// Renders a scene both ways and compares; false, and nothing said, if it needs a mesh that is not there.
bool compare(const fs::path& file) {
    const LoadResult loaded = load_named_scene(file.string(), {}, {});
    if (!loaded.scene) {
        for (const Diagnostic& d : loaded.diagnostics)
            if (d.message.find("there is no file") != std::string::npos) return false;
        ADD_FAILURE() << "does not load";
        return true;
    }
    const Rendering whole = rendered(loaded, false);
    EXPECT_TRUE(whole.plan.left_out.empty());
    EXPECT_LE(largest_difference(rendered(loaded, true).picture, whole.picture), 1e-4);
    return true;
}

class NoPrune : public testing::TestWithParam<const char*> {};

TEST_P(NoPrune, GivesTheSamePicture) {
    int compared = 0;
    for (const fs::path& scene : scenes_of(GetParam())) {
        SCOPED_TRACE(scene.filename().string());
        if (compare(scene))
            ++compared;
        else
            std::printf("skipped: %s needs a mesh that is not there\n", scene.filename().c_str());
    }
    if (compared == 0) GTEST_SKIP() << "skipped: no meshes";
}

INSTANTIATE_TEST_SUITE_P(Scenes, NoPrune, testing::Values("scenes", "scenes/course", "scenes/gallery", "scenes/paper", "tests/bench/light",
                                         "tests/bench/prune", "tests/corpus/scenes"),
                         [](const auto& chosen) {
                             std::string name = chosen.param;
                             std::replace(name.begin(), name.end(), '/', '_');
                             return name;
                         });

} // namespace
} // namespace pnr
