// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of axes that need no seeds: curvature, a vector, an axis, the light, the pigment.
#pragma once

#include "core/world.h"
#include "npr/curvature.h"

#include <memory>

namespace pnr {

struct AxisSource {
    FieldSource source = FieldSource::along;
    Vec3 vector{0, 1, 0};
    Vec3 point{0};
    std::vector<Light> lights;
    Texture texture;
    double reach = 1e-3; // distance over which the pigment's gradient is taken, world units
    std::shared_ptr<const CurvatureField> curvature;
};

// `source` is not FieldSource::seeds. The world must outlive the result. Vectors and points of the style are
// in world space.
AxisSource make_axis_source(const World& world, int object, FieldSource source, const PaintStyle& style);
// An axis at a place of the object, of any length; its tangent part counts. Zero where the source says
// nothing.
Vec3 eval_axis_source(const AxisSource& source, Vec3 position, Vec3 normal);

} // namespace pnr
