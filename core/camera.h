// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays and back.
#pragma once

#include "core/types.h"

#include <memory>
#include <optional>
#include <vector>

namespace pnr {

struct MeshView; // mesh_view.h

// POV-Ray's camera types. cylinder_1 and cylinder_3 are upright cylinders, _2 and _4 lying ones; the eye of the last two
// moves along the axis. mesh: rays start on the faces of meshes.
enum class Projection {
    perspective,
    orthographic,
    fisheye,
    ultra_wide_angle,
    omnimax,
    panoramic,
    spherical,
    cylinder_1,
    cylinder_2,
    cylinder_3,
    cylinder_4,
    mesh
};

// Focal blur: rays start on a disc about the location, at right angles to the direction, whose diameter is half the
// aperture, and meet those from the location on the plane at `distance` along the direction.
struct Lens {
    double aperture = 0; // 0: a pinhole
    double distance = 1;
    int samples_min = 0, samples_max = 0; // POV-Ray's blur_samples; as many rays a pixel
    double confidence = 0.9, variance = 1.0 / 128;
};

// POV-Ray's camera after look_at, angle and transforms. The picture plane's point (x, y) in [-1/2, 1/2]^2 (y up) is seen
// along direction + x right + y up from location (perspective), or along direction from location + x right + y up.
// How the other types see it is in grammar/references.md, "Cameras".
struct Camera {
    Projection projection = Projection::perspective;
    Vec3 location{0};
    Vec3 direction{0, 0, 1};
    Vec3 right{1.33, 0, 0};
    Vec3 up{0, 1, 0};
    double h_angle = 90, v_angle = 90; // degrees seen across and up; of the types whose rays are spaced by angle
    Lens lens;
    std::shared_ptr<const MeshView> mesh;
    Vec3 mesh_offset{0}; // added to the meshes' points: scene to world
};

// A camera and the size of the picture it fills. Pixel coordinates: x right, y down, (0.5, 0.5) is the centre of the
// top left pixel.
struct PictureView {
    Camera camera;
    int width = 1, height = 1;
};

// Unit direction; t_min 0. t_max < 0: the camera sees nothing there (outside a fisheye's circle, a mesh without a face).
Ray pixel_ray(const PictureView& view, Vec2 pixel);
inline bool sees_nothing(const Ray& camera_ray) { return camera_ray.t_max < 0; }
// The ray through the lens' point `on_lens` of the unit disc; pixel_ray if the camera has no aperture.
Ray lens_ray(const PictureView& view, Vec2 pixel, Vec2 on_lens);

struct Projected {
    Vec2 pixel;
    double distance; // along the camera ray, > 0
};
// Where a point is seen; nothing if it lies behind the camera (or the camera is degenerate), or where the camera shows
// meshes: there is no inverse then. It may be off the picture. Of a lens: as through its middle.
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
