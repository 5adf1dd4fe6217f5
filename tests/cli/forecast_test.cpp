// SPDX-License-Identifier: GPL-3.0-or-later
// What `pnr plan` foretells is what `pnr render` then takes. tests/bench/bench_plan.cpp looks at every scene.
#include "run_pnr.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>

namespace pnr {
namespace {

using nlohmann::json;

const std::string raytraced = R"(#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 1, -4> look_at 0 right x }
light_source { <3, 5, -4>, rgb 1 }
plane { y, -1 pigment { checker rgb 1 rgb 0.3 } }
sphere { 0, 1 pigment { rgb <1, 0.5, 0.2> } finish { reflection 0.2 } }
)";

struct Both {
    json foretold, stats;
};

Both foretell_and_render(const std::string& name, const std::string& text, const std::string& size) {
    const TemporaryFolder folder;
    folder.write(name, text);
    const Ran plan = run_pnr(folder, {"plan", name, "--size", size, "--format", "json"});
    const Ran render =
        run_pnr(folder, {"render", name, "--size", size, "--stats", "s.json", "--progress", "off"});
    EXPECT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(render.code, 0) << render.err;
    return {json::parse(plan.out)["forecast"], json::parse(folder.read("s.json"))};
}

void expect_memory(const Both& both) {
    double foretold = 0, measured = 0;
    for (const json& pass : both.foretold["passes"])
        foretold = std::max(foretold, pass["peak_rss_mb"].get<double>());
    for (const json& pass : both.stats["passes"])
        measured = std::max(measured, pass["peak_rss_mb"].get<double>());
    EXPECT_NEAR(foretold / measured, 1, 0.3);
    for (const json& structure : both.foretold["structures"]) {
        const double bytes = both.stats["memory"][structure["name"].get<std::string>()];
        if (bytes > 1 << 18)
            EXPECT_NEAR(structure["bytes"].get<double>() / bytes, 1, 0.3) << structure["name"];
        else
            EXPECT_LT(structure["bytes"].get<double>(), 1 << 19) << structure["name"];
    }
}

TEST(Forecast, KnowsTheMemoryOfAPaintedScene) {
    const Both both = foretell_and_render("s.pnr", box_scene(), "240x240");
    expect_memory(both);
    EXPECT_EQ(both.foretold["image"]["width"], 240);
    EXPECT_EQ(both.foretold["photons"], both.stats["photons"]["emitted"]);
}

TEST(Forecast, KnowsTheMemoryOfARaytracedScene) {
    const Both both = foretell_and_render("s.pov", raytraced, "320x320");
    expect_memory(both);
    EXPECT_EQ(both.foretold["photons"], 0);
}

// Wide bounds, for the machine may do other things: a factor of three where a pass takes more than a tenth.
TEST(Forecast, KnowsTheSharesOfTime) {
    const Both both = foretell_and_render("s.pnr", box_scene(), "240x240");
    double whole = 0, shares = 0;
    for (const json& pass : both.stats["passes"]) whole += pass["cpu_s"].get<double>();
    std::map<std::string, double> share;
    for (const json& pass : both.foretold["passes"]) shares += share[pass["name"]] = pass["share"];
    EXPECT_NEAR(shares, 1, 1e-9);
    for (const json& pass : both.stats["passes"]) {
        const double measured = pass["cpu_s"].get<double>() / whole;
        if (measured < 0.1) continue;
        EXPECT_GT(share[pass["name"]], measured / 3) << pass["name"];
        EXPECT_LT(share[pass["name"]], measured * 3) << pass["name"];
    }
}

// Memory follows the photons and the pixels that were asked for, though only few of them are tried.
TEST(Forecast, GrowsWithPhotonsAndPixels) {
    const TemporaryFolder folder;
    folder.write("s.pnr", "global_settings { photons { count Count } }\n" + box_scene());
    const auto sizes = [&](const std::string& count, const std::string& width) {
        const Ran ran =
            run_pnr(folder, {"plan", "s.pnr", "-D", "Count=" + count, "-W", width, "--format", "json"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        std::map<std::string, double> bytes;
        const json plan = json::parse(ran.out);
        for (const json& structure : plan["forecast"]["structures"])
            bytes[structure["name"]] = structure["bytes"];
        return bytes;
    };
    auto small = sizes("40000", "128"), many = sizes("400000", "128"), large = sizes("40000", "1280");
    EXPECT_NEAR(many["photons"] / small["photons"], 10, 0.3);
    EXPECT_EQ(many["gbuffer"], small["gbuffer"]);
    EXPECT_NEAR(large["gbuffer"] / small["gbuffer"], 100, 3);
    EXPECT_NEAR(large["photons"] / small["photons"], 1, 0.02);
}

} // namespace
} // namespace pnr
