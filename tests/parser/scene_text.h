// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes from a string, for the tests of the parser.
#pragma once

#include "parser/load_scene.h"

#include <gtest/gtest.h>

#include <string>

namespace pnr {

inline LoadResult load_text(const std::string& text, const std::string& name = "test.pnr") {
    return load_scene_text(text, name, LoadOptions{});
}

// The scene of a text that must be free of errors.
inline Scene scene_of(const std::string& text, const std::string& name = "test.pnr") {
    LoadResult result = load_text(text, name);
    for (const Diagnostic& d : result.diagnostics)
        EXPECT_NE(d.severity, Severity::error) << format(d, result.sources, false);
    return result.scene.value_or(Scene{});
}

// All diagnostics, "error: ..." or "warning: ...", a line each, with help behind " / ".
inline std::string diagnostics_of(const std::string& text, const std::string& name = "test.pnr") {
    const LoadResult result = load_text(text, name);
    std::string all;
    for (const Diagnostic& d : result.diagnostics) {
        all += d.severity == Severity::error ? "error: " : "warning: ";
        all += d.message + (d.help.empty() ? "" : " / " + d.help) + "\n";
    }
    return all;
}

inline bool says(const std::string& all, const std::string& part) {
    return all.find(part) != std::string::npos;
}

inline void expect_near(Vec3 got, Vec3 wanted, double error = 1e-12) {
    EXPECT_LE(glm::length(got - wanted), error)
        << "<" << got.x << ", " << got.y << ", " << got.z << "> is not <" << wanted.x << ", " << wanted.y
        << ", " << wanted.z << ">";
}

} // namespace pnr
