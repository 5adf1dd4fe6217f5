// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns made of one random point, or value, in each unit cube of space.
#include "core/noise.h"
#include "core/pattern_values.h"

#include <array>

namespace pnr {

namespace {

// POV-Ray's lower ends of cells are inclusive within this.
constexpr double cell_edge = 1e-10;

struct Nearest {
    std::array<double, 3> distance{1e6, 1e6, 1e6}; // of the three nearest points, in the metric's power
    Vec3 point{0};                                 // the nearest
};

double metric_power(Vec3 apart, double metric) {
    if (metric == 2) return glm::dot(apart, apart);
    const Vec3 a = glm::abs(apart);
    if (metric == 1) return a.x + a.y + a.z;
    return std::pow(a.x, metric) + std::pow(a.y, metric) + std::pow(a.z, metric);
}

// Cubes up to two away, but for those whose offsets are two along more than two axes or are corners too far
// to matter.
bool is_near(int x, int y, int z) { return x * x + y * y + z * z <= 5; }

Nearest find_nearest(Vec3 p, double metric) {
    const Vec3 home = glm::floor(p - Vec3(cell_edge));
    Nearest found;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) {
                if (!is_near(x, y, z)) continue;
                const Vec3 cell = home + Vec3(x, y, z), point = cell + cell_numbers(cell);
                const double d = metric_power(point - p, metric);
                auto& [first, second, third] = found.distance;
                if (d < first) {
                    third = second, second = first, first = d;
                    found.point = point;
                } else if (d < second) {
                    third = second, second = d;
                } else if (d < third) {
                    third = d;
                }
            }
    return found;
}

} // namespace

double cells_value(Vec3 point) { return cell_numbers(glm::floor(point + Vec3(cell_edge))).x; }

double value_of(const CracklePattern& kind, const Pattern& pattern, const SurfacePoint& at) {
    const Nearest nearest = find_nearest(at.point, kind.metric);
    if (kind.solid) return noise(nearest.point, pattern.noise_generator);
    const bool rooted = kind.metric != 1 && kind.metric != 0;
    const double offset = rooted ? std::pow(std::abs(kind.offset), kind.metric) : kind.offset;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        double distance = nearest.distance[static_cast<std::size_t>(i)] + offset;
        if (rooted) distance = kind.metric == 2 ? std::sqrt(distance) : std::pow(distance, 1 / kind.metric);
        sum += kind.form[i] * distance;
    }
    return std::clamp(sum, 0.0, 1.0);
}

} // namespace pnr
