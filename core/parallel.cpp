// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace pnr {

namespace {

// The cores this process may use: of the machine, its affinity mask and its cgroup's quota (in a container
// the file holds "quota period" or "max period").
int usable_cores() {
    int cores = std::max(1, tbb::info::default_concurrency());
    std::ifstream limits("/sys/fs/cgroup/cpu.max");
    double quota = 0, period = 0;
    if (limits >> quota >> period && quota > 0 && period > 0)
        cores = std::min(cores, std::max(1, static_cast<int>(std::ceil(quota / period))));
    return cores;
}

} // namespace

struct ThreadLimit::State {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : state_(
          new State{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads > 0 ? threads : usable_cores()))}) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t, std::int64_t, std::int64_t)>& body) {
    if (count <= 0) return;
    const std::int64_t chunks = (count + grain - 1) / grain;
    tbb::parallel_for(
        std::int64_t{0}, chunks,
        [&](std::int64_t chunk) { body(chunk * grain, std::min(count, (chunk + 1) * grain), chunk); },
        tbb::simple_partitioner{});
}

} // namespace pnr
