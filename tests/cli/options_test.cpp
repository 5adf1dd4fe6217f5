// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "cli/options.h"

#include "cli/load.h"

namespace pnr {
namespace {

using Words = std::vector<std::string>;

Options parse(const Words& words) { return parse_command_line(words).options; }

std::string refusal(const Words& words) {
    try {
        parse_command_line(words);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(Options, RenderTakesEveryWordOfTheContract) {
    const Options o =
        parse({"render",  "pot.pnr", "-o",         "a.png",     "-o",         "b.exr",          "-W",
               "640",     "-H",      "480",        "--threads", "2",          "--seed",         "7",
               "-D",      "N=1+2",   "-L",         "inc",       "--crop",     "1,2,3,4",        "--exposure",
               "-1.5",    "--view",  "shoulder",   "--maps",    "m",          "--aov",          "N,P",
               "--stats", "s.json",  "--progress", "json",      "--no-prune", "--no-overwrite", "--werror"});
    EXPECT_EQ(o.command, "render");
    EXPECT_EQ(o.scenes, Words{"pot.pnr"});
    ASSERT_EQ(o.outputs.size(), 2u);
    EXPECT_EQ(o.outputs[1], "b.exr");
    EXPECT_EQ(o.width, 640);
    EXPECT_EQ(o.height, 480);
    EXPECT_EQ(o.threads, 2);
    EXPECT_EQ(o.seed, 7u);
    ASSERT_EQ(o.declares.size(), 1u);
    EXPECT_EQ(o.declares[0].first, "N");
    EXPECT_EQ(o.declares[0].second, "1+2");
    EXPECT_EQ(o.crop, (CropWord{1, 2, 3, 4}));
    EXPECT_EQ(o.exposure, -1.5);
    EXPECT_EQ(o.view, View::shoulder);
    EXPECT_EQ(o.aovs, (Words{"N", "P"}));
    EXPECT_EQ(o.progress, ProgressMode::json);
    EXPECT_FALSE(o.prune);
    EXPECT_TRUE(o.no_overwrite);
    EXPECT_TRUE(o.werror);
}

TEST(Options, DeclareAloneIsPovRaysAndDropped) {
    EXPECT_TRUE(parse({"render", "a.pov", "-D"}).declares.empty());
    const Options o = parse({"render", "-D", "-W", "32", "a.pov"});
    EXPECT_TRUE(o.declares.empty());
    EXPECT_EQ(o.width, 32);
    const Options named = parse({"render", "-D", "A=-1", "Declare=B=2", "a.pov"});
    ASSERT_EQ(named.declares.size(), 2u);
    EXPECT_EQ(named.declares[0].second, "-1");
    EXPECT_EQ(named.declares[1].first, "B");
    EXPECT_EQ(named.declares[1].second, "2");
}

TEST(Options, PovRaysWayMeansRender) {
    const Options o =
        parse({"+Ipot.pov", "+Oout.png", "+W640", "+H480", "+A0.25", "+WT2", "+Linc", "+Q9", "-P", "+UA"});
    EXPECT_EQ(o.command, "render");
    EXPECT_EQ(o.scenes, Words{"pot.pov"});
    EXPECT_EQ(o.outputs, std::vector<std::filesystem::path>{"out.png"});
    EXPECT_EQ(o.width, 640);
    EXPECT_EQ(o.antialias, 0.25);
    EXPECT_EQ(o.threads, 2);
    EXPECT_EQ(o.library, std::vector<std::filesystem::path>{"inc"});
    EXPECT_EQ(parse({"render", "a.pov", "-A"}).antialias, 0);
    EXPECT_EQ(parse({"+Ia.pov", "+A", "+R4", "+J0.5"}).antialias_depth, 4);
    EXPECT_EQ(parse({"+Ia.pov", "+A", "+R4", "+J0.5"}).antialias_jitter, 0.5);
    EXPECT_EQ(parse({"+Ia.pov", "+J"}).antialias_jitter, 1);
    EXPECT_EQ(parse({"+Ia.pov", "-J"}).antialias_jitter, 0);
    const Settings off = merge_settings({}, parse({"render", "a.pov", "-A"}));
    EXPECT_EQ(off.render.grid.depth, 0) << "one ray a pixel of raytraced pictures too";
    const Settings fine = merge_settings({}, parse({"+Ia.pov", "+A0.1", "+R5"}));
    EXPECT_EQ(fine.render.grid.threshold, 0.1);
    EXPECT_EQ(fine.render.grid.depth, 5);
}

TEST(Options, FramesAreARangeWithAStep) {
    const Options o = parse({"render", "a.pnr", "--frames", "3-21x6"});
    ASSERT_TRUE(o.frames);
    EXPECT_EQ(o.frames->first, 3);
    EXPECT_EQ(o.frames->last, 21);
    EXPECT_EQ(o.frames->step, 6);
    const std::vector<AnimationFrame> frames = frames_of(o);
    ASSERT_EQ(frames.size(), 4u);
    EXPECT_EQ(frames[1].number, 9);
    EXPECT_NEAR(frames[1].clock, 1 / 3.0, 1e-15);
    EXPECT_EQ(frames[3].clock, 1);
    EXPECT_EQ(parse({"+Ia.pov", "+KFI2", "+KFF4"}).frames->last, 4);
    EXPECT_EQ(parse({"+Ia.pov", "+K0.5"}).clock, 0.5);
    for (const char* wrong : {"3", "3-", "5-3", "1-9x", "1-9x0", "1-9y2", "a-b"})
        EXPECT_NE(refusal({"render", "a.pnr", "--frames", wrong}), "") << wrong;
    EXPECT_EQ(numbered("out/pot.png", 7), "out/pot0007.png");
    EXPECT_EQ(numbered("pot-##.exr", 123), "pot-123.exr");
    EXPECT_EQ(numbered("#.png", 5), "5.png");
}

TEST(Options, RefusalsSayWhatWasMeant) {
    EXPECT_NE(refusal({}), "");
    EXPECT_NE(refusal({"rendr"}).find("render"), std::string::npos);
    EXPECT_NE(refusal({"render", "--thread", "2"}).find("--threads"), std::string::npos);
    EXPECT_NE(refusal({"render", "-W", "0"}), "");
    EXPECT_NE(refusal({"render", "-W", "100000"}), "");
    EXPECT_NE(refusal({"render", "--size", "640"}).find("WxH"), std::string::npos);
    EXPECT_NE(refusal({"render", "--crop", "1,2,3"}), "");
    EXPECT_NE(refusal({"render", "--view", "soft"}).find("shoulder"), std::string::npos);
    EXPECT_NE(refusal({"render", "-D", "=3"}), "");
    EXPECT_NE(refusal({"render", "--threads", "0"}), "");
    EXPECT_NE(refusal({"render", "a.pnr", "b.pnr"}), "");
    EXPECT_NE(refusal({"check"}), "");
    EXPECT_NE(refusal({"pick", "a.pnr"}), "");
    EXPECT_NE(refusal({"pick", "a.pnr", "--at", "3"}), "");
    EXPECT_NE(refusal({"help", "nothing"}), "");
    EXPECT_NE(refusal({"help", "spehre"}).find("`sphere`"), std::string::npos);
    EXPECT_NE(refusal({"help", "rendr"}).find("`render`"), std::string::npos);
    EXPECT_NE(refusal({"+Zx", "a.pov"}), "");
    EXPECT_NE(refusal({"render", "--skip-existing", "--no-overwrite"}), "");
}

TEST(Options, CropIsPixelsOrFractions) {
    const PixelRect whole = crop_window({}, 640, 480);
    EXPECT_EQ(whole.x1, 640);
    EXPECT_EQ(whole.y1, 480);
    const PixelRect quarter = crop_window(CropWord{0.5, 0, 1, 0.5}, 640, 480);
    EXPECT_EQ(quarter.x0, 320);
    EXPECT_EQ(quarter.x1, 640);
    EXPECT_EQ(quarter.y1, 240);
    const PixelRect pixels = crop_window(CropWord{10, 20, 30, 40}, 640, 480);
    EXPECT_EQ(pixels.x0, 10);
    EXPECT_EQ(pixels.y1, 40);
    EXPECT_THROW(crop_window(CropWord{10, 20, 10, 40}, 640, 480), UsageError);
    EXPECT_THROW(crop_window(CropWord{0, 0, 641, 480}, 640, 480), UsageError);
    EXPECT_THROW(crop_window(CropWord{-3, 0, 64, 48}, 640, 480), UsageError);
}

} // namespace
} // namespace pnr
