// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/identity.h"

#include "cli/options.h"
#include "core/rng.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <link.h>
#include <sstream>
#include <sys/stat.h>

namespace pnr {

namespace {

namespace fs = std::filesystem;

std::vector<unsigned char> bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct BuildIds {
    Hasher hash;
    std::vector<std::string_view> names; // parts of the names of the libraries that count; empty: all
};

bool counts(const BuildIds& ids, std::string_view name) {
    return ids.names.empty() || std::any_of(ids.names.begin(), ids.names.end(), [&](std::string_view part) {
               return name.find(part) != std::string_view::npos;
           });
}

// Adds the build id of a program or library, a note among its loaded segments.
int add_build_id(dl_phdr_info* library, std::size_t, void* build_ids) {
    auto& ids = *static_cast<BuildIds*>(build_ids);
    if (!counts(ids, library->dlpi_name)) return 0;
    for (int i = 0; i < library->dlpi_phnum; ++i) {
        const ElfW(Phdr)& segment = library->dlpi_phdr[i];
        if (segment.p_type != PT_NOTE) continue;
        const auto* at = reinterpret_cast<const unsigned char*>(library->dlpi_addr + segment.p_vaddr);
        const unsigned char* const end = at + segment.p_memsz;
        while (end - at >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof note);
            const auto padded = [](std::size_t size) { return (size + 3) & ~std::size_t{3}; };
            const unsigned char* const text = at + sizeof note + padded(note.n_namesz);
            if (text + padded(note.n_descsz) > end) break;
            if (note.n_type == NT_GNU_BUILD_ID) ids.hash.add(hash_bytes({text, note.n_descsz}));
            at = text + padded(note.n_descsz);
        }
    }
    return 0;
}

// Linkers may be told to leave the build id out; then the program's file must do.
void add_program_file(Hasher& hash) {
    const FileStamp stamp = stamp_of("/proc/self/exe");
    hash.add(stamp.size);
    hash.add(static_cast<std::uint64_t>(stamp.written_ns));
}

void add_processor(Hasher& hash) {
#if defined(__x86_64__)
    __builtin_cpu_init();
    const int features[] = {__builtin_cpu_supports("sse4.2"),   __builtin_cpu_supports("avx"),
                            __builtin_cpu_supports("fma"),      __builtin_cpu_supports("avx2"),
                            __builtin_cpu_supports("avx512f"),  __builtin_cpu_supports("avx512dq"),
                            __builtin_cpu_supports("avx512vl"), __builtin_cpu_supports("avx512bw"),
                            __builtin_cpu_supports("fma4")};
    for (const int feature : features) hash.add(std::uint64_t{feature != 0});
#else
    hash.add(std::string_view("another"));
#endif
}

// The files that lines with such a beginning name, in a text of words: an OBJ's or its materials'.
void add_named_files(const fs::path& file, std::string_view beginning, std::vector<fs::path>& found) {
    std::ifstream in(file, std::ios::binary);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || !word.starts_with(beginning)) continue;
        std::string rest;
        std::getline(words >> std::ws, rest);
        while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back())) != 0) rest.pop_back();
        std::istringstream names(rest);
        std::vector<std::string> all{rest};
        while (names >> word) all.push_back(word);
        for (const std::string& name : all) {
            std::error_code error;
            const fs::path path = file.parent_path() / name;
            if (fs::is_regular_file(path, error)) found.push_back(path);
        }
    }
}

} // namespace

void Hasher::add(std::uint64_t word) { value = hash_words(value, word); }
void Hasher::add(std::string_view text) {
    add(std::uint64_t{text.size()});
    add(hash_bytes({reinterpret_cast<const unsigned char*>(text.data()), text.size()}));
}

std::uint64_t hash_bytes(std::span<const unsigned char> bytes) {
    constexpr std::size_t lanes = 4, block = lanes * sizeof(std::uint64_t);
    std::uint64_t state[lanes] = {1, 2, 3, 4};
    const auto take = [&](const unsigned char* from, std::size_t size) {
        std::uint64_t words[lanes] = {};
        std::memcpy(words, from, size);
        for (std::size_t i = 0; i < lanes; ++i) {
            state[i] = (state[i] ^ words[i]) * 0x9e3779b97f4a7c15ull;
            state[i] ^= state[i] >> 32;
        }
    };
    std::size_t at = 0;
    for (; at + block <= bytes.size(); at += block) take(bytes.data() + at, block);
    if (at < bytes.size()) take(bytes.data() + at, bytes.size() - at);
    std::uint64_t hash = bytes.size();
    for (const std::uint64_t lane : state) hash = hash_words(hash, lane);
    return hash;
}

std::uint64_t build_identity() {
    static const std::uint64_t identity = [] {
        BuildIds ids;
        ids.hash.add(std::string_view(version()));
        dl_iterate_phdr(add_build_id, &ids);
        add_program_file(ids.hash);
        add_processor(ids.hash);
        return ids.hash.value;
    }();
    return identity;
}

std::uint64_t reader_identity() {
    BuildIds ids{
        {}, {"pnr_image", "pnr_font", "OpenImageIO", "OpenEXR", "png", "jpeg", "tiff", "webp", "freetype"}};
    dl_iterate_phdr(add_build_id, &ids);
    return ids.hash.value;
}

FileStamp stamp_of(const fs::path& file) {
    struct stat status {};
    FileStamp stamp{file, 0, 0, 0};
    if (::stat(file.c_str(), &status) != 0) return stamp;
    stamp.size = static_cast<std::uint64_t>(status.st_size);
    stamp.written_ns = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
    stamp.inode = status.st_ino;
    return stamp;
}

std::vector<fs::path> files_behind(const std::vector<std::string>& assets) {
    std::vector<fs::path> files(assets.begin(), assets.end());
    for (std::size_t i = 0; i < assets.size(); ++i)
        if (fs::path ending = files[i].extension(); ending == ".obj" || ending == ".OBJ") {
            std::vector<fs::path> materials;
            add_named_files(files[i], "mtllib", materials);
            files.insert(files.end(), materials.begin(), materials.end());
            for (const fs::path& material : materials) add_named_files(material, "map_", files);
        }
    std::vector<fs::path> once;
    for (const fs::path& file : files)
        if (std::find(once.begin(), once.end(), file) == once.end()) once.push_back(file);
    return once;
}

AssetsRead read_assets(const std::vector<std::string>& assets) {
    AssetsRead read;
    Hasher hash;
    for (const fs::path& file : files_behind(assets)) {
        read.stamps.push_back(stamp_of(file));
        const std::vector<unsigned char> bytes = bytes_of(file);
        if (bytes.size() != read.stamps.back().size) return {};
        const std::string ending = file.extension().string();
        hash.add(ending); // a mesh's form is told by its name
        constexpr std::string_view ours[] = {".ply", ".PLY", ".obj", ".OBJ", ".off",
                                             ".OFF", ".stl", ".STL", ".mtl", ".df3"};
        read.pictures_or_fonts |= std::find(std::begin(ours), std::end(ours), ending) == std::end(ours);
        hash.add(hash_bytes(bytes));
    }
    read.hash = hash.value;
    return read;
}

bool unchanged(const AssetsRead& assets) {
    return std::all_of(assets.stamps.begin(), assets.stamps.end(),
                       [](const FileStamp& stamp) { return stamp == stamp_of(stamp.path); });
}

} // namespace pnr
