// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's density files (df3): a block of numbers in [0, 1] over the unit cube.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pnr {

struct DensityGrid {
    int nx = 0, ny = 0, nz = 0;
    std::vector<float> values; // x the fastest, then y, then z
};

// Big-endian sizes of 16 bits, then values of 8, 16 or 32 bits as the file's length says. Throws FileError.
DensityGrid read_density_grid(const std::filesystem::path& file);

// interpolate: 0 the cell's own value, 1 trilinear, 2 tricubic between the cells' places; 0 outside the unit
// cube.
double density_at(const DensityGrid& grid, Vec3 point, int interpolate);

} // namespace pnr
