// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures whose pixels are numbers of colours: PNG [ISO 15948] and GIF [CompuServe 1990]. The image library gives the
// colours; height fields want the numbers. A part of the image module.
#pragma once

#include "core/image.h"

#include <cstdint>
#include <optional>
#include <string>

namespace pnr {

// Nothing if the file is no such picture, or cannot be read: then the image library says why. Interlaced PNG is not read.
std::optional<Image<std::uint8_t>> read_palette_numbers(const std::string& path);

} // namespace pnr
