// SPDX-License-Identifier: GPL-3.0-or-later
// The types' rules were found by letting POV-Ray 3.7.0.10 draw a sphere about the camera whose colour is the
// direction. Polynomial of omnimax: POV-Ray 3.7 documentation, "Omnimax projection".
#include "core/camera.h"

#include "core/mesh_view.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

double radians(double degrees) { return degrees * (pi / 180); }

// The camera's vectors as its type measures along them: as they are, or unit.
struct Axes {
    Vec3 right, up, direction;
};

Axes axes_of(const Camera& c) {
    const auto unit = [](Vec3 v) { return glm::normalize(v); };
    switch (c.projection) {
    case Projection::perspective:
    case Projection::orthographic:
    case Projection::panoramic:
    case Projection::mesh:
        return {c.right, c.up, c.direction};
    case Projection::cylinder_1:
    case Projection::cylinder_3:
        return {unit(c.right), c.up, unit(c.direction)};
    case Projection::cylinder_2:
    case Projection::cylinder_4:
        return {c.right, unit(c.up), unit(c.direction)};
    default:
        return {unit(c.right), unit(c.up), unit(c.direction)};
    }
}

// Coordinates along the axes; nothing if they do not span space.
std::optional<Vec3> in_axes(const Axes& axes, Vec3 v) {
    const Vec3 up_direction = glm::cross(axes.up, axes.direction);
    const double volume = glm::dot(axes.right, up_direction);
    if (volume == 0 || !std::isfinite(volume)) return std::nullopt;
    return Vec3(glm::dot(v, up_direction), glm::dot(v, glm::cross(axes.direction, axes.right)),
                glm::dot(v, glm::cross(axes.right, axes.up))) /
           volume;
}

// ---- round pictures: a place (a, b) within the unit circle stands for an angle from the lens' axis
// ----------------------------------------------------------------------------------------------------------

// The omnimax lens' picture is larger than ours and stands lower.
constexpr double omnimax_share = 0.78, omnimax_shift = 0.22;

double omnimax_angle(double r) {
    const double r2 = r * r;
    return r * (1.411269 + r2 * (-0.094389 + r2 * 0.25674125));
}

double omnimax_radius(double angle) { // Newton: the slope is never less than 1.4
    double r = angle / 1.5;
    for (int i = 0; i < 24; ++i) {
        const double r2 = r * r;
        r -= (omnimax_angle(r) - angle) / (1.411269 + r2 * (-0.283167 + r2 * 1.28370625));
    }
    return r;
}

double omnimax_stretch(const Camera& c) { return 2 * omnimax_share * glm::length(c.right) / glm::length(c.up); }

// Its foot is cut off by the ellipse that a picture of 4 : 3 holds.
bool within_omnimax(const Camera& c, double x, double y) {
    const double a = 2 * x * glm::length(c.right) / glm::length(c.up) * 0.75, b = 2 * y;
    return a * a + b * b <= 1;
}

Vec3 round_direction(double a, double b, double angle_of_1, bool omnimax) {
    const double r = std::hypot(a, b);
    if (r > 1) return Vec3(0);
    if (r == 0) return {0, 0, 1};
    const double angle = omnimax ? omnimax_angle(r) : r * angle_of_1;
    return {a / r * std::sin(angle), b / r * std::sin(angle), std::cos(angle)};
}

// ---- rays
// -----------------------------------------------------------------------------------------------------

