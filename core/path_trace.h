// SPDX-License-Identifier: GPL-3.0-or-later
// The reference: path tracing with next event estimation and multiple importance sampling [Kajiya 1986; Veach
// 1997]. Unbiased; shares nothing with the photon code but rays and materials. Light that reaches a point
// light's caustics only by photons is missing here, since no path from the eye meets a point.
#pragma once

#include "core/rng.h"
#include "core/settings.h"
#include "core/world.h"

namespace pnr {

// One sample of the radiance against a camera ray; its expectation is the radiance. `leave_out_paint`:
// painted objects seen directly or through the chain of gbuffer.h give 1 - mix of their light, as in the
// rendering pass.
Color path_radiance(const World& world, const Ray& camera_ray, const RenderSettings& settings,
                    bool leave_out_paint, Rng& rng);

} // namespace pnr
