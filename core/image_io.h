// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures on disk. The image library (OpenImageIO, 260 shared libraries, 0.4 s) lives in a module of its own that is
// opened when the first picture is read or written, so that commands that touch none do not pay for it.
#pragma once

#include "core/image.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pnr {

// One part of an EXR: `channels` planes of width * height floats, interleaved, named.
struct ImagePart {
    std::string name;                        // part name; "" for a single-part file
    std::vector<std::string> channel_names;  // e.g. R G B A, N.X N.Y N.Z
    std::vector<float> data;                 // rows from the top, channels interleaved; covers `data_window`
    bool half = false;                       // store as half instead of float32
};
struct ImageFile {
    int width = 0, height = 0;               // the displayWindow
    PixelRect data_window;                   // pixels in `data`; the whole picture when x1 == 0
    std::vector<ImagePart> parts;
    std::vector<std::pair<std::string, std::string>> metadata; // strings
};

// All write functions write a temporary file beside the target, then rename it: files appear whole or not at all.
// They throw FileError with the reason.
void write_exr(const std::filesystem::path& file, const ImageFile& image);
// 8 bits sRGB transfer, clipped to [0, 1] after `exposure` stops; no dithering. `alpha` may be empty.
void write_png(const std::filesystem::path& file, const Image<Color>& linear, const Image<float>& alpha,
               const std::vector<std::pair<std::string, std::string>>& metadata);

// Reads any picture as linear Rec.709 with alpha: 8-bit and 16-bit integer files are taken as sRGB, float ones as linear.
// Throws FileError.
Image<glm::vec4> read_image(const std::filesystem::path& file);
// Reads a multi-channel float picture (EXR) as it is, first part only.
ImageFile read_exr(const std::filesystem::path& file);

// sRGB transfer of a linear value in [0, 1] and back (IEC 61966-2-1).
float srgb_encode(float linear);
float srgb_decode(float encoded);
// The soft shoulder of `view shoulder`, on the largest channel from 0.45 (look.md).
Color shoulder(Color linear);

} // namespace pnr
