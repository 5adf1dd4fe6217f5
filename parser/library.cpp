// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/library.h"

#include "core/atomic_file.h"
#include "parser/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <system_error>

namespace pnr {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view embedded_prefix = "pnr:"; // path of an embedded file: pnr:colors.inc

// The folder of the text that is being read; empty for embedded files.
std::string current_folder(const Expander& in) {
    const std::string& path = in.sources.files[in.frames.back().source].path;
    if (path.starts_with(embedded_prefix)) return {};
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

std::vector<fs::path> search_folders(const Expander& in) {
    std::vector<fs::path> folders;
    const auto add = [&](const fs::path& folder) {
        if (!folder.empty() && std::find(folders.begin(), folders.end(), folder) == folders.end())
            folders.push_back(folder);
    };
    add(current_folder(in));
    add(in.scene_folder);
    for (const fs::path& folder : in.options.library) add(folder);
    return folders;
}

fs::path real_path(const fs::path& path) {
    std::error_code error;
    fs::path result = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? fs::absolute(path, error).lexically_normal() : result;
}

bool lies_below(const fs::path& path, const fs::path& folder) {
    const fs::path relative = path.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

// May a scene read this file? Only below its own folder and the library's.
bool is_allowed(const Expander& in, const fs::path& file) {
    const fs::path real = real_path(file);
    if (lies_below(real, real_path(in.scene_folder.empty() ? "." : in.scene_folder))) return true;
    for (const fs::path& folder : in.options.library)
        if (lies_below(real, real_path(folder))) return true;
    // Nobody but who installed them puts links into these; Debian's lead to its folder of fonts.
    std::error_code error;
    const fs::path said = fs::absolute(file, error).lexically_normal();
    for (const fs::path& folder : povray_folders())
        if (lies_below(real, real_path(folder)) || lies_below(said, folder)) return true;
    return false;
}

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

struct Found {
    std::string path;     // empty: not found
    bool refused = false; // found, but outside of the allowed folders
};

Found find_in(const Expander& in, const std::vector<fs::path>& folders, const std::string& name) {
    Found found;
    for (const fs::path& folder : folders) {
        const fs::path file = fs::path(name).is_absolute() ? fs::path(name) : folder / name;
        if (!is_file(file)) continue;
        if (is_allowed(in, file)) {
            const fs::path shown = folder == "." ? fs::path(name) : file;
            return {shown.lexically_normal().string(), false};
        }
        found.refused = true;
    }
    return found;
}

// Names of the files beside which the wanted one would lie, for "did you mean".
std::string nearest_file(const Expander& in, const std::string& name, bool includes) {
    std::vector<std::string> names;
    std::vector<fs::path> folders = search_folders(in);
    if (includes) {
        for (const EmbeddedFile& file : embedded_files()) names.emplace_back(file.name);
        for (const fs::path& folder : povray_folders()) folders.push_back(folder);
    }
    for (const fs::path& folder : folders) {
        std::error_code error;
        int seen = 0;
        for (fs::directory_iterator entry(folder / fs::path(name).parent_path(), error), last;
             !error && entry != last && seen < 5000; entry.increment(error), ++seen)
            names.push_back((fs::path(name).parent_path() / entry->path().filename()).string());
    }
    std::vector<std::string_view> views(names.begin(), names.end());
    return std::string(nearest_word(name, views));
}

[[noreturn]] void fail_missing(Parser& p, const Token& at, const std::string& name, bool includes,
                               bool refused) {
    if (refused || fs::path(name).is_absolute() || name.starts_with(".."))
        fail(p, at,
             fmt::format(
                 "the file \"{}\" lies outside of the scene's folder and the library, and is not read", name),
             "-L FOLDER adds a folder to the library");
    const std::string nearest = nearest_file(p.in, name, includes);
    constexpr std::size_t longest = 100;
    const std::size_t shown = std::min({name.find('\n'), name.size(), longest});
    if (shown < name.size())
        fail(p, at, fmt::format("there is no file \"{}...\"", name.substr(0, shown)), "is its closing `\"` missing?");
    for (const fs::path& folder : search_folders(p.in))
        if (std::error_code error; fs::is_directory(folder / name, error))
            fail(p, at, fmt::format("\"{}\" is a folder, a file is needed", name));
    fail(p, at, fmt::format("there is no file \"{}\"", name),
         nearest.empty() ? "looked in the scene's folder and the library; -L FOLDER adds a folder"
                         : fmt::format("did you mean \"{}\"?", nearest));
}

std::uint32_t add_file(Parser& p, const Token& at, const std::string& path) {
    Expander& in = p.in;
    const auto known = in.files.find(path);
    if (known != in.files.end()) return known->second;
    const auto most = static_cast<std::size_t>(in.options.budgets.file_bytes);
    std::optional<std::string> text = read_text(path, most);
    if (!text) fail(p, at, fmt::format("\"{}\" cannot be read", path));
    if (text->size() > most)
        stop_at_limit(p, at, &Budgets::file_bytes,
                      fmt::format("\"{}\" is larger than {} MB", path, most / 1'000'000));
    charge(p, at, text->size());
    const std::uint32_t source = in.sources.add(path, std::move(*text));
    in.files.emplace(path, source);
    return source;
}

} // namespace

std::optional<std::string> read_text(const std::string& path, std::size_t most) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) return {};
    std::error_code error;
    const auto size = fs::file_size(path, error);
    constexpr std::size_t step = 1 << 16;
    std::string text;
    text.reserve(std::min<std::size_t>(error ? 0 : size, most) + step);
    while (text.size() <= most) {
        const std::size_t before = text.size();
        text.resize(before + step);
        const std::size_t got = std::fread(text.data() + before, 1, step, file.get());
        text.resize(before + got);
        if (got == 0) break;
    }
    if (std::ferror(file.get())) return {};
    if (text.size() > most) text.resize(most + 1);
    return text;
}

