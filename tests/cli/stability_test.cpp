// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stability.h"

#include "cli/html_page.h"
#include "run_pnr.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

TEST(Stability, NotANumberNeverHolds) {
    EXPECT_TRUE(holds({"", "", "", 1, 1}));
    EXPECT_FALSE(holds({"", "", "", 1, 1.0000001}));
    EXPECT_FALSE(holds({"", "", "", 1, std::nan("")}));
    EXPECT_FALSE(holds({"", "", "", 0, std::numeric_limits<double>::infinity()}));
}

using Group = StabilityCases (*)();
class StabilityGroup : public testing::TestWithParam<Group> {};

TEST_P(StabilityGroup, Holds) {
    const StabilityCases cases = GetParam()();
    EXPECT_GE(cases.size(), 4u);
    for (const StabilityCase& c : cases)
        EXPECT_TRUE(holds(c)) << c.group << ", " << c.name << ": " << c.measured << " is " << c.value
                              << ", may be " << c.bound;
}

std::string group_name(const testing::TestParamInfo<Group>& group) {
    static const char* const names[] = {"paths", "fields", "roots", "rays", "photons", "sums", "pictures"};
    return names[group.index];
}
INSTANTIATE_TEST_SUITE_P(All, StabilityGroup,
                         testing::Values(path_cases, field_cases, root_cases, ray_cases, photon_cases, sum_cases,
                                         picture_cases),
                         group_name);

TEST(Stability, CommandPrintsTableAndPage) {
    const TemporaryFolder folder;
    const Ran ran = run_pnr(folder, {"stability", "--group", "roots,sums", "--html", "page.html"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("two roots"), std::string::npos);
    EXPECT_NE(ran.out.find(" cases hold"), std::string::npos);
    const std::string page = folder.read("page.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_EQ(page.find("http"), std::string::npos); // it needs nothing from elsewhere
    EXPECT_EQ(run_pnr(folder, {"stability", "--group", "root"}).code, 2);
}

TEST(HtmlPage, EscapesText) { EXPECT_EQ(html_text("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;"); }

TEST(HtmlPage, PlotsWhatIsAboveZero) {
    const std::string plot =
        html_log_plot("t", "x", "y", {{"line", {{1, 1}, {10, 0.1}, {0, 1}, {5, -1}}, false}});
    EXPECT_EQ(plot.find("nan"), std::string::npos);
    std::size_t dots = 0;
    for (std::size_t at = plot.find("<circle"); at != std::string::npos; at = plot.find("<circle", at + 1))
        ++dots;
    EXPECT_EQ(dots, 2u);
    EXPECT_EQ(html_log_plot("t", "x", "y", {{"line", {{0, 0}}, false}}), "");
}

} // namespace
} // namespace pnr
