// SPDX-License-Identifier: GPL-3.0-or-later
// What the bits of a result hang on beside the scene's own words: this build of the program, the machine's
// kind, and the files that the scene names.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// A hash that grows by one value after the other; the same values in the same order give the same one.
struct Hasher {
    std::uint64_t value = 0x8a5cd789635d2dffull;

    void add(std::uint64_t word);
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(std::string_view text);
};

// Of a file's bytes, fast: four words at a time.
std::uint64_t hash_bytes(std::span<const unsigned char> bytes);

// Of the program's own build and of the libraries that it starts with, by the build ids that linkers put into
// them, and of what the processor can do: numbers of the C library differ with it. Two runs with the same one
// give the same bits. The first call must come before modules are loaded.
std::uint64_t build_identity();
// Likewise of the libraries that read pictures and fonts, once they are loaded.
std::uint64_t reader_identity();

// A file's size and when it was last written: two that are equal are taken for the same file unchanged.
struct FileStamp {
    std::filesystem::path path;
    std::uint64_t size = 0;
    std::int64_t written_ns = 0; // 0 where there is no file
    std::uint64_t inode = 0;     // editors that save by renaming give another one

    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const std::filesystem::path& file);

// The files that the scene names, and those that they name: materials and pictures of OBJ meshes.
std::vector<std::filesystem::path> files_behind(const std::vector<std::string>& assets);

// What these files hold. `stamps` tells later whether they are still the same. 0: one of them cannot be read.
struct AssetsRead {
    std::uint64_t hash = 0;
    std::vector<FileStamp> stamps;
    bool pictures_or_fonts = false; // beside meshes and densities, which we read ourselves
};
AssetsRead read_assets(const std::vector<std::string>& assets);
bool unchanged(const AssetsRead& assets);

} // namespace pnr
