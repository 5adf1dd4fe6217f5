// SPDX-License-Identifier: GPL-3.0-or-later
// scenes/course: every lesson renders.
#include <gtest/gtest.h>

#include "run_pnr.h"

#include <filesystem>

namespace pnr {
namespace {

TEST(Course, EveryLessonRenders) {
    const TemporaryFolder folder;
    int lessons = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PNR_SOURCE_DIR "/scenes/course")) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() != ".pnr" || name.ends_with("_solution")) continue;
        const Ran ran = run_pnr(folder, {"render", entry.path().string(), "-H", "12", "-o", name + ".png"});
        EXPECT_EQ(ran.code, 0) << name << ": " << ran.err;
        EXPECT_EQ(ran.err.find("warning"), std::string::npos) << name << ": " << ran.err;
        ++lessons;
    }
    EXPECT_EQ(lessons, 12);
}

} // namespace
} // namespace pnr
