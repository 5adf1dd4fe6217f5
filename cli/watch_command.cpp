// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr watch`: renders again whenever the scene is saved, with just the passes that the change needs.
#include "cli/commands.h"

#include "cli/faults.h"
#include "cli/interrupt.h"
#include "cli/load.h"
#include "cli/map_files.h"
#include "cli/parts.h"
#include "cli/picture_files.h"
#include "cli/pipeline.h"
#include "cli/report.h"
#include "cli/tev_view.h"
#include "cli/watched_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// What was rendered last, to tell what a change has changed.
struct Last {
    bool any = false;
    SceneIdentity scene;
    ReuseKeys keys;
};

bool same_files(const SceneIdentity& a, const SceneIdentity& b) {
    return a.assets.hash == b.assets.hash && a.assets.hash != 0;
}

// Comments, spaces, names: what stays the same picture.
bool nothing_seen_changed(const Last& last, const SceneIdentity& scene) {
    return last.any && last.scene.world == scene.world && last.scene.camera == scene.camera &&
           last.scene.paint == scene.paint && same_files(last.scene, scene);
}

std::string what_changed(const Last& last, const ReuseKeys& keys, bool painted) {
    if (!last.any) return "the first picture";
    if (painted && keys.light != 0 && keys.light == last.keys.light) return "only paint has changed";
    if (painted && keys.seen != 0 && keys.seen == last.keys.seen && keys.photons == last.keys.photons)
        return "how far objects are painted has changed";
    if (keys.photons != 0 && keys.photons == last.keys.photons) return "only the camera has changed";
    return "light, objects or settings have changed";
}

std::string one_line(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
    return line;
}

// Stops a rendering as soon as the scene is saved again: nobody waits for a picture of yesterday's scene.
class StopOnChange {
public:
    StopOnChange(const WatchedFiles& watched, Passes& passes)
        : watcher_([&](const std::stop_token& done) {
              const auto stop = [&] { return done.stop_requested() || stop_signal() != 0; };
              if (!wait_for_change(watched, stop).empty()) passes.set_deadline(0);
          }) {}

private:
    std::jthread watcher_; // joined before what it looks at goes away
};

void write_outputs(const Scene& scene, const Rendering& r, const Options& options,
                   const std::vector<fs::path>& pictures, Passes& passes) {
    passes.run("write", [&](const Progress&) {
        for (const fs::path& picture : pictures)
            write_picture(scene, r, options.aovs, passes.times(), picture);
        if (!options.maps.empty()) write_maps(r, options.maps);
    });
}

// One picture of the scene as it is now. What a later one can use stays in `reuse`.
void paint_once(const Options& options, const std::vector<fs::path>& pictures, LoadResult& loaded,
                const WatchedFiles& watched, Reuse& reuse, Last& last, std::optional<TevView>& viewer) {
    const double began = Passes::elapsed();
    SceneIdentity scene = identity_of(loaded);
    if (nothing_seen_changed(last, scene)) {
        print_note("nothing that is seen has changed");
        return;
    }
    reuse.scene = scene;
    Passes passes(options.progress, !last.any);
    Wishes wishes;
    wishes.crop = options.crop;
    wishes.maps = !options.maps.empty();
    wishes.light_parts = wants_light_parts(options.aovs);
    wishes.budgets = options.budgets;
    wishes.before_passes = [](const std::vector<std::string>& notes) {
        for (const std::string& note : notes) print_note(note);
    };
    wishes.on_part = viewer_of(viewer);
    Rendering r = [&] {
        const StopOnChange stop(watched, passes);
        return render_scene(*loaded.scene, merge_settings(loaded.settings, options), wishes, reuse, passes);
    }();
    if (!r.stopped) {
        const std::string why = what_changed(last, reuse.keys, r.plan.paint);
        for (const std::string& line : fault_warnings(r)) print_warning(line);
        write_outputs(*loaded.scene, r, options, pictures, passes);
        print_note(fmt::format("{} after {:.2f} s; {}: {}", pictures.front().string(),
                               Passes::elapsed() - began, why, one_line(passes_to_run(r, wishes))));
        last = {true, std::move(scene), reuse.keys};
        if (reuse.disk) store_on_disk(reuse, r);
    } else if (stop_signal() == 0) {
        print_note("saved again: a new start");
    }
    keep(reuse, r);
}

} // namespace

int run_watch(const Options& options) {
    check_aovs(options.aovs);
    const fs::path scene = scene_name(options);
    if (scene == "-") throw UsageError("watch reads a file again and again, - is none");
    const std::vector<fs::path> pictures = options.outputs.empty()
                                               ? std::vector<fs::path>{scene_stem(scene.string()) + ".png"}
                                               : options.outputs;
    for (const fs::path& picture : pictures) {
        if (picture == "-") throw UsageError("watch writes a file again and again, - is none");
        check_output(picture);
    }
    const ThreadLimit limit(options.threads);
    Reuse reuse;
    if (options.cache) reuse.disk = users_cache();
    Last last;
    std::optional<TevView> viewer;
    if (!options.tev.empty()) viewer.emplace(options.tev, "pnr: " + pictures.front().string());
    std::vector<fs::path> files{scene};
    stop_gently();
    while (stop_signal() == 0) {
        const WatchedFiles before = watch_files(files);
        WatchedFiles watched = before;
        LoadResult loaded;
        try {
            const bool fine = load_and_report(options, {}, loaded);
            files = files_of_scene(scene, loaded, options.library);
            watched = watch_files(files, before);
            if (fine)
                with_scene_errors(loaded.sources, [&] {
                    paint_once(options, pictures, loaded, watched, reuse, last, viewer);
                    return exit_done;
                });
        } catch (const FileError& error) { // the scene's own file is away, or the picture cannot be written
            print_error(error.what());
        }
        print_note(
            fmt::format("watching {} and {} more files; Ctrl-C ends", scene.string(), files.size() - 1));
        wait_for_change(watched, [] { return stop_signal() != 0; });
    }
    return exit_signal + stop_signal();
}

} // namespace pnr
