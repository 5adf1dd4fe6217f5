// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr render`: one picture, or the frames of an animation one after the other.
#include "cli/commands.h"

#include "cli/faults.h"
#include "cli/interrupt.h"
#include "cli/load.h"
#include "cli/map_files.h"
#include "cli/parts.h"
#include "cli/picture_files.h"
#include "cli/pipeline.h"
#include "cli/render_page.h"
#include "cli/report.h"
#include "cli/stats.h"
#include "cli/tev_view.h"
#include "core/atomic_file.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// What one frame writes; empty paths: not asked for.
struct Files {
    std::vector<fs::path> pictures;
    fs::path maps, stats, html;
};

Files files_of(const Options& options, const AnimationFrame& frame) {
    Files files{options.outputs, options.maps, options.stats, options.html};
    if (files.pictures.empty()) files.pictures = {scene_stem(scene_name(options)) + ".png"};
    if (!options.frames) return files;
    for (fs::path& picture : files.pictures) picture = numbered(picture, frame.number);
    if (!files.maps.empty()) files.maps = numbered(files.maps, frame.number);
    if (!files.html.empty()) files.html = numbered(files.html, frame.number);
    if (!files.stats.empty() && files.stats != "-") files.stats = numbered(files.stats, frame.number);
    return files;
}

bool exists(const fs::path& file) { return file != "-" && fs::exists(file); }

// What the orientation fields could not do.
std::vector<std::string> field_notes(const Rendering& r) {
    std::vector<std::string> notes;
    for (const FieldReport& report : r.paint.fields.reports)
        for (const std::string& note : report.notes)
            notes.push_back(fmt::format("object {}: {}", report.object, note));
    return notes;
}

std::vector<std::string> all_warnings(const LoadResult& loaded, const Rendering& r) {
    std::vector<std::string> warnings = warning_texts(loaded.diagnostics, loaded.sources);
    for (const auto& more : {r.world.notes, field_notes(r), fault_warnings(r)})
        warnings.insert(warnings.end(), more.begin(), more.end());
    return warnings;
}

void write_results(const LoadResult& loaded, const Rendering& r, const Options& options, const Files& files,
                   const Reuse& reuse, Passes& passes) {
    passes.run("write", [&](const Progress&) {
        parallel_for(2, 1, [&](std::int64_t job, std::int64_t, std::int64_t) { // the cache is not waited for
            if (job == 1) return store_on_disk(reuse, r);
            for (const fs::path& picture : files.pictures)
                write_picture(*loaded.scene, r, options.aovs, passes.times(), picture);
            if (!files.maps.empty()) write_maps(r, files.maps);
            if (!files.html.empty())
                write_file_atomically(files.html,
                                      render_page(*loaded.scene, r, passes.times(), all_warnings(loaded, r)));
        });
    });
    if (files.stats.empty()) return;
    const std::string text = stats_json(*loaded.scene, r, passes.times(), all_warnings(loaded, r));
    if (files.stats == "-")
        print_answer(text);
    else
        write_file_atomically(files.stats, text);
}

bool wants_error(const Options& options) {
    return std::any_of(options.aovs.begin(), options.aovs.end(),
                       [](const std::string& name) { return name.starts_with("error."); });
}

// Error parts alone ask for passes too: three batches, the fewest that tell bias from noise.
std::optional<Refinement> refinement_of(const Options& options) {
    constexpr int fewest_for_error = 13;
    if (options.time_s || options.error || options.passes)
        return Refinement{options.time_s, options.error, options.passes};
    if (wants_error(options)) return Refinement{{}, {}, fewest_for_error};
    return {};
}

int code_of(const Rendering& r, const Options& options) {
    if (r.stopped) return exit_signal + stop_signal();
    if (!options.error || r.reached_error < *options.error) return exit_done;
    print_warning(r.error.empty()
                      ? "--error: too few passes were done to know the error"
                      : fmt::format("--error {}: missed; 90 % of the pixels are known within {:.2g} %",
                                    *options.error, 100 * r.reached_error));
    return exit_missed;
}

int render_frame(const Options& options, const AnimationFrame& frame, Reuse& reuse) {
    const Files files = files_of(options, frame);
    const auto& pictures = files.pictures;
    for (const fs::path& picture : pictures) check_output(picture);
    for (const fs::path& file : {files.stats, files.html, options.save_photons})
        if (!file.empty() && file != "-") check_writable(file);
    if (options.skip_existing && std::all_of(pictures.begin(), pictures.end(), exists)) return exit_done;
    if (options.no_overwrite && std::any_of(pictures.begin(), pictures.end(), exists))
        throw FileError("a picture of that name exists already (--no-overwrite)");

    Passes passes(options.progress, frame.number == frame.first || !options.frames);
    if (options.frames)
        passes.note(fmt::format("frame {} of {} to {}", frame.number, frame.first, frame.last));
    LoadResult loaded;
    if (!passes.run("parse", [&](const Progress&) { return load_and_report(options, frame, loaded); }))
        return exit_scene;
    return with_scene_errors(loaded.sources, [&] {
        const auto write_pictures = [&](const Rendering& r) {
            for (const fs::path& picture : pictures)
                write_picture(*loaded.scene, r, options.aovs, passes.times(), picture);
        };
        std::optional<TevView> viewer;
        if (!options.tev.empty()) viewer.emplace(options.tev, "pnr: " + pictures.front().string());
        Wishes wishes;
        wishes.crop = options.crop;
        wishes.maps = !files.maps.empty();
        wishes.light_parts = wants_light_parts(options.aovs);
        wishes.save_photons = options.save_photons;
        wishes.load_photons = options.load_photons;
        wishes.refinement = refinement_of(options);
        wishes.show = write_pictures;
        wishes.budgets = options.budgets;
        wishes.before_passes = [](const std::vector<std::string>& notes) {
            for (const std::string& note : notes) print_note(note);
        };
        wishes.on_part = viewer_of(viewer);
        reuse.scene = identity_of(loaded);
        Rendering r = render_scene(*loaded.scene, merge_settings(loaded.settings, options), wishes, reuse, passes);
        for (const std::string& note : field_notes(r)) print_note(note);
        for (const std::string& line : fault_warnings(r)) print_warning(line);
        write_results(loaded, r, options, files, reuse, passes);
        const int code = code_of(r, options);
        if (options.frames) keep(reuse, r);
        return code;
    });
}

} // namespace

int run_render(const Options& options) {
    check_aovs(options.aovs);
    const ThreadLimit limit(options.threads);
    Reuse reuse;
    reuse.film = options.frames.has_value();
    if (options.cache) reuse.disk = users_cache();
    int result = exit_done;
    for (const AnimationFrame& frame : frames_of(options)) {
        const int code = render_frame(options, frame, reuse);
        if (code != exit_done && code != exit_missed) return code;
        if (code == exit_missed) result = code;
        if (stop_signal() != 0) return exit_signal + stop_signal(); // between two frames
    }
    return result;
}

} // namespace pnr
