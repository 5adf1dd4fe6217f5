// SPDX-License-Identifier: GPL-3.0-or-later
// The parser's only door: scene text in, Scene and Settings or diagnostics out.
#pragma once

#include "core/scene.h"
#include "core/settings.h"
#include "parser/diagnostic.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pnr {

// What a scene's text may use up, so that none can hang the program or exhaust the machine. Beyond: a located
// error.
struct Budgets {
    std::int64_t loop_turns = 20'000'000; // of #while and #for together
    std::int64_t macro_calls = 10'000'000;
    std::int64_t tokens = 100'000'000;       // read after expansion
    std::int64_t bytes = 900'000'000;        // of objects, meshes, arrays and strings
    std::int64_t array_elements = 4'000'000; // of one array
    std::int64_t string_length = 1'000'000;
    std::int64_t file_bytes = 1'000'000'000; // of one text
    int macro_depth = 300, include_depth = 64;
    int nesting = 400;               // braces and parentheses
    int errors = 50, warnings = 200; // reported in one run
    int failures = 20'000;           // places that could not be read, also those that are not reported again
    std::size_t debug_output = 16'000'000; // bytes of #debug text that are kept
};

struct LoadOptions {
    std::vector<std::filesystem::path>
        library; // -L folders, then PNR_LIBRARY_PATH; ours and POV-Ray's are appended
    std::vector<std::pair<std::string, std::string>>
        declares;                     // -D NAME=EXPR, evaluated before the first line
    std::optional<int> width, height; // for image_width, image_height
    double clock = 0;
    int frame_number = 0, initial_frame = 0, final_frame = 0; // of a single picture: 0
    Budgets budgets;
};

struct LoadResult {
    std::optional<Scene> scene; // set if there was no error
    Settings settings;
    Sources sources; // the texts that diagnostics point into
    std::vector<Diagnostic> diagnostics;
    std::string debug_output; // #debug text, in order
};

LoadResult load_scene(const std::filesystem::path& file, const LoadOptions& options);
// From memory; `name` is shown in diagnostics. Used for the embedded scene, standard input and tests.
LoadResult load_scene_text(std::string text, const std::string& name, const LoadOptions& options);

// The embedded default scene's text (scenes/default.pnr at build time).
std::string default_scene_text();

} // namespace pnr
