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

std::vector<std::string> passes_to_run(const Rendering& r, const Wishes& wishes) {
    const Plan& plan = r.plan;
    std::vector<std::string> names{"parse", "build"};
    const auto add = [&](const char* name) {
        const bool kept = std::any_of(plan.left_out.begin(), plan.left_out.end(),
                                      [&](const LeftOut& left) { return left.what == name; });
        if (!kept) names.emplace_back(name);
        return !kept;
    };
    const bool traced = plan.photons && wishes.load_photons.empty() && add("photons");
    const bool sources = plan.paint && add("sparse"), light = add("render");
    if (plan.kdtree && (traced || sources || light)) names.emplace_back("kdtree");
    add("gbuffer");
    if (plan.paint) names.insert(names.end(), {"orient", "informative", "ilic"});
    names.emplace_back("write");
    const auto place = [](const std::string& name) {
        const std::vector<std::string>& all = pass_names();
        return std::find(all.begin(), all.end(), name) - all.begin();
    };
    std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
    return names;
}

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

PaintResult paint(const Rendering& r, Passes& passes, std::optional<SparseMap> sources, bool strokes) {
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
    if (!strokes) return p;
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

} // namespace

void check_photons(const Scene& scene, const World& world, const Settings& settings, const Budgets& budgets) {
    const std::int64_t count = plan_emission(world, settings.photons).count;
    if (count <= budgets.photons) return;
    throw SceneError({scene.file, 0, 0},
                     fmt::format("{} photons are asked for, more than the {} that are allowed; say a smaller `count` or "
                                 "a larger `spacing`, or `--limit photons={}`",
                                 count, budgets.photons, count));
}

namespace {

// Strokes and fills reach across the picture, so a crop of a painting is cut from the whole painting.
PixelRect traced_window(const Rendering& r, const Wishes& wishes, const PictureView& view) {
    return r.plan.paint || wishes.maps ? whole(view) : grow(r.window, 1, view.width, view.height);
}

void tell(const Rendering& r, const Wishes& wishes, RenderedPart part, const PixelRect& where) {
    if (wishes.on_part) wishes.on_part(r, part, where);
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
    tell(r, wishes, RenderedPart::seen, whole(view));
    refine(r, wishes, passes);
}

// Which results are taken from earlier renderings; the time that it takes counts for the pass it spares.
struct Taken {
    bool photons = false, seen = false, sources = false, light = false;
};
Taken take_all(Rendering& r, Reuse& reuse, Passes& passes) {
    Taken taken;
    const auto take = [&](bool& which, const char* pass, bool found) {
        which = found;
        passes.charge(pass);
    };
    take(taken.photons, "photons", take_photons(reuse, r));
    take(taken.seen, "gbuffer", take_seen(reuse, r));
    if (taken.photons) take(taken.sources, "sparse", take_sources(reuse, r));
    take(taken.light, "render", take_light(reuse, r));
    return taken;
}

template <class T>
void copy_rows(Image<T>& to, const Image<T>& from, const PixelRect& rows) {
    if (from.empty()) return;
    if (to.empty()) to = Image<T>(from.width, from.height);
    const auto begin = static_cast<std::ptrdiff_t>(rows.y0) * from.width, end = static_cast<std::ptrdiff_t>(rows.y1) * from.width;
    std::copy(from.pixels.begin() + begin, from.pixels.begin() + end, to.pixels.begin() + begin);
}

void add_band(RenderResult& all, const RenderResult& band, const PixelRect& rows) {
    copy_rows(all.layer.color, band.layer.color, rows);
    copy_rows(all.layer.alpha, band.layer.alpha, rows);
    all.parts.wanted = band.parts.wanted;
    copy_rows(all.parts.direct, band.parts.direct, rows);
    copy_rows(all.parts.indirect, band.parts.indirect, rows);
    copy_rows(all.parts.caustic, band.parts.caustic, rows);
    copy_rows(all.parts.specular, band.parts.specular, rows);
    copy_rows(all.parts.photon_density, band.parts.photon_density, rows);
    all.faults += band.faults;
    merge_faults(all.fault_places, band.fault_places);
    all.camera_rays += band.camera_rays;
    all.gathers += band.gathers;
    all.stopped = band.stopped;
}

// For who looks on, band by band: a part of a picture has the bits that it has in the whole. Not where gathered light is
// prepared for the whole picture each time.
void find_light(Rendering& r, const Wishes& wishes, const Progress& progress) {
    const PixelRect& window = r.window;
    const bool bands = wishes.on_part && r.world.illumination != Illumination::radiosity;
    const int rows = bands ? 32 : window.y1 - window.y0;
    RenderResult& all = r.rendered;
    all = {};
    for (int y = window.y0; y < window.y1 && !all.stopped; y += rows) {
        const PixelRect band{window.x0, y, window.x1, std::min(y + rows, window.y1)};
        constexpr std::int64_t parts = 1000; // of a band
        const auto of_all = [&](std::int64_t done, std::int64_t total) {
            return progress((y - window.y0) * parts + (band.y1 - y) * parts * done / total, (window.y1 - window.y0) * parts);
        };
        RenderResult found = render(r.world, r.gbuffer, r.photons, r.settings, band, wishes.light_parts, of_all);
        if (!bands) {
            all = std::move(found);
            return;
        }
        add_band(all, found, band);
        tell(r, wishes, RenderedPart::light, band);
    }
}

// Light at points is asked for by two passes alone, the one of the sources and the one of photoreal light.
void render_at_once(const Scene& scene, Rendering& r, const Wishes& wishes, const PictureView& view, const Taken& taken,
                    Passes& passes) {
    if (!taken.photons) r.photons = first_photons(scene, r, wishes, false, passes);
    save_if_asked(scene, r, wishes, passes);
    if (!taken.light || (r.plan.paint && !taken.sources)) add_field(r, r.settings, 1, r.photons, passes);
    if (!taken.seen) look(r, wishes, view, passes);
    tell(r, wishes, RenderedPart::seen, whole(view));
    if (r.plan.paint) {
        r.paint = paint(r, passes, taken.sources ? std::optional(std::move(r.paint.sparse)) : std::nullopt);
        tell(r, wishes, RenderedPart::paint, whole(view));
    }
    if (!taken.light)
        passes.run("render", [&](const Progress& progress) { find_light(r, wishes, progress); });
    else
        tell(r, wishes, RenderedPart::light, r.window);
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
    stop_gently();
    const Taken taken = take_all(r, reuse, passes);
    passes.expect(passes_to_run(r, wishes));
    const PictureView view{r.world.camera, r.settings.render.width, r.settings.render.height};
    try {
        if (wishes.refinement)
            render_in_passes(scene, r, wishes, view, passes);
        else
            render_at_once(scene, r, wishes, view, taken, passes);
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
