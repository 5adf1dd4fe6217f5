// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr watch`, driven as somebody at an editor would.
#include "run_pnr.h"

#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>

namespace pnr {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const char* const scene = "#include \"ball.inc\"\n"
                          "global_settings { photons { count 1500 } }\n"
                          "camera { location <0, 1, -4> look_at <0, 0.5, 0> angle 40 }\n"
                          "light_source { <1, 3, -2>, rgb 1 emitter { sphere 0.3 } power 90 }\n"
                          "box { <-3, -0.1, -3>, <3, 0, 3> pigment { rgb 0.8 } }\n"
                          "mesh { file \"tri.off\" pigment { rgb <0.2, 0.3, 0.9> } translate <-0.9, 0, 0> }\n"
                          "object { Ball npr { ilic { length 10 } } }\n";

void write_all(const TemporaryFolder& folder) {
    folder.write("a.pnr", scene);
    folder.write("ball.inc", "#declare Ball = sphere { <0, 0.6, 0>, 0.6 pigment { rgb <0.9, 0.6, 0.3> } }\n");
    folder.write("tri.off",
                 "OFF\n4 4 0\n0 0 0\n0.4 0 0\n0 0.4 0\n0 0 0.4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
}

std::string changed(const std::string& from, const std::string& to) {
    std::string text = scene;
    return text.replace(text.find(from), from.size(), to);
}

// Editors write a new file and give it the old one's name.
void save_by_renaming(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
    folder.write(name + "~new", text);
    fs::rename(folder / (name + "~new"), folder / name);
}

const Words words{"watch", "a.pnr", "-o", "a.png", "-W", "32", "-H", "24", "--progress", "off"};

std::string fresh(const TemporaryFolder& folder) {
    run_pnr(folder, {"render", "a.pnr", "-o", "fresh.png", "-W", "32", "-H", "24", "--no-cache"});
    return folder.read("fresh.png");
}

TEST(Watch, RunsJustThePassesThatAChangeNeeds) {
    const TemporaryFolder folder;
    write_all(folder);
    RunningPnr pnr(folder, words);
    ASSERT_TRUE(pnr.says(
        "the first picture: parse build photons kdtree gbuffer sparse orient informative ilic render write"))
        << pnr.said();
    ASSERT_TRUE(pnr.says("watching a.pnr and 2 more files")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    folder.write("a.pnr", changed("length 10", "length 16"));
    ASSERT_TRUE(pnr.says("only paint has changed: parse build orient informative ilic write")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    const std::string painted = folder.read("a.png");
    EXPECT_EQ(painted, fresh(folder));

    save_by_renaming(folder, "a.pnr", changed("length 10", "/* another word */  length 16"));
    ASSERT_TRUE(pnr.says("nothing that is seen has changed")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();

    save_by_renaming(folder, "a.pnr", changed("angle 40", "angle 44"));
    ASSERT_TRUE(pnr.says("only the camera has changed: parse build kdtree gbuffer sparse orient informative "
                         "ilic render write"))
        << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    save_by_renaming(folder, "a.pnr", changed("length 10 } }", "length 10 } mix 0.5 }"));
    ASSERT_TRUE(pnr.says("only the camera has changed")) << pnr.said(); // back again, and half painted
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    folder.write("ball.inc", "#declare Ball = sphere { <0, 0.6, 0>, 0.5 pigment { rgb <0.9, 0.6, 0.3> } }\n");
    ASSERT_TRUE(pnr.says("light, objects or settings have changed: parse build photons kdtree gbuffer"))
        << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    folder.write("tri.off",
                 "OFF\n4 4 0\n0 0 0\n0.4 0 0\n0 0.4 0\n0 0 0.6\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    ASSERT_TRUE(pnr.says("light, objects or settings have changed: parse build photons kdtree gbuffer"))
        << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    pnr.signal(SIGINT);
    EXPECT_EQ(pnr.end(), 130);
}

TEST(Watch, ShowsErrorsAndGoesOn) {
    const TemporaryFolder folder;
    write_all(folder);
    folder.write("a.pnr", changed("sphere 0.3", "shpere 0.3"));
    RunningPnr pnr(folder, words);
    ASSERT_TRUE(pnr.says("a.pnr:4:44: error: ")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), "");

    folder.write("a.pnr", scene);
    ASSERT_TRUE(pnr.says("the first picture")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    const std::string first = folder.read("a.png");
    EXPECT_NE(first, "");

    folder.write("a.pnr", changed("\"ball.inc\"", "\"ball2.inc\"")); // a file that comes later
    ASSERT_TRUE(pnr.says("a.pnr:1:10: error: ")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), first);
    folder.write("ball2.inc",
                 "#declare Ball = sphere { <0, 0.6, 0>, 0.4 pigment { rgb <0.9, 0.6, 0.3> } }\n");
    ASSERT_TRUE(pnr.says("light, objects or settings have changed")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));

    fs::remove(folder / "tri.off"); // seen once it is there again
    folder.write("a.pnr", changed("angle 40", "angle 41"));
    ASSERT_TRUE(pnr.says("error: there is no file \"tri.off\"")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    write_all(folder);
    ASSERT_TRUE(pnr.says("light, objects or settings have changed")) << pnr.said();
    pnr.signal(SIGTERM);
    EXPECT_EQ(pnr.end(), 143);
}

TEST(Watch, StartsAnewWhenItIsSavedWhileRendering) {
    const TemporaryFolder folder;
    write_all(folder);
    folder.write("a.pnr", changed("count 1500", "count 20000000"));
    RunningPnr pnr(folder, {"watch", "a.pnr", "-o", "a.png", "-W", "32", "-H", "24", "--progress", "json"});
    ASSERT_TRUE(pnr.says("\"photons\"")) << pnr.said();
    folder.write("a.pnr", scene);
    ASSERT_TRUE(pnr.says("saved again: a new start")) << pnr.said();
    ASSERT_TRUE(pnr.says("the first picture")) << pnr.said();
    ASSERT_TRUE(pnr.says("watching")) << pnr.said();
    EXPECT_EQ(folder.read("a.png"), fresh(folder));
    folder.write("a.pnr", changed("count 1500", "count 20000001"));
    ASSERT_TRUE(pnr.says("\"photons\"")) << pnr.said();
    pnr.signal(SIGINT); // in the middle of it
    EXPECT_EQ(pnr.end(), 130);
    EXPECT_EQ(folder.read("a.png"), folder.read("fresh.png"));
}

TEST(Watch, RefusesWhatItCannotWatch) {
    const TemporaryFolder folder;
    write_all(folder);
    EXPECT_EQ(run_pnr(folder, {"watch", "a.pnr", "-o", "-"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"watch", "a.pnr", "-o", "a.gif"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"watch", "a.pnr", "-o", "no/a.png"}).code, 4);
    EXPECT_EQ(run_pnr(folder, {"watch"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"watch", "-"}).code, 2);
}

} // namespace
} // namespace pnr
