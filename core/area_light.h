// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's area_light. Its points form a grid about the light's position; a point is shaded by the mean over the grid of
// what reaches it. With `adaptive` a square of the grid whose four corners agree is not looked into [POV-Ray 3.7
// reference, "Area Lights"].
#pragma once

#include "core/light.h"
#include "core/rng.h"

#include <vector>

namespace pnr {

// The grid as it is seen from one lit position.
struct AreaView {
    const AreaGrid* grid = nullptr;
    Vec3 center{0};
    Vec3 u{0}, v{0}; // full edges, turned towards the position if the light says `orient`
    Rng stray;       // of `jitter`
};
// `key` names the lit position among others, for the jitter; the light must have a grid.
AreaView view_area(const Light& light, Vec3 position, std::uint64_t key);
// A point of the grid; column and row may lie between points.
Vec3 area_point(const AreaView& view, double column, double row);
// A point spread evenly over the area, u in [0, 1)^2.
Vec3 area_point_at(const AreaView& view, Vec2 u);
// The share of the area's half diagonal to which its points reach from the centre, in world units.
double area_reach(const AreaGrid& grid);

// The mean over the grid of light_at(point), which tells how much of the light's colour comes from there.
template <class LightAt>
Color area_mean(const AreaView& view, const LightAt& light_at);

// ---- the template
// ---------------------------------------------------------------------------------------------

namespace area_detail {

// Corners that agree within this sum of differences over the channels end the search.
inline constexpr float agreement = 0.1f;

template <class LightAt>
struct Walk {
    const AreaView& view;
    const LightAt& light_at;
    std::vector<Color> known; // by row and column; x < 0: not looked at
    int columns;

    Color corner(int column, int row) {
        Color& c = known[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(column)];
        if (c.x < 0) c = light_at(area_point(view, column, row));
        return c;
    }

    Color mean(int c0, int r0, int c1, int r1, int level) {
        const Color a = corner(c0, r0), b = corner(c1, r0), c = corner(c0, r1), d = corner(c1, r1);
        const Color middle = 0.25f * (a + b + c + d);
        if (c1 - c0 <= 1 && r1 - r0 <= 1) return middle;
        if (level >= view.grid->adaptive && agree(a, b) && agree(a, c) && agree(b, d) && agree(c, d)) return middle;
        // The halves share their middle line where the number of points is odd.
        const int cl = (c0 + c1) / 2, ch = (c0 + c1 + 1) / 2, rl = (r0 + r1) / 2, rh = (r0 + r1 + 1) / 2;
        return 0.25f * (mean(c0, r0, cl, rl, level + 1) + mean(ch, r0, c1, rl, level + 1) +
                        mean(c0, rh, cl, r1, level + 1) + mean(ch, rh, c1, r1, level + 1));
    }

    static bool agree(Color a, Color b) {
        const Color d = glm::abs(a - b);
        return d.x + d.y + d.z <= agreement;
    }
};

} // namespace area_detail

template <class LightAt>
Color area_mean(const AreaView& view, const LightAt& light_at) {
    const int columns = view.grid->columns, rows = view.grid->rows;
    area_detail::Walk<LightAt> walk{
        view, light_at, std::vector<Color>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), Color(-1)), columns};
    return walk.mean(0, 0, columns - 1, rows - 1, 0);
}

} // namespace pnr
