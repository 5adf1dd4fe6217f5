// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/closest_point_field.h"

#include "core/shape_hits.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

struct Nearest {
    const Shape& shape;
    Vec3 query;
    double reach; // of the rays
    ClosestPoint best{};
    Vec3 direction{0}; // to it, unit
    HitList hits{};

    bool on_surface() const { return best.distance <= 1e-8 * reach; }

    bool look(Vec3 way) {
        const double length = glm::length(way);
        if (!(length > 0)) return false;
        const Vec3 unit = way / length;
        // A query on the surface is its own nearest point.
        if (intersect_shape(shape, {query, unit, -1e-8 * reach, std::min(reach, best.distance)}, hits, 1) == 0)
            return false;
        const ShapeHit& hit = hits.front();
        const double distance = std::abs(hit.t);
        if (!(distance < best.distance)) return false;
        best.position = query + hit.t * unit;
        best.normal = glm::normalize(hit.normal);
        best.distance = distance;
        direction = unit;
        return true;
    }
};

void look_around(Nearest& n, const Bounds& box) {
    constexpr int everywhere = 200, side = 7;
    for (int i = 0; i < everywhere && !n.on_surface(); ++i) { // evenly over the sphere [Gonzalez 2010, "Measurement of areas on a sphere"]
        const double height = 1 - (2 * i + 1.0) / everywhere, around = i * pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - height * height);
        n.look({r * std::cos(around), height, r * std::sin(around)});
    }
    for (int i = 0; i < side * side * side && !n.on_surface(); ++i) {
        const Vec3 share(i % side, i / side % side, i / side / side);
        n.look(box.low + (share + 0.5) / double(side) * (box.high - box.low) - n.query);
    }
}

} // namespace

ClosestPoint closest_point_by_rays(const Shape& shape, Vec3 p) {
    const Bounds box = shape_bounds(shape);
    if (is_empty(box) || !std::isfinite(glm::length(box.high - box.low))) return {};
    Nearest n{shape, p, glm::length(glm::max(box.high - p, p - box.low))};
    look_around(n, box);
    if (!std::isfinite(n.best.distance)) return {};
    // Ever smaller circles of rays about the best one.
    for (double angle = 0.2; angle > 1e-8 && !n.on_surface();) {
        const Frame frame = make_frame(n.direction);
        bool better = false;
        for (int i = 0; i < 6; ++i) {
            const double around = i * pi / 3;
            better |= n.look(n.direction + angle * (std::cos(around) * frame.x + std::sin(around) * frame.y));
        }
        if (!better) angle *= 0.5;
    }
    return n.best;
}

} // namespace pnr
