// SPDX-License-Identifier: GPL-3.0-or-later
// bench_threads [--rounds N] [SCENE [OPTION...]]: how much sooner a picture is done with two threads, beside what the
// machine lets two copies of a pure arithmetic loop gain, in interleaved rounds of one run. `gain` is two copies' work a
// second over one's, for the loop; the wall time of one thread over that of two, for the picture (the embedded default
// scene at 512 x 512 if none is named). `share` is the picture's gain over the loop's.
#include "process.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Multiplications and additions that wait for each other, from registers alone.
double arithmetic(double start) {
    double a = start, b = 1 - start;
    for (int i = 0; i < 400'000'000; ++i) {
        a = a * 0.999999 + 1e-6;
        b = b * 0.999998 + 2e-6;
    }
    return a + b;
}

// Wall seconds of so many copies side by side.
double loops(int copies) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<double> results(static_cast<std::size_t>(copies));
    std::vector<std::thread> threads;
    for (double& result : results)
        threads.emplace_back([&result] { result = arithmetic(result); });
    for (std::thread& thread : threads) thread.join();
    const double seconds = seconds_since(start);
    double sum = 0;
    for (const double result : results) sum += result;
    if (!(sum > 0)) std::exit(1); // cannot be; the compiler must not leave the loop out
    return seconds;
}

double picture(const Words& words, int threads, const fs::path& folder) {
    Words all{PNR_BINARY, "render"};
    all.insert(all.end(), words.begin(), words.end());
    for (const char* word : {"--no-cache", "--progress", "off", "-o", "threads.png", "--threads"})
        all.emplace_back(word);
    all.push_back(std::to_string(threads));
    const pnr::Process run = pnr::run_process(all, folder, folder / "threads.log", 1000);
    if (run.code == 0) return run.wall_s;
    std::fprintf(stderr, "%s", run.text.c_str());
    std::exit(1);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

} // namespace

int main(int argc, char** argv) {
    Words words(argv + 1, argv + argc);
    int rounds = 5;
    if (words.size() >= 2 && words[0] == "--rounds") {
        rounds = std::max(1, std::atoi(words[1].c_str()));
        words.erase(words.begin(), words.begin() + 2);
    }
    if (words.empty()) words = {"--size", "512x512"};
    const fs::path folder = fs::temp_directory_path();
    std::vector<double> loop_gains, picture_gains, shares;
    for (int round = 0; round < rounds; ++round) {
        loop_gains.push_back(2 * loops(1) / loops(2));
        picture_gains.push_back(picture(words, 1, folder) / picture(words, 2, folder));
        shares.push_back(picture_gains.back() / loop_gains.back());
    }
    std::printf("loop_gain,picture_gain,share\n%.3f,%.3f,%.3f\n", median(loop_gains), median(picture_gains),
                median(shares));
    return 0;
}
