// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes without global photons look as POV-Ray would render them: its finish formulas, its tinted shadows,
// its recursion.
#pragma once

#include "core/shade.h"

namespace pnr {

// Radiance against a camera ray by POV-Ray's formulas (ambient, diffuse with brilliance, phong, specular,
// reflection, transparency); with a caustic map (`photons {}` alone) its light is added.
Color povray_radiance(const Shading& shading, const Ray& camera_ray, SampleState& state);

// How thick a thin film is at a point of scene space, over what its `thickness` says.
double film_thickness(const Iridescence& irid, Vec3 point);
// Radiance against a ray of gathered light (radiosity.h); `weight` is the most that it can count in the picture. `distance`:
// to what it meets.
Color povray_gather_ray(const Shading& shading, const Ray& ray, Color weight, double& distance, SampleState& state);

} // namespace pnr
