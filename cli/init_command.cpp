// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr init NAME`: a small painted scene to start from.
#include "cli/commands.h"

#include "cli/report.h"
#include "core/atomic_file.h"
#include "parser/library.h"

#include <fmt/format.h>

#include <filesystem>

namespace pnr {

namespace {

std::string start_scene(const std::string& name) {
    for (const EmbeddedFile& file : embedded_files()) {
        if (file.name != "start.pnr") continue;
        std::string text(file.text);
        for (std::size_t at; (at = text.find("NAME.pnr")) != std::string::npos;) text.replace(at, 8, name);
        return text;
    }
    return {};
}

} // namespace

int run_init(const Options& options) {
    std::filesystem::path file = options.scenes.front();
    if (file.extension() != ".pnr") file += ".pnr";
    std::error_code error;
    if (std::filesystem::exists(file, error))
        throw FileError(fmt::format("{} is there already", file.string()));
    write_file_atomically(file, std::string_view(start_scene(file.filename().string())));
    print_note(fmt::format("wrote {0}; `pnr render {0}` paints it", file.string()));
    return exit_done;
}

} // namespace pnr
