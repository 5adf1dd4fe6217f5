// SPDX-License-Identifier: GPL-3.0-or-later
// Scene texts and places in them.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// Half-open byte range in one source.
struct Span {
    std::uint32_t source = 0;
    std::uint32_t begin = 0, end = 0;
};

struct SourceText {
    std::string path; // as shown in diagnostics
    std::string text;
    mutable std::vector<std::uint32_t> line_starts{}; // found when a place in the text is first asked for
};

struct LineColumn {
    int line = 1, column = 1; // from 1; column counts bytes
};

// All texts of one run; grows as files are included. References stay valid.
struct Sources {
    std::deque<SourceText> files;

    std::uint32_t add(std::string path, std::string text);
    LineColumn locate(std::uint32_t source, std::uint32_t offset) const;
    std::uint32_t offset(std::uint32_t source, LineColumn place) const; // 0 if there is no such line
    std::string_view line_text(std::uint32_t source, int line) const;
};

} // namespace pnr
