// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

// Where a point lies in the picture: u to the right, v up, the picture is the unit square.
struct PictureSpot {
    Vec2 uv{0};
    bool inside = true; // false: outside a picture that is shown once
};

double angle_about_y(Vec3 p) { // in turns, 0 at +x, a quarter at +z
    const double turns = std::atan2(p.z, p.x) / (2 * pi);
    return turns < 0 ? turns + 1 : turns;
}

PictureSpot picture_spot(const ImagePattern& pattern, Vec3 p) {
    const auto within = [](double x) { return x >= 0 && x <= 1; };
    switch (pattern.map_type) {
    case ImageMapType::planar:
        return {{p.x, p.y}, !pattern.once || (within(p.x) && within(p.y))};
    case ImageMapType::spherical: {
        const double length = glm::length(p);
        if (!(length > 0)) return {{0, 0}, false};
        return {{angle_about_y(p), 0.5 + std::asin(std::clamp(p.y / length, -1.0, 1.0)) / pi}, true};
    }
    case ImageMapType::cylindrical:
        return {{angle_about_y(p), p.y}, !pattern.once || within(p.y)};
    case ImageMapType::torus: // about a ring of radius 1 in the xz plane
        return {{angle_about_y(p), 0.5 + std::atan2(p.y, std::hypot(p.x, p.z) - 1) / (2 * pi)}, true};
    }
    return {};
}

using Texels = Image<glm::vec4>;

struct PixelReader {
    const Texels& image;
    bool once;

    glm::vec4 operator()(int x, int y) const {
        const auto place = [this](int i, int n) {
            return once ? std::clamp(i, 0, n - 1) : ((i % n) + n) % n;
        };
        return image.at(place(x, image.width), place(y, image.height));
    }
};

// Weights of four pixels in a row for a place t between the middle two [Catmull and Rom 1974].
std::array<float, 4> cubic_weights(float t) {
    return {t * (-0.5f + t * (1 - 0.5f * t)), 1 + t * t * (-2.5f + 1.5f * t), t * (0.5f + t * (2 - 1.5f * t)),
            t * t * (-0.5f + 0.5f * t)};
}

glm::vec4 bicubic(const PixelReader& texel, int i, int j, float s, float t) {
    const auto wx = cubic_weights(s), wy = cubic_weights(t);
    glm::vec4 sum(0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            sum += wx[static_cast<std::size_t>(x)] * wy[static_cast<std::size_t>(y)] *
                   texel(i - 1 + x, j - 1 + y);
    return sum;
}

// The four nearest, by the inverse of their squared distance.
glm::vec4 by_distance(const PixelReader& texel, int i, int j, float s, float t) {
    glm::vec4 sum(0);
    float weights = 0;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
            const float dx = s - static_cast<float>(x), dy = t - static_cast<float>(y);
            const float weight = 1 / std::max(dx * dx + dy * dy, 1e-12f);
            sum += weight * texel(i + x, j + y);
            weights += weight;
        }
    return sum / weights;
}

} // namespace

std::optional<glm::vec4> picture_at(const ImagePattern& pattern, Vec3 point) {
    if (!pattern.image || pattern.image->empty()) return std::nullopt;
    const PictureSpot spot = picture_spot(pattern, point);
    if (!spot.inside || !std::isfinite(spot.uv.x) || !std::isfinite(spot.uv.y)) return std::nullopt;
    const PixelReader texel{*pattern.image, pattern.once};
    // Into the unit square first: far tiles would overflow an int.
    const auto tile = [&](double x) { return pattern.once ? x : x - std::floor(x); };
    const double x = tile(spot.uv.x) * texel.image.width;
    const double y = (1 - tile(spot.uv.y)) * texel.image.height;
    if (pattern.interpolation == Interpolation::none)
        return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    // Between the four nearest pixel centres.
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const float s = static_cast<float>(x - 0.5 - left), t = static_cast<float>(y - 0.5 - top);
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    switch (pattern.interpolation) {
    case Interpolation::bicubic:
        return bicubic(texel, i, j, s, t);
    case Interpolation::distance:
        return by_distance(texel, i, j, s, t);
    default:
        return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), s),
                        glm::mix(texel(i, j + 1), texel(i + 1, j + 1), s), t);
    }
}

} // namespace pnr
