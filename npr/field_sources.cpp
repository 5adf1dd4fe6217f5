// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/field_sources.h"

#include "core/pigment.h"

namespace pnr {

namespace {

// Towards the lights, each by what it would give a surface that faces it: power over distance squared.
Vec3 light_direction(const AxisSource& source, Vec3 position) {
    Vec3 sum(0);
    for (const Light& light : source.lights) {
        const Vec3 toward = light.said.position - position;
        const double distance2 = glm::dot(toward, toward);
        if (!(distance2 > 0)) continue;
        // POV-Ray's lights do not fade unless told to, so for them the distance does not count.
        const double strength = light.is_emitter() ? static_cast<double>(luminance(light.power)) / distance2
                                                   : static_cast<double>(luminance(light.said.color));
        sum += toward / std::sqrt(distance2) * strength;
    }
    return sum;
}

// Along the gradient of the pigment's lightness, by central differences in the tangent plane.
Vec3 pigment_direction(const AxisSource& source, Vec3 position, Vec3 normal) {
    const Frame frame = make_frame(normal);
    const auto lightness = [&](Vec3 p) {
        return static_cast<double>(luminance(texture_color(source.texture, {p, Vec2(0), normal})));
    };
    const double x =
        lightness(position + frame.x * source.reach) - lightness(position - frame.x * source.reach);
    const double y =
        lightness(position + frame.y * source.reach) - lightness(position - frame.y * source.reach);
    return frame.x * x + frame.y * y;
}

} // namespace

AxisSource make_axis_source(const World& world, int object, FieldSource source, const PaintStyle& style) {
    AxisSource made;
    made.source = source;
    made.vector = style.field_vector;
    made.point = style.field_point;
    if (source == FieldSource::light) made.lights = world.lights;
    if (source == FieldSource::curvature_min || source == FieldSource::curvature_max)
        made.curvature = std::make_shared<const CurvatureField>(make_curvature_field(world, object));
    if (source == FieldSource::gradient) {
        const Bounds& bounds = world.objects[static_cast<std::size_t>(object)].bounds;
        const double extent = is_empty(bounds) ? world.radius : glm::distance(bounds.low, bounds.high);
        made.reach = 0.005 * (std::isfinite(extent) ? std::min(extent, 2 * world.radius) : world.radius);
        for (const Surface& surface : world.surfaces) {
            if (surface.object != object) continue;
            made.texture = world.materials[static_cast<std::size_t>(surface.material)].texture;
            break;
        }
    }
    return made;
}

Vec3 eval_axis_source(const AxisSource& source, Vec3 position, Vec3 normal) {
    switch (source.source) {
    case FieldSource::around:
        return glm::cross(source.vector, position - source.point);
    case FieldSource::light:
        return light_direction(source, position);
    case FieldSource::gradient:
        return pigment_direction(source, position, normal);
    case FieldSource::curvature_min:
        return eval_curvature_axis(*source.curvature, position, normal, false);
    case FieldSource::curvature_max:
        return eval_curvature_axis(*source.curvature, position, normal, true);
    case FieldSource::seeds:
    case FieldSource::along:
        break;
    }
    return source.vector;
}

} // namespace pnr
