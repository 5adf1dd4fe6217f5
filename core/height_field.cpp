// SPDX-License-Identifier: GPL-3.0-or-later
// Height fields. Over each cell of the grid the surface is two triangles that meet along the diagonal from
// (1, 0) to (0, 1), as in POV-Ray. A ray goes down a pyramid of lowest and highest heights [Tevs et al. 2008,
// "Maximum mipmaps"]; in a cell its height over the surface is linear between the cell's border and the
// diagonal, and a hit is where its sign changes. Neighbouring cells compute the same bits at the border they
// share, so no ray slips through.
#include "core/image_io.h"
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

float height_at(const HeightGrid& g, int i, int k) {
    return g.heights[static_cast<std::size_t>(k) * static_cast<std::size_t>(g.width) +
                     static_cast<std::size_t>(i)];
}

// In the grid's space: x and z count cells.
struct GridRay {
    const HeightGrid& grid;
    const HeightField& shape;
    Vec3 origin, direction;
    double t_min, t_max;
    HitList& hits;
    int enough;

    bool done() const { return static_cast<int>(hits.size()) >= enough; }
};

// The part of [from, to] in which o + t d is in [low, high].
bool cut(double o, double d, double low, double high, double& from, double& to) {
    if (d == 0) return o >= low && o <= high;
    const double a = (low - o) / d, b = (high - o) / d;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
    return from <= to;
}

// The height of a ray over the surface where it crosses the border of a cell, or its diagonal.
struct CellRay {
    const GridRay& r;
    int i, k;
    double h00, h10, h01, h11; // at x = i, i + 1 and z = k, k + 1; the first digit is x's

    double over_x_border(double t, int x) const {
        const double v = r.origin.z + t * r.direction.z - k;
        const double a = x == i ? h00 : h10, b = x == i ? h01 : h11;
        return r.origin.y + t * r.direction.y - (a + v * (b - a));
    }
    double over_z_border(double t, int z) const {
        const double u = r.origin.x + t * r.direction.x - i;
        const double a = z == k ? h00 : h01, b = z == k ? h10 : h11;
        return r.origin.y + t * r.direction.y - (a + u * (b - a));
    }
    double over_diagonal(double t) const {
        const double v = r.origin.z + t * r.direction.z - k;
        return r.origin.y + t * r.direction.y - (h10 + v * (h01 - h10));
    }
    bool is_far_half(double t) const {
        return r.origin.x + t * r.direction.x - i + (r.origin.z + t * r.direction.z - k) > 1;
    }
};

