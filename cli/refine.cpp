// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/refine.h"

#include "cli/interrupt.h"

#include <fmt/format.h>

namespace pnr {

namespace {

// Passes after which an error that is not yet reached never will be, for all practical purposes.
constexpr int most_passes = 100'000;

// What loading the image library and writing the picture will take, s.
double time_to_write(const Rendering& r) {
    const double pixels = static_cast<double>(r.window.x1 - r.window.x0) * (r.window.y1 - r.window.y0);
    return 0.3 + 4e-7 * pixels;
}

// The result of all passes so far, as if it were one.
void take_means(Rendering& r) {
    const ProgressiveSum& sum = r.progressive;
    r.rendered.layer = sum.mean;
    r.rendered.parts = sum.parts;
    r.rendered.faults = sum.faults;
    r.rendered.fault_places = sum.fault_places;
    r.rendered.camera_rays = sum.camera_rays;
    r.rendered.gathers = sum.gathers;
}

// The photon map of a batch; the first one's is that of the whole rendering.
struct BatchMap {
    PhotonMap own;
    const PhotonMap* now = nullptr;
};

void prepare_pass(Rendering& r, const ProgressiveStep& step, const Settings& settings, int pass, BatchMap& map,
                  Passes& passes) {
    const bool sharper = pass == 1 && r.progressive.preview;
    if (sharper || (pass == 0 && !step.preview)) add_field(r, settings, 1, r.photons, passes);
    if (step.batch > 0 && step.begins_batch) {
        map.own = PhotonMap{}; // before the next one is made: memory is that of one batch
        map.own = make_photons(r, settings, step.batch, step.shrink, true, passes);
        map.now = &map.own;
    }
    if (r.plan.paint && (pass == 0 || sharper)) r.paint = paint(r, passes, {});
}

bool enough(Rendering& r, const Refinement& asked, int batches_before, Passes& passes) {
    if (r.progressive.batches > batches_before && r.progressive.batches >= 2) {
        r.error = estimate_error(r.progressive, r.window);
        r.reached_error = relative_error_90(r.progressive, r.error, r.window);
        passes.note(fmt::format("{} passes: 90 % of the pixels are known within {:.2g} %", r.passes_done,
                                100 * r.reached_error));
        if (asked.error && r.reached_error < *asked.error) return true;
    }
    return r.passes_done >= asked.passes.value_or(most_passes) || passes.past_deadline();
}

} // namespace

void refine(Rendering& r, const Wishes& wishes, Passes& passes) {
    const Refinement& asked = *wishes.refinement;
    r.asked_error = asked.error.value_or(0);
    BatchMap map{{}, &r.photons};
    const bool large = large_picture(r.gbuffer.view.width, r.gbuffer.view.height);
    for (int pass = 0;; ++pass) {
        const ProgressiveStep step =
            progressive_step(pass, r.world.illumination, r.settings.render.integrator, large);
        const Settings settings = settings_of(step, r.settings);
        Settings drawn = r.settings;
        if (wishes.sample_seed) drawn.render.seed = *wishes.sample_seed;
        drawn = settings_of(step, drawn);
        RenderResult result;
        try {
            prepare_pass(r, step, settings, pass, map, passes);
            result = passes.run("render", [&](const Progress& progress) {
                return render(r.world, r.gbuffer, *map.now, drawn, r.window, wishes.light_parts, progress,
                              samples_of(step, r.progressive));
            });
        } catch (const Interrupted&) {
            if (pass == 0) throw;
            break;
        }
        if (result.stopped && pass > 0) break;
        const int batches = r.progressive.batches;
        add_pass(r.progressive, step, std::move(result));
        r.passes_done = pass + 1;
        take_means(r);
        if (asked.time_s) passes.set_deadline(*asked.time_s - time_to_write(r));
        if (wishes.on_part) {
            if (pass == 0 && r.plan.paint) wishes.on_part(r, RenderedPart::paint, {0, 0, r.gbuffer.view.width, r.gbuffer.view.height});
            wishes.on_part(r, RenderedPart::light, r.window);
        }
        if (wishes.after_pass && !wishes.after_pass(r)) break;
        if (stop_signal() != 0 || enough(r, asked, batches, passes)) break;
        if (take_picture_request() && wishes.show) {
            complete_picture(r);
            wishes.show(r);
        }
    }
    passes.set_deadline(infinity);
    r.stopped = stop_signal() != 0;
}

} // namespace pnr
