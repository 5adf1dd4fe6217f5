// SPDX-License-Identifier: GPL-3.0-or-later
// bench_plan [-W N] [SCENE...]: what `pnr plan` foretells beside what `pnr render --stats` then says, for
// these scenes or every scene of the project; meshes are looked for in PNR_LIBRARY_PATH, and scenes that do
// not load are left out. Shares of CPU time are compared where either side says more than 5 %, memory at the
// end of `render` and of the whole, structures from 1 MB on; a/b is foretold and measured. Worst ratios come
// last: `time` should be below 2, `memory` below 1.3.
#include "run_scene.h"

#include <cmath>
#include <cstdio>
#include <map>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

double off(double a, double b) { return a > 0 && b > 0 ? std::max(a / b, b / a) : INFINITY; }

struct Worst {
    double value = 1;
    std::string what;
    void take(double ratio, const std::string& name) {
        if (ratio > value) value = ratio, what = name;
    }
};

struct Compared {
    Worst time, memory;
    std::string text;
};

Compared compare(const json& foretold, const json& stats) {
    std::map<std::string, json> passes;
    for (const json& pass : foretold["passes"]) passes[pass["name"]] = pass;
    const double whole = pnr::cpu_seconds(stats);
    Compared c;
    std::string shares, memory;
    char cell[80];
    double said = 0, peak = 0, peak_said = 0;
    for (const json& pass : stats["passes"]) {
        const std::string name = pass["name"];
        const double share = pass["cpu_s"].get<double>() / whole, guess = passes[name]["share"];
        said += passes[name]["cpu_s"].get<double>();
        peak = std::max(peak, pass["peak_rss_mb"].get<double>());
        peak_said = std::max(peak_said, passes[name]["peak_rss_mb"].get<double>());
        if (std::max(share, guess) > 0.05) {
            c.time.take(off(guess, share), name);
            std::snprintf(cell, sizeof cell, "%s%s %.0f/%.0f", shares.empty() ? "" : ", ", name.c_str(),
                          100 * guess, 100 * share);
            shares += cell;
        }
        if (name == "render" || name == "write") {
            c.memory.take(off(peak_said, peak), name);
            std::snprintf(cell, sizeof cell, " %.0f/%.0f |", peak_said, peak);
            memory += cell;
        }
    }
    for (const json& structure : foretold["structures"]) {
        const double bytes = stats["memory"][structure["name"].get<std::string>()],
                     guess = structure["bytes"];
        if (std::max(bytes, guess) > 1 << 20) c.memory.take(off(guess, bytes), structure["name"]);
    }
    std::snprintf(cell, sizeof cell, " %.1f/%.1f |", said, whole);
    c.text = " " + shares + " |" + memory + cell;
    return c;
}

} // namespace

int main(int count, char** words) {
    std::string width = "256";
    std::vector<fs::path> scenes;
    for (int i = 1; i < count; ++i) {
        if (std::string(words[i]) == "-W" && i + 1 < count)
            width = words[++i];
        else
            scenes.emplace_back(words[i]);
    }
    if (scenes.empty()) scenes = pnr::all_scenes();
    const fs::path folder = fs::temp_directory_path() / "bench_plan";
    fs::create_directories(folder);
    Worst time, memory;
    std::printf("| scene | time | memory | CPU time, %% | MB by render | MB in all | CPU s |\n"
                "|---|---|---|---|---|---|---|\n");
    for (const fs::path& scene : scenes) {
        const std::string name = scene.stem().string();
        const pnr::Words plan{PNR_BINARY, "plan",     scene.string(), "-W",
                              width,      "--format", "json",         "--no-cache"};
        const pnr::Process said = pnr::run_process(plan, fs::current_path(), folder / "plan.log", 100'000);
        const json stats =
            said.code == 0 ? pnr::render_stats(folder, name, {scene.string(), "-W", width}) : json();
        if (stats.is_null()) {
            std::fprintf(stderr, "%s is left out: it does not load\n", name.c_str());
            continue;
        }
        const Compared c = compare(json::parse(said.text.substr(said.text.find('{')))["forecast"], stats);
        std::printf("| %s | %.2f %s | %.2f %s |%s\n", name.c_str(), c.time.value, c.time.what.c_str(),
                    c.memory.value, c.memory.what.c_str(), c.text.c_str());
        std::fflush(stdout);
        time.take(c.time.value, name + " " + c.time.what);
        memory.take(c.memory.value, name + " " + c.memory.what);
    }
    std::printf("\nWorst: time %.2f (%s), memory %.2f (%s).\n", time.value, time.what.c_str(), memory.value,
                memory.what.c_str());
    return 0;
}
