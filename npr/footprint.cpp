// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/footprint.h"

#include <algorithm>
#include <cmath>

namespace pnr {

Footprint footprint_of(const Seen& seen) {
    const float uu = glm::dot(seen.dpdx, seen.dpdx), uv = glm::dot(seen.dpdx, seen.dpdy),
                vv = glm::dot(seen.dpdy, seen.dpdy);
    const float middle = 0.5f * (uu + vv), half = 0.5f * (uu - vv);
    const float radius =
        static_cast<float>(std::sqrt(static_cast<double>(half) * half + static_cast<double>(uv) * uv));
    const float most2 = middle + radius;
    if (!(most2 > 0)) return {};
    // The product of both is the area: stable where they differ much.
    const float area2 = std::max(0.0f, uu * vv - uv * uv);
    return {std::sqrt(area2 / most2), std::sqrt(most2)};
}

std::optional<Vec2> footprint_offset(const Seen& seen, Vec3 offset) {
    const Vec3 u(seen.dpdx), v(seen.dpdy);
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return {};
    const double du = glm::dot(offset, u), dv = glm::dot(offset, v);
    return Vec2(vv * du - uv * dv, uu * dv - uv * du) / determinant;
}

} // namespace pnr
