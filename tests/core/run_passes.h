// SPDX-License-Identifier: GPL-3.0-or-later
// A progressive run as the command line does it, for tests that look at its mean and its stated error.
#pragma once

#include "core/gbuffer.h"
#include "core/irradiance_field.h"
#include "core/progressive.h"
#include "core/trace_photons.h"

namespace pnr::test {

inline ProgressiveSum run_passes(const World& world, const Settings& settings, int passes,
                                 bool large = false) {
    const PictureView view{world.camera, settings.render.width, settings.render.height};
    const PixelRect window{0, 0, view.width, view.height};
    const GBuffer gbuffer = make_gbuffer(world, view, window, settings.render);
    const bool photons = settings.render.integrator == Integrator::photons;
    ProgressiveSum sum;
    PhotonMap map;
    for (int pass = 0; pass < passes; ++pass) {
        const ProgressiveStep step =
            progressive_step(pass, world.illumination, settings.render.integrator, large);
        const Settings own = settings_of(step, settings);
        if (photons && (pass == 0 || step.begins_batch)) {
            map = trace_photons(world, own.photons, settings.render.seed, step.batch, false);
            build_photon_tree(map);
            map.radius *= static_cast<float>(std::sqrt(step.shrink));
            map.caustic_radius *= static_cast<float>(std::sqrt(step.shrink));
        }
        if (photons && !step.preview && !map.field)
            map.field = make_irradiance_field(world, map, {step.shrink, 0});
        add_pass(sum, step, render(world, gbuffer, map, own, window, false, {}, samples_of(step, sum)));
    }
    return sum;
}

} // namespace pnr::test
