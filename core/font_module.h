// SPDX-License-Identifier: GPL-3.0-or-later
// What font.cpp and the font module (font_module.cpp, a library of its own that links FreeType) say to one
// another.
#pragma once

#include "core/types.h"

#include <array>
#include <string>
#include <vector>

namespace pnr {

// A curve of degree 1 to 3, in ems.
struct GlyphCurve {
    int degree = 1;
    std::array<Vec2, 4> points{};
};
struct FontGlyph {
    std::vector<GlyphCurve> curves; // closed outlines, one after the other
    double advance = 0;             // ems
    double bearing = 0;             // from the pen to the leftmost point
    double kerning = 0;             // to the letter before
};

struct FontModule {
    int version = 0; // font_module_version, else the library is of another build
    // One glyph for each letter. Returns the reason why it failed, or "".
    std::string (*read_glyphs)(const std::string& file, const std::u32string& letters,
                               std::vector<FontGlyph>& glyphs) = nullptr;
};
inline constexpr int font_module_version = 1;
inline constexpr const char* font_module_symbol = "pnr_font_module"; // extern "C" const FontModule*()

} // namespace pnr
