// SPDX-License-Identifier: GPL-3.0-or-later
// Bumps that are not there: POV-Ray's `normal`, which turns the shading normal by a pattern.
//
// Patterns made for it (bumps, dents, wrinkles, ripples, waves, quilted, facets, a picture's heights) have a vector of
// their own; of any other pattern the gradient is taken, by its values at the corners of a tetrahedron.
#pragma once

#include "core/pattern.h"

#include <vector>

namespace pnr {

struct SlopeStop { // of a `slope_map`: the height above a value of the pattern, and how it climbs there
    double position = 0;
    double height = 0, slope = 0;
};

struct Normal {
    Pattern pattern;                     // of a bump_map a picture: its brightness is the height
    double size = 0.5;                   // bump_size: of bump_map, or the number behind any other pattern
    double accuracy = 0.02;              // distance of the tetrahedron's corners, in pattern space
    bool scale_bumps = true;             // off: `no_bump_scale`
    std::vector<SlopeStop> slopes;       // slope_map: of the pattern's values; empty: the values are heights
    std::vector<BlendEntry<Normal>> normals; // normal_map, a list or `average`: these instead, picked by the pattern
};

// The perturbed normal, unit. `at` is in the space of pattern.transform's result; at.normal is what is perturbed: unit, on the
// viewer's side. Never NaN.
Vec3 perturb_normal(const Normal& normal, const SurfacePoint& at);

// The normal follows its object, like transform_pigment.
void transform_bumps(Normal& normal, const Transform& by);

} // namespace pnr
