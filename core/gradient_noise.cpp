// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gradient_noise.h"

#include "core/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pnr {

namespace {

// A unit gradient at each point of the lattice, picked by a permutation looked up for x, then y; along z the
// gradients follow one another. Both tables come from the lattice's generator. That they have 2048 entries,
// their seed, and where the lattice begins were found from POV-Ray's values about lattice points.
constexpr std::uint32_t table_size = 2048, last = table_size - 1;
constexpr double lattice_offset = 0.02315721415;
constexpr std::int64_t lattice_start = 1664;

struct Tables {
    std::vector<Vec3> gradients;
    std::vector<std::uint32_t> permutation; // one entry more than are looked up: the first swap goes there
};

Tables make_tables() {
    Tables tables;
    std::uint32_t state = 1;
    const auto random = [&state] {
        state = next_lattice_random(state);
        return lattice_random_value(state);
    };
    while (tables.gradients.size() < table_size) { // uniform in a ball, brought to its surface
        Vec3 v;
        for (int i = 0; i < 3; ++i) v[i] = (double(random() % (2 * table_size)) - table_size) / table_size;
        const double length2 = glm::dot(v, v);
        if (length2 > 0 && length2 <= 1) tables.gradients.push_back(v / std::sqrt(length2));
    }
    auto& p = tables.permutation;
    for (std::uint32_t i = 0; i < table_size; ++i) p.push_back(i);
    p.push_back(0);
    for (std::uint32_t i = table_size; i > 0; i -= 2) std::swap(p[i], p[random() % table_size]);
    return tables;
}

struct Axis {
    std::uint32_t number[2]; // of the lattice points below and above
    double from[2];          // signed distances from them
    double weight;           // of the one above
};

Axis make_axis(double x) {
    const double shifted = std::clamp(x, -1e15, 1e15) + lattice_offset;
    const double low = std::floor(shifted), t = shifted - low;
    const auto number = static_cast<std::uint32_t>((static_cast<std::int64_t>(low) + lattice_start) & last);
    return {{number, (number + 1) & last}, {t, t - 1}, t * t * (3 - 2 * t)};
}

double between(double a, double b, double t) { return a + t * (b - a); }

} // namespace

double gradient_noise(Vec3 point) {
    static const Tables tables = make_tables();
    const Axis x = make_axis(point.x), y = make_axis(point.y), z = make_axis(point.z);
    double along_z[2];
    for (int k = 0; k < 2; ++k) {
        double along_y[2];
        for (int j = 0; j < 2; ++j) {
            double along_x[2];
            for (int i = 0; i < 2; ++i) {
                const std::uint32_t row =
                    tables.permutation[(tables.permutation[x.number[i]] + y.number[j]) & last];
                const Vec3& gradient = tables.gradients[(row + z.number[k]) & last];
                along_x[i] = glm::dot(gradient, Vec3(x.from[i], y.from[j], z.from[k]));
            }
            along_y[j] = between(along_x[0], along_x[1], x.weight);
        }
        along_z[k] = between(along_y[0], along_y[1], y.weight);
    }
    return between(along_z[0], along_z[1], z.weight);
}

} // namespace pnr
