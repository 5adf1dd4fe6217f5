// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress_view.h"

#include "cli/passes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace pnr {

namespace {

// What a pass usually costs beside the others; good enough for a bar, and mended by the clock as it goes.
double usual_cost(const std::string& pass) {
    if (pass == "render") return 6;
    if (pass == "sparse" || pass == "photons" || pass == "gbuffer") return 2;
    if (pass == "ilic" || pass == "build") return 1;
    return 0.3;
}

void print(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

std::string minutes(double seconds) {
    const auto whole = static_cast<long>(std::ceil(std::max(0.0, seconds)));
    if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

} // namespace

ProgressView::ProgressView(ProgressMode mode) : form_(Form::none), expected_(pass_names()) {
    if (mode == ProgressMode::json) form_ = Form::json;
    if (mode == ProgressMode::automatic) form_ = ::isatty(STDERR_FILENO) != 0 ? Form::bar : Form::lines;
}

ProgressView::~ProgressView() { clear_bar(); }

void ProgressView::expect(std::vector<std::string> names) {
    const std::lock_guard lock(mutex_);
    expected_ = std::move(names);
}

void ProgressView::begin(const std::string& pass) {
    const std::lock_guard lock(mutex_);
    current_ = pass;
    largest_ = 0;
    if (form_ == Form::bar) draw(pass, 0);
    if (form_ == Form::json) print_json(pass, 0, false);
}

void ProgressView::update(const std::string& pass, double share) {
    if (form_ != Form::bar && form_ != Form::json) return;
    const std::lock_guard lock(mutex_);
    largest_ = std::max(largest_, std::min(share, 1.0));
    const auto now = Clock::now();
    if (now - last_drawn_ < std::chrono::milliseconds(100)) return;
    last_drawn_ = now;
    if (form_ == Form::bar) draw(pass, largest_);
    if (form_ == Form::json) print_json(pass, largest_, false);
}

void ProgressView::end(const std::string& pass, double wall_s) {
    const std::lock_guard lock(mutex_);
    finished_.push_back(pass);
    current_.clear();
    largest_ = 0;
    if (form_ == Form::lines) print(fmt::format("{:<12}{:8.2f} s\n", pass, wall_s));
    if (form_ == Form::json) print_json(pass, 1, true);
}

void ProgressView::note(const std::string& line) {
    if (form_ != Form::bar && form_ != Form::lines) return;
    const std::lock_guard lock(mutex_);
    clear_bar();
    print(line + "\n");
}

double ProgressView::overall(double share) const {
    double done = 0, all = 0;
    for (const std::string& pass : expected_) {
        const double cost = usual_cost(pass);
        all += cost;
        if (std::find(finished_.begin(), finished_.end(), pass) != finished_.end())
            done += cost;
        else if (pass == current_)
            done += cost * share;
    }
    return all > 0 ? done / all : 0;
}

double ProgressView::seconds_left(double share) const {
    const double done = overall(share);
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    return done > 0 ? elapsed * (1 - done) / done : 0;
}

void ProgressView::draw(const std::string& pass, double share) {
    constexpr int cells = 30;
    const double done = overall(share);
    const int full = static_cast<int>(std::lround(done * cells));
    const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                            std::string(static_cast<std::size_t>(cells - full), '.');
    const std::string left = done > 0.02 ? minutes(seconds_left(share)) + " left" : "";
    print(fmt::format("\r\x1b[K[{}] {:3.0f} %  {:<12}{}", bar, 100 * done, pass, left));
    bar_shown_ = true;
}

void ProgressView::print_json(const std::string& pass, double share, bool done) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    const double part = done ? 0 : share; // a finished pass is already in `finished_`
    const nlohmann::ordered_json line{{"pass", pass},
                                      {"done", share},
                                      {"overall", overall(part)},
                                      {"elapsed_s", elapsed},
                                      {"left_s", seconds_left(part)}};
    print(line.dump() + "\n");
}

void ProgressView::clear_bar() {
    if (bar_shown_) print("\r\x1b[K");
    bar_shown_ = false;
}

} // namespace pnr
