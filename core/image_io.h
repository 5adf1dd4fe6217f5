// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures on disk. The image library (OpenImageIO, 260 shared libraries, 0.4 s) lives in a module of its own
// that is opened when the first picture is read or an EXR is written, so that commands that touch none do not
// pay for it.
#pragma once

#include "core/image.h"

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pnr {

// What a picture says of itself: names and texts or numbers.
using Metadata = std::vector<std::pair<std::string, std::variant<std::string, float>>>;

// One part of an EXR: `channels` planes of width * height floats, interleaved, named.
struct ImagePart {
    std::string name;                       // part name; "" for a single-part file
    std::vector<std::string> channel_names; // e.g. R G B A, N.X N.Y N.Z
    std::vector<float> data;                // rows from the top, channels interleaved; covers `data_window`
    bool half = false;                      // store as half instead of float32
};
struct ImageFile {
    int width = 0, height = 0; // the displayWindow
    PixelRect data_window;     // pixels in `data`; the whole picture when x1 == 0
    std::vector<ImagePart> parts;
    Metadata metadata;
};

// All write functions write whole files or none (atomic_file.h) and throw FileError with the reason. Colour
// parts say that their primaries are Rec.709's.
void write_exr(const std::filesystem::path& file, const ImageFile& image);
// 8 bits, sRGB transfer, clipped to [0, 1]; no dithering; not a number is black. Exposure and shoulder are
// the caller's. `alpha` may be empty: then the file has none. With alpha, `linear` is premultiplied by it.
void write_png(const std::filesystem::path& file, const Image<Color>& linear, const Image<float>& alpha,
               const Metadata& metadata);

// Reads any picture as linear Rec.709 with alpha: 8-bit and 16-bit integer files are taken as sRGB, float
// ones as linear. Throws FileError.
Image<glm::vec4> read_image(const std::filesystem::path& file);
// A picture as heights in [0, 1), as POV-Ray's height fields take it: 65536 times a height is the value of a grey 16-bit
// pixel or 257 times that of an 8-bit one, 256 times the number of a palette's colour, 256 red + green of 8-bit colours,
// the grey of 16-bit ones. `pot`: palette numbers in the left half are high bytes, in the right half low ones [Fractint].
// Throws FileError.
Image<float> read_heights(const std::filesystem::path& file, bool pot);
// The bytes of such files, for writing to standard output.
std::vector<unsigned char> encode_exr(const ImageFile& image);
std::vector<unsigned char> encode_png(const Image<Color>& linear, const Image<float>& alpha,
                                      const Metadata& metadata);

// Reads a picture of many channels (EXR) as it is: every part that has the first one's size.
ImageFile read_exr(const std::filesystem::path& file);

// sRGB transfer of a linear value in [0, 1] and back (IEC 61966-2-1).
float srgb_encode(float linear);
float srgb_decode(float encoded);
// Between linear light and a scene's working values (Scene::assumed_gamma). Not defined below 0: such values stay.
float working_from_linear(float linear, double assumed_gamma);
float linear_from_working(float working, double assumed_gamma);
// The soft shoulder of `view shoulder`: up to 0.45 nothing changes, above it the largest channel m becomes
// 1 - 0.55 exp(-(m - 0.45) / 0.55), which never reaches 1; the hue is kept.
Color shoulder(Color linear);

} // namespace pnr