// The direction in the axes; zero where nothing is seen. x and y in [-1/2, 1/2].
Vec3 direction_in_axes(const Camera& c, double x, double y) {
    const double ax = x * radians(c.h_angle), ay = y * radians(c.v_angle);
    switch (c.projection) {
    case Projection::perspective:
        return {x, y, 1};
    case Projection::orthographic:
    case Projection::mesh:
        return {0, 0, 1};
    case Projection::fisheye:
        return round_direction(2 * x * glm::length(c.right), 2 * y * glm::length(c.up),
                               radians(c.h_angle) / 2, false);
    case Projection::omnimax:
        if (!within_omnimax(c, x, y)) return Vec3(0);
        return round_direction(x * omnimax_stretch(c), 2 * omnimax_share * y + omnimax_shift, 0, true);
    case Projection::ultra_wide_angle:
        return {std::sin(ax), std::sin(ay), std::cos(ax) * std::cos(ay)};
    case Projection::panoramic:
        return {std::sin(pi * x), std::tan(pi * y), std::cos(pi * x)};
    case Projection::spherical:
        return {std::sin(ax) * std::cos(ay), std::sin(ay), std::cos(ax) * std::cos(ay)};
    case Projection::cylinder_1:
        return {std::sin(ax), y, std::cos(ax)};
    case Projection::cylinder_2:
        return {x, std::sin(ay), std::cos(ay)};
    case Projection::cylinder_3:
        return {std::sin(ax), 0, std::cos(ax)};
    case Projection::cylinder_4:
        return {0, std::sin(ay), std::cos(ay)};
    }
    return Vec3(0);
}

Vec3 origin_in_axes(const Camera& c, double x, double y) {
    switch (c.projection) {
    case Projection::orthographic:
        return {x, y, 0};
    case Projection::cylinder_3:
        return {0, y, 0};
    case Projection::cylinder_4:
        return {x, 0, 0};
    default:
        return Vec3(0);
    }
}

Vec3 from_axes(const Axes& axes, Vec3 v) { return v.x * axes.right + v.y * axes.up + v.z * axes.direction; }

constexpr Ray nothing_seen{{0, 0, 0}, {0, 0, 1}, 0, -1};

// ---- and back
// -------------------------------------------------------------------------------------------------

// Where on the picture plane a point is seen whose coordinates in the axes, from the location, are v; nothing if it is not.
std::optional<Vec2> on_picture_plane(const Camera& c, Vec3 v) {
    const double h = radians(c.h_angle), up_angle = radians(c.v_angle);
    const auto away = [&v] { return std::hypot(v.x, v.y); };
    switch (c.projection) {
    case Projection::perspective:
        if (!(v.z > 0)) return std::nullopt;
        return Vec2(v.x / v.z, v.y / v.z);
    case Projection::orthographic:
        if (!(v.z > 0)) return std::nullopt;
        return Vec2(v.x, v.y);
    case Projection::fisheye:
    case Projection::omnimax: {
        const double angle = std::atan2(away(), v.z);
        const bool omnimax = c.projection == Projection::omnimax;
        const double r = omnimax ? omnimax_radius(angle) : angle / (h / 2);
        if (!(r <= 1)) return std::nullopt;
        const Vec2 ab = away() > 0 ? r / away() * Vec2(v.x, v.y) : Vec2(0);
        if (omnimax) {
            const Vec2 p(ab.x / omnimax_stretch(c), (ab.y - omnimax_shift) / (2 * omnimax_share));
            return within_omnimax(c, p.x, p.y) ? std::optional(p) : std::nullopt;
        }
        return ab / (2.0 * Vec2(glm::length(c.right), glm::length(c.up)));
    }
    case Projection::ultra_wide_angle: { // v = s (sin ax, sin ay, cos ax cos ay); s^2 solves a quadratic equation
        const double l = glm::dot(v, v);
        const double s = std::sqrt((l + std::sqrt(std::max(0.0, l * l - 4 * v.x * v.x * v.y * v.y))) / 2);
        if (!(s > 0)) return std::nullopt;
        const double cy = std::sqrt(std::max(0.0, 1 - v.y * v.y / (s * s)));
        return Vec2(std::atan2(v.x, v.z / std::max(cy, 1e-300)) / h, std::asin(std::clamp(v.y / s, -1.0, 1.0)) / up_angle);
    }
    case Projection::panoramic:
        return Vec2(std::atan2(v.x, v.z) / pi, std::atan2(v.y, std::hypot(v.x, v.z)) / pi);
    case Projection::spherical:
        return Vec2(std::atan2(v.x, v.z) / h, std::atan2(v.y, std::hypot(v.x, v.z)) / up_angle);
    case Projection::cylinder_1:
        return Vec2(std::atan2(v.x, v.z) / h, v.y / std::hypot(v.x, v.z));
    case Projection::cylinder_2:
        return Vec2(v.x / std::hypot(v.y, v.z), std::atan2(v.y, v.z) / up_angle);
    case Projection::cylinder_3:
        return Vec2(std::atan2(v.x, v.z) / h, v.y);
    case Projection::cylinder_4:
        return Vec2(v.x, std::atan2(v.y, v.z) / up_angle);
    case Projection::mesh:
        return std::nullopt;
    }
    return std::nullopt;
}

} // namespace

