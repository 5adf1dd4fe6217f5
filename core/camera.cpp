// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// A point in the camera's own coordinates: (x, y) of the picture plane and the depth in units of |direction|.
struct PlanePoint {
    double x, y, depth;
};

// Solves offset = x right + y up + depth direction (orthographic), or with x and y multiplied by depth
// (perspective). Nothing if the three vectors do not span space.
std::optional<Vec3> in_camera_frame(const Camera& camera, Vec3 offset) {
    const Vec3 up_direction = glm::cross(camera.up, camera.direction);
    const double volume = glm::dot(camera.right, up_direction);
    if (volume == 0 || !std::isfinite(volume)) return std::nullopt;
    return Vec3(glm::dot(offset, up_direction), glm::dot(offset, glm::cross(camera.direction, camera.right)),
                glm::dot(offset, glm::cross(camera.right, camera.up))) /
           volume;
}

std::optional<PlanePoint> on_picture_plane(const Camera& camera, Vec3 point) {
    const auto c = in_camera_frame(camera, point - camera.location);
    if (!c || !(c->z > 0)) return std::nullopt;
    const double w = camera.projection == Projection::perspective ? c->z : 1;
    const PlanePoint p{c->x / w, c->y / w, c->z};
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
    return p;
}

} // namespace

Ray pixel_ray(const PictureView& view, Vec2 pixel) {
    const Camera& c = view.camera;
    const double x = pixel.x / view.width - 0.5;
    const double y = 0.5 - pixel.y / view.height;
    const Vec3 across = x * c.right + y * c.up;
    if (c.projection == Projection::orthographic)
        return {c.location + across, glm::normalize(c.direction), 0, infinity};
    return {c.location, glm::normalize(c.direction + across), 0, infinity};
}

std::optional<Projected> project(const PictureView& view, Vec3 point) {
    const auto p = on_picture_plane(view.camera, point);
    if (!p) return std::nullopt;
    const double distance = view.camera.projection == Projection::perspective
                                ? glm::length(point - view.camera.location)
                                : p->depth * glm::length(view.camera.direction);
    return Projected{{(p->x + 0.5) * view.width, (0.5 - p->y) * view.height}, distance};
}

Vec2 project_direction(const PictureView& view, Vec3 point, Vec3 direction) {
    const auto p = on_picture_plane(view.camera, point);
    const auto d = in_camera_frame(view.camera, direction);
    if (!p || !d) return Vec2(0);
    // Perspective: x = X / w, so dx = (dX - x dw) / w.
    const bool perspective = view.camera.projection == Projection::perspective;
    const double dx = perspective ? (d->x - p->x * d->z) / p->depth : d->x;
    const double dy = perspective ? (d->y - p->y * d->z) / p->depth : d->y;
    return {dx * view.width, -dy * view.height};
}

PictureSize default_size(const Camera& camera) {
    const double ratio = glm::length(camera.up) / glm::length(camera.right);
    if (!std::isfinite(ratio)) return {512, 512};
    return {512, static_cast<int>(std::lround(std::clamp(512 * ratio, 1.0, 65536.0)))};
}

} // namespace pnr
