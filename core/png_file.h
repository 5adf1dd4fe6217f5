// SPDX-License-Identifier: GPL-3.0-or-later
// PNG files of 8 bits, written without the image library, which takes longer to load than a picture to write
// [PNG 2003].
#pragma once

#include "core/image_io.h"

#include <cstdint>
#include <vector>

namespace pnr {

// `channels` (3 or 4) interleaved bytes, rows from the top, sRGB transfer already applied, alpha not
// associated.
struct BytePicture {
    int width = 0, height = 0, channels = 3;
    std::vector<std::uint8_t> bytes;
    Metadata metadata; // texts are kept as tEXt, numbers as their decimal text
};

// The bytes of the file. Throws std::invalid_argument for an empty picture or one whose bytes do not fill it.
std::vector<unsigned char> png_bytes(const BytePicture& picture);

} // namespace pnr
