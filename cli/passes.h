// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the passes one after the other, measures each and shows how far they are.
#pragma once

#include "cli/options.h"
#include "core/parallel.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace pnr {

struct PassTime {
    std::string name;
    double wall_s = 0, cpu_s = 0; // all threads
    double peak_rss_mb = 0;       // of the process so far; 0 if the pass did not run
};

// The names of all passes in their order (design: the file contract).
const std::vector<std::string>& pass_names();

class ProgressView; // passes.cpp

class Passes {
public:
    // `from_start`: what the process has done so far, loading the program, counts for the first pass.
    Passes(ProgressMode mode, bool from_start);
    ~Passes();

    // Which passes will run, for the time left; called once that is known.
    void expect(std::vector<std::string> names);

    // Runs `work(progress)` under a name; times of the same name add up. All time since the end of the pass
    // before counts for this one, so that the sum is the process's.
    template <class Work>
    auto run(const std::string& name, Work work) {
        const Running running(*this, name);
        return work(progress_of(name));
    }

    // All time since the end of the pass before counts for this one, which does not run.
    void charge(const std::string& name);

    const std::vector<PassTime>& times() const { return times_; } // one entry a name, in pass_names' order
    // Seconds of wall time since the process began.
    static double elapsed();
    // From now on passes are told to stop when so many seconds have gone by since the process began; infinity: never.
    // From any thread.
    void set_deadline(double elapsed_s) { deadline_ = elapsed_s; }
    bool past_deadline() const { return elapsed() > deadline_; }

    // A line that does not break the bar; printed unless progress is off or JSON.
    void note(const std::string& line);

private:
    struct Running {
        Running(Passes& owner, std::string name);
        ~Running();
        Running(const Running&) = delete;
        Running& operator=(const Running&) = delete;
        Passes& passes;
        std::string pass;
    };
    Progress progress_of(const std::string& name);
    void finish(const std::string& name);

    std::unique_ptr<ProgressView> view_;
    std::vector<PassTime> times_;
    double wall_mark_ = 0, cpu_mark_ = 0;
    std::atomic<double> deadline_ = std::numeric_limits<double>::infinity();
};

} // namespace pnr
