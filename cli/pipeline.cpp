// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/pipeline.h"

#include "cli/interrupt.h"
#include "core/emission.h"
#include "cli/refine.h"
#include "core/irradiance_field.h"
#include "core/near_limits.h"
#include "core/trace_photons.h"
#include "npr/hidden_sources.h"

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
    return map;
}

void save_if_asked(const Scene& scene, const Rendering& r, const Wishes& wishes, Passes& passes) {
    if (wishes.save_photons.empty()) return;
    passes.run("write", [&](const Progress&) { save_photons(r.photons, scene.hash, wishes.save_photons); });
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

PaintResult paint(const Rendering& r, Passes& passes, std::optional<SparseMap> sources) {
    PaintResult p;
    const std::uint64_t seed = r.settings.render.seed;
    p.sparse = sources ? std::move(*sources) : passes.run("sparse", [&](const Progress& progress) {
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
    std::optional<InformativeMap> shown; // where it is not the map that the files show
    if (const auto sparse = without_hidden(p.sparse, r.world, r.gbuffer, r.photons))
        shown = passes.run("informative", [&](const Progress& progress) {
            return make_informative_map(*sparse, r.world, r.gbuffer, seed, progress);
        });
    p.layer = passes.run("ilic", [&](const Progress& progress) {
        return convolve(shown ? *shown : p.informative, find_seats(r.world, r.gbuffer, r.photons), r.world, r.gbuffer, seed, progress);
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

void check_photons(const Scene& scene, const World& world, const Settings& settings, const Budgets& budgets) {
    const std::int64_t count = plan_emission(world, settings.photons).count;
    if (count <= budgets.photons) return;
    throw SceneError({scene.file, 0, 0},
                     fmt::format("{} photons are asked for, more than the {} that are allowed; say a smaller `count` or "
                                 "a larger `spacing`, or `--limit photons={}`",
                                 count, budgets.photons, count));
}

// Strokes and fills reach across the picture, so a crop of a painting is cut from the whole painting.
PixelRect traced_window(const Rendering& r, const Wishes& wishes, const PictureView& view) {
    return r.plan.paint || wishes.maps ? whole(view) : grow(r.window, 1, view.width, view.height);
}

void look(Rendering& r, const Wishes& wishes, const PictureView& view, Passes& passes) {
    r.gbuffer = passes.run("gbuffer", [&](const Progress& progress) {
        return make_gbuffer(r.world, view, traced_window(r, wishes, view), r.settings.render, progress);
    });
}

void render_in_passes(const Scene& scene, Rendering& r, const Wishes& wishes, const PictureView& view, Passes& passes) {
    r.photons = first_photons(scene, r, wishes, false, passes);
    save_if_asked(scene, r, wishes, passes);
    look(r, wishes, view, passes);
    refine(r, wishes, passes);
}

// Each pass whose result is kept is left out; light at points is asked for by those two that look for it alone.
void render_at_once(const Scene& scene, Rendering& r, const Wishes& wishes, const PictureView& view, Reuse& reuse,
                    Passes& passes) {
    const bool lit = passes.run("render", [&](const Progress&) { return take_light(reuse, r); });
    if (!passes.run("photons", [&](const Progress&) { return take_photons(reuse, r); }))
        r.photons = first_photons(scene, r, wishes, false, passes);
    save_if_asked(scene, r, wishes, passes);
    const bool sparse = passes.run("sparse", [&](const Progress&) { return take_sources(reuse, r); });
    if (!lit || (r.plan.paint && !sparse)) add_field(r, r.settings, 1, r.photons, passes);
    if (!passes.run("gbuffer", [&](const Progress&) { return take_seen(reuse, r); })) look(r, wishes, view, passes);
    if (r.plan.paint)
        r.paint = paint(r, passes, sparse ? std::optional(std::move(r.paint.sparse)) : std::nullopt);
    if (!lit)
        r.rendered = passes.run("render", [&](const Progress& progress) {
            return render(r.world, r.gbuffer, r.photons, r.settings, r.window, wishes.light_parts, progress);
        });
    r.stopped = r.rendered.stopped;
}

} // namespace

Rendering plan_rendering(const Scene& scene, const Settings& settings, const Wishes& wishes, Reuse& reuse,
                         Passes& passes) {
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
    find_keys(reuse, r, wishes);
    return r;
}

Rendering render_scene(const Scene& scene, const Settings& settings, const Wishes& wishes, Reuse& reuse,
                       Passes& passes) {
    Rendering r = plan_rendering(scene, settings, wishes, reuse, passes);
    if (wishes.before_passes) wishes.before_passes(r.world.notes);
    if (r.plan.photons && wishes.load_photons.empty()) check_photons(scene, r.world, r.settings, wishes.budgets);
    passes.expect(expected_passes(r.plan, wishes));
    stop_gently();
    const PictureView view{r.world.camera, r.settings.render.width, r.settings.render.height};
    try {
        if (wishes.refinement)
            render_in_passes(scene, r, wishes, view, passes);
        else
            render_at_once(scene, r, wishes, view, reuse, passes);
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
