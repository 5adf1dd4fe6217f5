// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/pipeline.h"

#include "cli/interrupt.h"
#include "core/emission.h"
#include "cli/refine.h"
#include "core/irradiance_field.h"
#include "core/near_limits.h"
#include "core/trace_photons.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

PixelRect whole(const PictureView& view) { return {0, 0, view.width, view.height}; }

Layer empty_layer(const PictureView& view) {
    return {Image<Color>(view.width, view.height), Image<float>(view.width, view.height)};
}

std::vector<std::string> expected_passes(const Plan& plan, const Wishes& wishes) {
    std::vector<std::string> names{"parse", "build"};
    if (plan.photons && wishes.load_photons.empty()) names.emplace_back("photons");
    if (plan.kdtree) names.emplace_back("kdtree");
    names.emplace_back("gbuffer");
    if (plan.paint) names.insert(names.end(), {"sparse", "orient", "informative", "ilic"});
    names.insert(names.end(), {"render", "write"});
    return names;
}

// The first photon map: traced, or one that an earlier run has kept.
PhotonMap first_photons(const Scene& scene, const Rendering& r, const Wishes& wishes, bool field, Passes& passes) {
    PhotonMap map;
    if (wishes.load_photons.empty()) {
        map = make_photons(r, r.settings, 0, 1, field, passes);
    } else {
        map = passes.run("photons", [&](const Progress&) { return load_photons(scene.hash, wishes.load_photons); });
        passes.run("kdtree", [&](const Progress&) {
            if (r.plan.kdtree && map.tree.count == 0) build_photon_tree(map);
        });
        if (field) add_field(r, r.settings, 1, map, passes);
    }
    if (!wishes.save_photons.empty())
        passes.run("write", [&](const Progress&) { save_photons(map, scene.hash, wishes.save_photons); });
    return map;
}

} // namespace

PhotonMap make_photons(const Rendering& r, const Settings& settings, int batch, double shrink, bool field,
                       Passes& passes) {
    PhotonMap map = passes.run("photons", [&](const Progress& progress) {
        if (!r.plan.photons) return PhotonMap{};
        return trace_photons(r.world, settings.photons, r.settings.render.seed, batch, batch == 0 && r.plan.normals,
                             progress);
    });
    if (!r.plan.kdtree) return map;
    passes.run("kdtree", [&](const Progress&) {
        build_photon_tree(map);
        map.radius *= static_cast<float>(std::sqrt(shrink));
        map.caustic_radius *= static_cast<float>(std::sqrt(shrink));
    });
    if (field) add_field(r, settings, shrink, map, passes);
    return map;
}

void add_field(const Rendering& r, const Settings& settings, double shrink, PhotonMap& map, Passes& passes) {
    if (!r.plan.kdtree || r.world.illumination != Illumination::photon_mapped) return;
    passes.run("kdtree", [&](const Progress& progress) {
        map.field = make_irradiance_field(r.world, map, {shrink, settings.render.gather_effort}, progress);
    });
}

PaintResult paint(const Rendering& r, Passes& passes) {
    PaintResult p;
    const std::uint64_t seed = r.settings.render.seed;
    p.sparse = passes.run("sparse", [&](const Progress& progress) {
        return make_sparse_map(r.world, r.gbuffer, r.photons, r.settings, progress);
    });
    passes.run("orient", [&](const Progress& progress) {
        p.fields = make_orientation_fields(r.world);
        p.oriented = orient_photons(r.world, r.photons, p.fields, progress);
        orient_strokes(p.sparse, r.world, r.gbuffer, r.photons, p.oriented);
    });
    p.informative = passes.run("informative", [&](const Progress& progress) {
        return make_informative_map(p.sparse, r.world, r.gbuffer, seed, progress);
    });
    p.layer = passes.run("ilic", [&](const Progress& progress) {
        return convolve(p.informative, find_seats(r.world, r.gbuffer, r.photons), r.world, r.gbuffer, seed, progress);
    });
    return p;
}

namespace {

// The two layers as one, without a value that no file can hold.
Layer put_together(const Rendering& r, SampleFaults& faults, std::vector<FaultPlace>& places) {
    const Layer &painted = r.paint.layer, &photoreal = r.rendered.layer;
    const PixelRect& window = r.window;
    Layer picture{over(painted, photoreal), photoreal.alpha};
    std::vector<FaultPlace> found;
    for (int y = 0; y < picture.color.height; ++y) {
        for (int x = 0; x < picture.color.width; ++x) {
            Color& color = picture.color.at(x, y);
            float& alpha = picture.alpha.at(x, y);
            if (x < window.x0 || x >= window.x1 || y < window.y0 || y >= window.y1) {
                color = Color(0);
                alpha = 0;
                continue;
            }
            alpha = std::min(1.0f, alpha + painted.alpha.at(x, y));
            SampleFaults here;
            for (int c = 0; c < 3; ++c) {
                if (std::isfinite(color[c])) continue;
                ++(std::isnan(color[c]) ? here.nan : here.inf);
                color[c] = 0;
            }
            if (here.sum() > 0) found.push_back({x, y, r.gbuffer.seen.at(x, y).object, here});
            faults += here;
        }
    }
    merge_faults(places, std::move(found));
    return picture;
}

} // namespace

PictureSize picture_size(const Camera& camera, const RenderSettings& settings) {
    const double aspect = glm::length(camera.right) / glm::length(camera.up);
    const auto side = [](double pixels) {
        return std::clamp(static_cast<int>(std::lround(std::min(pixels, 1e6))), 1, 65536);
    };
    if (settings.width > 0 && settings.height > 0) return {settings.width, settings.height};
    if (settings.width > 0) return {settings.width, side(settings.width / aspect)};
    if (settings.height > 0) return {side(settings.height * aspect), settings.height};
    return default_size(camera);
}

