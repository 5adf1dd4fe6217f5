// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/forecast.h"

#include "core/trace_photons.h"
#include "npr/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <unistd.h>

namespace pnr {

namespace {

// Of the small picture; in a smaller one too little is seen of what there is.
constexpr int small_width = 112;
// Photons of the small run: as many fewer as there are pixels fewer, so that it looks alike, but enough for the
// projection map of caustics (emission.cpp) to be made.
constexpr double fewest_photons = 16'500;

// How much more of each there is in the rendering than in the small run.
struct Scale {
    double photons = 1, pixels = 1;
};

// How a pass' time grows: by powers of the photons' and the pixels' ratio. Fitted to 34 scenes (scenes/, gallery,
// course, paper) at 256 and eight of them at 512 pixels' width, one thread: root mean square of the logarithm's
// error 0.07 photons and kdtree, 0.10 gbuffer, 0.28 sparse, 0.22 render. What is beside 0 and 1 says how pictures grow:
// of a larger one a smaller share are edges, which get more samples; strokes are longer; records of indirect
// light are shared by more pixels.
struct Law {
    double photons = 0, pixels = 0;
};
double grown(double seconds, Law law, const Scale& scale) {
    return std::max(0.0, seconds) * std::pow(scale.photons, law.photons) * std::pow(scale.pixels, law.pixels);
}
constexpr Law photons_law{1, 0}, kdtree_law{1, 0}, gbuffer_law{0, 0.75}, orient_law{1, 0}, informative_law{0, 1.25},
    ilic_law{0, 1.1};
constexpr Law sparse_law{1, 0}, sparse_records_law{0.4, 0.2}; // source photons' light; the records that it asks for
constexpr Law render_law{0, 0.85}, render_records_law{0.2, 0};
// Loading the image library and writing a PNG: s and s a pixel, where the above was measured (2.6 GHz).
constexpr double write_s = 0.165, write_s_pixel = 3.5e-7;

// ---- the small run
// ---------------------------------------------------------------------------------------------------

// CPU seconds of its parts.
struct Taken {
    double photons_fixed = 0, photons = 0, kdtree = 0, gbuffer = 0;
    double sparse = 0, sparse_again = 0;   // the second time all records that it asks for are there
    double fields = 0, orient = 0;         // the field's making, which no number of photons changes, and the rest
    double informative = 0, ilic = 0, render = 0, render_again = 0;
    double fields_bytes = 0;
};

double resident_bytes() {
    std::ifstream file("/proc/self/statm");
    double size = 0, resident = 0;
    file >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// The seconds that `work` takes.
template <class Work>
double timed(const char* pass, const Work& work) {
    Passes passes(ProgressMode::off, false);
    passes.run(pass, work);
    double sum = 0;
    for (const PassTime& time : passes.times()) sum += time.cpu_s;
    return sum;
}

void run_photons(Rendering& r, Taken& taken) {
    if (!r.plan.photons) return;
    PhotonSettings one = r.settings.photons;
    one.count = 1, one.spacing = 0;
    taken.photons_fixed = timed("photons", [&](const Progress& progress) {
        trace_photons(r.world, one, r.settings.render.seed, 0, r.plan.normals, progress);
    });
    Passes passes(ProgressMode::off, false);
    r.photons = make_photons(r, r.settings, 0, 1, true, passes);
    for (const PassTime& time : passes.times()) {
        if (time.name == "photons") taken.photons = time.cpu_s - taken.photons_fixed;
        if (time.name == "kdtree") taken.kdtree = time.cpu_s;
    }
}

void run_paint(Rendering& r, Taken& taken) {
    if (!r.plan.paint) return;
    PaintResult& p = r.paint;
    const std::uint64_t seed = r.settings.render.seed;
    const auto sparse = [&](const Progress& progress) {
        p.sparse = make_sparse_map(r.world, r.gbuffer, r.photons, r.settings, progress);
    };
    taken.sparse = timed("sparse", sparse);
    taken.sparse_again = r.photons.field ? timed("sparse", sparse) : taken.sparse;
    const double resident = resident_bytes();
    taken.fields = timed("orient", [&](const Progress&) { p.fields = make_orientation_fields(r.world); });
    taken.fields_bytes = std::max(0.0, resident_bytes() - resident);
    taken.orient = timed("orient", [&](const Progress& progress) {
        p.oriented = orient_photons(r.world, r.photons, p.fields, progress);
        orient_strokes(p.sparse, r.world, r.gbuffer, r.photons, p.oriented);
    });
    taken.informative = timed("informative", [&](const Progress& progress) {
        p.informative = make_informative_map(p.sparse, r.world, r.gbuffer, seed, progress);
    });
    taken.ilic = timed("ilic", [&](const Progress& progress) {
        p.layer = convolve(p.informative, find_seats(r.world, r.gbuffer, r.photons), r.world, r.gbuffer, seed, progress);
    });
}

Taken run_small(Rendering& r) {
    Taken taken;
    run_photons(r, taken);
    const PictureView view{r.world.camera, r.settings.render.width, r.settings.render.height};
    r.window = {0, 0, view.width, view.height};
    taken.gbuffer = timed("gbuffer", [&](const Progress& progress) {
        r.gbuffer = make_gbuffer(r.world, view, r.window, r.settings.render, progress);
    });
    run_paint(r, taken);
    const auto rendering = [&](const Progress& progress) {
        r.rendered = render(r.world, r.gbuffer, r.photons, r.settings, r.window, false, progress);
    };
    taken.render = timed("render", rendering);
    taken.render_again = r.photons.field ? timed("render", rendering) : taken.render;
    complete_picture(r);
    return taken;
}

// ---- from there to the rendering
// --------------------------------------------------------------------------------------

double seconds_of(const std::string& pass, const Taken& t, const Scale& scale, double pixels) {
    if (pass == "photons") return t.photons_fixed + grown(t.photons, photons_law, scale);
    if (pass == "kdtree") return grown(t.kdtree, kdtree_law, scale);
    if (pass == "gbuffer") return grown(t.gbuffer, gbuffer_law, scale);
    if (pass == "sparse")
        return grown(t.sparse_again, sparse_law, scale) + grown(t.sparse - t.sparse_again, sparse_records_law, scale);
    if (pass == "orient") return t.fields + grown(t.orient, orient_law, scale);
    if (pass == "informative") return grown(t.informative, informative_law, scale);
    if (pass == "ilic") return grown(t.ilic, ilic_law, scale);
    if (pass == "render")
        return grown(t.render_again, render_law, scale) + grown(t.render - t.render_again, render_records_law, scale);
    return pass == "write" ? write_s + write_s_pixel * pixels : 0;
}

double scale_of(const std::string& structure, const Scale& scale) {
    if (structure == "bvh") return 1;
    return structure == "photons" || structure == "kdtree" || structure == "field" ? scale.photons : scale.pixels;
}

// What the passes hold, and beside it for a while, in the order in which they come.
void foretell_memory(Forecast& f, const Rendering& small, const Scale& scale, const Taken& taken, double peak_mb) {
    std::array<double, 7> sizes{};
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = f.structures[i].bytes;
    const auto [bvh, photons, kdtree, field, gbuffer, paint, picture] = sizes;
    const double stored = static_cast<double>(small.photons.photons.size()) * scale.photons;
    const double pixels = static_cast<double>(f.width) * f.height;
    double held = peak_mb * 1e6, peak = held;
    for (PassForecast& pass : f.passes) {
        double brief = 0; // given back at the end of the pass
        if (pass.name == "photons") held += photons, brief = photons;
        if (pass.name == "kdtree") held += kdtree + field, brief = std::max(0.0, photons + 20 * stored - field);
        if (pass.name == "gbuffer") held += gbuffer;
        if (pass.name == "orient") held += taken.fields_bytes;
        if (pass.name == "sparse") held += paint;
        if (pass.name == "ilic" && paint > 0) brief = 160 * pixels + 60 * stored;
        if (pass.name == "render") held += picture, brief = 270 * pixels;
        if (pass.name == "write") held += 95e6, brief = 16 * pixels;
        peak = std::max(peak, held + brief);
        pass.peak_rss_mb = peak / 1e6;
    }
}

} // namespace

Forecast forecast(World world, const Settings& settings, const Plan& plan, const std::vector<PassTime>& times) {
    Forecast f;
    const PictureSize size = picture_size(world.camera, settings.render);
    f.width = size.width, f.height = size.height;
    Rendering small;
    small.plan = plan;
    small.settings = settings;
    RenderSettings& picture = small.settings.render;
    f.small_width = picture.width = std::min(small_width, size.width);
    picture.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(picture.width) / size.width * size.height)));
    Scale scale;
    const double pixels = static_cast<double>(size.width) * size.height;
    scale.pixels = pixels / (static_cast<double>(picture.width) * picture.height);
    f.photons = plan.photons ? plan_emission(world, settings.photons).everywhere : 0;
    const double like = static_cast<double>(f.photons) / scale.pixels;
    f.small_photons = std::min(f.photons, static_cast<std::int64_t>(std::max(like, fewest_photons)));
    if (f.small_photons > 0) scale.photons = static_cast<double>(f.photons) / static_cast<double>(f.small_photons);
    small.settings.photons.count = f.small_photons;
    small.settings.photons.spacing = 0;
    small.settings.photons.radius *= std::sqrt(scale.photons);
    small.world = std::move(world);
    const Taken taken = run_small(small);

    double sum = 0;
    for (const PassTime& time : times) {
        const double own = seconds_of(time.name, taken, scale, pixels);
        f.passes.push_back({time.name, time.cpu_s + own, 0, 0});
        sum += f.passes.back().cpu_s;
    }
    for (PassForecast& pass : f.passes) pass.share = pass.cpu_s / sum;
    f.structures = structure_sizes(small);
    for (StructureSize& structure : f.structures) structure.bytes *= scale_of(structure.name, scale);
    double peak_mb = 0;
    for (const PassTime& time : times) peak_mb = std::max(peak_mb, time.peak_rss_mb);
    foretell_memory(f, small, scale, taken, peak_mb);
    for (std::size_t i = 0; i < 2; ++i) f.passes[i].peak_rss_mb = times[i].peak_rss_mb;
    return f;
}

} // namespace pnr
