// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, "Normal", for what they look like; their numbers were measured against POV-Ray's pictures.
#include "core/normal_bumps.h"

#include "core/noise.h"
#include "core/pattern_values.h"
#include "core/picture.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Vec3 bumps(const Vec3& p) { return noise_vector(p); }

Vec3 dents(const Vec3& p, int generator) {
    const double depth = noise(p, generator);
    return depth * depth * depth * noise_vector(p);
}

Vec3 wrinkles(const Vec3& p) {
    Vec3 sum(0);
    double scale = 1;
    for (int octave = 0; octave < 10; ++octave, scale *= 2) sum += glm::abs(noise_vector(p * scale)) / scale;
    return sum;
}

// The mean of rings about each of the sources. Those of `waves` have frequencies of their own, and the slower are the higher.
Vec3 rings(const Pattern& pattern, Vec3 p, bool waves) {
    Vec3 sum(0);
    for (int i = 0; i < pattern.number_of_waves; ++i) {
        const WaveSource& source = wave_sources()[static_cast<std::size_t>(i)];
        const double frequency = waves ? source.frequency : 1;
        const Vec3 way = p - source.center;
        const double length = glm::length(way);
        if (!(length > 0)) continue;
        sum += way * (cycloid(length * pattern.frequency * frequency + pattern.phase) / (frequency * length));
    }
    return sum / static_cast<double>(std::max(1, pattern.number_of_waves));
}

// ---- pictures

double brightness(const ImagePattern& picture, Vec3 point) {
    const glm::vec4 c = picture_at(picture, point).value_or(glm::vec4(0));
    return 0.297 * static_cast<double>(c.x) + 0.589 * static_cast<double>(c.y) + 0.114 * static_cast<double>(c.z);
}

// A picture that is a bump_map; an image_pattern is a pattern like any other.
const ImagePattern* bump_map_of(const Normal& normal) {
    const auto* picture = std::get_if<ImagePattern>(&normal.pattern.kind);
    return picture && picture->is_map ? picture : nullptr;
}

// The size of a pixel along the picture's two axes, at a point of pattern space.
Vec2 pixel_size(const ImagePattern& picture, Vec3 p) {
    const int width = picture.image ? picture.image->width : 0, height = picture.image ? picture.image->height : 0;
    if (width <= 0 || height <= 0) return {0, 0};
    Vec2 whole(1, 1);
    if (picture.map_type == ImageMapType::spherical || picture.map_type == ImageMapType::cylindrical)
        whole.x = 2 * pi * std::hypot(p.x, p.z);
    if (picture.map_type == ImageMapType::spherical) whole.y = pi * glm::length(p);
    return whole / Vec2(width, height);
}

// The plane through the heights of three pixels: the one at the point and those a row below to its left and right. A pixel is
// as wide as white is high. Whatever way the surface looks, the picture's rows lie level on it.
Vec3 picture_slope(const ImagePattern& picture, Vec3 p, Vec3 n) {
    const Vec3 up(0, 1, 0);
    Vec3 right = glm::cross(n, up);
    right = glm::length(right) > 1e-9 ? glm::normalize(right) : Vec3(1, 0, 0);
    const Vec3 along = glm::normalize(glm::cross(right, n));
    const Vec2 pixel = pixel_size(picture, p);
    const bool flat = picture.map_type == ImageMapType::planar;
    const auto height_at = [&](double x, double y) {
        return brightness(picture, p + (flat ? Vec3(x * pixel.x, y * pixel.y, 0) : x * pixel.x * right + y * pixel.y * along));
    };
    const double middle = height_at(0, 0), east = height_at(1, -1), west = height_at(-1, -1);
    return -0.5 * (east - west) * right - (middle - 0.5 * (east + west)) * along;
}

// The slope of a quilt's cubic between two control values, rising from 0 to 1 over the half diagonal of a unit cube.
Vec3 quilt(const QuiltedPattern& kind, Vec3 p) {
    const Vec3 from_center = p - glm::floor(p) - Vec3(0.5);
    const double t = glm::length(from_center), s = 1 - t;
    return from_center * ((3 * s * s * t * kind.control0 + 3 * s * t * t * kind.control1 + t * t * t) * 2 / std::sqrt(3.0));
}

} // namespace

bool has_bump_vector(const Normal& normal) {
    if (bump_map_of(normal) || std::holds_alternative<QuiltedPattern>(normal.pattern.kind)) return true;
    const auto* plain = std::get_if<PlainPattern>(&normal.pattern.kind);
    if (!plain) return false;
    switch (plain->kind) {
    case PlainKind::bumps:
    case PlainKind::dents:
    case PlainKind::wrinkles:
    case PlainKind::ripples:
    case PlainKind::waves:
        return true;
    default:
        return false;
    }
}

Vec3 bumped(const Normal& normal, const SurfacePoint& here, Vec3 n) {
    if (const ImagePattern* picture = bump_map_of(normal)) return n + normal.size * picture_slope(*picture, here.point, n);
    if (const auto* quilted = std::get_if<QuiltedPattern>(&normal.pattern.kind))
        return n + normal.size * quilt(*quilted, here.point);
    const auto* plain = std::get_if<PlainPattern>(&normal.pattern.kind);
    switch (plain->kind) {
    case PlainKind::dents:
        return n + normal.size * dents(here.point, normal.pattern.noise_generator);
    case PlainKind::wrinkles:
        return n + normal.size * wrinkles(here.point);
    case PlainKind::ripples:
        return n + normal.size * rings(normal.pattern, here.point, false);
    case PlainKind::waves:
        return n + normal.size * rings(normal.pattern, here.point, true);
    default:
        return n + normal.size * bumps(here.point);
    }
}

} // namespace pnr
