// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr fmt`: a scene text with its lines indented by braces and directives, and spaces where they are wanted.
#pragma once

#include <cstdint>
#include <string>

namespace pnr {

struct FormattedText {
    std::string text;    // set if there is no problem
    std::string problem; // what cannot be read, at the byte `at` of the text; empty: none
    std::uint32_t at = 0;
};

// The author's line breaks stay, of several empty lines one; tokens and comments are the same before and after, but
// for blanks at the end of a line. format_text(format_text(t).text).text is format_text(t).text. Lines end with \n.
FormattedText format_text(const std::string& text);

} // namespace pnr
