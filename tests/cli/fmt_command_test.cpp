// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/run_pnr.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

TEST(Fmt, WritesFilesChecksThemAndReadsStandardInput) {
    const TemporaryFolder folder;
    const std::string loose = "sphere{0,1\npigment{rgb 1}}", neat = "sphere { 0, 1\n    pigment { rgb 1 } }\n";
    folder.write("a.pnr", loose);
    const Ran check = run_pnr(folder, {"fmt", "--check", "a.pnr"});
    EXPECT_EQ(check.code, 5);
    EXPECT_NE(check.err.find("a.pnr"), std::string::npos);
    EXPECT_EQ(folder.read("a.pnr"), loose);
    EXPECT_EQ(run_pnr(folder, {"fmt", "a.pnr"}).code, 0);
    EXPECT_EQ(folder.read("a.pnr"), neat);
    EXPECT_EQ(run_pnr(folder, {"fmt", "--check", "a.pnr"}).code, 0);
    for (const auto& words : {std::vector<std::string>{"fmt"}, std::vector<std::string>{"fmt", "-"}}) {
        const Ran piped = run_pnr(folder, words, {}, loose);
        EXPECT_EQ(piped.code, 0);
        EXPECT_EQ(piped.out, neat);
    }
}

TEST(Fmt, LeavesAloneWhatItCannotRead) {
    const TemporaryFolder folder;
    folder.write("broken.pnr", "sphere {\n/* open");
    folder.write("b.pnr", "x  ;");
    const Ran broken = run_pnr(folder, {"fmt", "broken.pnr", "b.pnr"});
    EXPECT_EQ(broken.code, 3);
    EXPECT_NE(broken.err.find("broken.pnr:2:1: error:"), std::string::npos) << broken.err;
    EXPECT_EQ(folder.read("broken.pnr"), "sphere {\n/* open");
    EXPECT_EQ(folder.read("b.pnr"), "x;\n");
    EXPECT_EQ(run_pnr(folder, {"fmt", "none.pnr"}).code, 4);
}

} // namespace
} // namespace pnr
