// SPDX-License-Identifier: GPL-3.0-or-later
// From the command line's words to a scene and the settings that it is rendered with.
#pragma once

#include "cli/options.h"
#include "parser/load_scene.h"

#include <string>

namespace pnr {

// One picture of an animation; as it stands, the one picture of a scene that does not move.
struct AnimationFrame {
    int number = 0, first = 0, last = 0;
    double clock = 0;
};
// The frames that are to be rendered; the clock runs from --clock-first at the first of --frames to --clock-last at the
// last.
std::vector<AnimationFrame> frames_of(const Options& options);
// out.png and frame 7: out0007.png; a row of # says where the number stands and how long it is.
std::filesystem::path numbered(const std::filesystem::path& file, int frame);

// Reads the scene named (empty: the embedded one; "-": standard input), with the options' declarations and
// library. Diagnostics are in the result, not printed. Throws FileError if the file cannot be read.
LoadResult load_named_scene(const std::string& name, const Options& options, const AnimationFrame& frame);
// The same for the one scene of a command; prints what was found. False: it cannot be rendered.
bool load_and_report(const Options& options, const AnimationFrame& frame, LoadResult& loaded);

// Whether nothing stands in the way of rendering: no error, and with --werror no warning.
bool may_render(const LoadResult& loaded, const Options& options);

// The command line's word over the scene's.
Settings merge_settings(const Settings& scene, const Options& options);

// The one scene of a command; "" if none was named.
std::string scene_name(const Options& options);
// "pot" for scenes/pot.pnr: pictures are named after it.
std::string scene_stem(const std::string& name);

} // namespace pnr
