// SPDX-License-Identifier: GPL-3.0-or-later
// What image_io.cpp and the image module (image_module.cpp, a library of its own) say to one another. Only
// these functions cross the border; files are written by image_io.cpp.
#pragma once

#include "core/image_io.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pnr {

// Any picture as it lies in the file. `is_integer`: its values are integers scaled to [0, 1], else floats.
struct DecodedPicture {
    ImageFile image;
    bool is_integer = false;
    int bits = 8; // of an integer channel
};

// Each returns the reason why it failed, or "".
struct ImageModule {
    int version = 0; // image_module_version, else the library is of another build
    std::string (*encode_exr)(const ImageFile& image, std::vector<unsigned char>& file) = nullptr;
    std::string (*decode)(const std::string& path, DecodedPicture& picture) = nullptr;
    std::string (*decode_numbers)(const std::string& path, Image<std::uint8_t>& numbers) = nullptr; // of a palette
};
inline constexpr int image_module_version = 3;
inline constexpr const char* image_module_symbol = "pnr_image_module"; // extern "C" const ImageModule*()

} // namespace pnr