std::vector<fs::path> povray_folders() {
    std::vector<fs::path> folders;
    for (const char* root : {"/usr/share", "/usr/local/share"}) {
        std::error_code error;
        for (fs::directory_iterator entry(root, error), last; !error && entry != last;
             entry.increment(error)) {
            const std::string name = entry->path().filename().string();
            if (name.starts_with("povray-") && fs::is_directory(entry->path() / "include", error))
                folders.push_back(entry->path() / "include");
        }
    }
    std::sort(folders.rbegin(), folders.rend());
    return folders;
}

std::uint32_t open_include(Parser& p, const Token& at, const std::string& name) {
    Expander& in = p.in;
    if (const auto text = in.written.find(name); text != in.written.end()) {
        const std::string shown = "written:" + name;
        const auto known = in.files.find(shown);
        if (known != in.files.end() && in.sources.files[known->second].text == text->second)
            return known->second;
        charge(p, at, text->second.size());
        return in.files[shown] = in.sources.add(shown, text->second);
    }
    const Found found = find_in(in, search_folders(in), name);
    if (!found.path.empty()) return add_file(p, at, found.path);
    for (const EmbeddedFile& file : embedded_files()) {
        if (file.name != name) continue;
        const std::string path = std::string(embedded_prefix) + name;
        const auto known = in.files.find(path);
        if (known != in.files.end()) return known->second;
        const std::uint32_t source = in.sources.add(path, std::string(file.text));
        in.files.emplace(path, source);
        return source;
    }
    const Found installed = find_in(in, povray_folders(), name);
    if (!installed.path.empty()) return add_file(p, at, installed.path);
    fail_missing(p, at, name, true, found.refused || installed.refused);
}

namespace {

// Is there `#declare NAME` or `#macro NAME` in the text?
bool declares(std::string_view text, std::string_view name) {
    const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if (end < text.size() && in_word(text[end])) continue;
        std::size_t before = at;
        while (before > 0 && (text[before - 1] == ' ' || text[before - 1] == '\t')) --before;
        const std::string_view front = text.substr(0, before);
        if (before < at && (front.ends_with("declare") || front.ends_with("macro"))) return true;
    }
    return false;
}

} // namespace

std::string include_that_declares(const Parser& p, std::string_view name) {
    if (name.size() < 3) return {};
    const auto is_read = [&](const std::string& path) { return p.in.files.contains(path); };
    for (const EmbeddedFile& file : embedded_files())
        if (file.name.ends_with(".inc") && declares(file.text, name))
            return is_read(std::string(embedded_prefix) + std::string(file.name)) ? "" : std::string(file.name);
    std::string found;
    for (const fs::path& folder : povray_folders()) {
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), last; !error && entry != last; entry.increment(error)) {
            if (entry->path().extension() != ".inc") continue;
            const auto text = read_text(entry->path().string(), 1'000'000);
            const std::string file = entry->path().filename().string();
            if (text && declares(*text, name) && !is_read(entry->path().string()) && (found.empty() || file < found))
                found = file;
        }
    }
    return found;
}

fs::path writable_path(const Expander& in, const std::string& name) {
    const fs::path& folder = in.options.allow_write;
    if (folder.empty() || name.empty() || name.find('\0') != std::string::npos) return {};
    const fs::path file = folder / name; // an absolute name stands alone
    return lies_below(real_path(file), real_path(folder)) ? file : fs::path();
}

void write_files(const Expander& in) {
    for (const auto& [name, text] : in.written) {
        const fs::path file = writable_path(in, name);
        if (file.empty()) continue;
        std::error_code error; // shows when the file is written
        fs::create_directories(file.parent_path(), error);
        write_file_atomically(file, text);
    }
}

bool file_exists(Parser& p, const std::string& name) {
    charge_work(p, peek(p), 1000); // as #include
    if (p.in.written.contains(name)) return true;
    for (const EmbeddedFile& file : embedded_files())
        if (file.name == name) return true;
    return !find_in(p.in, search_folders(p.in), name).path.empty() ||
           !find_in(p.in, povray_folders(), name).path.empty();
}

std::string resolve_file(Parser& p, const Token& at, const std::string& name) {
    const Found found = find_in(p.in, search_folders(p.in), name);
    const Found installed = found.path.empty() ? find_in(p.in, povray_folders(), name) : Found{};
    const std::string& path = found.path.empty() ? installed.path : found.path;
    if (path.empty()) fail_missing(p, at, name, false, found.refused || installed.refused);
    std::vector<std::string>& assets = p.in.assets;
    if (std::find(assets.begin(), assets.end(), path) == assets.end()) assets.push_back(path);
    return path;
}

} // namespace pnr
