// SPDX-License-Identifier: GPL-3.0-or-later
// Runs pnr on a scene and reads what it says of itself.
#pragma once

#include "process.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pnr {

using Words = std::vector<std::string>;

// The statistics of a rendering; null where it fails (its words are printed). The picture lies in
// FOLDER/NAME.exr. Of an animation `frame` is the number as it stands in file names.
inline nlohmann::json render_stats(const std::filesystem::path& folder, const std::string& name,
                                   const Words& options, const std::string& frame = "") {
    const std::filesystem::path stats = folder / (name + ".json");
    Words words{PNR_BINARY, "render",       "-o",         (folder / (name + ".exr")).string(),
                "--stats",  stats.string(), "--progress", "off", "--no-cache"};
    words.insert(words.end(), options.begin(), options.end());
    const Process run =
        run_process(words, std::filesystem::current_path(), folder / (name + ".log"), 100'000);
    if (run.code == 0) return nlohmann::json::parse(std::ifstream(folder / (name + frame + ".json")));
    std::fprintf(stderr, "%s", run.text.c_str());
    return nullptr;
}

// Sums over the passes.
inline double cpu_seconds(const nlohmann::json& stats) {
    double sum = 0;
    for (const auto& pass : stats["passes"]) sum += pass["cpu_s"].get<double>();
    return sum;
}
inline double peak_mb(const nlohmann::json& stats) {
    double peak = 0;
    for (const auto& pass : stats["passes"]) peak = std::max(peak, pass["peak_rss_mb"].get<double>());
    return peak;
}

// Every scene of the project, in the order of folders and names.
inline std::vector<std::filesystem::path> all_scenes() {
    std::vector<std::filesystem::path> scenes;
    for (const char* folder : {"", "gallery", "paper", "course"}) {
        std::vector<std::filesystem::path> here;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(PNR_SCENES) / folder))
            if (entry.path().extension() == ".pnr") here.push_back(entry.path());
        std::sort(here.begin(), here.end());
        scenes.insert(scenes.end(), here.begin(), here.end());
    }
    return scenes;
}

} // namespace pnr
