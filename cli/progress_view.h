// SPDX-License-Identifier: GPL-3.0-or-later
// How far the passes are, on standard error: a bar with the time left on a terminal, else one line a pass; or
// JSON lines.
#pragma once

#include "cli/options.h"

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

namespace pnr {

class ProgressView {
public:
    explicit ProgressView(ProgressMode mode);
    ~ProgressView();

    void expect(std::vector<std::string> names);
    void begin(const std::string& pass);
    void update(const std::string& pass, double share); // from any thread; share of the pass in [0, 1]
    void end(const std::string& pass, double wall_s);
    void note(const std::string& line);

private:
    enum class Form { none, bar, lines, json };
    using Clock = std::chrono::steady_clock;

    double overall(double share) const; // of all expected passes, by their usual cost
    double seconds_left(double share) const;
    void draw(const std::string& pass, double share);
    void print_json(const std::string& pass, double share, bool done);
    void clear_bar();

    Form form_;
    std::mutex mutex_; // passes report from many threads
    std::vector<std::string> expected_;
    std::vector<std::string> finished_;
    std::string current_;
    double largest_ = 0; // share of the current pass; chunks may report out of order
    bool bar_shown_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_drawn_{};
};

} // namespace pnr
