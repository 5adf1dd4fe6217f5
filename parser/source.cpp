// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/source.h"

#include <algorithm>

namespace pnr {

std::uint32_t Sources::add(std::string path, std::string text) {
    SourceText source{std::move(path), std::move(text), {0}};
    for (std::size_t i = 0; i < source.text.size(); ++i)
        if (source.text[i] == '\n') source.line_starts.push_back(static_cast<std::uint32_t>(i + 1));
    files.push_back(std::move(source));
    return static_cast<std::uint32_t>(files.size() - 1);
}

LineColumn Sources::locate(std::uint32_t source, std::uint32_t offset) const {
    const auto& starts = files[source].line_starts;
    const auto next_line = std::upper_bound(starts.begin(), starts.end(), offset);
    const auto line = next_line - starts.begin();
    return {static_cast<int>(line), static_cast<int>(offset - *(next_line - 1) + 1)};
}

std::string_view Sources::line_text(std::uint32_t source, int line) const {
    const SourceText& file = files[source];
    const std::size_t begin = file.line_starts[static_cast<std::size_t>(line - 1)];
    std::string_view text(file.text);
    text = text.substr(begin, text.find('\n', begin) - begin);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
}

} // namespace pnr
