// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/area_light.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// A place of the square [-1/2, 1/2]^2 on the disc in it: squares about the centre become circles.
Vec2 bend_to_disc(Vec2 p) {
    const double length = glm::length(p);
    if (!(length > 0)) return p;
    return p * (std::max(std::abs(p.x), std::abs(p.y)) / length);
}

} // namespace

AreaView view_area(const Light& light, Vec3 position, std::uint64_t key) {
    const AreaGrid& grid = *light.said.area;
    AreaView view{&grid, light.said.position, grid.u, grid.v, {key, 0}};
    const Vec3 toward = position - view.center;
    const double distance = glm::length(toward);
    if (grid.orient && distance > 0) {
        const Frame frame = make_frame(toward / distance);
        view.u = glm::length(grid.u) * frame.x;
        view.v = glm::length(grid.v) * frame.y;
    }
    return view;
}

Vec3 area_point(const AreaView& view, double column, double row) {
    const AreaGrid& grid = *view.grid;
    Vec2 p(0);
    if (grid.columns > 1) p.x = column / (grid.columns - 1) - 0.5;
    if (grid.rows > 1) p.y = row / (grid.rows - 1) - 0.5;
    if (grid.jitter) { // within half a square all round
        const auto index = static_cast<std::uint64_t>(row) * 65536u + static_cast<std::uint64_t>(column);
        Rng stray{hash_words(view.stray.key, index), 0};
        if (grid.columns > 1) p.x += (stray.uniform() - 0.5) / (grid.columns - 1);
        if (grid.rows > 1) p.y += (stray.uniform() - 0.5) / (grid.rows - 1);
    }
    if (grid.circular) p = bend_to_disc(p);
    return view.center + p.x * view.u + p.y * view.v;
}

Vec3 area_point_at(const AreaView& view, Vec2 u) {
    Vec2 p = view.grid->circular ? 0.5 * square_to_disc(u) : u - Vec2(0.5);
    return view.center + p.x * view.u + p.y * view.v;
}

double area_reach(const AreaGrid& grid) { return 0.5 * (glm::length(grid.u) + glm::length(grid.v)); }

} // namespace pnr
