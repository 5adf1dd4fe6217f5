// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/light.h"

#include "core/area_light.h"

#include <algorithm>
#include <cmath>

namespace pnr {

// ---- maps from the unit square
// ----------------------------------------------------------------------------------

Vec2 square_to_disc(Vec2 u) {
    const double a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool along_a = std::abs(a) > std::abs(b);
    const double radius = along_a ? a : b;
    const double angle = along_a ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec3 square_to_cosine(Vec2 u, const Frame& frame) {
    const Vec2 d = square_to_disc(u);
    const double z = std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y));
    return glm::normalize(d.x * frame.x + d.y * frame.y + z * frame.z);
}

Vec3 square_to_cone(Vec2 u, const Frame& frame, double one_minus_cos) {
    // The disc's squared radius is uniform in [0, 1], as the cap's 1 - cos is [Shirley and Chiu 1997].
    const Vec2 d = square_to_disc(u);
    const double r2 = std::min(1.0, d.x * d.x + d.y * d.y);
    const double h = r2 * one_minus_cos; // 1 - cos
    const double scale = std::sqrt(one_minus_cos * std::max(0.0, 2 - h));
    return glm::normalize(d.x * scale * frame.x + d.y * scale * frame.y + (1 - h) * frame.z);
}

// ---- making
// -------------------------------------------------------------------------------------------------------

namespace {

double emitter_area(const Emitter& emitter) {
    switch (emitter.shape) {
    case EmitterShape::sphere:
        return 4 * pi * emitter.radius * emitter.radius;
    case EmitterShape::hemisphere:
        return 2 * pi * emitter.radius * emitter.radius;
    case EmitterShape::disc:
        return pi * emitter.radius * emitter.radius;
    case EmitterShape::rectangle:
        return glm::length(glm::cross(emitter.u, emitter.v));
    }
    return 0;
}

// Bound on how far rounding moves a point of the emitter; its surface stands in the BVH in double too.
double emitter_error(const Light& light) {
    const Emitter& e = *light.said.emitter;
    const Vec3 p = glm::abs(light.said.position);
    const double extent = e.shape == EmitterShape::rectangle ? glm::length(e.u) + glm::length(e.v) : e.radius;
    return (std::max({p.x, p.y, p.z}) + extent) * 0x1p-48;
}

Vec3 rectangle_normal(const Emitter& e) { return glm::normalize(glm::cross(e.u, e.v)); }

} // namespace

Light make_light(const LightSource& said) {
    Light light;
    light.said = said;
    light.power = said.color;
    if (!said.emitter) return light;
    Emitter& emitter = *light.said.emitter;
    if (emitter.shape == EmitterShape::hemisphere || emitter.shape == EmitterShape::disc) {
        const double length = glm::length(emitter.axis);
        if (!(length > 0) || !std::isfinite(length))
            throw SceneError(said.said_at, "the emitter's axis has no direction");
        emitter.axis /= length;
    }
    light.area = emitter_area(emitter);
    if (!(light.area > 0) || !std::isfinite(light.area))
        throw SceneError(said.said_at, "the emitter has no area");
    const double amount = emitter.power ? *emitter.power : emitter.radiance.value_or(1.0);
    if (!(amount >= 0) || !std::isfinite(amount))
        throw SceneError(said.said_at, "an emitter's radiance or power must be a finite number >= 0");
    const double radiance = emitter.power ? amount / (pi * light.area) : amount;
    light.radiance = said.color * static_cast<float>(radiance);
    light.power = said.color * static_cast<float>(pi * light.area * radiance);
    return light;
}

// ---- POV-Ray's lights
// ---------------------------------------------------------------------------------------------

namespace {

// 0 below low, 1 from high on, the cubic 3 t^2 - 2 t^3 between.
double smooth_step(double low, double high, double x) {
    if (x < low) return 0;
    if (x >= high) return 1;
    const double t = (x - low) / (high - low);
    return (3 - 2 * t) * t * t;
}

} // namespace

Vec3 light_axis(const Light& light) {
    const Vec3 d = light.said.point_at - light.said.position;
    const double length = glm::length(d);
    return length > 0 ? d / length : Vec3(0);
}

