// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/density_grid.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace pnr {
namespace {

// 4 x 3 x 2 bytes; the values below are POV-Ray 3.7.0.10's of this block.
DensityGrid block() {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "block.df3";
    {
        std::ofstream out(file, std::ios::binary);
        for (const int n : {0, 4, 0, 3, 0, 2}) out.put(static_cast<char>(n));
        for (int i = 0; i < 24; ++i) out.put(static_cast<char>((37 * i * i + 11 * i) % 256));
    }
    return read_density_grid(file);
}

} // namespace

TEST(DensityGrid, AsPovray) {
    const DensityGrid grid = block();
    const struct {
        Vec3 point;
        double nearest, linear;
    } known[] = {{{0.1, 0.1, 0.1}, 0, 0.31191},
                 {{0.13, 0.4, 0.3}, 0.48627, 0.60313},
                 {{0.5, 0.5, 0.5}, 0.60392, 0.75294},
                 {{0.9, 0.95, 0.9}, 0.44706, 0.26886},
                 {{0.99, 0.2, 0.75}, 0.16471, 0.42340},
                 {{0.3, 0.7, 0.6}, 0.64314, 0.62965},
                 {{0.625, 0.5, 0.25}, 0.46275, 0.70588},
                 {{1, 0.5, 0.5}, 0, 0},
                 {{-0.01, 0.5, 0.5}, 0, 0}};
    for (const auto& k : known) {
        EXPECT_NEAR(density_at(grid, k.point, 0), k.nearest, 1e-5);
        EXPECT_NEAR(density_at(grid, k.point, 1), k.linear, 1e-5);
    }
    for (int x = 0; x < 4; ++x) // both go through the numbers themselves
        EXPECT_NEAR(density_at(grid, {x / 4.0, 0, 0}, 2), density_at(grid, {x / 4.0, 0, 0}, 0), 1e-12);
}

TEST(DensityGrid, RefusesWhatIsNone) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "short.df3";
    std::ofstream(file, std::ios::binary) << "abc";
    EXPECT_THROW(read_density_grid(file), FileError);
    EXPECT_THROW(read_density_grid("no such file.df3"), FileError);
}

} // namespace pnr
