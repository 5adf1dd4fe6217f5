// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays and back.
#pragma once

#include "core/types.h"

#include <optional>

namespace pnr {

enum class Projection { perspective, orthographic };

// POV-Ray's camera after look_at, angle and transforms. The picture plane's point (x, y) in [-1/2, 1/2]^2 (y up) is seen
// along direction + x right + y up from location (perspective), or along direction from location + x right + y up.
struct Camera {
    Projection projection = Projection::perspective;
    Vec3 location{0};
    Vec3 direction{0, 0, 1};
    Vec3 right{1.33, 0, 0};
    Vec3 up{0, 1, 0};
};

// A camera and the size of the picture it fills. Pixel coordinates: x right, y down, (0.5, 0.5) is the centre of the
// top left pixel.
struct PictureView {
    Camera camera;
    int width = 1, height = 1;
};

// Unit direction; t_min 0.
Ray pixel_ray(const PictureView& view, Vec2 pixel);

struct Projected {
    Vec2 pixel;
    double distance; // along the camera ray, > 0
};
// Where a point is seen; nothing if it lies behind the camera (or the camera is degenerate). It may be off the picture.
std::optional<Projected> project(const PictureView& view, Vec3 point);

// The derivative of the pixel position when the seen point moves along `direction`: pixels per unit; zero vector if
// the point is not in front of the camera.
Vec2 project_direction(const PictureView& view, Vec3 point, Vec3 direction);

// Pixel size of the picture when only the camera is known: width 512, height 512 |up| / |right|, rounded, at least 1.
struct PictureSize {
    int width, height;
};
PictureSize default_size(const Camera& camera);

} // namespace pnr