double light_falloff(const Light& light, Vec3 position) {
    const LightSource& l = light.said;
    if (light.is_emitter() || (!l.spotlight && !l.cylinder)) return 1;
    const Vec3 axis = light_axis(light);
    const Vec3 d = position - l.position;
    const double along = glm::dot(d, axis);
    if (l.cylinder) { // radius, falloff: distances from the axis
        const double off = glm::length(d - along * axis);
        if (along <= 0 || !(off < l.falloff)) return 0;
        const double inward = 1 - off / l.falloff;
        double value = std::pow(inward, l.tightness);
        if (l.radius > 0 && off > l.radius) value *= smooth_step(0, 1 - l.radius / l.falloff, inward);
        return value;
    }
    const double distance = glm::length(d);
    // A parallel spot shines straight along its axis everywhere: POV-Ray gives it no edge.
    const double cosine = l.parallel || !(distance > 0) ? 1.0 : along / distance;
    if (cosine <= 0) return 0;
    const double inner = std::cos(l.radius * pi / 180), outer = std::cos(l.falloff * pi / 180);
    double value = std::pow(cosine, l.tightness);
    if (inner > 0) value *= smooth_step(outer, inner, cosine);
    return value;
}

bool is_parallel(const Light& light) {
    return !light.is_emitter() && (light.said.parallel || light.said.cylinder);
}

double light_fading(const Light& light, double distance) {
    const LightSource& l = light.said;
    if (light.is_emitter() || !(l.fade_power > 0) || !(std::abs(l.fade_distance) > 0)) return 1;
    return 2 / (1 + std::pow(distance / std::abs(l.fade_distance), l.fade_power));
}

double light_attenuation(const Light& light, Vec3 position) {
    if (light.is_emitter()) return 1;
    const Vec3 d = position - light.said.position;
    const double distance = is_parallel(light) ? std::abs(glm::dot(d, light_axis(light))) : glm::length(d);
    return light_falloff(light, position) * light_fading(light, distance);
}

// ---- sampling a lit position's view of the light
// ------------------------------------------------------------------

