// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/passes.h"

#include "cli/interrupt.h"
#include "cli/progress_view.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

namespace pnr {

namespace {

double clock_seconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_rss_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The process's start as the kernel keeps it, in clock ticks since the machine's own: what loading the program took counts.
double process_start() {
    std::ifstream file("/proc/self/stat");
    std::string line;
    std::getline(file, line);
    std::istringstream fields(line.substr(std::min(line.rfind(')') + 2, line.size())));
    std::string field;
    for (int i = 3; i <= 22 && fields >> field; ++i) {}
    const double ticks = std::atof(field.c_str());
    const double start = ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    const double now = clock_seconds(CLOCK_BOOTTIME);
    return start > 0 && start <= now && now - start < 60 ? start : now;
}

} // namespace

double Passes::elapsed() {
    static const double started = process_start();
    return clock_seconds(CLOCK_BOOTTIME) - started;
}

const std::vector<std::string>& pass_names() {
    static const std::vector<std::string> names{"parse",   "build",  "photons", "kdtree",
                                                "gbuffer", "sparse", "orient",  "informative",
                                                "ilic",    "render", "write"};
    return names;
}

Passes::Passes(ProgressMode mode, bool from_start)
    : view_(std::make_unique<ProgressView>(mode)), wall_mark_(clock_seconds(CLOCK_MONOTONIC)),
      cpu_mark_(from_start ? 0 : clock_seconds(CLOCK_PROCESS_CPUTIME_ID)) {
    for (const std::string& name : pass_names()) times_.push_back({name});
}
Passes::~Passes() = default;

void Passes::expect(std::vector<std::string> names) { view_->expect(std::move(names)); }
void Passes::note(const std::string& line) { view_->note(line); }

Passes::Running::Running(Passes& owner, std::string name) : passes(owner), pass(std::move(name)) {
    passes.view_->begin(pass);
}
Passes::Running::~Running() { passes.finish(pass); }

Progress Passes::progress_of(const std::string& name) {
    ProgressView* view = view_.get();
    return [this, view, name](std::int64_t done, std::int64_t total) {
        view->update(name, static_cast<double>(done) / static_cast<double>(total));
        return stop_signal() == 0 && !past_deadline();
    };
}

void Passes::charge(const std::string& name) {
    const double wall = clock_seconds(CLOCK_MONOTONIC), cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    for (PassTime& time : times_) {
        if (time.name != name) continue;
        time.wall_s += wall - wall_mark_;
        time.cpu_s += cpu - cpu_mark_;
        time.peak_rss_mb = peak_rss_mb();
    }
    wall_mark_ = wall;
    cpu_mark_ = cpu;
}

void Passes::finish(const std::string& name) {
    const double began = wall_mark_;
    charge(name);
    view_->end(name, wall_mark_ - began);
}

} // namespace pnr
