// SPDX-License-Identifier: GPL-3.0-or-later
// bench_light [--references DIR] [--paths N] [--scene s1|s2] [--errors FILE.exr] [-- OPTION...]: how far the
// pictures of two scenes (light/s1.pnr: a diffuse bunny; light/s2.pnr: a glass sphere and its caustic) are
// from the truth, for growing budgets, and what CPU time they took. The truth is two independent path-traced
// pictures A and B, so that relMSE = mean((x - A)(x - B) / (r^2 + 0.01)), r = (A + B) / 2, is free of their
// own noise; pixels within 2 of r > 10 are left out. They are kept in DIR and made if they are not there, N
// paths a pixel each. `ratio` is the mean of x over the mean of r, and p90 the share of relative error that
// nine tenths of the pixels do not exceed, as far as the references' noise lets it be known. Options behind
// `--` replace the list of budgets by one run with them. --errors writes the squared errors of the last run.
#include "core/image_io.h"
#include "process.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Picture = pnr::Image<glm::vec4>;
using Words = std::vector<std::string>;

struct Task {
    fs::path references = "references";
    int paths = 256;
    Words scenes{"s1", "s2"};
    fs::path errors;
    std::vector<Words> budgets;
};

fs::path scene_file(const std::string& scene) { return fs::path(PNR_LIGHT_SCENES) / (scene + ".pnr"); }

// Renders a scene; the process tells its CPU time.
pnr::Process render(const std::string& scene, const fs::path& picture, const Words& options) {
    Words words{PNR_BINARY,   "render", scene_file(scene).string(), "-o", picture.string(),
                "--progress", "off"};
    words.insert(words.end(), options.begin(), options.end());
    const pnr::Process run = pnr::run_process(words, fs::current_path(), picture.string() + ".log", 100'000);
    if (run.code == 0) return run;
    std::fprintf(stderr, "%s", run.text.c_str());
    std::exit(1);
}

Picture reference(const Task& task, const std::string& scene, char which) {
    const fs::path file = task.references / (scene + '_' + which + ".exr");
    if (!fs::exists(file)) {
        fs::create_directories(task.references);
        const fs::path unfinished = task.references / (scene + '_' + which + ".part.exr");
        render(scene, unfinished,
               {"--integrator", "path", "--passes", std::to_string(task.paths), "--seed",
                which == 'a' ? "1001" : "2002"});
        fs::rename(unfinished, file);
    }
    return pnr::read_image(file);
}

struct Truth {
    Picture a, b;
    std::vector<char> counts; // pixels that are compared
};

bool near_lamp(const Truth& truth, int x, int y) {
    for (int v = y - 2; v <= y + 2; ++v)
        for (int u = x - 2; u <= x + 2; ++u) {
            if (!truth.a.contains(u, v)) continue;
            const glm::vec4 r = 0.5f * (truth.a.at(u, v) + truth.b.at(u, v));
            if (std::max({r.x, r.y, r.z}) > 10) return true;
        }
    return false;
}

Truth make_truth(const Task& task, const std::string& scene) {
    Truth truth{reference(task, scene, 'a'), reference(task, scene, 'b'), {}};
    for (int y = 0; y < truth.a.height; ++y)
        for (int x = 0; x < truth.a.width; ++x) truth.counts.push_back(!near_lamp(truth, x, y));
    return truth;
}

struct Distance {
    double rel_mse = 0, ratio = 0, p90 = 0;
};

Distance compare(const Picture& x, const Truth& truth, Picture* errors) {
    double sum = 0, mine = 0, theirs = 0;
    std::size_t n = 0;
    std::vector<double> relative;
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        if (!truth.counts[i]) continue;
        double squares = 0, of = 0;
        for (int c = 0; c < 3; ++c) {
            const double a = static_cast<double>(truth.a.pixels[i][c]),
                         b = static_cast<double>(truth.b.pixels[i][c]);
            const double value = static_cast<double>(x.pixels[i][c]), r = 0.5 * (a + b);
            const double square = (value - a) * (value - b) / (r * r + 0.01);
            if (errors) errors->pixels[i][c] = static_cast<float>(square);
            sum += square;
            mine += value;
            theirs += r;
            squares += (value - a) * (value - b);
            of += r;
            ++n;
        }
        relative.push_back(std::sqrt(std::max(0.0, squares / 3)) / (of / 3 + 0.01));
    }
    const auto ninth =
        relative.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(relative.size()));
    std::nth_element(relative.begin(), ninth, relative.end());
    return {sum / static_cast<double>(n), mine / theirs, *ninth};
}

void write_errors(const Picture& errors, const fs::path& file) {
    pnr::ImageFile image;
    image.width = errors.width;
    image.height = errors.height;
    pnr::ImagePart part{"", {"R", "G", "B"}, {}, false};
    for (const glm::vec4 e : errors.pixels)
        for (int c = 0; c < 3; ++c) part.data.push_back(e[c]);
    image.parts.push_back(std::move(part));
    pnr::write_exr(file, image);
}

void measure(const Task& task, const std::string& scene) {
    const Truth truth = make_truth(task, scene);
    const fs::path picture = task.references / (scene + "_x.exr");
    for (const Words& budget : task.budgets) {
        const pnr::Process run = render(scene, picture, budget);
        const Picture x = pnr::read_image(picture);
        Picture errors(x.width, x.height, glm::vec4(0));
        const Distance d = compare(x, truth, task.errors.empty() ? nullptr : &errors);
        std::string options;
        for (const std::string& word : budget) options += (options.empty() ? "" : " ") + word;
        std::printf("%s,%s,%.2f,%.2f,%.6f,%.4f,%.4f\n", scene.c_str(), options.c_str(), run.cpu_s, run.wall_s,
                    d.rel_mse, d.ratio, d.p90);
        std::fflush(stdout);
        if (!task.errors.empty()) write_errors(errors, task.errors);
    }
}

Task read_arguments(int argc, char** argv) {
    Task task;
    const Words words(argv + 1, argv + argc);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--") {
            task.budgets.emplace_back(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
            break;
        }
        if (i + 1 == words.size()) {
            std::fprintf(stderr, "bench_light: `%s` needs a value\n", words[i].c_str());
            std::exit(2);
        }
        const std::string& value = words[i + 1];
        if (words[i] == "--references")
            task.references = value;
        else if (words[i] == "--paths")
            task.paths = std::max(1, std::atoi(value.c_str()));
        else if (words[i] == "--scene")
            task.scenes = {value};
        else if (words[i] == "--errors")
            task.errors = value;
        ++i;
    }
    if (task.budgets.empty())
        task.budgets = {{"--quality", "draft"}, {},
                        {"--quality", "high"},  {"--time", "1.6"},
                        {"--time", "3"},        {"--time", "5.5"},
                        {"--time", "8.5"}};
    return task;
}

} // namespace

int main(int argc, char** argv) {
    const Task task = read_arguments(argc, argv);
    std::printf("scene,options,cpu_s,wall_s,rel_mse,ratio,p90\n");
    for (const std::string& scene : task.scenes) measure(task, scene);
    return 0;
}
