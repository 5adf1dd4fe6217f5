// SPDX-License-Identifier: GPL-3.0-or-later
// Isosurfaces. A ray's stretch inside the container is cut into eighths again and again, front to back. A
// piece is done with when the field's values over it cannot reach the threshold; when the field rises or
// falls all along it, so that the signs at its ends tell of one crossing or none; or when it is shorter than
// the accuracy. What the field can do on a piece is told by interval arithmetic (field_enclosure.cpp), or,
// where the field calls something opaque, by the value in the middle and max_gradient [Kalra and Barr 1989,
// "Guaranteed ray intersections with implicit surfaces"].
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Shape container_of(const IsosurfaceData& data) {
    return data.in_sphere ? Shape(data.sphere) : Shape(data.box);
}

double size_of(const Bounds& b) { return glm::length(b.high - b.low); }

// The field over the threshold: negative inside. Where it has no value, it counts as outside.
double over_threshold(const IsosurfaceData& data, double value) {
    return std::isnan(value) ? field_huge : value - data.threshold;
}

struct Search {
    const IsosurfaceData& data;
    Vec3 origin, direction;
    double speed;     // of the ray
    double gradient;  // bound on the field's change along the ray, or 0: it can be enclosed
    double tolerance; // length of pieces, in t
    HitList& hits;
    int enough;
    FieldScratch scratch{};

    double value(double t) {
        return over_threshold(data, field_value(data.field, origin + t * direction, scratch));
    }
    bool done() const { return static_cast<int>(hits.size()) >= enough; }
};

// Where the field crosses the threshold between a and b, at which its signs differ: regula falsi with the
// ends' weights halved [Dowell and Jarratt 1971, the Illinois method], and halving where that is slow.
double crossing(Search& s, double a, double fa, double b, double fb) {
    const double fine = 0x1p-46 * std::max({std::abs(a), std::abs(b), 0x1p-20 * s.tolerance});
    int side = 0;
    for (int i = 0; i < 100 && b - a > fine; ++i) {
        double t = i % 4 == 3 ? 0.5 * (a + b) : a - fa * (b - a) / (fb - fa);
        if (!(t > a && t < b)) t = 0.5 * (a + b);
        const double f = s.value(t);
        if (f == 0) return t;
        if ((f < 0) == (fa < 0)) {
            a = t, fa = f;
            if (side == -1) fb *= 0.5;
            side = -1;
        } else {
            b = t, fb = f;
            if (side == 1) fa *= 0.5;
            side = 1;
        }
    }
    return 0.5 * (a + b);
}

Vec3 gradient_at(const IsosurfaceData& data, Vec3 p, FieldScratch& scratch) {
    const double h = data.accuracy;
    FieldPoints points;
    for (int l = 0; l < field_lanes; ++l) points.x[l] = p.x, points.y[l] = p.y, points.z[l] = p.z;
    points.x[0] -= h, points.x[1] += h, points.y[2] -= h, points.y[3] += h, points.z[4] -= h,
        points.z[5] += h;
    double f[field_lanes];
    field_values(data.field, points, f, scratch);
    Vec3 gradient(f[1] - f[0], f[3] - f[2], f[5] - f[4]);
    for (int k = 0; k < 3; ++k)
        if (!std::isfinite(gradient[k])) gradient[k] = 0;
    return gradient / (2 * h);
}

void add_crossing(Search& s, double a, double fa, double b, double fb) {
    const double t = crossing(s, a, fa, b, fb);
    const Vec3 p = s.origin + t * s.direction;
    Vec3 normal = gradient_at(s.data, p, s.scratch);
    if (normal == Vec3(0)) normal = fa > 0 ? -s.direction : s.direction;
    s.hits.push_back({t, normal, Vec2(0), 0});
}

// What the field can do on each eighth of a piece.
struct Pieces {
    double t[field_lanes + 1];
    double f[field_lanes + 1]; // at t, where known
    bool known[field_lanes + 1]{};
    FieldEnclosure range; // relative to the threshold
    double middle[field_lanes];
};

