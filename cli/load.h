// SPDX-License-Identifier: GPL-3.0-or-later
// From the command line's words to a scene and the settings that it is rendered with.
#pragma once

#include "cli/options.h"
#include "parser/load_scene.h"

#include <string>

namespace pnr {

// Reads the scene named (empty: the embedded one; "-": standard input), with the options' declarations and
// library. Diagnostics are in the result, not printed. Throws FileError if the file cannot be read.
LoadResult load_named_scene(const std::string& name, const Options& options);

// Whether nothing stands in the way of rendering: no error, and with --werror no warning.
bool may_render(const LoadResult& loaded, const Options& options);

// The command line's word over the scene's.
Settings merge_settings(const Settings& scene, const Options& options);

// "pot" for scenes/pot.pnr: pictures are named after it.
std::string scene_stem(const std::string& name);

} // namespace pnr
