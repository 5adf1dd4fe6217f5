// SPDX-License-Identifier: GPL-3.0-or-later
// Materials beside an OBJ file: MTL [Wavefront 1995].
#pragma once

#include "core/scene.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace pnr {

// Textures by name. Kd or map_Kd is the pigment, Ks and Ns a highlight, Ke what it emits, d (or 1 - Tr) what it does not
// let through; Ka, refraction and all other words are left out. Pictures are named relative to the file and lie in its folder
// or below: others are left out. A file that is not there gives no textures.
std::map<std::string, Texture, std::less<>> read_materials(const std::filesystem::path& file, const SourceRef& said_at);
// The same from bytes in memory.
std::map<std::string, Texture, std::less<>> parse_materials(std::string_view bytes, const std::filesystem::path& folder,
                                                            const std::string& name, const SourceRef& said_at);

// Whether a file named by another lies in that one's folder or below.
bool stays_below(const std::filesystem::path& named);

} // namespace pnr
