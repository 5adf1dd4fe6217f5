// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas fitted to what POV-Ray 3.7.0.10 prints of functions of warped patterns.
#include "core/warp.h"

#include "core/noise.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Vec3 repeat(const RepeatWarp& warp, Vec3 p) {
    const int axis = warp.axis;
    const double slab = std::floor(p[axis] / warp.width);
    const bool mirrored = std::fmod(std::abs(slab), 2.0) == 1;
    p[axis] -= slab * warp.width;
    if (mirrored) {
        if (warp.flip[axis] < 0) p[axis] -= warp.width;
        p *= warp.flip;
    }
    return p + slab * warp.offset;
}

Vec3 black_hole(const BlackHoleWarp& warp, Vec3 p) {
    Vec3 center = warp.center;
    if (warp.repeat) {
        Vec3 block(0);
        for (int i = 0; i < 3; ++i)
            if (warp.repeat_size[i] != 0) block[i] = std::floor(p[i] / warp.repeat_size[i]);
        center += warp.turbulence * cell_numbers(block) + block * warp.repeat_size;
    }
    const Vec3 away = p - center;
    const double depth = 1 - glm::length(away) / warp.radius; // 0 at the rim, 1 at the centre
    if (!(depth > 0)) return p;
    const double pull = std::min(1.0, std::pow(depth, warp.falloff) * warp.strength);
    return p + away * (warp.inverse ? -pull : pull);
}

double turns(double y, double x) {
    const double t = std::atan2(y, x) / (2 * pi);
    return t < 0 ? t + 1 : t;
}

// A net of the cube, four squares wide and three high: -x, +z, +x, -z in the middle row, +y above and -y
// below +z.
Vec3 cubic(Vec3 p) {
    const Vec3 a = glm::abs(p);
    if (a.x >= a.y && a.x >= a.z) {
        if (a.x == 0) return Vec3(0);
        const bool front = p.x > 0;
        const double along = (front ? -p.z : p.z) / a.x;
        return {((front ? 2 : 0) + (1 + along) / 2) / 4, (1 + (1 + p.y / a.x) / 2) / 3, a.x};
    }
    if (a.y >= a.z) {
        const bool up = p.y > 0;
        const double along = (up ? -p.z : p.z) / a.y;
        return {(1 + (1 + p.x / a.y) / 2) / 4, ((up ? 2 : 0) + (1 + along) / 2) / 3, a.y};
    }
    const bool far = p.z > 0;
    const double along = (far ? p.x : -p.x) / a.z;
    return {((far ? 1 : 3) + (1 + along) / 2) / 4, (1 + (1 + p.y / a.z) / 2) / 3, a.z};
}

// u, v and the distance from the shape.
Vec3 unrolled(const MapWarp& warp, Vec3 p) {
    switch (warp.shape) {
    case MapShape::spherical: {
        const double r = glm::length(p);
        const double latitude = r > 0 ? std::asin(std::clamp(p.y / r, -1.0, 1.0)) : 0;
        const double stretch = std::pow(r, warp.dist_exp);
        return {turns(p.z, p.x) * stretch, (0.5 + latitude / pi) * stretch, r};
    }
    case MapShape::cylindrical: {
        const double r = std::hypot(p.x, p.z);
        return {turns(p.z, p.x) * std::pow(r, warp.dist_exp), p.y, r};
    }
    case MapShape::toroidal: {
        const double ring = std::hypot(p.x, p.z) - warp.major_radius, r = std::hypot(ring, p.y);
        const double stretch = std::pow(r, warp.dist_exp);
        return {turns(p.z, p.x) * stretch, (0.5 + std::atan2(p.y, ring) / (2 * pi)) * stretch, r};
    }
    case MapShape::planar:
        return {p.x, p.y, warp.distance};
    case MapShape::cubic:
        return cubic(p);
    }
    return p;
}

// POV-Ray's way from the z axis to the orientation: exact for the axes, a mixture of them between.
Vec3 oriented(const MapWarp& warp, Vec3 q) {
    if (warp.shape == MapShape::cubic) return q;
    const Vec3 o = warp.orientation;
    return {o.x * q.z + (o.y + o.z) * q.x, (o.x + o.z) * q.y - o.y * q.z, o.y * q.y + o.z * q.z - o.x * q.x};
}

struct Bend {
    Vec3 p;

    Vec3 operator()(const Turbulence& warp) const { return p + warp.amount * turbulence_vector(p, warp); }
    Vec3 operator()(const RepeatWarp& warp) const { return repeat(warp, p); }
    Vec3 operator()(const BlackHoleWarp& warp) const { return black_hole(warp, p); }
    Vec3 operator()(const MapWarp& warp) const { return oriented(warp, unrolled(warp, p)); }
    Vec3 operator()(const TransformWarp& warp) const { return transform_point(warp.transform.inverse, p); }
};

} // namespace

Vec3 warp_point(const Warp& warp, Vec3 point) { return std::visit(Bend{point}, warp); }

} // namespace pnr
