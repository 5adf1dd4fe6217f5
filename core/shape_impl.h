// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of curved shapes share.
#pragma once

#include "core/shape_hits.h"

#include <cmath>

namespace pnr {

// Takes a hit into the list, which stays in order of t, if it lies inside the ray's open interval. A normal
// without a length, at a cusp say, becomes the direction back along the ray.
inline void add_hit(HitList& hits, const Ray& ray, double t, Vec3 normal, Vec2 uv = Vec2(0),
                    double error = 0) {
    if (!(t > ray.t_min && t < ray.t_max)) return;
    const double length2 = glm::dot(normal, normal);
    if (!(length2 > 0 && std::isfinite(length2))) normal = -ray.direction;
    auto at = hits.end();
    while (at != hits.begin() && (at - 1)->t > t) --at;
    hits.insert(at, ShapeHit{t, normal, uv, error});
}

// The angle from +x towards +z as a share of the turn, in [0, 1).
inline double turn_about_y(double x, double z) {
    const double turn = std::atan2(z, x) / (2 * pi);
    return turn < 0 ? turn + 1 : turn;
}

// A stretch of a ray.
struct Span {
    double enter = -infinity, leave = infinity;
    bool empty() const { return !(enter <= leave); }
    // Keeps where low <= o + t d <= high.
    void cut(double o, double d, double low, double high) {
        if (d == 0) {
            if (!(o >= low && o <= high)) leave = -infinity, enter = infinity;
            return;
        }
        const double a = (low - o) / d, b = (high - o) / d;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    void cut(Vec3 o, Vec3 d, const Bounds& box) {
        for (int k = 0; k < 3; ++k) cut(o[k], d[k], box.low[k], box.high[k]);
    }
};

} // namespace pnr