// The mean of the normals of the four triangles between a point and its neighbours, in steps of the grid and
// of 1 / 65536 of the height, where POV-Ray takes it: steep ones count as much as flat ones.
Vec3 smooth_normal_at(const HeightGrid& g, int i, int k) {
    const int around[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    const auto holds = [&](int x, int z) { return x >= 0 && z >= 0 && x < g.width && z < g.height; };
    Vec3 sum(0);
    for (int side = 0; side < 4; ++side) {
        const auto& [ax, az] = around[side];
        const auto& [bx, bz] = around[side + 1];
        if (!holds(i + ax, k + az) || !holds(i + bx, k + bz)) continue;
        const double h = height_at(g, i, k);
        const Vec3 a(ax, 65536 * (height_at(g, i + ax, k + az) - h), az);
        const Vec3 b(bx, 65536 * (height_at(g, i + bx, k + bz) - h), bz);
        sum += glm::normalize(glm::cross(b, a));
    }
    return sum;
}

// Between a cell's corners, in the shape's space; not unit.
Vec3 smooth_normal(const CellRay& cell, double t) {
    const HeightGrid& g = cell.r.grid;
    const double u = std::clamp(cell.r.origin.x + t * cell.r.direction.x - cell.i, 0.0, 1.0);
    const double v = std::clamp(cell.r.origin.z + t * cell.r.direction.z - cell.k, 0.0, 1.0);
    const auto unit = [](Vec3 n) { return n == Vec3(0) ? n : glm::normalize(n); };
    const Vec3 near = (1 - u) * unit(smooth_normal_at(g, cell.i, cell.k)) +
                      u * unit(smooth_normal_at(g, cell.i + 1, cell.k));
    const Vec3 far = (1 - u) * unit(smooth_normal_at(g, cell.i, cell.k + 1)) +
                     u * unit(smooth_normal_at(g, cell.i + 1, cell.k + 1));
    const Vec3 n = (1 - v) * near + v * far;
    return {n.x * (g.width - 1), n.y * 65536, n.z * (g.height - 1)};
}

void add_hit(GridRay& r, const CellRay& cell, double t, bool far_half) {
    if (!(t > r.t_min && t < r.t_max)) return;
    const HeightFieldData& data = *r.shape.data;
    if (r.origin.y + t * r.direction.y < data.water_level) return;
    const double along_x = far_half ? cell.h11 - cell.h01 : cell.h10 - cell.h00;
    const double along_z = far_half ? cell.h11 - cell.h10 : cell.h01 - cell.h00;
    ShapeHit hit{t, Vec3(-along_x * (r.grid.width - 1), 1, -along_z * (r.grid.height - 1)), Vec2(0), 1e-12};
    if (data.smooth) {
        hit.shading = smooth_normal(cell, t);
        if (glm::dot(hit.shading, hit.normal) <= 0) hit.shading = hit.normal;
    }
    r.hits.push_back(hit);
}

void intersect_cell(GridRay& r, int i, int k) {
    const HeightGrid& g = r.grid;
    const CellRay cell{r,
                       i,
                       k,
                       height_at(g, i, k),
                       height_at(g, i + 1, k),
                       height_at(g, i, k + 1),
                       height_at(g, i + 1, k + 1)};
    const Vec3 &o = r.origin, &d = r.direction;
    if (d.x == 0 && d.z == 0) { // straight down or up: one of the halves
        const bool far = cell.is_far_half(0);
        const double u = o.x - i, v = o.z - k;
        const double h = far ? cell.h11 + (1 - u) * (cell.h01 - cell.h11) + (1 - v) * (cell.h10 - cell.h11)
                             : cell.h00 + u * (cell.h10 - cell.h00) + v * (cell.h01 - cell.h00);
        return add_hit(r, cell, (h - o.y) / d.y, far);
    }
    const double x0 = d.x > 0 ? i : i + 1, x1 = d.x > 0 ? i + 1 : i, z0 = d.z > 0 ? k : k + 1,
                 z1 = d.z > 0 ? k + 1 : k;
    const double tx0 = d.x != 0 ? (x0 - o.x) / d.x : -infinity, tx1 = d.x != 0 ? (x1 - o.x) / d.x : infinity;
    const double tz0 = d.z != 0 ? (z0 - o.z) / d.z : -infinity, tz1 = d.z != 0 ? (z1 - o.z) / d.z : infinity;
    double t[3], f[3];
    int count = 0;
    const double enter = std::max(tx0, tz0), leave = std::min(tx1, tz1);
    if (!(enter <= leave)) return;
    t[count] = enter;
    f[count++] = tx0 >= tz0 ? cell.over_x_border(enter, static_cast<int>(x0))
                            : cell.over_z_border(enter, static_cast<int>(z0));
    if (d.x + d.z != 0) {
        const double middle = (i + k + 1 - o.x - o.z) / (d.x + d.z);
        if (middle > enter && middle < leave) t[count] = middle, f[count++] = cell.over_diagonal(middle);
    }
    t[count] = leave;
    f[count++] = tx1 <= tz1 ? cell.over_x_border(leave, static_cast<int>(x1))
                            : cell.over_z_border(leave, static_cast<int>(z1));
    for (int n = 0; n + 1 < count && !r.done(); ++n)
        if ((f[n] < 0) != (f[n + 1] < 0))
            add_hit(r, cell, t[n] - f[n] * ((t[n + 1] - t[n]) / (f[n + 1] - f[n])),
                    cell.is_far_half(0.5 * (t[n] + t[n + 1])));
}

// `level` 0: a cell; else a square of 2^level cells a side.
void descend(GridRay& r, int level, int i, int k) {
    if (r.done()) return;
    const HeightGrid& g = r.grid;
    const int size = 1 << level, x = i << level, z = k << level;
    if (x >= g.width - 1 || z >= g.height - 1) return;
    double from = r.t_min, to = r.t_max;
    const double slack = 1e-9;
    if (!cut(r.origin.x, r.direction.x, x - slack, x + size + slack, from, to)) return;
    if (!cut(r.origin.z, r.direction.z, z - slack, z + size + slack, from, to)) return;
    if (level == 0) return intersect_cell(r, i, k);
    const HeightGrid::Level& l = g.levels[static_cast<std::size_t>(level - 1)];
    const auto& ends =
        l.ends[static_cast<std::size_t>(k) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(i)];
    if (!cut(r.origin.y, r.direction.y, ends[0] - 1e-9, ends[1] + 1e-9, from, to)) return;
    // Children in the order in which the ray may pass them.
    const int first_x = r.direction.x < 0 ? 1 : 0, first_z = r.direction.z < 0 ? 1 : 0;
    descend(r, level - 1, 2 * i + first_x, 2 * k + first_z);
    descend(r, level - 1, 2 * i + 1 - first_x, 2 * k + first_z); // at most one of these two
    descend(r, level - 1, 2 * i + first_x, 2 * k + 1 - first_z);
    descend(r, level - 1, 2 * i + 1 - first_x, 2 * k + 1 - first_z);
}

// ---- making the grid
// ----------------------------------------------------------------------------------------------

void add_levels(HeightGrid& g) {
    int width = g.width - 1, height = g.height - 1; // of the level below; cells at first
    do {
        HeightGrid::Level level{(width + 1) / 2, (height + 1) / 2, {}};
        level.ends.assign(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height),
                          {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()});
        const auto grow = [&](int i, int k, float low, float high) {
            auto& ends = level.ends[static_cast<std::size_t>(k) * static_cast<std::size_t>(level.width) +
                                    static_cast<std::size_t>(i)];
            ends = {std::min(ends[0], low), std::max(ends[1], high)};
        };
        for (int k = 0; k < height; ++k)
            for (int i = 0; i < width; ++i) {
                if (g.levels.empty()) {
                    for (int corner = 0; corner < 4; ++corner) {
                        const float h = height_at(g, i + (corner & 1), k + (corner >> 1));
                        grow(i / 2, k / 2, h, h);
                    }
                } else {
                    const auto& below =
                        g.levels.back().ends[static_cast<std::size_t>(k) * static_cast<std::size_t>(width) +
                                             static_cast<std::size_t>(i)];
                    grow(i / 2, k / 2, below[0], below[1]);
                }
            }
        width = level.width, height = level.height;
        g.levels.push_back(std::move(level));
    } while (width > 1 || height > 1);
}

