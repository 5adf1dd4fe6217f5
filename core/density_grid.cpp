// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/density_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

namespace pnr {

namespace {

double value_at(const DensityGrid& grid, int x, int y, int z) {
    const auto inside = [](int i, int n) { return static_cast<std::size_t>(std::clamp(i, 0, n - 1)); };
    const std::size_t index = (inside(z, grid.nz) * static_cast<std::size_t>(grid.ny) + inside(y, grid.ny)) *
                                  static_cast<std::size_t>(grid.nx) +
                              inside(x, grid.nx);
    return static_cast<double>(grid.values[index]);
}

} // namespace

DensityGrid read_density_grid(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw FileError("cannot read the density file `" + file.string() + "`");
    const std::vector<unsigned char> bytes((std::istreambuf_iterator<char>(in)), {});
    const auto refuse = [&](const char* why) {
        throw FileError("cannot read the density file `" + file.string() + "`: " + why);
    };
    if (bytes.size() < 6) refuse("it is too short");
    DensityGrid grid;
    grid.nx = bytes[0] * 256 + bytes[1];
    grid.ny = bytes[2] * 256 + bytes[3];
    grid.nz = bytes[4] * 256 + bytes[5];
    const std::size_t count = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny) *
                              static_cast<std::size_t>(grid.nz);
    if (count == 0 || count > (std::size_t{1} << 29)) refuse("its sizes are out of range");
    const std::size_t width = (bytes.size() - 6) / count; // bytes of a value
    if (width != 1 && width != 2 && width != 4) refuse("its length does not fit its sizes");
    grid.values.resize(count);
    const double largest = std::pow(2.0, 8.0 * static_cast<double>(width)) - 1;
    for (std::size_t i = 0; i < count; ++i) {
        double value = 0;
        for (std::size_t b = 0; b < width; ++b) value = value * 256 + bytes[6 + i * width + b];
        grid.values[i] = static_cast<float>(value / largest);
    }
    return grid;
}

double density_at(const DensityGrid& grid, Vec3 point, int interpolate) {
    if (grid.values.empty()) return 0;
    for (int i = 0; i < 3; ++i)
        if (!(point[i] >= 0 && point[i] < 1)) return 0;
    const Vec3 p = point * Vec3(grid.nx, grid.ny, grid.nz);
    if (interpolate == 0) return value_at(grid, int(p.x), int(p.y), int(p.z));
    const Vec3 low = glm::floor(p), t = p - low;
    const int x = int(low.x), y = int(low.y), z = int(low.z);
    double sum = 0;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                sum += (i ? t.x : 1 - t.x) * (j ? t.y : 1 - t.y) * (k ? t.z : 1 - t.z) *
                       value_at(grid, x + i, y + j, z + k);
    return sum;
}

} // namespace pnr
