// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/lsp.h"

#include "core/atomic_file.h"
#include "core/types.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace pnr {

namespace {

using Json = nlohmann::json;

constexpr std::string_view file_scheme = "file://";
constexpr std::string_view embedded_prefix = "pnr:"; // the parser's path of an embedded include

// UTF-16 units of the character that begins with this byte; 0 for a byte inside of one.
std::uint32_t units(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0) == 0x80) return 0;
    return byte >= 0xf0 ? 2 : 1;
}

std::uint32_t line_end(const EditorText& text, std::size_t line) {
    std::uint32_t end = line + 1 < text.lines.size() ? text.lines[line + 1] - 1
                                                     : static_cast<std::uint32_t>(text.source.text.size());
    if (end > text.lines[line] && text.source.text[end - 1] == '\r') --end;
    return end;
}

std::filesystem::path cache_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
        return std::filesystem::path(cache) / "pnr";
    const char* home = std::getenv("HOME");
    return home == nullptr ? std::filesystem::path() : std::filesystem::path(home) / ".cache" / "pnr";
}

} // namespace

Json lsp_position(const LspServer& server, const EditorText& text, std::uint32_t offset) {
    offset = std::min(offset, static_cast<std::uint32_t>(text.source.text.size()));
    const auto behind = std::upper_bound(text.lines.begin(), text.lines.end(), offset);
    const auto line = static_cast<std::size_t>(behind - text.lines.begin() - 1);
    std::uint32_t column = 0;
    for (std::uint32_t i = text.lines[line]; i < offset; ++i)
        column += server.utf8 ? 1 : units(text.source.text[i]);
    return {{"line", line}, {"character", column}};
}

Json lsp_range(const LspServer& server, const EditorText& text, std::uint32_t begin, std::uint32_t end) {
    return {{"start", lsp_position(server, text, begin)}, {"end", lsp_position(server, text, end)}};
}

std::uint32_t lsp_offset(const LspServer& server, const EditorText& text, const Json& position) {
    const auto line = position.at("line").get<std::uint64_t>();
    const auto column = position.at("character").get<std::uint64_t>();
    if (line >= text.lines.size()) return static_cast<std::uint32_t>(text.source.text.size());
    const std::uint32_t end = line_end(text, line);
    std::uint32_t at = text.lines[line];
    std::uint64_t passed = 0;
    while (at < end && passed < column) {
        passed += server.utf8 ? 1 : units(text.source.text[at]);
        ++at;
        while (!server.utf8 && at < end && units(text.source.text[at]) == 0) ++at;
    }
    return at;
}

std::string path_of_uri(const std::string& uri) {
    if (!uri.starts_with(file_scheme)) return uri;
    std::string path;
    const std::size_t begin = uri.find('/', file_scheme.size());
    const auto digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t i = begin; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) && digit(uri[i + 2])) {
            path += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

std::string uri_of_path(const std::string& path) {
    std::string uri{file_scheme};
    for (const char c : path) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                           std::string_view("/-._~").find(c) != std::string_view::npos;
        uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return uri;
}

std::string uri_of_source(const EditorText& text) {
    std::error_code error;
    std::filesystem::path path = text.source.path;
    if (text.source.path.starts_with(embedded_prefix)) {
        const std::filesystem::path cache = cache_folder();
        if (cache.empty()) return {};
        path = cache / "include" / text.source.path.substr(embedded_prefix.size());
        std::filesystem::create_directories(path.parent_path(), error);
        try {
            write_file_atomically(path, std::string_view(text.source.text));
        } catch (const FileError&) {
            return {};
        }
    }
    path = std::filesystem::absolute(path, error);
    return !error && std::filesystem::is_regular_file(path, error)
               ? uri_of_path(path.lexically_normal().string())
               : "";
}

} // namespace pnr
