// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/source.h"

#include <algorithm>
#include <cstring>

namespace pnr {

namespace {

const std::vector<std::uint32_t>& lines_of(const SourceText& source) {
    if (!source.line_starts.empty()) return source.line_starts;
    source.line_starts.push_back(0);
    const char* const begin = source.text.data();
    const char* const end = begin + source.text.size();
    const auto left = [&](const char* at) { return static_cast<std::size_t>(end - at); };
    if (!source.text.empty() && std::memchr(begin, '\r', source.text.size()) == nullptr) {
        for (const char* at = begin; (at = static_cast<const char*>(std::memchr(at, '\n', left(at))));)
            source.line_starts.push_back(static_cast<std::uint32_t>(++at - begin));
        return source.line_starts;
    }
    for (const char* at = begin; at < end; ++at) {
        if (*at != '\n' && *at != '\r') continue;
        if (*at == '\r' && at + 1 < end && at[1] == '\n') ++at; // one end of a line
        source.line_starts.push_back(static_cast<std::uint32_t>(at + 1 - begin));
    }
    return source.line_starts;
}

} // namespace

std::uint32_t Sources::add(std::string path, std::string text) {
    files.push_back({std::move(path), std::move(text)});
    return static_cast<std::uint32_t>(files.size() - 1);
}

LineColumn Sources::locate(std::uint32_t source, std::uint32_t offset) const {
    const auto& starts = lines_of(files[source]);
    const auto next_line = std::upper_bound(starts.begin(), starts.end(), offset);
    const auto line = next_line - starts.begin();
    return {static_cast<int>(line), static_cast<int>(offset - *(next_line - 1) + 1)};
}

std::uint32_t Sources::offset(std::uint32_t source, LineColumn place) const {
    const SourceText& file = files[source];
    const auto& starts = lines_of(file);
    if (place.line < 1 || static_cast<std::size_t>(place.line) > starts.size()) return 0;
    const std::size_t begin = starts[static_cast<std::size_t>(place.line - 1)];
    const std::size_t column = place.column > 1 ? static_cast<std::size_t>(place.column - 1) : 0;
    return static_cast<std::uint32_t>(std::min(begin + column, file.text.size()));
}

std::string_view Sources::line_text(std::uint32_t source, int line) const {
    const SourceText& file = files[source];
    const auto& starts = lines_of(file);
    const auto index = static_cast<std::size_t>(line - 1);
    const std::size_t begin = starts[index];
    std::size_t end = index + 1 < starts.size() ? starts[index + 1] : file.text.size();
    while (end > begin && (file.text[end - 1] == '\n' || file.text[end - 1] == '\r')) --end;
    return std::string_view(file.text).substr(begin, end - begin);
}

} // namespace pnr
