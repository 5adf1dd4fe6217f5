// SPDX-License-Identifier: GPL-3.0-or-later
// The lessons of scenes/course as the build embeds them, and which of them use a word.
#pragma once

#include "parser/library.h"

#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// The lessons' texts in their order, without the solutions; written by the build (embed.cmake).
const std::vector<EmbeddedFile>& embedded_course();

struct Lesson {
    std::string_view file;  // "07_seeds.pnr"
    std::string_view title; // "Lesson 7: seeds and the field", as its text says
};
// The lessons whose scene has the word, a directive's without `#`, outside of comments and strings, in their
// order.
std::vector<Lesson> lessons_with(std::string_view word);

} // namespace pnr
