// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/normal.h"

#include "core/normal_bumps.h"
#include "core/pigment.h"

#include <array>
#include <cmath>

namespace pnr {

namespace {

// ---- to pattern space and back. A scaled normal's bumps are scaled in depth as in width, so that their slopes stay, unless
// `no_bump_scale` is said: the normal gets its length back at each transform, or keeps what the transform made of it
// [POV-Ray 3.7 reference, "Scaling normals"; both measured].

Vec3 restored(Vec3 n, bool scale_bumps) {
    const double length = glm::length(n);
    return scale_bumps && length > 0 && std::isfinite(length) ? n / length : n;
}

Vec3 go_in(const Transform& t, Vec3 n, bool scale_bumps) {
    return restored(Vec3(glm::transpose(t.matrix) * glm::dvec4(n, 0)), scale_bumps);
}

Vec3 go_out(const Transform& t, Vec3 n, bool scale_bumps) {
    return restored(transform_normal(t, n), scale_bumps);
}

Vec3 into_pattern(const Normal& normal, Vec3 n) {
    const Pattern& pattern = normal.pattern;
    n = go_in(pattern.transform, restored(n, normal.scale_bumps), normal.scale_bumps);
    for (auto warp = pattern.warps.rbegin(); warp != pattern.warps.rend(); ++warp)
        if (const auto* transform = std::get_if<TransformWarp>(&*warp))
            n = go_in(transform->transform, n, normal.scale_bumps);
    return n;
}

Vec3 out_of_pattern(const Normal& normal, Vec3 n) {
    const Pattern& pattern = normal.pattern;
    for (const Warp& warp : pattern.warps)
        if (const auto* transform = std::get_if<TransformWarp>(&warp))
            n = go_out(transform->transform, n, normal.scale_bumps);
    return go_out(pattern.transform, n, normal.scale_bumps);
}

// ---- heights

// The cubic through the two entries about a value, with their slopes over that stretch taken as one.
double slope_height(const std::vector<SlopeStop>& stops, double value) {
    const BlendSpot spot = look_up(stops, value);
    const SlopeStop &low = stops[spot.low], &high = stops[spot.high];
    if (spot.low == spot.high) return low.height;
    const double t = spot.weight, t2 = t * t, t3 = t2 * t;
    return low.height * (2 * t3 - 3 * t2 + 1) + low.slope * (t3 - 2 * t2 + t) + high.height * (3 * t2 - 2 * t3) +
           high.slope * (t3 - t2);
}

double height(const Normal& normal, const SurfacePoint& here) {
    const double value = eval_pattern_here(normal.pattern, here);
    return normal.slopes.empty() ? value : slope_height(normal.slopes, value);
}

// Against the gradient, by the values at the corners of a tetrahedron about the point: their sum times the corners' directions
// is 4/3 of the gradient, times the distance. POV-Ray's bumps are 0.1 high. Warps have been left behind: they move the corners
// with the point.
Vec3 bump_by_gradient(const Normal& normal, const SurfacePoint& here) {
    static const std::array<Vec3, 4> corners{
        Vec3(std::sqrt(8.0) / 3, -1.0 / 3, 0), Vec3(-std::sqrt(2.0) / 3, -1.0 / 3, std::sqrt(2.0 / 3)),
        Vec3(-std::sqrt(2.0) / 3, -1.0 / 3, -std::sqrt(2.0 / 3)), Vec3(0, 1, 0)};
    Vec3 sum(0);
    for (const Vec3& corner : corners) {
        SurfacePoint there = here;
        there.point += normal.accuracy * corner;
        sum += height(normal, there) * corner;
    }
    return -0.1 * normal.size / normal.accuracy * sum;
}

bool is_average(const Normal& normal) { return std::holds_alternative<AveragePattern>(normal.pattern.kind); }

// Of the normals that a map picks; n is in pattern space.
Vec3 picked_normal(const Normal& normal, const SurfacePoint& here, Vec3 n) {
    SurfacePoint inner = here;
    inner.normal = n;
    const auto& list = normal.normals;
    if (is_average(normal)) {
        Vec3 sum(0);
        for (const auto& entry : list) sum += entry.position * perturb_normal(entry.value, inner);
        return sum;
    }
    const double value = eval_pattern_here(normal.pattern, here);
    const BlendSpot spot = look_up(list, value, is_list_pattern(normal.pattern));
    const Vec3 low = perturb_normal(list[spot.low].value, inner);
    if (spot.low == spot.high) return low;
    return (1 - spot.weight) * low + spot.weight * perturb_normal(list[spot.high].value, inner);
}

} // namespace

void transform_bumps(Normal& normal, const Transform& by) { transform_pattern(normal.pattern, by); }

Vec3 perturb_normal(const Normal& normal, const SurfacePoint& at) {
    if (normal.normals.empty() && std::holds_alternative<UniformPattern>(normal.pattern.kind)) return at.normal;
    const Vec3 n = into_pattern(normal, at.normal);
    const SurfacePoint here = to_pattern_space(normal.pattern, at);
    Vec3 turned;
    if (!normal.normals.empty())
        turned = picked_normal(normal, here, n);
    else if (has_bump_vector(normal))
        turned = bumped(normal, here, n);
    else
        turned = n + bump_by_gradient(normal, here);
    turned = out_of_pattern(normal, turned);
    const double length = glm::length(turned);
    return length > 0 && std::isfinite(length) ? turned / length : at.normal;
}

} // namespace pnr
