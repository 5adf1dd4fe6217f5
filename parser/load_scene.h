// SPDX-License-Identifier: GPL-3.0-or-later
// The parser's only door: scene text in, Scene and Settings or diagnostics out.
#pragma once

#include "core/scene.h"
#include "core/settings.h"
#include "parser/diagnostic.h"
#include "parser/limits.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pnr {

struct LoadOptions {
    std::vector<std::filesystem::path>
        library; // -L folders, then PNR_LIBRARY_PATH; ours and POV-Ray's are appended
    std::vector<std::pair<std::string, std::string>>
        declares;                     // -D NAME=EXPR, evaluated before the first line
    std::optional<int> width, height; // for image_width, image_height
    double clock = 0, initial_clock = 0, final_clock = 0;     // of a single picture: 0
    int frame_number = 0, initial_frame = 0, final_frame = 0; // likewise
    Budgets budgets;
    std::filesystem::path allow_write; // files that #fopen writes land below it; empty: they stay in memory
};

struct LoadResult {
    std::optional<Scene> scene; // set if there was no error
    Settings settings;
    Sources sources; // the texts that diagnostics point into
    std::vector<Diagnostic> diagnostics;
    std::string debug_output; // #debug text, in order
    // Of all that was said, after evaluation, but cameras, paint and what stands in other files: with the same one, the
    // same `assets` and the same objects painted (World) two runs describe the same world.
    std::uint64_t world_hash = 0;
    std::uint64_t camera_hash = 0;   // likewise of the cameras
    std::uint64_t paint_hash = 0;    // likewise of paint
    std::vector<std::string> assets; // files that the scene names, each once: pictures, meshes, fonts, densities
};

LoadResult load_scene(const std::filesystem::path& file, const LoadOptions& options);
// From memory; `name` is shown in diagnostics. Used for the embedded scene, standard input and tests.
LoadResult load_scene_text(std::string text, const std::string& name, const LoadOptions& options);

// The embedded default scene's text (scenes/default.pnr at build time).
std::string default_scene_text();

} // namespace pnr
