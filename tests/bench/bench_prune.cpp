// SPDX-License-Identifier: GPL-3.0-or-later
// bench_prune: what leaving out saves, in CPU time and memory, on six scenes (prune/), as they are and with
// --no-prune, as a Markdown table; `difference` is the largest of any channel between the two pictures. In
// the sixth only the camera has moved since a frame before: its photons are used again, or are not there.
#include "run_scene.h"

#include "core/image_io.h"

#include <cmath>
#include <cstdio>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

double difference(const fs::path& a, const fs::path& b) {
    const auto first = pnr::read_image(a), second = pnr::read_image(b);
    double most = first.pixels.size() == second.pixels.size() ? 0 : INFINITY;
    for (std::size_t i = 0; i < first.pixels.size() && std::isfinite(most); ++i)
        for (int c = 0; c < 4; ++c)
            most = std::max(most, std::abs(static_cast<double>(first.pixels[i][c]) -
                                           static_cast<double>(second.pixels[i][c])));
    return most;
}

std::string list(const json& left_out) {
    std::string text;
    for (const json& left : left_out) text += (text.empty() ? "" : ", ") + left["what"].get<std::string>();
    return text.empty() ? "nothing" : text;
}

void print_row(const std::string& name, const json& with, const json& without, double off) {
    std::printf("| %s | %s | %.2f | %.2f | %.0f | %.0f | %.1g |\n", name.c_str(),
                list(with["plan"]["left_out"]).c_str(), pnr::cpu_seconds(with), pnr::cpu_seconds(without),
                pnr::peak_mb(with), pnr::peak_mb(without), off);
    std::fflush(stdout);
}

} // namespace

int main() {
    const fs::path folder = fs::temp_directory_path() / "bench_prune";
    fs::create_directories(folder);
    std::printf("| scene | left out | CPU s | --no-prune | MB | --no-prune | difference "
                "|\n|---|---|---|---|---|---|---|\n");
    for (const char* name : {"plain", "all_painted", "nothing_painted", "no_glass", "one_seed"}) {
        const std::string scene =
            std::string(PNR_PRUNE_SCENES "/") + name + (std::string(name) == "plain" ? ".pov" : ".pnr");
        const json with = pnr::render_stats(folder, "with", {scene}),
                   without = pnr::render_stats(folder, "without", {scene, "--no-prune"});
        if (with.is_null() || without.is_null()) return 1;
        print_row(name, with, without, difference(folder / "with.exr", folder / "without.exr"));
    }
    // The second of two frames that differ in their camera alone, and by itself.
    const pnr::Words moved{PNR_PRUNE_SCENES "/no_glass.pnr", "--frames", "1-2"};
    pnr::Words alone = moved;
    alone.insert(alone.end(), {"--subset", "2-2"});
    const json with = pnr::render_stats(folder, "with", moved, "0002"),
               without = pnr::render_stats(folder, "without", alone, "0002");
    if (with.is_null() || without.is_null()) return 1;
    print_row("camera_moved", with, without, difference(folder / "with0002.exr", folder / "without0002.exr"));
    return 0;
}
