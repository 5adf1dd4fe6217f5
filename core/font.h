// SPDX-License-Identifier: GPL-3.0-or-later
// Letters of font files, set in a line.
#pragma once

#include "core/shape_swept.h"

#include <string>
#include <vector>

namespace pnr {

// The letters of a text (UTF-8; what is not, is taken byte by byte) from a TrueType or OpenType file, one em
// one unit, along x from the origin, with the font's advance widths and pair kerning as POV-Ray sets them,
// and `offset` added between letters. A letter that the font lacks is its missing glyph. Throws
// std::invalid_argument if the file is no font, FileError if the font module is missing.
std::vector<PlacedGlyph> set_text(const std::string& font_file, const std::string& text, Vec2 offset);

} // namespace pnr
