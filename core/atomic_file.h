// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace pnr {

// Writes a temporary file in the target's folder, then renames it over the target. Links are followed;
// devices and pipes are written to directly. Throws FileError that names the file and the reason (no such
// folder, not writable, disk full); the old file then stands unchanged and nothing is left behind.
void write_file_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

} // namespace pnr
