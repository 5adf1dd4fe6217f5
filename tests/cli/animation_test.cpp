// SPDX-License-Identifier: GPL-3.0-or-later
// Frames by the built program: what they share, and how a run that was killed goes on; POV-Ray's .ini files; limits.
#include "run_pnr.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>

namespace pnr {
namespace {

using Words = std::vector<std::string>;

// The camera goes round; with `more` the world may change as well.
std::string turning(const std::string& more = "") {
    return "#declare Angle = 90 * clock;\n"
           "camera { location vrotate(<0, 2, -6>, Angle * y) look_at 0 }\n"
           "light_source { <2, 4, -3>, rgb 1 }\n"
           "global_settings { photons { global on count 3000 } }\n"
           "#debug concat(\"frame \", str(frame_number, 0, 0), \"\\n\")\n"
           "sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } }\nbox { <-4, -2, -4>, <4, -1, 4> pigment { rgb 1 } }\n" +
           more;
}

bool kept_photons(const TemporaryFolder& folder, const std::string& stats) {
    const nlohmann::json all = nlohmann::json::parse(folder.read(stats)); // named: it must outlive the loop
    for (const auto& left : all["plan"]["left_out"])
        if (left["what"] == "photons" && left["why"].get<std::string>().find("camera") != std::string::npos) return true;
    return false;
}

TEST(Animation, PhotonsAreKeptWhileOnlyTheCameraMoves) {
    const TemporaryFolder folder;
    folder.write("a.pnr", turning());
    const Words words{"render", "a.pnr", "-W", "16", "-H", "12", "--frames", "1-3", "--stats", "s#.json"};
    ASSERT_EQ(run_pnr(folder, words).code, 0);
    EXPECT_FALSE(kept_photons(folder, "s1.json"));
    EXPECT_TRUE(kept_photons(folder, "s2.json"));
    EXPECT_TRUE(kept_photons(folder, "s3.json"));
    // A frame is the same picture whether frames came before it or not.
    ASSERT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "16", "-H", "12", "--frames", "1-3", "--subset", "3-3", "-o",
                               "alone.png"})
                  .code,
              0);
    EXPECT_EQ(folder.read("a0003.png"), folder.read("alone0003.png"));
}

TEST(Animation, PhotonsAreMadeAnewWhenTheWorldChanges) {
    const char* const changes[] = {
        "sphere { <clock, 2, 0>, 0.2 pigment { rgb 1 } }\n",
        "sphere { 2, 0.2 pigment { rgb <clock, 0, 0> } }\n",
        "#if (clock > 0.4) box { 2, 3 pigment { rgb 1 } } #end\n",
        "#declare A = array[2] { 1, 2 }; sphere { 3, A[int(clock + 0.6)] / 10 pigment { rgb 1 } }\n",
        "#macro Ball(R) sphere { 3, R pigment { rgb 1 } } #end Ball(clock + 0.1)\n",
        "isosurface { function { x * x + y * y + z * z - 1 - clock } contained_by { box { -2, 2 } } pigment { rgb 1 } }\n",
    };
    for (const char* change : changes) {
        const TemporaryFolder folder;
        folder.write("a.pnr", turning(change));
        const Ran ran = run_pnr(folder, {"render", "a.pnr", "-W", "16", "-H", "12", "--frames", "1-2", "--stats", "s#.json"});
        ASSERT_EQ(ran.code, 0) << ran.err;
        EXPECT_FALSE(kept_photons(folder, "s2.json")) << change;
    }
}

TEST(Animation, AKilledRunGoesOnWhereItStopped) {
    const TemporaryFolder folder, whole;
    for (const TemporaryFolder* each : {&folder, &whole}) each->write("a.pnr", turning());
    const Words words{"render", "a.pnr", "-W", "240", "-H", "180", "--frames", "1-4", "--skip-existing"};
    ASSERT_EQ(run_pnr(whole, words).code, 0);
    EXPECT_EQ(run_pnr_and_signal(folder, words, SIGKILL, "frame 3").code, 128 + SIGKILL);
    const std::string first = folder.read("a0001.png");
    EXPECT_FALSE(first.empty());
    EXPECT_TRUE(folder.read("a0004.png").empty());
    ASSERT_EQ(run_pnr(folder, words).code, 0);
    for (const char* frame : {"a0001.png", "a0002.png", "a0003.png", "a0004.png"})
        EXPECT_EQ(folder.read(frame), whole.read(frame)) << frame;
}

