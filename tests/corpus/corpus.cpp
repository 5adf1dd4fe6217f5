// SPDX-License-Identifier: GPL-3.0-or-later
// Renders a folder of POV-Ray scenes with pnr and compares the pictures with POV-Ray's, worst first. Where a
// reference picture is missing, `povray` makes it; where that refuses a scene, the scene is not counted.
//     corpus --scenes /usr/share/doc/povray/examples --references build/povray
#include "process.h"
#include "similarity.h"

#include "core/image_io.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <thread>

namespace pnr {

namespace {

namespace fs = std::filesystem;

struct Wish {
    fs::path scenes, references, work = "corpus", pnr = PNR_BINARY,
                                 includes = "/usr/share/povray-3.7/include";
    std::string match; // only scenes whose name holds it
    int sample = 0;    // that many, chosen by `seed`; 0: all
    unsigned seed = 1;
    int jobs = 2, cpu = 30; // scenes at a time; CPU seconds a program
    int width = 160, height = 120;
    bool known_only = false;  // leave out scenes that have no reference yet
    double threshold = 0.85;  // of similarity
    double least_similar = 0; // shares of the counted scenes that are asked for: 0 .. 1
    double least_accepted = 0, least_rendered = 0;
};

struct Scene {
    fs::path file;
    std::string name; // its path below the folder, with _ for /
};

struct Row {
    std::string name;
    bool valid = false; // POV-Ray takes it
    bool compared = false, accepted = false, rendered = false, timed_out = false;
    double similarity = 0, luma = 0, reference_luma = 0, cpu_s = 0;
    std::string cause;
};

std::vector<Scene> find_scenes(const Wish& wish) {
    std::vector<Scene> scenes;
    for (const auto& entry : fs::recursive_directory_iterator(wish.scenes)) {
        if (entry.path().extension() != ".pov") continue;
        std::string name = fs::relative(entry.path(), wish.scenes).replace_extension().string();
        std::replace(name.begin(), name.end(), '/', '_');
        const bool known =
            fs::exists(wish.references / (name + ".png")) || fs::exists(wish.references / (name + ".fail"));
        if (name.find(wish.match) != std::string::npos && (known || !wish.known_only))
            scenes.push_back({entry.path(), name});
    }
    std::sort(scenes.begin(), scenes.end(), [](const Scene& a, const Scene& b) { return a.name < b.name; });
    if (wish.sample <= 0) return scenes;
    std::mt19937 rng(wish.seed);
    for (std::size_t i = scenes.size(); i > 1; --i) std::swap(scenes[i - 1], scenes[rng() % i]);
    scenes.resize(std::min(scenes.size(), static_cast<std::size_t>(wish.sample)));
    return scenes;
}

// POV-Ray's picture; none if it refuses the scene (then `name.fail` holds its exit code, 124 if it took too
// long).
std::optional<fs::path> reference_of(const Scene& scene, const Wish& wish, bool& valid) {
    const fs::path picture = wish.references / (scene.name + ".png"),
                   failed = wish.references / (scene.name + ".fail");
    if (!fs::exists(failed) && !fs::exists(picture)) {
        const fs::path made = fs::absolute(wish.references / (scene.name + ".part.png"));
        const Process p = run_process({"povray", "+I" + scene.file.filename().string(), "+O" + made.string(),
                                       fmt::format("+W{}", wish.width), fmt::format("+H{}", wish.height),
                                       "+A0.3", "-D", "+WT1", "+L" + wish.includes.string()},
                                      fs::absolute(scene.file).parent_path(),
                                      fs::absolute(wish.work / (scene.name + ".povray.log")), 3 * wish.cpu);
        if (p.code == 0 && fs::exists(made))
            fs::rename(made, picture);
        else
            std::ofstream(failed) << (p.timed_out ? 124 : p.code) << '\n';
    }
    int code = 0;
    if (std::ifstream file(failed); file) file >> code;
    valid = code == 0 || code == 124;
    if (code != 0) return std::nullopt;
    return picture;
}

// The first error, or the distinct things that warnings name, without places and counts.
std::string cause_of(const Process& p) {
    if (p.timed_out) return "takes too long";
    static const std::regex message(R"((error|warning): ([^\n]*))");
    std::set<std::string> seen;
    std::string warnings;
    for (std::sregex_iterator i(p.text.begin(), p.text.end(), message), end; i != end; ++i) {
        if ((*i)[1] == "error") return "error: " + (*i)[2].str();
        if (seen.insert((*i)[2]).second && seen.size() <= 3)
            warnings += (warnings.empty() ? "" : " | ") + (*i)[2].str();
    }
    return p.code == 0 ? warnings : fmt::format("exit code {}", p.code);
}

void compare(const fs::path& ours, const fs::path& reference, Row& row) {
    const Image<double> a = luma_of(read_image(ours)), b = luma_of(read_image(reference));
    row.similarity = similarity(a, b);
    row.luma = mean_luma(a);
    row.reference_luma = mean_luma(b);
    row.compared = true;
}

Row examine(const Scene& scene, const Wish& wish) {
    Row row;
    row.name = scene.name;
    const auto reference = reference_of(scene, wish, row.valid);
    const fs::path folder = fs::absolute(scene.file).parent_path(), file = fs::absolute(scene.file);
    const fs::path picture = fs::absolute(wish.work / (scene.name + ".png"));
    const fs::path log = fs::absolute(wish.work / (scene.name + ".log"));
    std::error_code ignored;
    fs::remove(picture, ignored);
    const std::string pnr = fs::absolute(wish.pnr).string();
    const Process check =
        run_process({pnr, "check", file.string(), "-L", wish.includes.string()}, folder, log, wish.cpu);
    row.accepted = check.code == 0;
    row.cause = cause_of(check);
    row.timed_out = check.timed_out;
    row.cpu_s = check.cpu_s;
    if (!row.accepted) return row;
    const Process render = run_process({pnr, "render", file.string(), "-L", wish.includes.string(), "+A0.3",
                                        "-W", std::to_string(wish.width), "-H", std::to_string(wish.height),
                                        "--threads", "1", "--progress", "off", "-o", picture.string()},
                                       folder, log, wish.cpu);
    row.rendered = render.code == 0;
    row.cpu_s = render.cpu_s;
    row.timed_out = render.timed_out;
    row.cause = cause_of(render);
    if (row.rendered && reference) compare(picture, *reference, row);
    return row;
}

std::vector<Row> examine_all(const std::vector<Scene>& scenes, const Wish& wish) {
    std::vector<Row> rows(scenes.size());
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> workers;
    for (int i = 0; i < std::max(1, wish.jobs); ++i)
        workers.emplace_back([&] {
            for (std::size_t k = next++; k < scenes.size(); k = next++) rows[k] = examine(scenes[k], wish);
        });
    workers.clear();
    return rows;
}

void print_rows(std::vector<Row> rows) {
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
        return std::tie(a.accepted, a.rendered, a.similarity, a.name) <
               std::tie(b.accepted, b.rendered, b.similarity, b.name);
    });
    fmt::print("  SSIM   luma  POV-Ray  CPU s  scene: cause\n");
    for (const Row& r : rows) {
        const std::string ssim = r.compared   ? fmt::format("{:6.3f}", r.similarity)
                                 : r.rendered ? "     -"
                                 : r.accepted ? " fails"
                                              : "errors";
        fmt::print("{} {:6.1f}  {:7.1f} {:6.1f}  {}{}: {:.160}\n", ssim, r.luma, r.reference_luma, r.cpu_s,
                   r.valid ? "" : "(not POV-Ray's) ", r.name, r.cause);
    }
}