Image<float> read_heights_of(const HeightFieldData& data) {
    if (data.file.empty()) return {};
    try {
        return read_heights(data.file, data.pot);
    } catch (const FileError& problem) { // what the reader has to say against the file belongs where the scene names it
        throw SceneError(data.said_at, problem.what());
    }
}

// Pictures have their first row at the top, which is z = 1.
std::shared_ptr<const HeightGrid> make_grid(const HeightFieldData& data) {
    auto grid = std::make_shared<HeightGrid>();
    const Image<float> heights = read_heights_of(data);
    grid->width = data.file.empty() ? data.width : heights.width;
    grid->height = data.file.empty() ? data.height : heights.height;
    if (grid->width < 2 || grid->height < 2)
        throw SceneError(data.said_at, "a height field needs a picture of at least 2 by 2 pixels");
    grid->heights.reserve(static_cast<std::size_t>(grid->width) * static_cast<std::size_t>(grid->height));
    for (int k = 0; k < grid->height; ++k)
        for (int i = 0; i < grid->width; ++i) {
            if (!data.file.empty()) {
                grid->heights.push_back(heights.at(i, grid->height - 1 - k));
                continue;
            }
            const double x = i / (grid->width - 1.0), y = 1 - k / (grid->height - 1.0);
            const double h = data.function(Vec3(x, y, 0));
            grid->heights.push_back(h > 0 ? static_cast<float>(std::min(h, 1.0) * (65535.0 / 65536)) : 0.0f);
        }
    add_levels(*grid);
    return grid;
}

// Over the unit square; a point outside has none.
double surface_height(const HeightGrid& g, double x, double z) {
    const double gx = x * (g.width - 1), gz = z * (g.height - 1);
    const int i = std::clamp(static_cast<int>(gx), 0, g.width - 2),
              k = std::clamp(static_cast<int>(gz), 0, g.height - 2);
    const double u = gx - i, v = gz - k, h10 = height_at(g, i + 1, k), h01 = height_at(g, i, k + 1);
    if (u + v > 1) {
        const double h11 = height_at(g, i + 1, k + 1);
        return h11 + (1 - u) * (h01 - h11) + (1 - v) * (h10 - h11);
    }
    const double h00 = height_at(g, i, k);
    return h00 + u * (h10 - h00) + v * (h01 - h00);
}

} // namespace

HeightField prepare_height_field(const HeightField& shape) { return {shape.data, make_grid(*shape.data)}; }

Bounds bounds_of(const HeightField& shape) {
    if (!shape.grid) return {{0, shape.data->water_level, 0}, {1, 1, 1}};
    const auto& ends = shape.grid->levels.back().ends.front();
    if (ends[1] < shape.data->water_level) return {};
    return {{0, std::max(double(ends[0]), shape.data->water_level), 0}, {1, ends[1], 1}};
}

void intersect(const HeightField& shape, const Ray& ray, HitList& hits, int enough) {
    if (!shape.grid) return;
    const HeightGrid& g = *shape.grid;
    const Vec3 to_grid(g.width - 1, 1, g.height - 1);
    GridRay r{g, shape, ray.origin * to_grid, ray.direction * to_grid, ray.t_min, ray.t_max, hits, enough};
    descend(r, static_cast<int>(g.levels.size()), 0, 0);
}

bool is_inside(const HeightField& shape, Vec3 p) {
    return shape.grid && p.x >= 0 && p.x <= 1 && p.z >= 0 && p.z <= 1 &&
           p.y < surface_height(*shape.grid, p.x, p.z);
}

} // namespace pnr