Ray pixel_ray(const PictureView& view, Vec2 pixel) {
    const Camera& c = view.camera;
    if (c.mesh) return mesh_view_ray(*c.mesh, c, pixel, view.width, view.height);
    const double x = pixel.x / view.width - 0.5;
    const double y = 0.5 - pixel.y / view.height;
    const Axes axes = axes_of(c);
    const Vec3 direction = direction_in_axes(c, x, y);
    if (direction == Vec3(0)) return nothing_seen;
    return {c.location + from_axes(axes, origin_in_axes(c, x, y)),
            glm::normalize(from_axes(axes, direction)), 0, infinity};
}

Ray lens_ray(const PictureView& view, Vec2 pixel, Vec2 on_lens) {
    const Camera& c = view.camera;
    Ray ray = pixel_ray(view, pixel);
    if (!(c.lens.aperture > 0) || sees_nothing(ray)) return ray;
    const Vec3 forward = glm::normalize(c.direction);
    const double along = glm::dot(ray.direction, forward);
    if (!(along > 1e-6)) return ray;
    const Vec3 sharp = ray.origin + ray.direction * (c.lens.distance / along);
    const Vec3 across = glm::normalize(glm::cross(forward, c.up));
    ray.origin += c.lens.aperture / 4 * (on_lens.x * across + on_lens.y * glm::cross(across, forward));
    ray.direction = glm::normalize(sharp - ray.origin);
    return ray;
}

std::optional<Projected> project(const PictureView& view, Vec3 point) {
    const Camera& c = view.camera;
    if (c.mesh) return std::nullopt;
    const Axes axes = axes_of(c);
    const auto v = in_axes(axes, point - c.location);
    if (!v) return std::nullopt;
    const auto p = on_picture_plane(c, *v);
    if (!p || !std::isfinite(p->x) || !std::isfinite(p->y)) return std::nullopt;
    const Vec3 from = from_axes(axes, origin_in_axes(c, p->x, p->y));
    return Projected{{(p->x + 0.5) * view.width, (0.5 - p->y) * view.height},
                     glm::length(point - c.location - from)};
}

Vec2 project_direction(const PictureView& view, Vec3 point, Vec3 direction) {
    const Camera& c = view.camera;
    const auto here = project(view, point);
    if (!here) return Vec2(0);
    const bool perspective = c.projection == Projection::perspective;
    if (perspective || c.projection == Projection::orthographic) {
        const auto v = in_axes(axes_of(c), point - c.location), d = in_axes(axes_of(c), direction);
        // Perspective: x = X / w, so dx = (dX - x dw) / w.
        const Vec2 moved = perspective ? Vec2(d->x - v->x / v->z * d->z, d->y - v->y / v->z * d->z) / v->z : Vec2(*d);
        return {moved.x * view.width, -moved.y * view.height};
    }
    const double length = glm::length(direction), h = 1e-5 * here->distance;
    if (!(length > 0)) return Vec2(0);
    const auto there = project(view, point + direction * (h / length)), back = project(view, point - direction * (h / length));
    if (!there || !back) return Vec2(0);
    return (there->pixel - back->pixel) * (length / (2 * h));
}

PictureSize default_size(const Camera& camera) {
    const double ratio = glm::length(camera.up) / glm::length(camera.right);
    if (!std::isfinite(ratio)) return {512, 512};
    return {512, static_cast<int>(std::lround(std::clamp(512 * ratio, 1.0, 65536.0)))};
}

} // namespace pnr
