// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that tests use when they are there: in the folders of PNR_LIBRARY_PATH.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

namespace pnr {

// The file's path, or an empty one where no folder holds it; the test then skips, naming it.
inline std::filesystem::path library_file(const std::string& name) {
    const char* folders = std::getenv("PNR_LIBRARY_PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');)
        if (std::filesystem::exists(std::filesystem::path(folder) / name))
            return std::filesystem::path(folder) / name;
    return {};
}

} // namespace pnr
