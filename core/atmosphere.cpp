// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, "Atmospheric effects"; what it does not print was measured against POV-Ray 3.7.0.10 one
// ray at a time.
#include "core/atmosphere.h"

#include "core/noise.h"
#include "core/world.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// POV-Ray's distance to what is beyond all objects.
constexpr double far_away = 1e7;

// The mean of 1 / (1 + h^2), the ground fog's density at height h over its border (1 below it), between two heights.
double mean_density(double a, double b) {
    if (a > b) std::swap(a, b);
    if (b <= 0) return 1;
    if (b - a < 1e-6 * (1 + b)) {
        const double h = std::max(0.0, 0.5 * (a + b));
        return 1 / (1 + h * h);
    }
    const double below = std::max(0.0, -a), from = std::max(0.0, a);
    return (below + std::atan(b) - std::atan(from)) / (b - a);
}

double ground_density(const Fog& fog, const Ray& ray, double distance) {
    const double start = glm::dot(ray.origin, fog.up) - fog.offset;
    const double end = start + distance * glm::dot(ray.direction, fog.up);
    if (fog.altitude > 0) return mean_density(start / fog.altitude, end / fog.altitude);
    const double rise = std::abs(end - start); // a border without any mist above
    if (!(rise > 0)) return start <= 0 ? 1 : 0;
    return std::clamp(-std::min(start, end) / rise, 0.0, 1.0);
}

// How much thinner turbulence makes the way: less far away.
double turbulent_share(const Fog& fog, const Vec3 middle, double distance) {
    const Turbulence words{Vec3(1), fog.octaves, fog.omega, fog.lambda};
    const double swirl = turbulence(middle * fog.turbulence, words, 2);
    return 1 - std::exp(-distance / fog.distance) * std::min(1.0, swirl * fog.depth);
}

// Share of what is `distance` away that is seen.
float left_by_fog(const World& world, const Fog& fog, const Ray& ray, double distance) {
    if (!(fog.distance > 0)) return 1;
    distance = std::min(distance, far_away);
    double thinned = 1;
    if (fog.turbulence != Vec3(0))
        thinned = turbulent_share(fog, world.offset + ray.origin + distance / 2 * ray.direction, distance);
    if (fog.ground) distance *= ground_density(fog, ray, distance);
    distance *= thinned;
    return std::max(static_cast<float>(std::exp(-distance / fog.distance)), fog.color.transmit);
}

Color fog_tint(const Fog& fog) { return Color(1 - fog.color.filter) + fog.color.filter * fog.color.rgb; }

// ---- rainbow
// --------------------------------------------------------------------------------------------------

ColorFT map_color(const std::vector<ColorStop>& map, double value) {
    std::size_t next = 0;
    while (next < map.size() && map[next].position < value) ++next;
    if (next == 0) return map.front().color;
    if (next == map.size()) return map.back().color;
    const ColorStop &low = map[next - 1], &high = map[next];
    const auto t = static_cast<float>((value - low.position) / (high.position - low.position));
    return {glm::mix(low.color.rgb, high.color.rgb, t), glm::mix(low.color.filter, high.color.filter, t),
            glm::mix(low.color.transmit, high.color.transmit, t)};
}

// How much of the arc is there so far from its middle: 1 within falloff_angle, 0 from arc_angle on (full angles).
double arc_share(const Rainbow& rainbow, Vec3 direction) {
    if (rainbow.falloff_angle >= 360) return 1;
    const Vec3 right = glm::normalize(glm::cross(rainbow.up, rainbow.direction));
    const Vec3 up = glm::cross(rainbow.direction, right);
    const double turn = std::abs(std::atan2(glm::dot(direction, right), glm::dot(direction, up))) * 180 / pi;
    const double full = rainbow.falloff_angle / 2, none = rainbow.arc_angle / 2;
    if (turn <= full) return 1;
    if (turn >= none) return 0;
    const double t = (none - turn) / (none - full);
    return t * t * (3 - 2 * t);
}

Color through_rainbow(const Rainbow& rainbow, const Ray& ray, double distance, Color behind) {
    if (rainbow.map.empty() || !(rainbow.width > 0)) return behind;
    const double cosine = std::clamp(glm::dot(ray.direction, rainbow.direction), -1.0, 1.0);
    const double place = (std::acos(cosine) * 180 / pi - rainbow.angle) / rainbow.width + 0.5;
    if (!(place >= 0 && place <= 1)) return behind;
    const ColorFT color = map_color(rainbow.map, place);
    const double seen = distance < infinity ? std::exp(-distance / rainbow.distance) : 0;
    const double left = 1 - (1 - std::max(seen, static_cast<double>(color.transmit))) * arc_share(rainbow, ray.direction);
    const auto added = static_cast<float>(1 - left);
    return static_cast<float>(left) * behind * (Color(1) - color.filter * added * (Color(1) - color.rgb)) +
           added * color.rgb;
}

} // namespace

Color sky_radiance(const World& world, Vec3 direction) {
    const Atmosphere& air = world.atmosphere;
    Color below = air.background.rgb * std::max(0.0f, 1 - air.background.filter - air.background.transmit);
    for (const Pigment& layer : air.sky.layers) {
        const ColorFT c = eval_pigment(layer, SurfacePoint{direction});
        const float opacity = std::max(0.0f, 1 - c.filter - c.transmit);
        below = opacity * c.rgb * air.sky.emission + below * (c.rgb * c.filter + Color(c.transmit));
    }
    return below;
}

bool has_sky_light(const World& world) {
    const Atmosphere& air = world.atmosphere;
    return !is_black(air.background.rgb) || (!air.sky.layers.empty() && !is_black(air.sky.emission));
}

Color fog_transmittance(const World& world, const Ray& ray, double distance) {
    Color left(1);
    for (const Fog& fog : world.atmosphere.fogs)
        if (fog.distance > 0) left *= left_by_fog(world, fog, ray, distance) * fog_tint(fog);
    return left;
}

Color through_atmosphere(const World& world, const Ray& ray, double distance, Color behind) {
    const Atmosphere& air = world.atmosphere;
    for (const Rainbow& rainbow : air.rainbows) behind = through_rainbow(rainbow, ray, distance, behind);
    // Fogs dim what is behind them one after the other, but not each other.
    Color added(0);
    for (const Fog& fog : air.fogs) {
        if (!(fog.distance > 0)) continue;
        const float left = left_by_fog(world, fog, ray, distance);
        behind *= left * fog_tint(fog);
        added += (1 - left) * fog.color.rgb;
    }
    return behind + added;
}

} // namespace pnr