namespace {

// Memory for pixels is taken at once: better an answer than a machine that stands still.
void check_picture(const PictureSize& size, const Budgets& budgets) {
    const std::int64_t pixels = static_cast<std::int64_t>(size.width) * size.height;
    if (pixels <= budgets.pixels) return;
    throw UsageError(fmt::format("a picture of {} x {} pixels is larger than the {} that are allowed; `--limit "
                                 "pixels={}` allows it",
                                 size.width, size.height, budgets.pixels, pixels));
}

// Where the photons will be sent, if they are not too many.
Focus check_photons(const Scene& scene, const World& world, const Settings& settings, const Budgets& budgets) {
    const EmissionPlan plan = plan_emission(world, settings.photons);
    const std::int64_t count = plan.count;
    if (count <= budgets.photons) return plan.focus;
    throw SceneError({scene.file, 0, 0},
                     fmt::format("{} photons are asked for, more than the {} that are allowed; say a smaller `count` or "
                                 "a larger `spacing`, or `--limit photons={}`",
                                 count, budgets.photons, count));
}

bool same(const Focus& a, const Focus& b) { return a.center == b.center && a.radius == b.radius; }

// Only the camera may have moved since the map was made. Where planes are endless, photons fall about the first
// camera too: a later one must stand in their midst.
bool still_holds(const KeptPhotons& kept, std::uint64_t world_hash, const Rendering& r) {
    if (!kept.valid || kept.world != world_hash || kept.normals != r.plan.normals) return false;
    const PhotonSettings &a = kept.settings.photons, &b = r.settings.photons;
    if (kept.settings.render.seed != r.settings.render.seed || a.count != b.count || a.spacing != b.spacing) return false;
    return glm::distance(r.world.camera.location, kept.focus.center) <= kept.focus.radius ||
           same(kept.focus, plan_emission(r.world, b).focus);
}

// The map as it was before its first frame: the field's records are made where a picture needs them.
PhotonMap take_kept(const Rendering& r, KeptPhotons& kept, Passes& passes) {
    PhotonMap map = std::move(kept.map);
    if (map.field) add_field(r, r.settings, 1, map, passes);
    return map;
}

} // namespace

void keep_photons(Rendering& r, std::uint64_t world_hash, KeptPhotons& kept) {
    if (r.stopped || !r.plan.photons) return;
    kept.valid = true;
    kept.world = world_hash;
    kept.settings = r.settings;
    kept.normals = r.plan.normals;
    kept.map = std::move(r.photons);
}

Rendering render_scene(const Scene& scene, const Settings& settings, const Wishes& wishes, KeptPhotons& kept,
                       std::uint64_t world_hash, Passes& passes) {
    Rendering r;
    r.settings = settings;
    const PictureSize size = picture_size(scene.camera, settings.render);
    r.settings.render.width = size.width;
    r.settings.render.height = size.height;
    check_picture(size, wishes.budgets);
    r.window = crop_window(wishes.crop, size.width, size.height);

    r.world = passes.run("build", [&](const Progress&) { return build_world(scene, r.settings); });
    r.plan = make_plan(r.world, r.settings, wishes.maps);
    for (std::string& note : near_limits(r.world, r.settings, r.plan.photons)) r.world.notes.push_back(std::move(note));
    if (wishes.before_passes) wishes.before_passes(r.world.notes);
    const bool reuse = !wishes.refinement && still_holds(kept, world_hash, r);
    if (reuse)
        r.plan.left_out.push_back({"photons", "only the camera has moved since the frame before: its map is used again"});
    else if (r.plan.photons && wishes.load_photons.empty())
        kept.focus = check_photons(scene, r.world, r.settings, wishes.budgets);
    passes.expect(expected_passes(r.plan, wishes));
    stop_gently();
    const PictureView view{r.world.camera, size.width, size.height};
    // Strokes and fills reach across the picture, so a crop of a painting is cut from the whole painting.
    const bool all = r.plan.paint || wishes.maps;
    try {
        r.photons = reuse ? take_kept(r, kept, passes) : first_photons(scene, r, wishes, !wishes.refinement, passes);
        kept.valid = false;
        r.gbuffer = passes.run("gbuffer", [&](const Progress& progress) {
            return make_gbuffer(r.world, view, all ? whole(view) : grow(r.window, 1, view.width, view.height),
                                r.settings.render, progress);
        });
        if (wishes.refinement) {
            refine(r, wishes, passes);
        } else {
            if (r.plan.paint) r.paint = paint(r, passes);
            r.rendered = passes.run("render", [&](const Progress& progress) {
                return render(r.world, r.gbuffer, r.photons, r.settings, r.window, wishes.light_parts, progress);
            });
            r.stopped = r.rendered.stopped;
        }
    } catch (const Interrupted&) {
        r.stopped = true;
    }
    complete_picture(r);
    return r;
}

void complete_picture(Rendering& r) {
    r.faults = r.rendered.faults;
    r.fault_places = r.rendered.fault_places;
    const bool nothing = r.paint.layer.color.empty() && r.rendered.layer.color.empty();
    if (r.stopped && nothing) return;
    if (r.paint.layer.color.empty()) r.paint.layer = empty_layer(r.gbuffer.view);
    if (r.rendered.layer.color.empty()) r.rendered.layer = empty_layer(r.gbuffer.view);
    r.picture = put_together(r, r.faults, r.fault_places);
}

} // namespace pnr