// Prints the counts; false if fewer than asked for.
bool print_counts(const std::vector<Row>& rows, const Wish& wish) {
    const auto count = [&](const auto& holds) { return std::count_if(rows.begin(), rows.end(), holds); };
    const auto valid = count([](const Row& r) { return r.valid; });
    const auto accepted = count([](const Row& r) { return r.valid && r.accepted; });
    const auto rendered = count([](const Row& r) { return r.valid && r.rendered; });
    const auto similar = count([&](const Row& r) { return r.compared && r.similarity >= wish.threshold; });
    const auto compared = count([](const Row& r) { return r.compared; });
    fmt::print(
        "{} scenes, {} of them POV-Ray takes: {} accepted, {} rendered, {} compared, {} with SSIM >= {}\n",
        rows.size(), valid, accepted, rendered, compared, similar, wish.threshold);
    const auto enough = [&](auto n, double share) {
        return static_cast<double>(n) >= share * static_cast<double>(valid) - 1e-9;
    };
    return enough(accepted, wish.least_accepted) && enough(rendered, wish.least_rendered) &&
           enough(similar, wish.least_similar);
}

} // namespace

} // namespace pnr

int main(int argc, char** argv) {
    using namespace pnr;
    Wish wish;
    CLI::App app("Compare pnr's pictures of a folder of POV-Ray scenes with POV-Ray's");
    app.add_option("--scenes", wish.scenes, "folder of .pov files")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_option("--references", wish.references, "folder of POV-Ray's pictures; missing ones are made")
        ->required();
    app.add_option("--work", wish.work, "folder for our pictures and the logs");
    app.add_option("--pnr", wish.pnr, "the program");
    app.add_option("--includes", wish.includes, "POV-Ray's own includes");
    app.add_option("--match", wish.match, "only scenes whose name holds this");
    app.add_option("--sample", wish.sample, "only that many, chosen by --seed");
    app.add_option("--seed", wish.seed);
    app.add_option("--jobs", wish.jobs, "scenes at a time");
    app.add_option("--cpu", wish.cpu, "CPU seconds a scene");
    app.add_flag("--known-only", wish.known_only, "leave out scenes without a reference");
    app.add_option("--threshold", wish.threshold, "SSIM that counts as similar");
    app.add_option("--least-accepted", wish.least_accepted, "fail below this share of the scenes");
    app.add_option("--least-rendered", wish.least_rendered);
    app.add_option("--least-similar", wish.least_similar);
    CLI11_PARSE(app, argc, argv);
    std::filesystem::create_directories(wish.references);
    std::filesystem::create_directories(wish.work);
    const auto rows = examine_all(find_scenes(wish), wish);
    print_rows(rows);
    return print_counts(rows, wish) ? 0 : 1;
}
