// SPDX-License-Identifier: GPL-3.0-or-later
// bench_parse [--runs N] [--small] [--keep DIR]: how fast `pnr check` reads three large scenes, beside POV-Ray in the
// same run: mesh2 text with a million triangles, a #while that places 100,000 spheres, a macro called a million
// times. POV-Ray has no way to parse alone; a picture of one pixel without antialiasing, display or file is the
// cheapest. The two take turns; medians are compared. cpu is user and system time, wall the clock's, rss the largest
// resident memory; povray_parse is what POV-Ray itself says that its parser took.
#include "process.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using pnr::Process;

constexpr const char* head = "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
                             "camera { location <0, 2, -3> look_at 0 }\nlight_source { <5, 10, -10>, rgb 1 }\n";

// A square sheet of n x n corners, 2 (n - 1)^2 triangles.
std::string mesh_scene(int n) {
    std::string text = std::string(head) + "mesh2 {\n vertex_vectors { " + std::to_string(n * n) + ",\n";
    char line[160];
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            std::snprintf(line, sizeof line, "  <%.6f, %.6f, %.6f>,\n", double(i) / n - 0.5,
                          0.05 * std::sin(0.05 * i) * std::cos(0.07 * j), double(j) / n - 0.5);
            text += line;
        }
    }
    text += " }\n face_indices { " + std::to_string(2 * (n - 1) * (n - 1)) + ",\n";
    for (int i = 0; i + 1 < n; ++i) {
        for (int j = 0; j + 1 < n; ++j) {
            const int a = i * n + j;
            std::snprintf(line, sizeof line, "  <%d, %d, %d>, <%d, %d, %d>,\n", a, a + 1, a + n, a + 1, a + n + 1,
                          a + n);
            text += line;
        }
    }
    return text + " }\n pigment { rgb 1 }\n}\n";
}

std::string spheres_scene(int count) {
    return std::string(head) + "#declare I = 0;\n#while (I < " + std::to_string(count) +
           ")\n  sphere {\n    <mod(I, 317) * 0.01, int(I / 317) * 0.01, sin(I) * 0.1>, 0.004 + 0.001 * cos(I)\n"
           "    pigment { rgb <0.5, 0.4, mod(I, 10) / 10> }\n  }\n  #declare I = I + 1;\n#end\n";
}

std::string macro_scene(int count) {
    return std::string(head) +
           "#macro Step(A, B)\n  #local C = A * 0.5 + B;\n  #declare Total = mod(Total + C, 1000);\n#end\n"
           "#declare Total = 0;\n#declare I = 0;\n#while (I < " +
           std::to_string(count) +
           ")\n  Step(I, 0.25)\n  #declare I = I + 1;\n#end\n"
           "sphere { <0, Total / 1000, 0>, 1 pigment { rgb 1 } }\n";
}

struct Measured {
    std::vector<double> cpu, wall, rss, own;
};

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// What POV-Ray's own statistics say: "Parse Time: ... (1.234 seconds)".
double own_parse_time(const std::string& text) {
    const std::size_t at = text.find("Parse Time:");
    const std::size_t number = at == text.npos ? at : text.find('(', at);
    return number == text.npos ? 0 : std::atof(text.c_str() + number + 1);
}

void measure(const std::vector<std::string>& words, const fs::path& folder, Measured& into) {
    const Process run = pnr::run_process(words, folder, folder / "log.txt", 600);
    if (run.code != 0) {
        std::fprintf(stderr, "%s failed with %d:\n%s\n", words[0].c_str(), run.code, run.text.c_str());
        std::exit(1);
    }
    into.cpu.push_back(run.cpu_s);
    into.wall.push_back(run.wall_s);
    into.rss.push_back(run.peak_rss_mb);
    into.own.push_back(own_parse_time(run.text));
}

bool has_povray(const fs::path& folder) {
    return pnr::run_process({"povray", "--version"}, folder, folder / "log.txt", 10).code == 0;
}

void compare(const std::string& name, const std::string& text, const fs::path& folder, int runs, bool povray) {
    const std::string scene = name + ".pov";
    std::ofstream(folder / scene, std::ios::binary) << text;
    Measured ours, theirs;
    for (int i = 0; i < runs; ++i) {
        measure({PNR_BINARY, "check", scene}, folder, ours);
        if (povray)
            measure({"povray", "+I" + scene, "+W1", "+H1", "+WT1", "-D", "-F", "-A"}, folder, theirs);
    }
    const double cpu = median(ours.cpu), wall = median(ours.wall), rss = median(ours.rss);
    std::printf("%s,%.3f,%.3f,%.0f", name.c_str(), cpu, wall, rss);
    if (povray) {
        const double their_cpu = median(theirs.cpu), their_wall = median(theirs.wall), their_rss = median(theirs.rss);
        std::printf(",%.3f,%.3f,%.0f,%.3f,%.2f,%.2f,%.2f", their_cpu, their_wall, their_rss, median(theirs.own),
                    their_cpu / cpu, their_wall / wall, rss / their_rss);
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    int runs = 5;
    bool small = false;
    fs::path folder;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--runs") == 0 && i + 1 < argc)
            runs = std::max(1, std::atoi(argv[++i]));
        else if (std::strcmp(argv[i], "--small") == 0)
            small = true; // a hundredth of the work, to see that all runs
        else if (std::strcmp(argv[i], "--keep") == 0 && i + 1 < argc)
            folder = argv[++i];
        else
            return std::fprintf(stderr, "usage: bench_parse [--runs N] [--small] [--keep DIR]\n"), 2;
    }
    const bool keep = !folder.empty();
    if (!keep) folder = fs::temp_directory_path() / ("bench_parse." + std::to_string(std::rand()));
    fs::create_directories(folder);
    folder = fs::absolute(folder);
    const bool povray = has_povray(folder);
    std::printf("scene,pnr_cpu_s,pnr_wall_s,pnr_rss_mb%s\n",
                povray ? ",povray_cpu_s,povray_wall_s,povray_rss_mb,povray_parse_s,cpu_ratio,wall_ratio,rss_ratio" : "");
    if (!povray) std::fprintf(stderr, "povray is not installed: only pnr's own times\n");
    compare("mesh2", mesh_scene(small ? 72 : 709), folder, runs, povray);
    compare("spheres", spheres_scene(small ? 1'000 : 100'000), folder, runs, povray);
    compare("macro", macro_scene(small ? 10'000 : 1'000'000), folder, runs, povray);
    if (!keep) fs::remove_all(folder);
}
