// SPDX-License-Identifier: GPL-3.0-or-later
// Compares what a scene's function says at twelve points with what POV-Ray printed of it.
#pragma once

#include "evaluate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <sstream>

namespace pnr::test {

struct Row {
    const char* pattern;
    double values[12];
};

inline constexpr double points[12][3] = {
    {2.393, -1.393, -2.076},
    {2.58, -3.079, -0.19},
    {0.463, 0.891, -2.836},
    {1.045, 0.005, 2.809},
    {-3.773, 3.657, -2.619},
    {2.507, 0.059, 2.686},
    {-2.537, -1.428, -3.303},
    {2.23, 0.272, -2.36},
    {-2.466, -3.352, -2.399},
    {0.481, -0.499, 1.634},
    {-3.39, 2.716, 3.857},
    {1.918, 1.945, 2.798}};

// word: pattern or pigment; component: what stands behind the call.
inline void expect_rows(const char* word, const char* component, std::span<const Row> rows) {
    for (const Row& row : rows) {
        std::string text = fmt::format("#declare F = function {{ {} {{ {} }} }}\n", word, row.pattern);
        for (const auto& p : points)
            text += fmt::format("#debug concat(str(F({}, {}, {}){}, 0, 9), \"\\n\")\n", p[0], p[1], p[2], component);
        std::istringstream printed(run(text));
        for (std::size_t i = 0; i < 12; ++i) {
            double value = -1e9;
            EXPECT_TRUE(printed >> value) << row.pattern << ": " << printed.str();
            EXPECT_NEAR(value, row.values[i], 1e-6) << row.pattern << " at point " << i;
            if (!printed) break;
        }
    }
}

} // namespace pnr::test
