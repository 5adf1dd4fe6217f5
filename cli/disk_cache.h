// SPDX-License-Identifier: GPL-3.0-or-later
// Results kept between runs, in the user's cache folder, under the hash of what they were made from. Entries
// appear whole or not at all and carry a checksum; one that is damaged, cut short or of another build counts
// as absent. All of them together stay below a bound: those used longest ago go first. Any number of runs may
// use the folder at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pnr {

struct DiskCache {
    std::filesystem::path folder;
    std::uint64_t most_bytes = std::uint64_t{1} << 30; // of all entries; one alone may have a quarter
};

// $XDG_CACHE_HOME/pnr or ~/.cache/pnr [XDG 2021]. Nothing if the user has no such place.
std::optional<DiskCache> users_cache();

// Where the entry of this kind ("photons") and key lies, or would lie.
std::filesystem::path entry_path(const DiskCache& cache, const std::string& kind, std::uint64_t key);

// The bytes of an entry, and it counts as used now. Nothing if it is absent or not whole.
std::optional<std::vector<unsigned char>> load_entry(const DiskCache& cache, const std::string& kind,
                                                     std::uint64_t key);
// Keeps an entry, if it is not too large, and drops the oldest ones that are too many. What cannot be written
// is not kept: a cache never fails a run.
void store_entry(const DiskCache& cache, const std::string& kind, std::uint64_t key,
                 std::span<const unsigned char> bytes);

// For entries that others write or read as files of their own: whether one of so many bytes may be kept, the
// folder being made; and that an entry was used just now, or has been added.
bool may_store(const DiskCache& cache, std::uint64_t bytes);
void mark_used(const std::filesystem::path& entry);
void drop_entry(
    const std::filesystem::path& entry); // it is of no use: whoever makes the value will store it anew
void drop_oldest(const DiskCache& cache);

} // namespace pnr