namespace {

// A POV-Ray light, seen at its position or, if it has an area, at a place of that.
LightSample sample_delta(const Light& light, Vec3 position, Vec2 u) {
    const LightSource& l = light.said;
    LightSample sample;
    Vec3 shines_from = l.position;
    if (light.has_extent()) shines_from = area_point_at(view_area(light, position, 0), u);
    const Vec3 d = shines_from - position;
    if (is_parallel(light)) {
        const Vec3 axis = light_axis(light);
        const double depth = -glm::dot(d, axis);
        sample.distance = std::abs(depth);
        sample.direction = -axis;
        // Behind the light's plane POV-Ray's parallel light shines all the same, and nothing shades it: the
        // point then lies as good as at the position itself.
        const double clear = std::max(glm::length(position), std::abs(depth)) * 0x1p-50;
        sample.point = position - (depth > 0 ? depth : clear) * axis;
    } else {
        sample.distance = glm::length(d);
        if (!(sample.distance > 0)) return sample;
        sample.direction = d / sample.distance;
        sample.point = shines_from;
    }
    const Vec3 p = glm::abs(sample.point);
    sample.error = std::max({p.x, p.y, p.z}) * 0x1p-50;
    sample.irradiance = l.color * static_cast<float>(pi * light_attenuation(light, position));
    return sample;
}

// 1 - cos of the half angle under which a sphere at distance d > r is seen, without cancellation for small
// ones.
double cone_of_sphere(double radius, double distance) {
    const double sin2 = radius * radius / (distance * distance);
    return sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
}

// Whether any of a hemisphere's outer side can be seen from a point at d = position - centre.
bool sees_hemisphere(Vec3 d, double distance, double radius, Vec3 axis) {
    // The visible cap is within acos(r / distance) of d; it meets the half space about the axis unless d lies
    // further than that plus 90 degrees from the axis.
    const double cap = std::acos(std::min(1.0, radius / distance));
    const double angle = std::acos(std::clamp(glm::dot(d, axis) / distance, -1.0, 1.0));
    return angle < cap + pi / 2;
}

// Far from a hemisphere its points are chosen by their area as seen from infinity: a disc's half and half an
// ellipse. None falls in the missing half, so that the light that a point gets unshadowed hardly varies. Near
// it the horizon cuts off too much of them, and directions serve better.
constexpr double far_in_radii = 3;

// Area of what is seen of the unit hemisphere from infinity, at this cosine to its axis.
double seen_from_infinity(double cosine) { return pi * (1 + cosine) / 2; }

bool by_seen_area(const Emitter& e, Vec3 d, double distance) {
    return e.shape == EmitterShape::hemisphere && distance > far_in_radii * e.radius &&
           glm::dot(d, e.axis) > -0.5 * distance;
}

// For `d` = position - centre, where by_seen_area.
LightSample sample_far_hemisphere(const Light& light, Vec3 d, double distance, Vec2 u) {
    const Emitter& e = *light.said.emitter;
    const Vec3 toward = d / distance;
    const double cosine = glm::dot(e.axis, toward);
    Frame frame = make_frame(toward);
    const Vec3 lean = e.axis - cosine * toward; // y points away from the axis, to the missing half
    if (const double length = glm::length(lean); length > 1e-6) {
        frame.y = lean / -length;
        frame.x = glm::cross(frame.y, frame.z);
    }
    // Columns of the disc, from -h to h, become columns from -h to cosine h: all by the same factor.
    const Vec2 disc = square_to_disc(u);
    const double h = std::sqrt(std::max(0.0, 1 - disc.x * disc.x));
    const double y = 0.5 * ((1 + cosine) * disc.y + (cosine - 1) * h);
    const double z = std::sqrt(std::max(0.0, 1 - disc.x * disc.x - y * y));
    const Vec3 normal = glm::normalize(disc.x * frame.x + y * frame.y + z * frame.z);
    LightSample sample;
    sample.point = light.said.position + e.radius * normal;
    const Vec3 to = e.radius * normal - d;
    sample.distance = glm::length(to);
    sample.direction = to / sample.distance;
    sample.error = emitter_error(light);
    const double facing = -glm::dot(normal, sample.direction);
    if (!(facing > 0) || !(z > 0)) return sample; // beyond the horizon
    sample.pdf =
        z * sample.distance * sample.distance / (facing * e.radius * e.radius * seen_from_infinity(cosine));
    sample.irradiance = light.radiance * static_cast<float>(1 / sample.pdf);
    return sample;
}

LightSample sample_sphere(const Light& light, Vec3 position, Vec2 u) {
    const Emitter& e = *light.said.emitter;
    LightSample sample;
    const Vec3 d = position - light.said.position;
    const double distance = glm::length(d);
    if (!(distance > e.radius)) return sample; // inside an emitter there is only its black inner side
    const bool half = e.shape == EmitterShape::hemisphere;
    if (half && !sees_hemisphere(d, distance, e.radius, e.axis)) return sample;
    if (by_seen_area(e, d, distance)) return sample_far_hemisphere(light, d, distance, u);
    const double cone = cone_of_sphere(e.radius, distance);
    const Frame frame = make_frame(-d / distance);
    sample.direction = square_to_cone(u, frame, cone);
    sample.pdf = 1 / (2 * pi * cone);
    // The near crossing of the direction with the sphere.
    const double along = glm::dot(-d, sample.direction);
    const Vec3 closest = d + along * sample.direction; // from the centre
    const double under = std::max(0.0, e.radius * e.radius - glm::dot(closest, closest));
    sample.distance = along - std::sqrt(under);
    const Vec3 normal = glm::normalize(d + sample.distance * sample.direction);
    sample.point = light.said.position + e.radius * normal;
    // Where the direction only grazes the sphere, rounding moves the crossing much further along it.
    const double base = emitter_error(light);
    const double cosine = std::max(-glm::dot(normal, sample.direction), std::sqrt(base / e.radius));
    sample.error = base / std::max(cosine, 1e-8);
    if (half && !(glm::dot(normal, e.axis) > 0)) return sample; // the missing half: black, with its pdf
    sample.irradiance = light.radiance * static_cast<float>(1 / sample.pdf);
    return sample;
}

LightSample sample_disc(const Light& light, Vec3 position, Vec2 u) {
    const Emitter& e = *light.said.emitter;
    LightSample sample;
    const Frame frame = make_frame(e.axis);
    const Vec2 d = square_to_disc(u) * e.radius;
    sample.point = light.said.position + d.x * frame.x + d.y * frame.y;
    const Vec3 to = sample.point - position;
    sample.distance = glm::length(to);
    if (!(sample.distance > 0)) return sample;
    sample.direction = to / sample.distance;
    const double cosine = -glm::dot(sample.direction, e.axis);
    if (!(cosine > 0)) return sample;
    sample.error = emitter_error(light) / std::max(cosine, 1e-8);
    sample.pdf = sample.distance * sample.distance / (cosine * light.area);
    sample.irradiance = light.radiance * static_cast<float>(1 / sample.pdf);
    return sample;
}

// The solid angle of a rectangle, and a point of it by solid angle [Urena et al. 2013, "An
// area-preserving parametrization for spherical rectangles"]. Needs perpendicular edges.
struct SphericalRectangle {
    Vec3 origin, x, y, z;      // local frame at the lit position; z points away from the rectangle
    double x0, y0, z0, x1, y1; // the rectangle in it
    double b0, b1, k, solid_angle;
};

SphericalRectangle see_rectangle(Vec3 corner, Vec3 u, Vec3 v, Vec3 from) {
    SphericalRectangle s{};
    const double lu = glm::length(u), lv = glm::length(v);
    s.origin = from;
    s.x = u / lu;
    s.y = v / lv;
    s.z = glm::cross(s.x, s.y);
    const Vec3 d = corner - from;
    s.z0 = glm::dot(d, s.z);
    if (s.z0 > 0) {
        s.z = -s.z;
        s.z0 = -s.z0;
    }
    s.x0 = glm::dot(d, s.x);
    s.y0 = glm::dot(d, s.y);
    s.x1 = s.x0 + lu;
    s.y1 = s.y0 + lv;
    // Normals of the four edge planes: only their z components matter.
    const auto edge = [&s](double a) { return -a / std::sqrt(s.z0 * s.z0 + a * a); };
    const double n0 = edge(s.y0), n1 = -edge(s.x1), n2 = -edge(s.y1), n3 = edge(s.x0);
    const auto angle = [](double a, double b) { return std::acos(std::clamp(-a * b, -1.0, 1.0)); };
    const double g0 = angle(n0, n1), g1 = angle(n1, n2), g2 = angle(n2, n3), g3 = angle(n3, n0);
    s.b0 = n0;
    s.b1 = n2;
    s.k = 2 * pi - g2 - g3;
    s.solid_angle = g0 + g1 - s.k;
    return s;
}

Vec3 sample_rectangle_point(const SphericalRectangle& s, Vec2 u) {
    const double au = u.x * s.solid_angle + s.k;
    const double fu = (std::cos(au) * s.b0 - s.b1) / std::sin(au);
    double cu = std::copysign(1 / std::sqrt(fu * fu + s.b0 * s.b0), fu);
    cu = std::clamp(cu, -1.0, 1.0);
    double xu = -(cu * s.z0) / std::max(std::sqrt(std::max(0.0, 1 - cu * cu)), 1e-300);
    xu = std::clamp(xu, s.x0, s.x1);
    const double d = std::sqrt(xu * xu + s.z0 * s.z0);
    const double h0 = s.y0 / std::sqrt(d * d + s.y0 * s.y0), h1 = s.y1 / std::sqrt(d * d + s.y1 * s.y1);
    const double hv = h0 + u.y * (h1 - h0), hv2 = hv * hv;
    double yv = hv2 < 1 - 1e-12 ? hv * d / std::sqrt(1 - hv2) : s.y1;
    yv = std::clamp(yv, s.y0, s.y1);
    return s.origin + xu * s.x + yv * s.y + s.z0 * s.z;
}

// Solid-angle sampling pays near the rectangle and is ill-conditioned far from it, where area sampling is as
// good; it also needs a right angle between the edges.
bool by_solid_angle(const Light& light, double solid_angle) {
    const Emitter& e = *light.said.emitter;
    const double lu = glm::length(e.u), lv = glm::length(e.v);
    return std::abs(glm::dot(e.u, e.v)) <= 1e-9 * lu * lv && solid_angle > 1e-3;
}

LightSample sample_rectangle(const Light& light, Vec3 position, Vec2 u) {
    const Emitter& e = *light.said.emitter;
    LightSample sample;
    const Vec3 normal = rectangle_normal(e);
    const Vec3 corner = light.said.position - 0.5 * (e.u + e.v);
    if (!(glm::dot(position - light.said.position, normal) > 0)) return sample;
    const SphericalRectangle seen = see_rectangle(corner, e.u, e.v, position);
    const bool solid = by_solid_angle(light, seen.solid_angle);
    sample.point = solid ? sample_rectangle_point(seen, u) : corner + u.x * e.u + u.y * e.v;
    const Vec3 to = sample.point - position;
    sample.distance = glm::length(to);
    if (!(sample.distance > 0)) return sample;
    sample.direction = to / sample.distance;
    const double cosine = -glm::dot(sample.direction, normal);
    if (!(cosine > 0)) return sample;
    sample.error = emitter_error(light) / std::max(cosine, 1e-8);
    sample.pdf = solid ? 1 / seen.solid_angle : sample.distance * sample.distance / (cosine * light.area);
    sample.irradiance = light.radiance * static_cast<float>(1 / sample.pdf);
    return sample;
}

} // namespace

