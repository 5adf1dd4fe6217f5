// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/folds.h"

#include "core/parallel.h"
#include "npr/footprint.h"
#include "npr/maps.h"

#include <atomic>

namespace pnr {

namespace {

constexpr float largest_step = 3;     // off the tangent planes, in pixels' widths
constexpr float sharpest_turn = 0.5f; // cosine between the normals

} // namespace

bool is_fold(Vec3f a, Vec3f normal_a, Vec3f b, Vec3f normal_b, float pixel) {
    const Vec3f way = b - a;
    // A surface that bends away slowly leaves one of the two planes by little.
    if (std::min(std::abs(glm::dot(way, normal_a)), std::abs(glm::dot(way, normal_b))) > largest_step * pixel)
        return true;
    return glm::dot(normal_a, normal_b) < sharpest_turn;
}

Folds find_folds(const GBuffer& gbuffer) {
    Folds folds;
    const int width = gbuffer.seen.width, height = gbuffer.seen.height;
    folds.walls = Image<std::uint8_t>(width, height, 0);
    Image<float> widths(width, height, 0.0f);
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x)
                if (is_painted(gbuffer.seen.at(x, y)))
                    widths.at(x, y) = footprint_of(gbuffer.seen.at(x, y)).least;
    });
    std::atomic<bool> any{false};
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                const Seen& seen = gbuffer.seen.at(x, y);
                if (!is_painted(seen)) continue;
                const float pixel = widths.at(x, y);
                if (!(pixel > 0)) continue;
                std::uint8_t walls = 0;
                for (int j = -1; j <= 1; ++j) {
                    for (int i = -1; i <= 1; ++i) {
                        if ((i == 0 && j == 0) || !gbuffer.seen.contains(x + i, y + j)) continue;
                        const Seen& other = gbuffer.seen.at(x + i, y + j);
                        if (!is_painted(other) || other.object != seen.object || other.via != seen.via)
                            continue;
                        // The larger of the two pixels, so that both sides say the same.
                        const float wider = std::max(pixel, widths.at(x + i, y + j));
                        if (is_fold(seen.position, seen.normal, other.position, other.normal, wider))
                            walls |= wall_bit(i, j);
                    }
                }
                folds.walls.at(x, y) = walls;
                if (walls != 0) any = true;
            }
        }
    });
    folds.any = any;
    return folds;
}

bool is_folded_between(const Folds& folds, int x0, int y0, int x1, int y1) {
    const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
    int x = x0, y = y0;
    for (int k = 1; k <= steps; ++k) {
        const int nx = x0 + static_cast<int>(std::lround(static_cast<double>(k * (x1 - x0)) / steps));
        const int ny = y0 + static_cast<int>(std::lround(static_cast<double>(k * (y1 - y0)) / steps));
        if ((folds.walls.at(x, y) & wall_bit(nx - x, ny - y)) != 0) return true;
        x = nx;
        y = ny;
    }
    return false;
}

} // namespace pnr
