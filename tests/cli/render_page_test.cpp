// SPDX-License-Identifier: GPL-3.0-or-later
// The page of `pnr render --html`: what is on it, that it needs nothing else, and that a browser shows it.
#include "core/image_io.h"
#include "run_pnr.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

namespace pnr {
namespace {

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

void expect_whole(const std::string& page) {
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    for (const char* tag : {"html", "head", "body", "table", "tr", "td", "figure", "h2", "svg", "p"})
        EXPECT_EQ(count_of(page, std::string("<") + tag + ">") + count_of(page, std::string("<") + tag + " "),
                  count_of(page, std::string("</") + tag + ">"))
            << tag;
    EXPECT_EQ(page.find("http"), std::string::npos) << "nothing from elsewhere";
}

TEST(RenderPage, ShowsPassesMemoryMapsErrorAndPlan) {
    const TemporaryFolder folder;
    folder.write("s.pnr", box_scene());
    const Ran ran = run_pnr(folder, {"render", "s.pnr", "--size", "48x48", "--passes", "9", "--html",
                                     "page.html", "-o", "s.png", "--progress", "off"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::string page = folder.read("page.html");
    expect_whole(page);
    for (const char* part : {"Time", "Memory of structures", "What lies behind it", "Error", "Plan"})
        EXPECT_NE(page.find(std::string("<h2>") + part), std::string::npos) << part;
    for (const char* caption : {"normals", "objects", "depth", "sparse map", "orientation", "informative map",
                                "painted layer", "photoreal layer", "estimated noise"})
        EXPECT_NE(page.find(std::string("alt=\"") + caption), std::string::npos) << caption;
    EXPECT_EQ(count_of(page, "data:image/png;base64,"), 11u); // and the picture, and the bias
    EXPECT_NE(page.find("9 passes"), std::string::npos);
}

TEST(RenderPage, OfARaytracedSceneHasNoPaint) {
    const TemporaryFolder folder;
    folder.write("s.pov",
                 "#version 3.7; global_settings { assumed_gamma 1 } camera { location -4 * z look_at 0 }\n"
                 "light_source { -9 * z, 1 } sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } }");
    const Ran ran =
        run_pnr(folder, {"render", "s.pov", "--size", "32x32", "--html", "page.html", "--progress", "off"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::string page = folder.read("page.html");
    expect_whole(page);
    EXPECT_NE(page.find("nothing is painted"), std::string::npos);
    EXPECT_EQ(page.find("sparse map"), std::string::npos);
    EXPECT_EQ(page.find("<h2>Error"), std::string::npos);
    EXPECT_EQ(run_pnr(folder, {"render", "s.pov", "--html", "absent/page.html"}).code, 4);
}

TEST(RenderPage, IsShownByABrowser) {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "skipped: chromium is not installed";
    const TemporaryFolder folder;
    folder.write("s.pnr", box_scene());
    ASSERT_EQ(
        run_pnr(folder, {"render", "s.pnr", "--size", "48x48", "--html", "page.html", "--progress", "off"})
            .code,
        0);
    const std::string place = folder.path().string();
    const std::string browse =
        "HOME='" + place +
        "' timeout 120 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars "
        "--window-size=1000,1400 --screenshot='" +
        place + "/shot.png' 'file://" + place + "/page.html' >/dev/null 2>&1";
    ASSERT_EQ(std::system(browse.c_str()), 0);
    const Image<glm::vec4> shot = read_image(folder / "shot.png");
    EXPECT_EQ(shot.width, 1000);
    std::set<int> colors; // a page with its pictures has many, an empty one a few
    for (const glm::vec4& c : shot.pixels)
        colors.insert(static_cast<int>(c.x * 63) << 12 | static_cast<int>(c.y * 63) << 6 |
                      static_cast<int>(c.z * 63));
    EXPECT_GT(colors.size(), 500u);
}

} // namespace
} // namespace pnr
