// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/watched_files.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// Looking is cheap, a few calls of stat, and works on every file system, which notices of the kernel's do
// not.
constexpr auto pause = std::chrono::milliseconds(15);

bool is_there(const FileStamp& stamp) { return stamp.written_ns != 0; }

} // namespace

std::vector<fs::path> files_of_scene(const fs::path& scene, const LoadResult& loaded,
                                     const std::vector<fs::path>& library) {
    std::vector<fs::path> files{scene};
    const auto add = [&](const fs::path& file) {
        std::error_code error;
        if (fs::exists(file, error) && std::find(files.begin(), files.end(), file) == files.end())
            files.push_back(file);
    };
    for (const SourceText& source : loaded.sources.files)
        add(source.path); // -D and our own includes are no files
    for (const fs::path& file : files_behind(loaded.assets)) add(file);
    if (loaded.scene) return files;
    add(scene.has_parent_path() ? scene.parent_path() : fs::path("."));
    for (const fs::path& folder : library) add(folder);
    return files;
}

WatchedFiles watch_files(const std::vector<fs::path>& files, const WatchedFiles& before) {
    WatchedFiles watched;
    for (const fs::path& file : files) {
        const auto known = std::find_if(before.stamps.begin(), before.stamps.end(),
                                        [&](const FileStamp& stamp) { return stamp.path == file; });
        watched.stamps.push_back(known != before.stamps.end() ? *known : stamp_of(file));
    }
    return watched;
}

std::vector<fs::path> changed_files(const WatchedFiles& watched) {
    std::vector<fs::path> changed;
    for (const FileStamp& before : watched.stamps) {
        const FileStamp now = stamp_of(before.path);
        if (now == before || (is_there(before) && (!is_there(now) || now.size == 0))) continue;
        changed.push_back(before.path);
    }
    return changed;
}

std::vector<fs::path> wait_for_change(const WatchedFiles& watched, const std::function<bool()>& stop) {
    WatchedFiles last;
    while (!stop()) {
        std::vector<fs::path> changed = changed_files(watched);
        WatchedFiles now;
        for (const fs::path& file : changed) now.stamps.push_back(stamp_of(file));
        if (!changed.empty() && now.stamps == last.stamps) return changed;
        last = std::move(now);
        std::this_thread::sleep_for(pause);
    }
    return {};
}

} // namespace pnr
