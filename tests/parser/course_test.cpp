// SPDX-License-Identifier: GPL-3.0-or-later
// scenes/course: every lesson and solution loads without an error or a warning, is short, and has its picture.
#include "tests/parser/scene_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pnr {
namespace {

namespace fs = std::filesystem;

TEST(Course, EveryLessonLoadsAndHasASolutionAndAPicture) {
    const fs::path folder = fs::path(PNR_SOURCE_DIR) / "scenes" / "course";
    std::ostringstream readme;
    readme << std::ifstream(folder / "README.md").rdbuf();
    int lessons = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".pnr") continue;
        const LoadResult loaded = load_scene(entry.path(), {});
        for (const Diagnostic& d : loaded.diagnostics) ADD_FAILURE() << format(d, loaded.sources, false);
        std::ostringstream file;
        file << std::ifstream(entry.path()).rdbuf();
        const std::string text = file.str(), stem = entry.path().stem().string();
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 60) << stem;
        EXPECT_TRUE(fs::exists(folder / "pictures" / (stem + ".png"))) << stem;
        if (stem.ends_with("_solution")) continue;
        ++lessons;
        EXPECT_TRUE(says(text, "// Exercise: ")) << stem;
        EXPECT_TRUE(fs::exists(folder / (stem + "_solution.pnr"))) << stem;
        EXPECT_TRUE(says(readme.str(), stem + ".pnr")) << stem;
    }
    EXPECT_EQ(lessons, 12);
}

} // namespace
} // namespace pnr
