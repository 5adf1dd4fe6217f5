// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/disk_cache.h"

#include "cli/identity.h"
#include "core/atomic_file.h"
#include "core/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

namespace pnr {

namespace {

namespace fs = std::filesystem;

struct EntryHeader {
    std::array<char, 8> magic{};
    std::uint64_t key = 0, size = 0, checksum = 0;
};
constexpr std::array<char, 8> entry_magic{'p', 'n', 'r', 'k', 'e', 'p', 't', '1'};

// Half-written files of runs that were killed.
bool is_leftover(const fs::directory_entry& file, fs::file_time_type now) {
    std::error_code error;
    const bool temporary = file.path().filename().string().starts_with(".");
    return temporary && now - file.last_write_time(error) > std::chrono::hours(1) && !error;
}

} // namespace

std::optional<DiskCache> users_cache() {
    DiskCache cache;
    const char* const said = std::getenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    if (said != nullptr &&
        fs::path(said).is_absolute()) // a relative one is to be ignored, says the specification
        cache.folder = fs::path(said) / "pnr";
    else if (home != nullptr && fs::path(home).is_absolute())
        cache.folder = fs::path(home) / ".cache" / "pnr";
    else
        return {};
    return cache;
}

fs::path entry_path(const DiskCache& cache, const std::string& kind, std::uint64_t key) {
    return cache.folder / fmt::format("{:016x}.{}", key, kind);
}

namespace {

// Nothing if the file is not the whole entry that it should be.
std::optional<std::vector<unsigned char>> read_entry(std::ifstream& in, std::uintmax_t size,
                                                     std::uint64_t key) {
    EntryHeader header;
    if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    if (header.magic != entry_magic || header.key != key || header.size != size - sizeof header) return {};
    std::vector<unsigned char> bytes(header.size);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
        return {};
    if (hash_bytes(bytes) != header.checksum) return {};
    return bytes;
}

} // namespace

std::optional<std::vector<unsigned char>> load_entry(const DiskCache& cache, const std::string& kind,
                                                     std::uint64_t key) {
    const fs::path path = entry_path(cache, kind, key);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) return {};
    auto bytes = read_entry(in, size, key);
    bytes ? mark_used(path) : drop_entry(path);
    return bytes;
}

void store_entry(const DiskCache& cache, const std::string& kind, std::uint64_t key,
                 std::span<const unsigned char> bytes) {
    if (!may_store(cache, bytes.size())) return;
    const EntryHeader header{entry_magic, key, bytes.size(), hash_bytes(bytes)};
    std::vector<unsigned char> file(sizeof header + bytes.size());
    std::memcpy(file.data(), &header, sizeof header);
    if (!bytes.empty()) std::memcpy(file.data() + sizeof header, bytes.data(), bytes.size());
    try {
        write_file_atomically(entry_path(cache, kind, key), std::span<const unsigned char>(file));
    } catch (const FileError&) {
        return;
    }
    drop_oldest(cache);
}

bool may_store(const DiskCache& cache, std::uint64_t bytes) {
    if (bytes > cache.most_bytes / 4) return false;
    std::error_code error;
    fs::create_directories(cache.folder, error);
    return !error;
}

void mark_used(const fs::path& entry) {
    std::error_code ignored;
    fs::last_write_time(entry, fs::file_time_type::clock::now(), ignored);
}

void drop_entry(const fs::path& entry) {
    std::error_code ignored;
    fs::remove(entry, ignored);
}

void drop_oldest(const DiskCache& cache) {
    struct Entry {
        fs::path path;
        fs::file_time_type used;
        std::uintmax_t size = 0;
    };
    std::vector<Entry> entries;
    std::uintmax_t all = 0;
    std::error_code error, ignored;
    const auto now = fs::file_time_type::clock::now();
    for (fs::directory_iterator file(cache.folder, error), last; !error && file != last;
         file.increment(error)) {
        if (is_leftover(*file, now)) fs::remove(file->path(), ignored);
        std::error_code gone; // another run may have dropped it
        Entry entry{file->path(), file->last_write_time(gone), 0};
        entry.size = file->file_size(gone);
        if (gone || entry.path.filename().string().starts_with(".")) continue;
        all += entry.size;
        entries.push_back(std::move(entry));
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& entry : entries) {
        if (all <= cache.most_bytes) return;
        fs::remove(entry.path, ignored);
        all -= entry.size;
    }
}

} // namespace pnr
