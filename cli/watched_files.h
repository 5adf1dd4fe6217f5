// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are looked at again and again until one of them has changed.
#pragma once

#include "cli/identity.h"
#include "parser/load_scene.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace pnr {

struct WatchedFiles {
    std::vector<FileStamp> stamps; // as they were before the scene was read
};

// The scene's own file, all texts that it included and the files that it names. Where reading failed, a file
// may have been missing: then also the folders in which it could appear.
std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& scene,
                                                  const LoadResult& loaded,
                                                  const std::vector<std::filesystem::path>& library);
// Files that were watched before keep their stamps, taken before they were read; the others are looked at
// now.
WatchedFiles watch_files(const std::vector<std::filesystem::path>& files, const WatchedFiles& before = {});

// Those that have changed since, but for files that are being replaced this moment: editors that save by
// renaming leave none for an instant, others an empty one.
std::vector<std::filesystem::path> changed_files(const WatchedFiles& watched);

// Waits until some have changed and stayed as they are for an instant; empty: `stop` said so.
std::vector<std::filesystem::path> wait_for_change(const WatchedFiles& watched,
                                                   const std::function<bool()>& stop);

} // namespace pnr
