// SPDX-License-Identifier: GPL-3.0-or-later
// parser/course.h: what the lessons use, against scenes/course as it lies there.
#include "parser/course.h"

#include "parser/manual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pnr {
namespace {

std::vector<std::string> files_with(std::string_view word) {
    std::vector<std::string> files;
    for (const Lesson& lesson : lessons_with(word)) files.emplace_back(lesson.file);
    return files;
}

TEST(CourseLessons, AreTheFilesOfTheCourse) {
    std::vector<std::string> there, embedded;
    for (const auto& entry : std::filesystem::directory_iterator(PNR_SOURCE_DIR "/scenes/course")) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".pnr") && name.find("_solution") == std::string::npos) there.push_back(name);
    }
    std::sort(there.begin(), there.end());
    for (const EmbeddedFile& file : embedded_course()) {
        embedded.emplace_back(file.name);
        std::ostringstream text;
        text << std::ifstream(PNR_SOURCE_DIR "/scenes/course/" + embedded.back()).rdbuf();
        EXPECT_EQ(text.str(), file.text) << embedded.back();
    }
    EXPECT_EQ(embedded, there);
    EXPECT_EQ(embedded.size(), 12u);
}

TEST(CourseLessons, EachSaysItsTitle) {
    for (const Lesson& lesson : lessons_with("camera"))
        EXPECT_TRUE(lesson.title.starts_with("Lesson ")) << lesson.file;
    EXPECT_EQ(lessons_with("camera").size(), 12u); // no picture without one
}

TEST(CourseLessons, WordsInCommentsAndPartsOfWordsDoNotCount) {
    EXPECT_TRUE(lessons_with("exercise").empty()); // each lesson's comment has one
    EXPECT_TRUE(lessons_with("amera").empty());
    EXPECT_TRUE(lessons_with("").empty());
    const std::vector<std::string> seeds = files_with("seeds");
    EXPECT_NE(std::find(seeds.begin(), seeds.end(), "07_seeds.pnr"), seeds.end());
}

TEST(CourseLessons, TheManualNamesThem) {
    EXPECT_NE(manual_text("seeds").find("scenes/course/07_seeds.pnr"), std::string::npos)
        << manual_text("seeds");
    EXPECT_NE(manual_text("#macro").find("in the course:"), std::string::npos);
    EXPECT_EQ(manual_text("julia_fractal").find("in the course:"), std::string::npos);
}

} // namespace
} // namespace pnr
