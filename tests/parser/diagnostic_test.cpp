// SPDX-License-Identifier: GPL-3.0-or-later
// What the messages say, byte for byte: errors/NAME.pnr gives errors/NAME.txt. To accept changed messages,
// after reading them: PNR_ACCEPT=1 build/bin/test_parser --gtest_filter='Diagnostic.*'
#include "evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace pnr::test {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// The scenes are named relative to their folder, so that messages do not depend on where the project lies.
struct InFolder {
    fs::path before = fs::current_path();
    explicit InFolder(const fs::path& folder) { fs::current_path(folder); }
    ~InFolder() { fs::current_path(before); }
};

TEST(Diagnostic, MessagesAreTheContract) {
    const InFolder folder(fs::path(PNR_SOURCE_DIR) / "tests/parser/errors");
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator("."))
        if (entry.path().extension() == ".pnr") scenes.push_back(entry.path().filename());
    std::sort(scenes.begin(), scenes.end());
    EXPECT_GE(scenes.size(), 10u);
    for (const fs::path& scene : scenes) {
        const std::string said = messages(load_scene(scene, {}));
        const fs::path expected = fs::path(scene).replace_extension(".txt");
        if (std::getenv("PNR_ACCEPT")) std::ofstream(expected, std::ios::binary) << said;
        EXPECT_EQ(said, read(expected)) << scene;
    }
}

TEST(Diagnostic, Json) {
    const LoadResult result = load_scene_text("#declare A = Foo;\n", "a \"b\".pnr", {});
    EXPECT_EQ(format_json(result.diagnostics, result.sources),
              "[\n{\"severity\":\"error\",\"file\":\"a "
              "\\\"b\\\".pnr\",\"line\":1,\"column\":14,\"end_line\":1,\"end_column\":17,"
              "\"message\":\"`Foo` is not declared\",\"help\":\"\",\"notes\":[]}\n]\n");
}

TEST(Diagnostic, NearestWord) {
    EXPECT_EQ(nearest_word("shpere", {"sphere", "spheres", "box"}), "sphere");
    EXPECT_EQ(nearest_word("Sphere", {"sphere", "box"}), "sphere");
    EXPECT_EQ(nearest_word("pigmnt", {"pigment", "point_at"}), "pigment");
    EXPECT_EQ(nearest_word("xyz", {"sphere", "box"}), "");
    EXPECT_EQ(nearest_word("q", {"x", "y"}), "");
}

TEST(Diagnostic, EveryErrorPointsAtALine) {
    const LoadResult result = load_scene_text("sphere { 0, 1 / 0 }\n#declare A = ;\n", "a.pnr", {});
    ASSERT_EQ(result.diagnostics.size(), 2u);
    EXPECT_FALSE(result.scene.has_value());
    for (const Diagnostic& d : result.diagnostics) EXPECT_LT(d.span.source, result.sources.files.size());
}

} // namespace
} // namespace pnr::test