double end_value(Search& s, Pieces& pieces, int i) {
    if (!pieces.known[i]) pieces.f[i] = s.value(pieces.t[i]), pieces.known[i] = true;
    return pieces.f[i];
}

void find_middles(Search& s, Pieces& pieces) {
    FieldPoints points;
    for (int l = 0; l < field_lanes; ++l) {
        const Vec3 p = s.origin + 0.5 * (pieces.t[l] + pieces.t[l + 1]) * s.direction;
        points.x[l] = p.x, points.y[l] = p.y, points.z[l] = p.z;
    }
    field_values(s.data.field, points, pieces.middle, s.scratch);
    for (double& f : pieces.middle) f = over_threshold(s.data, f);
}

void find_range(Search& s, Pieces& pieces) {
    FieldBoxes boxes;
    for (int l = 0; l < field_lanes; ++l) {
        const Vec3 a = s.origin + pieces.t[l] * s.direction, b = s.origin + pieces.t[l + 1] * s.direction;
        const Vec3 low = glm::min(a, b), high = glm::max(a, b);
        boxes.low.x[l] = low.x, boxes.low.y[l] = low.y, boxes.low.z[l] = low.z;
        boxes.high.x[l] = high.x, boxes.high.y[l] = high.y, boxes.high.z[l] = high.z;
        boxes.along.x[l] = s.direction.x, boxes.along.y[l] = s.direction.y, boxes.along.z[l] = s.direction.z;
    }
    field_enclosure(s.data.field, boxes, pieces.range, s.scratch);
    for (int l = 0; l < field_lanes; ++l)
        pieces.range.low[l] -= s.data.threshold, pieces.range.high[l] -= s.data.threshold;
}

// Whether the value in the middle and the slopes leave the threshold out of reach.
bool out_of_reach(double middle, double slope_low, double slope_high, double length) {
    const double most = 0.5 * length * std::max(std::abs(slope_low), std::abs(slope_high));
    return std::abs(middle) > most && std::abs(middle) < field_huge;
}

enum class Verdict { nothing, one_crossing_at_most, unknown };

Verdict judge_enclosed(Search& s, Pieces& pieces, int i, bool& have_middles) {
    const FieldEnclosure& r = pieces.range;
    if (r.low[i] > 0 || r.high[i] < 0) return Verdict::nothing;
    if (r.slope_low[i] > 0 || r.slope_high[i] < 0) return Verdict::one_crossing_at_most;
    const double length = pieces.t[i + 1] - pieces.t[i];
    if (!(std::max(-r.slope_low[i], r.slope_high[i]) < field_huge) || length <= s.tolerance)
        return Verdict::unknown;
    if (!have_middles) find_middles(s, pieces), have_middles = true;
    return out_of_reach(pieces.middle[i], r.slope_low[i], r.slope_high[i], length) ? Verdict::nothing
                                                                                   : Verdict::unknown;
}

void search(Search& s, double t0, double t1) {
    Pieces pieces;
    for (int i = 0; i <= field_lanes; ++i) pieces.t[i] = t0 + (t1 - t0) * i / field_lanes;
    pieces.t[field_lanes] = t1;
    const bool enclosed = s.gradient == 0;
    bool have_middles = !enclosed;
    enclosed ? find_range(s, pieces) : find_middles(s, pieces);
    for (int i = 0; i < field_lanes && !s.done(); ++i) {
        const double length = pieces.t[i + 1] - pieces.t[i];
        Verdict verdict = Verdict::unknown;
        if (enclosed)
            verdict = judge_enclosed(s, pieces, i, have_middles);
        else if (out_of_reach(pieces.middle[i], s.gradient, s.gradient, length))
            verdict = Verdict::nothing;
        if (verdict == Verdict::nothing) continue;
        if (verdict == Verdict::unknown && length > s.tolerance) {
            search(s, pieces.t[i], pieces.t[i + 1]);
            continue;
        }
        const double fa = end_value(s, pieces, i), fb = end_value(s, pieces, i + 1);
        if ((fa < 0) != (fb < 0)) add_crossing(s, pieces.t[i], fa, pieces.t[i + 1], fb);
    }
}

