// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/font.h"

#include "core/font_module.h"
#include "core/module.h"

#include <map>
#include <stdexcept>

namespace pnr {

namespace {

const FontModule& font_module() {
    static const auto& module = *static_cast<const FontModule*>(
        open_module({"font", "FreeType", "libpnr_font.so", "PNR_FONT_MODULE", font_module_symbol, font_module_version}));
    return module;
}

// The letter at text[i], and i moved behind it.
char32_t next_letter(const std::string& text, std::size_t& i) {
    const auto byte = [&](std::size_t k) {
        return static_cast<unsigned char>(k < text.size() ? text[k] : 0);
    };
    const unsigned char first = byte(i);
    const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc2 ? 1 : 0;
    char32_t letter = more == 0 ? first : first & (0x3fu >> more);
    for (std::size_t k = 1; k <= more; ++k) {
        if ((byte(i + k) & 0xc0) != 0x80) return ++i, first; // not UTF-8
        letter = letter << 6 | (byte(i + k) & 0x3fu);
    }
    i += 1 + more;
    return letter;
}

std::shared_ptr<const std::vector<CurvePiece>> make_outline(const FontGlyph& glyph) {
    auto pieces = std::make_shared<std::vector<CurvePiece>>();
    for (const GlyphCurve& curve : glyph.curves) {
        const CurvePiece piece = make_piece(curve.degree, curve.points);
        if (piece.low != piece.high) pieces->push_back(piece);
    }
    return pieces;
}

} // namespace

std::vector<PlacedGlyph> set_text(const std::string& font_file, const std::string& text, Vec2 offset) {
    std::u32string letters;
    for (std::size_t i = 0; i < text.size();) letters.push_back(next_letter(text, i));
    std::vector<FontGlyph> glyphs;
    if (const std::string why = font_module().read_glyphs(font_file, letters, glyphs); !why.empty())
        throw std::invalid_argument("cannot take letters from `" + font_file + "`: " + why);
    std::map<char32_t, std::shared_ptr<const std::vector<CurvePiece>>> outlines;
    std::vector<PlacedGlyph> placed;
    Vec2 pen(glyphs.empty() ? 0 : -glyphs[0].bearing,
             0); // the first letter begins at x = 0 [measured on POV-Ray 3.7]
    for (std::size_t i = 0; i < glyphs.size(); ++i) {
        auto& outline = outlines[letters[i]];
        if (!outline) outline = make_outline(glyphs[i]);
        pen.x += glyphs[i].kerning;
        placed.push_back({outline, pen});
        pen += Vec2(glyphs[i].advance, 0) + offset;
    }
    return placed;
}

} // namespace pnr
