// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/course.h"

#include <algorithm>
#include <cctype>

namespace pnr {

namespace {

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Where what begins at `begin` and ends with `end` is over.
std::size_t behind(std::string_view text, std::size_t begin, std::string_view end) {
    const std::size_t at = text.find(end, begin);
    return at == std::string_view::npos ? text.size() : at + end.size();
}

bool uses(std::string_view text, std::string_view word) {
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view rest = text.substr(at);
        if (rest.starts_with("//"))
            at = behind(text, at, "\n");
        else if (rest.starts_with("/*"))
            at = behind(text, at + 2, "*/");
        else if (rest[0] == '"')
            at = behind(text, at + 1, "\"");
        else if (in_word(rest[0])) {
            const auto end = std::find_if_not(rest.begin(), rest.end(), in_word);
            const auto length = static_cast<std::size_t>(end - rest.begin());
            if (rest.substr(0, length) == word) return true;
            at += length;
        } else
            ++at;
    }
    return false;
}

// `// Lesson 7: seeds and the field.` without its slashes and its end.
std::string_view title_of(std::string_view text) {
    const std::size_t at = text.find("Lesson ");
    if (at == std::string_view::npos) return {};
    return text.substr(at, text.find_first_of(".\n", at) - at);
}

} // namespace

std::vector<Lesson> lessons_with(std::string_view word) {
    std::vector<Lesson> lessons;
    for (const EmbeddedFile& file : embedded_course())
        if (uses(file.text, word)) lessons.push_back({file.name, title_of(file.text)});
    return lessons;
}

} // namespace pnr
