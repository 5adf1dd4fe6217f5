// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/plan.h"

namespace pnr {
namespace {

// What the painted objects of a world ask for, over all of them.
struct PaintNeeds {
    bool any = false; // painted with mix > 0
    bool several_seeds = false;
    bool paths = false; // some ILIC length > 0
};

PaintNeeds paint_needs(const World& world) {
    PaintNeeds needs;
    for (const WorldObject& object : world.objects) {
        if (!object.npr || object.paint.mix <= 0) continue;
        needs.any = true;
        needs.several_seeds = needs.several_seeds || object.paint.seeds.size() > 1;
        needs.paths = needs.paths || object.paint.length > 0;
    }
    return needs;
}

// Notes each thing as used, or as left out with the reason; an empty reason: there is nothing to say.
struct Decision {
    bool& chosen;
    const char* what;
    bool needed;
    const char* why;
};

} // namespace

Plan make_plan(const World& world, const Settings& settings, bool maps) {
    const PaintNeeds paint = paint_needs(world);
    const bool path = settings.render.integrator == Integrator::path;
    const bool lit = (world.illumination == Illumination::photon_mapped || world.caustics_apart) && !path;
    const bool photons = lit || paint.any;
    const char* unwanted = path ? "paths need no photons and nothing is painted"
                                : "no photons are wanted and nothing is painted";
    Plan plan;
    const Decision decisions[] = {
        {plan.photons, "photon pass", photons, unwanted},
        {plan.kdtree, "kd-tree", photons, unwanted},
        {plan.normals, "photon normals", photons && (paint.any || maps),
         photons ? "nothing is painted and no maps are asked for" : unwanted},
        {plan.caustic_map, "caustic map", photons && world.has_specular,
         photons ? "no surface reflects or refracts" : unwanted},
        {plan.paint, "npr pass", paint.any, "nothing is painted"},
        {plan.rbf, "rbf solve", paint.several_seeds,
         paint.any ? "no painted object has two seeds" : "nothing is painted"},
        {plan.ilic, "ilic", paint.paths, paint.any ? "every stroke has length 0" : "nothing is painted"},
        {plan.render_rays, "rendering pass", true, ""},
    };
    for (const Decision& decision : decisions) {
        decision.chosen = decision.needed || !settings.render.prune;
        if (decision.chosen)
            plan.used.emplace_back(decision.what);
        else
            plan.left_out.push_back({decision.what, decision.why});
    }
    return plan;
}

} // namespace pnr