// ---- cells
// -------------------------------------------------------------------------------------------------------

constexpr int cells = IsosurfaceCells::size;

// Calls f(t0, t1) for the stretches of the ray inside [t0, t1] that lie in cells that count [Amanatides and
// Woo 1987].
template <class F>
void walk(const IsosurfaceCells& grid, Vec3 origin, Vec3 direction, double t0, double t1, F f) {
    const Vec3 start = (origin + t0 * direction - grid.low) / grid.step;
    int at[3], way[3];
    double next[3], per_cell[3];
    for (int k = 0; k < 3; ++k) {
        at[k] = std::clamp(static_cast<int>(std::floor(start[k])), 0, cells - 1);
        const double rate = direction[k] / grid.step[k];
        way[k] = rate > 0 ? 1 : -1;
        per_cell[k] = rate != 0 ? std::abs(1 / rate) : infinity;
        const double border = at[k] + (rate > 0 ? 1 : 0);
        next[k] = rate != 0 ? t0 + (border - start[k]) / rate : infinity;
    }
    double t = t0, run = infinity; // where the stretch under way began
    while (t < t1) {
        const bool counts = grid.rows[static_cast<std::size_t>(at[2] * cells + at[1])] >> at[0] & 1;
        if (counts && run == infinity) run = t;
        if (!counts && run != infinity) {
            if (!f(run, t)) return;
            run = infinity;
        }
        const int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        t = std::max(t, next[k]);
        next[k] += per_cell[k];
        at[k] += way[k];
        if (at[k] < 0 || at[k] >= cells) break;
    }
    if (run != infinity && run < t1) f(run, t1);
}

struct CellFinder {
    const IsosurfaceData& data;
    IsosurfaceCells& grid;
    FieldScratch scratch{};

    // Cells of `size` grid cells a side, from `corner` on, cut into eight.
    void divide(const std::array<int, 3>& corner, int size) {
        const int half = size / 2;
        FieldBoxes boxes{};
        FieldPoints middles;
        std::array<int, 3> corners[field_lanes];
        const double slack = 1e-9;
        for (int l = 0; l < field_lanes; ++l) {
            for (std::size_t k = 0; k < 3; ++k) corners[l][k] = corner[k] + (l >> k & 1 ? half : 0);
            const Vec3 c(corners[l][0], corners[l][1], corners[l][2]);
            const Vec3 low = grid.low + grid.step * (c - slack),
                       high = grid.low + grid.step * (c + (half + slack));
            boxes.low.x[l] = low.x, boxes.low.y[l] = low.y, boxes.low.z[l] = low.z;
            boxes.high.x[l] = high.x, boxes.high.y[l] = high.y, boxes.high.z[l] = high.z;
            const Vec3 m = 0.5 * (low + high);
            middles.x[l] = m.x, middles.y[l] = m.y, middles.z[l] = m.z;
        }
        FieldEnclosure range;
        if (grid.gradient == 0)
            field_enclosure(data.field, boxes, range, scratch);
        else
            guess(middles, 0.5 * half * glm::length(grid.step), range);
        for (int l = 0; l < field_lanes; ++l) {
            const bool counts = range.low[l] <= data.threshold && range.high[l] >= data.threshold;
            if (range.low[l] <= data.threshold && (counts || touches_border(corners[l], half)))
                grow(corners[l], half, counts);
            if (!counts) continue;
            if (half > 1)
                divide(corners[l], half);
            else
                grid.rows[static_cast<std::size_t>(corners[l][2] * cells + corners[l][1])] |=
                    1u << corners[l][0];
        }
    }

    void guess(const FieldPoints& middles, double reach, FieldEnclosure& range) {
        double f[field_lanes];
        field_values(data.field, middles, f, scratch);
        for (int l = 0; l < field_lanes; ++l) {
            const bool known = std::isfinite(f[l]);
            range.low[l] = known ? f[l] - grid.gradient * reach : -field_huge;
            range.high[l] = known ? f[l] + grid.gradient * reach : field_huge;
        }
    }

