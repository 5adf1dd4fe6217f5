// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr render --show KIND,...`: one picture for each kind.
#include "cli/commands.h"

#include "cli/interrupt.h"
#include "cli/load.h"
#include "cli/picture_files.h"
#include "cli/report.h"
#include "cli/show.h"
#include "cli/stats.h"
#include "core/atomic_file.h"

#include <fmt/format.h>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// A name for each kind: as many as were said, or the one that was said with the kind behind it.
std::vector<fs::path> names_of(const Options& options) {
    const std::size_t kinds = options.shows.size();
    std::vector<fs::path> names = options.outputs;
    if (names.empty()) names = {scene_stem(scene_name(options)) + ".png"};
    if (names.size() == kinds && !(options.outputs.empty())) return names;
    if (names.size() != 1)
        throw UsageError(
            fmt::format("--show: {} kinds and {} pictures (-o) do not fit; one for each, or one name for all",
                        kinds, names.size()));
    if (names.front() == "-") throw UsageError("--show: standard output takes one kind");
    const fs::path name = names.front();
    names.clear();
    for (const std::string& kind : options.shows)
        names.push_back(name.parent_path() /
                        fmt::format("{}_{}{}", name.stem().string(), kind, name.extension().string()));
    return names;
}

Image<Color> cut(const Image<Color>& picture, const PixelRect& window) {
    Image<Color> part(window.x1 - window.x0, window.y1 - window.y0);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) part.at(x - window.x0, y - window.y0) = picture.at(x, y);
    return part;
}

Rendering look(const Options& options, const LoadResult& loaded, const ShowNeeds& needs, Passes& passes) {
    constexpr int usual_passes = 13; // three batches: the fewest that tell bias from noise
    Wishes wishes;
    wishes.crop = options.crop;
    wishes.budgets = options.budgets;
    Reuse reuse;
    reuse.scene = identity_of(loaded);
    if (options.cache) reuse.disk = users_cache();
    const Settings settings = merge_settings(loaded.settings, options);
    if (needs.error) {
        const bool said = options.time_s || options.error || options.passes;
        wishes.refinement =
            Refinement{options.time_s, options.error, said ? options.passes : std::optional(usual_passes)};
        return render_scene(*loaded.scene, settings, wishes, reuse, passes);
    }
    Rendering r = plan_rendering(*loaded.scene, settings, wishes, reuse, passes);
    stop_gently();
    try {
        look_behind(*loaded.scene, r, needs, wishes, reuse, passes);
    } catch (const Interrupted&) {
        r.stopped = true;
    }
    return r;
}

int show_frame(const Options& options, const AnimationFrame& frame) {
    std::vector<Show> kinds;
    for (const std::string& name : options.shows) kinds.push_back(show_kind(name));
    std::vector<fs::path> names = names_of(options);
    if (options.frames)
        for (fs::path& name : names) name = numbered(name, frame.number);
    for (const fs::path& name : names) check_output(name);
    Passes passes(options.progress, true);
    LoadResult loaded;
    if (!passes.run("parse", [&](const Progress&) { return load_and_report(options, frame, loaded); }))
        return exit_scene;
    return with_scene_errors(loaded.sources, [&] {
        const Rendering r = look(options, loaded, needs_of(kinds), passes);
        if (r.stopped) return exit_signal + stop_signal();
        std::vector<std::string> legends;
        passes.run("write", [&](const Progress&) {
            for (std::size_t i = 0; i < kinds.size(); ++i) {
                const Shown shown = show(kinds[i], r);
                write_flat_picture(cut(shown.picture, r.window), names[i]);
                for (const std::string& line : shown.legend)
                    legends.push_back(options.shows[i] + ": " + line);
            }
        });
        for (const std::string& line : legends) print_note(line);
        if (!options.stats.empty()) {
            const std::string text = stats_json(*loaded.scene, r, passes.times(),
                                                warning_texts(loaded.diagnostics, loaded.sources));
            options.stats == "-" ? print_answer(text) : write_file_atomically(options.stats, text);
        }
        return exit_done + 0;
    });
}

} // namespace

int run_show(const Options& options) {
    const ThreadLimit limit(options.threads);
    for (const AnimationFrame& frame : frames_of(options))
        if (const int code = show_frame(options, frame); code != exit_done) return code;
    return exit_done;
}

} // namespace pnr