LightSample sample_light(const Light& light, Vec3 position, Vec2 u) {
    if (!light.is_emitter()) return sample_delta(light, position, u);
    switch (light.said.emitter->shape) {
    case EmitterShape::sphere:
    case EmitterShape::hemisphere:
        return sample_sphere(light, position, u);
    case EmitterShape::disc:
        return sample_disc(light, position, u);
    case EmitterShape::rectangle:
        return sample_rectangle(light, position, u);
    }
    return {};
}

double sample_light_pdf(const Light& light, Vec3 position, Vec3 on_light, Vec3 normal) {
    if (!light.is_emitter()) return 0;
    const Emitter& e = *light.said.emitter;
    const Vec3 to = on_light - position;
    const double distance2 = glm::dot(to, to);
    if (!(distance2 > 0)) return 0;
    const double cosine = -glm::dot(to, normal) / std::sqrt(distance2);
    if (!(cosine > 0)) return 0;
    if (e.shape == EmitterShape::sphere || e.shape == EmitterShape::hemisphere) {
        const Vec3 d = position - light.said.position;
        const double distance = glm::length(d);
        if (!(distance > e.radius)) return 0;
        if (by_seen_area(e, d, distance)) {
            const double seen = seen_from_infinity(glm::dot(e.axis, d) / distance);
            return std::max(0.0, glm::dot(normal, d) / distance) * distance2 /
                   (cosine * e.radius * e.radius * seen);
        }
        return 1 / (2 * pi * cone_of_sphere(e.radius, distance));
    }
    if (e.shape == EmitterShape::rectangle) {
        const Vec3 corner = light.said.position - 0.5 * (e.u + e.v);
        const SphericalRectangle seen = see_rectangle(corner, e.u, e.v, position);
        if (by_solid_angle(light, seen.solid_angle)) return 1 / seen.solid_angle;
    }
    return distance2 / (cosine * light.area);
}

