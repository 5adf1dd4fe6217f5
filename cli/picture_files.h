// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures that -o names: PNG for the eye, EXR with radiance and the parts asked for.
#pragma once

#include "cli/pipeline.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pnr {

// Throws FileError if a file's folder is missing or it must not be written: better now than after an hour.
void check_writable(const std::filesystem::path& file);
// The same for a picture, and UsageError for an ending that is neither .png nor .exr. "-" is standard output.
void check_output(const std::filesystem::path& output);

// The window of the picture as PNG shows it: with exposure and the view's shoulder, linear, not yet clipped.
Image<Color> shown_picture(const Scene& scene, const Rendering& r);

// Throws FileError. Of a rendering that has no picture yet nothing is written.
void write_picture(const Scene& scene, const Rendering& r, const std::vector<std::string>& aovs,
                   const std::vector<PassTime>& times, const std::filesystem::path& output);

// A picture that comes from no scene, linear light; the same rules for names and errors.
void write_flat_picture(const Image<Color>& picture, const std::filesystem::path& output);

} // namespace pnr
