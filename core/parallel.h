// SPDX-License-Identifier: GPL-3.0-or-later
// Work split over the cores. Chunks are fixed by the problem alone, never by the number of threads, so a
// result that is joined in chunk order has the same bits on any machine.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace pnr {

// Limits all parallel work of the process while it lives. threads <= 0: as many as the machine (or its
// cgroup) gives.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct State;
    std::unique_ptr<State> state_;
};

int thread_count(); // how many threads parallel work uses now

// Calls body(begin, end, chunk) for consecutive chunks of `grain` items that cover [0, count); chunk counts
// from 0. Chunks run in any order and at the same time; the first exception thrown is passed on. Nested calls
// are fine.
void parallel_for(std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t begin, std::int64_t end, std::int64_t chunk)>& body);

// A pass tells how far it is through this: done of total, from any thread, total >= 1. It returns false when
// the user wants the pass to stop; the pass then throws Interrupted. An empty function means nobody asks.
using Progress = std::function<bool(std::int64_t done, std::int64_t total)>;

// Thrown by a pass whose Progress said stop (a signal): the command line saves what can be saved, then exits
// 130 or 143.
struct Interrupted {};

} // namespace pnr