// ---- emission
// -----------------------------------------------------------------------------------------------------

EmissionSample sample_emission(const Light& light, Vec2 u_point, Vec2 u_direction) {
    const Emitter& e = *light.said.emitter;
    EmissionSample sample;
    sample.error = emitter_error(light);
    switch (e.shape) {
    case EmitterShape::sphere:
    case EmitterShape::hemisphere: {
        const bool half = e.shape == EmitterShape::hemisphere;
        const Frame frame = make_frame(half ? e.axis : Vec3(0, 0, 1));
        sample.normal = square_to_cone(u_point, frame, half ? 1 : 2);
        sample.point = light.said.position + e.radius * sample.normal;
        break;
    }
    case EmitterShape::disc: {
        const Frame frame = make_frame(e.axis);
        const Vec2 d = square_to_disc(u_point) * e.radius;
        sample.normal = e.axis;
        sample.point = light.said.position + d.x * frame.x + d.y * frame.y;
        break;
    }
    case EmitterShape::rectangle:
        sample.normal = rectangle_normal(e);
        sample.point = light.said.position + (u_point.x - 0.5) * e.u + (u_point.y - 0.5) * e.v;
        break;
    }
    sample.direction = square_to_cosine(u_direction, make_frame(sample.normal));
    return sample;
}

} // namespace pnr
