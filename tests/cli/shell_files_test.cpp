// SPDX-License-Identifier: GPL-3.0-or-later
// Completions and the manual page, as the shells and man read them; where one is not installed its part is
// left out.
#include <gtest/gtest.h>

#include "run_pnr.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace pnr {
namespace {

bool is_installed(const std::string& program) {
    std::istringstream folders(std::getenv("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');)
        if (std::filesystem::exists(std::filesystem::path(folder) / program)) return true;
    return false;
}

// What a shell command prints, run in the folder.
std::string printed(const TemporaryFolder& folder, const std::string& command) {
    const std::string out = (folder / "printed").string();
    const int status =
        std::system(("cd " + folder.path().string() + " && (" + command + ") > " + out + " 2>&1").c_str());
    return (status == 0 ? "" : "failed: ") + folder.read("printed");
}

TEST(ShellFiles, BashCompletesCommandsOptionsAndValues) {
    const TemporaryFolder folder;
    folder.write("pnr.bash", run_pnr(folder, {"completions", "bash"}).out);
    folder.write("pot.pnr", "");
    const auto completed = [&](const std::string& words, int current) {
        return printed(folder, "bash -c 'source ./pnr.bash; COMP_WORDS=(" + words + "); COMP_CWORD=" +
                                   std::to_string(current) + "; _pnr; echo \"${COMPREPLY[@]}\"'");
    };
    EXPECT_EQ(completed("pnr ren", 1), "render\n");
    EXPECT_EQ(completed("pnr render --pass", 2), "--passes\n");
    EXPECT_EQ(completed("pnr render --view \"\"", 3), "clip shoulder\n");
    EXPECT_EQ(completed("pnr check pot", 2), "pot.pnr\n");
    EXPECT_EQ(completed("pnr check --pass", 2), "\n") << "no option of check";
    EXPECT_EQ(completed("pnr help fm", 2), "fmt\n");
}

TEST(ShellFiles, ZshAndFishTakeTheirs) {
    const TemporaryFolder folder;
    folder.write("_pnr", run_pnr(folder, {"completions", "zsh"}).out);
    folder.write("pnr.fish", run_pnr(folder, {"completions", "fish"}).out);
    if (is_installed("zsh")) { EXPECT_EQ(printed(folder, "zsh -n _pnr"), ""); }
    if (is_installed("fish")) {
        EXPECT_EQ(printed(folder, "fish --no-execute pnr.fish"), "");
        const std::string values =
            printed(folder, "fish -c 'source pnr.fish; complete -C \"pnr render --view \"'");
        EXPECT_NE(values.find("shoulder"), std::string::npos) << values;
    }
}

TEST(ShellFiles, TheManualPageHasEveryCommandAndOption) {
    const TemporaryFolder folder;
    const std::string page = run_pnr(folder, {"man"}).out;
    folder.write("pnr.1", page);
    std::istringstream help(run_pnr(folder, {"help"}).out);
    int commands = 0;
    bool listed = false;
    for (std::string line; std::getline(help, line);) {
        if (line == "Subcommands:")
            listed = true;
        else if (line.empty())
            listed = false;
        else if (listed && line.compare(0, 2, "  ") == 0 && line[2] != ' ') {
            const std::string name = line.substr(2, line.find(' ', 2) - 2);
            EXPECT_NE(page.find("\\fBpnr " + name + "\\fR"), std::string::npos) << name;
            ++commands;
        }
    }
    EXPECT_GE(commands, 10);
    EXPECT_NE(page.find("\\fB\\-\\-save\\-photons\\fR \\fIFILE\\fR"), std::string::npos);
    if (is_installed("mandoc")) {
        const std::string complaints = printed(folder, "mandoc -Tlint -Werror pnr.1");
        EXPECT_EQ(complaints, "");
    }
}

TEST(ShellFiles, EveryCommandShowsAnExample) {
    const TemporaryFolder folder;
    for (const char* command : {"render", "check", "plan", "pick", "help", "ilic", "stability", "converge",
                                "fmt", "init", "lsp", "completions", "man"})
        EXPECT_NE(run_pnr(folder, {command, "--help"}).out.find("Example"), std::string::npos) << command;
}

TEST(Init, WritesASceneThatIsPaintedAndNoFileTwice) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_pnr(folder, {"init", "pot"}).code, 0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"pot.pnr"}));
    const std::string text = folder.read("pot.pnr");
    EXPECT_NE(text.find("pnr render pot.pnr"), std::string::npos);
    EXPECT_EQ(run_pnr(folder, {"check", "--werror", "pot.pnr"}).code, 0);
    EXPECT_EQ(run_pnr(folder, {"fmt", "--check", "pot.pnr"}).code, 0);
    EXPECT_EQ(run_pnr(folder, {"render", "pot.pnr", "-H", "16"}).code, 0);
    folder.write("pot.pnr", "mine");
    EXPECT_EQ(run_pnr(folder, {"init", "pot.pnr"}).code, 4);
    EXPECT_EQ(folder.read("pot.pnr"), "mine");
    EXPECT_EQ(run_pnr(folder, {"init"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"init", "no/such/folder"}).code, 4);
}

} // namespace
} // namespace pnr