    bool touches_border(const std::array<int, 3>& corner, int size) const {
        if (data.open) return false;
        return data.in_sphere ||
               std::any_of(corner.begin(), corner.end(), [&](int c) { return c == 0 || c + size == cells; });
    }

    // The surface's bounds take in undivided cells of it, and what is full beside the lids.
    void grow(const std::array<int, 3>& corner, int size, bool counts) {
        if (counts && size > 1) return;
        const Vec3 c(corner[0], corner[1], corner[2]);
        grid.bounds =
            merge(grid.bounds, Bounds{grid.low + grid.step * c, grid.low + grid.step * (c + double(size))});
    }
};

// At least max_gradient; more where more was met: at all but a twentieth of some points, so that single jumps
// do not make every ray slow.
double met_gradient(const IsosurfaceData& data, const Bounds& box) {
    constexpr int side = 8;
    std::vector<double> met;
    FieldScratch scratch;
    for (int i = 0; i < side * side * side; ++i) {
        const Vec3 share((i % side + 0.5) / side, (i / side % side + 0.5) / side,
                         (i / side / side + 0.5) / side);
        met.push_back(glm::length(gradient_at(data, box.low + share * (box.high - box.low), scratch)));
    }
    const auto place = met.begin() + static_cast<std::ptrdiff_t>(met.size() * 19 / 20);
    std::nth_element(met.begin(), place, met.end());
    return std::max(data.max_gradient, *place);
}

std::shared_ptr<const IsosurfaceCells> find_cells(const IsosurfaceData& data) {
    auto grid = std::make_shared<IsosurfaceCells>();
    const Bounds box = shape_bounds(container_of(data));
    grid->low = box.low;
    grid->step = (box.high - box.low) / double(cells);
    grid->rows.assign(cells * cells, 0);
    if (!has_enclosures(data.field)) grid->gradient = met_gradient(data, box);
    CellFinder{data, *grid}.divide({0, 0, 0}, cells);
    grid->bounds = {glm::max(grid->bounds.low, box.low), glm::min(grid->bounds.high, box.high)};
    return grid;
}

} // namespace

Isosurface prepare_isosurface(const Isosurface& shape) { return {shape.data, find_cells(*shape.data)}; }

Bounds bounds_of(const Isosurface& shape) {
    return shape.cells ? shape.cells->bounds : shape_bounds(container_of(*shape.data));
}

void intersect(const Isosurface& shape, const Ray& ray, HitList& hits, int enough) {
    const IsosurfaceData& data = *shape.data;
    HitList ends;
    const Ray line{ray.origin, ray.direction, -infinity, infinity};
    if (intersect_shape(container_of(data), line, ends) < 2) return;
    const double speed = glm::length(ray.direction), from = ends.front().t, to = ends.back().t;
    if (!(to > ray.t_min) || !(from < ray.t_max)) return;
    const Bounds box = shape_bounds(container_of(data));
    const double size = size_of(box);
    const bool enclosed = has_enclosures(data.field);
    const double steepest = enclosed ? 0 : shape.cells ? shape.cells->gradient : data.max_gradient;
    Search s{data,
             ray.origin,
             ray.direction,
             speed,
             steepest * speed,
             0.25 * std::min(data.accuracy, 0.01 * size) / speed,
             hits,
             enough};
    if (!data.open && from > ray.t_min && s.value(from) < 0) hits.push_back(ends.front());
    const auto look = [&](double t0, double t1) {
        search(s, t0, t1);
        return !s.done();
    };
    const double start = std::max(from, ray.t_min), end = std::min(to, ray.t_max);
    if (start < end && !s.done()) {
        if (shape.cells)
            walk(*shape.cells, ray.origin, ray.direction, start, end, look);
        else
            look(start, end);
    }
    if (!data.open && to < ray.t_max && !s.done() && s.value(to) < 0) hits.push_back(ends.back());
    for (ShapeHit& hit : hits) hit.error = 1e-9 * size;
}

bool is_inside(const Isosurface& shape, Vec3 p) {
    FieldScratch scratch;
    return inside_shape(container_of(*shape.data), p) &&
           over_threshold(*shape.data, field_value(shape.data->field, p, scratch)) < 0;
}

} // namespace pnr
