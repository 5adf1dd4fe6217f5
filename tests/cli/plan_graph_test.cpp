// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace pnr {
namespace {

int count(const std::string& text, const std::string& what) {
    int found = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++found;
    return found;
}

Forecast some_forecast() {
    Forecast f;
    f.passes = {{"photons", 1.25, 0.5, 20}, {"orient", 0.75, 0.3, 20}, {"render", 0.5, 0.2, 20}};
    f.structures = {{"kdtree", 3 * 1024.0 * 1024.0}};
    f.width = 40;
    f.height = 30;
    f.photons = 1000;
    return f;
}

TEST(PlanGraph, ShowsAllPassesAndWhatTheyAreForetoldToTake) {
    const std::string svg = plan_graph({}, some_forecast());
    EXPECT_EQ(count(svg, "<g class=\"used\">"), 13);
    EXPECT_EQ(count(svg, "class=\"gone\""), 0);
    for (const char* said :
         {">1.25 s, 50 %<", ">0.50 s, 20 %<", ">3.0 MB<", "40 x 30 pixels, 1000 photons: 2.5 s"})
        EXPECT_EQ(count(svg, said), 1) << said;
}

TEST(PlanGraph, WhatIsLeftOutIsGreyAndSaysWhyInLinesThatFit) {
    Plan plan;
    plan.left_out = {
        {"caustic map", "no surface reflects or refracts & none is <glass>, however long one looks"},
        {"rbf solve", "no painted object has two seeds"},
        {"render", "an earlier run's is used again"}};
    const std::string svg = plan_graph(plan, some_forecast());
    EXPECT_EQ(count(svg, "<g class=\"gone\">"), 1);
    EXPECT_EQ(count(svg, "<path class=\"gone\""), 2); // from the tree and to the rendering pass
    EXPECT_EQ(count(svg, "<g class=\"kept\">"), 1);
    EXPECT_EQ(count(svg, ">0.75 s, 30 %<"), 1); // orientation goes on without its solve
    EXPECT_EQ(count(svg, ">no rbf solve: no painted<"), 1) << svg;
    EXPECT_EQ(count(svg, "refracts &amp; none is"), 1);
    EXPECT_EQ(count(svg, "<glass>"), 0);
    const std::regex line("<text x=[^>]*>([^<]*)<");
    for (std::sregex_iterator at(svg.begin(), svg.end(), line), end; at != end; ++at)
        EXPECT_LE((*at)[1].length(), 40) << (*at)[1];
}

} // namespace
} // namespace pnr
