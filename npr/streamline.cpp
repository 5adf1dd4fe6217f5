// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/streamline.h"

namespace pnr {

namespace {

using Floats = std::array<float, lanes>;

struct Lanes {
    Floats x, y, along_x, along_y, way;
    std::array<std::uint32_t, lanes> turn;
    std::array<std::int32_t, lanes> alive; // all bits or none
};

Lanes begin_paths(const Canvas& canvas, const Starts& starts, int side) {
    Lanes now;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Vec2f d = canvas.at(starts.x[i], starts.y[i]).direction * (side == 0 ? 1.0f : -1.0f);
        now.x[i] = static_cast<float>(starts.x[i]) + 0.5f;
        now.y[i] = static_cast<float>(starts.y[i]) + 0.5f;
        now.along_x[i] = d.x, now.along_y[i] = d.y;
        now.way[i] = 0;
        now.turn[i] = first_turn(starts.turn[i], side);
        now.alive[i] = -1;
    }
    return now;
}

template <bool walled>
void walk_all(const Canvas& canvas, const Walk& walk, Lanes now, MetRow* met) {
    const auto whole = static_cast<float>(walk.count);
    const float step = walk.step;
    const std::int64_t width = canvas.width;
    const CanvasPoint* points = canvas.points.data();
    for (int k = 0; k < longest_way * walk.count; ++k, ++met) {
        Floats share, dx, dy, stretch, next_x, next_y;
        std::array<std::int32_t, lanes> x, y, ok;
        [[maybe_unused]] std::array<bool, lanes> folded;
        for (std::size_t i = 0; i < lanes; ++i) {
            share[i] = sample_share(now.turn[i]);
            now.turn[i] += next_turn;
            const float reach = share[i] * step;
            x[i] = static_cast<std::int32_t>(now.x[i] + now.along_x[i] * reach);
            y[i] = static_cast<std::int32_t>(now.y[i] + now.along_y[i] * reach);
        }
        for (std::size_t i = 0; i < lanes; ++i) {
            const CanvasPoint& point = points[y[i] * width + x[i]];
            dx[i] = point.direction.x, dy[i] = point.direction.y;
            met->cell[i] = point.cell;
            stretch[i] = walled ? std::abs(point.stretch) : point.stretch;
            if constexpr (walled) folded[i] = point.stretch < 0;
        }
        for (std::size_t i = 0; i < lanes; ++i) {
            const float dot = dx[i] * now.along_x[i] + dy[i] * now.along_y[i];
            const float sign = dot < 0 ? -1.0f : 1.0f;
            dx[i] *= sign;
            dy[i] *= sign;
            next_x[i] = now.x[i] + dx[i] * step, next_y[i] = now.y[i] + dy[i] * step;
            const float before = now.way[i] + share[i] * stretch[i];
            ok[i] = now.alive[i] & (met->cell[i] != no_cell ? -1 : 0) & (before < whole ? -1 : 0);
            met->place[i] = static_cast<std::int32_t>(before) & ok[i];
        }
        if constexpr (walled)
            for (std::size_t i = 0; i < lanes; ++i)
                if (folded[i] && ok[i] != 0 && canvas.is_walled({now.x[i], now.y[i]}, {next_x[i], next_y[i]}))
                    ok[i] = 0;
        std::int32_t any = 0;
        for (std::size_t i = 0; i < lanes; ++i) {
            met->way[i] = ok[i] != 0 ? stretch[i] : 0.0f;
            now.way[i] += met->way[i];
            now.x[i] = ok[i] != 0 ? next_x[i] : now.x[i];
            now.y[i] = ok[i] != 0 ? next_y[i] : now.y[i];
            now.along_x[i] = ok[i] != 0 ? dx[i] : now.along_x[i];
            now.along_y[i] = ok[i] != 0 ? dy[i] : now.along_y[i];
            now.alive[i] = ok[i];
            any |= ok[i];
        }
        if (any == 0) return;
    }
    met->way.fill(0);
}

} // namespace

void walk_paths(const Canvas& canvas, const Walk& walk, const Starts& starts, int side,
                std::vector<MetRow>& met) {
    const std::size_t room = static_cast<std::size_t>(longest_way * walk.count + 1);
    if (met.size() < room) met.resize(room);
    const Lanes now = begin_paths(canvas, starts, side);
    if (canvas.walls.empty())
        walk_all<false>(canvas, walk, now, met.data());
    else
        walk_all<true>(canvas, walk, now, met.data());
}

} // namespace pnr