TEST(Animation, IniFilesSayWhatTheySayToPovRay) {
    const TemporaryFolder folder;
    folder.write("a.pnr", turning());
    folder.write("a.ini", "; comment\nInput_File_Name=\"a.pnr\"\nWidth = 40\nHeight = 30\nInitial_Frame=1\nFinal_Frame=4\n"
                          "Initial_Clock=0\nFinal_Clock=2\nCyclic_Animation=on\nDisplay=off\n[small]\n+W16 +H12\n"
                          "Subset_Start_Frame=2\nSubset_End_Frame=3\n");
    const Ran ran = run_pnr(folder, {"a.ini[small]"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(folder.names(), (Words{"a.ini", "a.pnr", "a0002.png", "a0003.png"}));
    // Of 4 frames that run round, the third has half of the clock.
    EXPECT_EQ(run_pnr(folder, {"render", "a.pnr", "-W", "16", "-H", "12", "--clock", "1", "-o", "still.png"}).code, 0);
    EXPECT_EQ(folder.read("still.png"), folder.read("a0003.png"));
    EXPECT_EQ(run_pnr(folder, {"a.ini[large]"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"absent.ini"}).code, 4);
}

TEST(Limit, IsRaisedAndLowered) {
    const TemporaryFolder folder;
    folder.write("a.pnr", "#for (I, 1, 100) #end\n");
    EXPECT_EQ(run_pnr(folder, {"check", "a.pnr"}).code, 0);
    const Ran ran = run_pnr(folder, {"check", "a.pnr", "--limit", "loop-turns=50"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.err.find("a.pnr:1:1: error: the scene's loops turn more than 50 times"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("--limit loop-turns=100"), std::string::npos) << ran.err;
    EXPECT_EQ(run_pnr(folder, {"check", "a.pnr", "--limit", "loops=50"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"check", "a.pnr", "--limit", "nesting=many"}).code, 2);
    const Ran help = run_pnr(folder, {"check", "--limit", "help"});
    EXPECT_EQ(help.code, 0);
    for (const char* name : {"loop-turns", "macro-depth", "memory", "pixels", "photons"})
        EXPECT_NE(help.out.find(name), std::string::npos) << name;
}

TEST(Limit, PicturesAndPhotons) {
    const TemporaryFolder folder;
    folder.write("a.pnr", turning());
    const Ran large = run_pnr(folder, {"render", "a.pnr", "-W", "60000", "-H", "60000"});
    EXPECT_EQ(large.code, 2);
    EXPECT_NE(large.err.find("--limit pixels="), std::string::npos) << large.err;
    folder.write("b.pnr", "global_settings { photons { global on spacing 1e-9 } }\nsphere { 0, 1 pigment { rgb 1 } }\n"
                          "light_source { 5, rgb 1 }\n");
    const Ran many = run_pnr(folder, {"render", "b.pnr", "-W", "8"});
    EXPECT_EQ(many.code, 3);
    EXPECT_NE(many.err.find("--limit photons="), std::string::npos) << many.err;
}

TEST(AllowWrite, FilesLandBelowItsFolderAlone) {
    const TemporaryFolder folder;
    folder.write("a.pnr", "#fopen F \"sub/a.txt\" write #write (F, 1, \" \", <1, 2, 3>, \"\\n\") #fclose F\n"
                          "#fopen G \"../b.txt\" write #write (G, 2) #fclose G\n");
    ASSERT_EQ(run_pnr(folder, {"check", "a.pnr"}).code, 0);
    EXPECT_EQ(folder.names(), Words{"a.pnr"}); // in memory
    const Ran ran = run_pnr(folder, {"check", "a.pnr", "--allow-write", "out"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("stays in memory"), std::string::npos) << ran.err;
    EXPECT_EQ(folder.read("out/sub/a.txt"), "1 <1,2,3>\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.txt"));
}

TEST(Check, JsonHasEveryFieldForEveryScene) {
    const TemporaryFolder folder;
    folder.write("a.pnr", "sphere { Foo, 1 }\n");
    folder.write("b.pnr", "#macro M() shpere { 0, 1 } #end\nM()\n");
    const Ran ran = run_pnr(folder, {"check", "a.pnr", "b.pnr", "--format", "json"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_EQ(ran.err, "");
    const nlohmann::json found = nlohmann::json::parse(ran.out);
    ASSERT_EQ(found.size(), 2u);
    for (const auto& each : found) {
        for (const char* field : {"severity", "file", "message", "help"}) EXPECT_TRUE(each[field].is_string()) << field;
        for (const char* field : {"line", "column", "end_line", "end_column"})
            EXPECT_TRUE(each[field].is_number_integer()) << field;
        EXPECT_TRUE(each["notes"].is_array());
    }
    EXPECT_EQ(found[1]["file"], "b.pnr");
    EXPECT_EQ(found[1]["line"], 1);
    EXPECT_EQ(found[1]["column"], 12);
    EXPECT_EQ(found[1]["help"], "did you mean `sphere`?");
    EXPECT_EQ(found[1]["notes"][0]["line"], 2);
}

} // namespace
} // namespace pnr
