// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the built program as a user would, in a folder of its own.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace pnr {

struct Ran {
    int code = -1; // exit code; 128 + n if signal n killed it
    std::string out, err;
    double cpu_s = 0; // of the process, all threads
};

using Environment = std::map<std::string, std::string>;

// A folder that goes away with its owner.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const; // bytes; "" if it is not there
    std::vector<std::string> names() const;          // sorted

    const std::filesystem::path& cache() const { return cache_; } // what stands for the user's cache folder

private:
    std::filesystem::path path_, cache_;
};

// Runs pnr with `folder` as its current folder and `input` on its standard input.
Ran run_pnr(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
            const Environment& environment = {}, const std::string& input = "");
// The same; it gets `signal` as soon as its standard error holds `signal_at`.
Ran run_pnr_and_signal(const TemporaryFolder& folder, const std::vector<std::string>& arguments, int signal,
                       const std::string& signal_at);

// pnr running beside the test, which reads what it says and answers by what it does.
class RunningPnr {
public:
    RunningPnr(const TemporaryFolder& folder, const std::vector<std::string>& arguments);
    ~RunningPnr(); // ends it if it still runs
    RunningPnr(const RunningPnr&) = delete;
    RunningPnr& operator=(const RunningPnr&) = delete;

    // Waits until its standard error says this, behind what was waited for before. False: it ended, or took a minute and
    // more. `said` is then what came instead.
    bool says(const std::string& text);
    const std::string& said() const { return err_; } // all so far
    void signal(int signal) const;
    int end(); // waits for its end: the exit code, 128 + n if signal n killed it

private:
    struct Ends;
    std::unique_ptr<Ends> ends_;
    int child_ = -1;
    std::string err_;
    std::size_t read_ = 0; // of err_, by says()
};

// A painted ball and a photoreal one in a box 2 wide with a hemisphere light at the ceiling.
std::string box_scene(const std::string& more = "");

} // namespace pnr
