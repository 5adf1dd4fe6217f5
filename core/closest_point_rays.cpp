// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest point of a shape that knows its hits and nothing else: lines through the query, the best of
// many turned until none near it is better.
#include "core/closest_point.h"
#include "core/shape_hits.h"

#include <cmath>

namespace pnr {

namespace {

struct Nearest {
    const Shape& shape;
    Vec3 query;
    double distance = infinity;
    Vec3 position{0}, normal{0};

    // Both ways along a unit direction. Only what is nearer than what is known is looked for.
    bool try_line(Vec3 direction) {
        const double reach = std::isfinite(distance) ? distance * (1 + 1e-12) : distance;
        HitList hits;
        intersect_shape(shape, {query, direction, -reach, reach}, hits);
        bool nearer = false;
        for (const ShapeHit& hit : hits) {
            if (!(std::abs(hit.t) < distance)) continue;
            distance = std::abs(hit.t);
            position = query + hit.t * direction;
            normal = glm::normalize(hit.normal);
            nearer = true;
        }
        return nearer;
    }
    Vec3 way() const { return distance > 0 ? (position - query) / distance : normal; }
};

// Directions that cover half of the sphere evenly, along a spiral of golden sections [Gonzalez 2010].
Vec3 spread_direction(int i, int count) {
    const double z = (i + 0.5) / count, r = std::sqrt(1 - z * z), angle = 2 * pi * 0.618033988749895 * i;
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

void try_points_of(const Bounds& box, Nearest& nearest) {
    constexpr int across = 5;
    for (int i = 0; i < across * across * across; ++i) {
        const Vec3 share(i % across, i / across % across, i / (across * across));
        const Vec3 to =
            box.low + (share + 0.5) / static_cast<double>(across) * (box.high - box.low) - nearest.query;
        if (const double length = glm::length(to); length > 0) nearest.try_line(to / length);
    }
}

// The pattern of directions is turned from step to step, so that it finds its way along edges too.
void turn(Nearest& nearest) {
    constexpr double golden_angle = 2.39996322972865332;
    double angle = 0;
    for (double step = 0.3; step > 1e-8; angle += golden_angle) {
        bool better = nearest.try_line(nearest.normal);
        const Frame frame = make_frame(nearest.way());
        for (int k = 0; k < 5; ++k) {
            const double at = angle + 2 * pi * k / 5;
            better |= nearest.try_line(
                glm::normalize(nearest.way() + step * (std::cos(at) * frame.x + std::sin(at) * frame.y)));
        }
        if (!better) step *= 0.7;
    }
}

} // namespace

ClosestPoint closest_point_by_rays(const Shape& shape, Vec3 point) {
    const Bounds box = shape_bounds(shape);
    if (is_empty(box)) return {};
    const double size = glm::length(box.high - box.low);
    Nearest nearest{shape, point};
    for (int k = 0; k < 3; ++k) {
        Vec3 axis(0);
        axis[k] = 1;
        nearest.try_line(axis);
    }
    const double scale = std::isfinite(size) ? size + glm::length(point) : glm::length(point);
    if (!(nearest.distance <= 1e-10 * scale)) { // else the query is on the surface
        constexpr int directions = 64;
        for (int i = 0; i < directions; ++i) nearest.try_line(spread_direction(i, directions));
        if (std::isfinite(size)) try_points_of(box, nearest);
        if (!std::isfinite(nearest.distance)) return {};
        turn(nearest);
    }
    ClosestPoint found;
    found.position = nearest.position;
    found.normal = nearest.normal;
    found.distance = nearest.distance;
    return found;
}

} // namespace pnr
