// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a text and gives what it printed with #debug, or its diagnostics.
#pragma once

#include "parser/load_scene.h"

#include <string>

namespace pnr::test {

inline std::string messages(const LoadResult& result) {
    std::string text;
    for (const Diagnostic& diagnostic : result.diagnostics) text += format(diagnostic, result.sources, false);
    return text;
}

// What #debug printed; if the text has errors, their messages instead.
inline std::string run(const std::string& text, const LoadOptions& options = {}) {
    const LoadResult result = load_scene_text(text, "test.pnr", options);
    for (const Diagnostic& diagnostic : result.diagnostics)
        if (diagnostic.severity == Severity::error) return messages(result);
    return result.debug_output;
}

// The first error's own line, "" if there is none.
inline std::string first_error(const std::string& text, const LoadOptions& options = {}) {
    const LoadResult result = load_scene_text(text, "test.pnr", options);
    for (const Diagnostic& diagnostic : result.diagnostics)
        if (diagnostic.severity == Severity::error) {
            const std::string shown = format(diagnostic, result.sources, false);
            return shown.substr(0, shown.find('\n'));
        }
    return {};
}

} // namespace pnr::test
