// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/forecast.h"

#include "core/lit_places.h"
#include "core/trace_photons.h"
#include "npr/paint.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace pnr {

namespace {

// Of the small picture: a third of the width, between these. In a smaller one too little is seen of what
// there is.
constexpr int least_width = 48, most_width = 112;
// Photons of the small run: as many fewer as there are pixels fewer, so that it looks alike, but enough for
// the projection map of caustics (emission.cpp) to be made.
constexpr double fewest_photons = 16'500;

constexpr double mega = 1024 * 1024;

// How much more of each there is in the rendering than in the small run.
struct Scale {
    double photons = 1, pixels = 1;
};

// How a pass' time grows: by powers of the photons' and the pixels' ratio. Fitted to 34 scenes (scenes/,
// gallery, course, paper) at 256 and eight of them at 512 pixels' width, one thread: root mean square of the
// logarithm's error 0.07 photons and kdtree, 0.10 gbuffer, 0.28 sparse, 0.22 render. What is beside 0 and 1
// says how pictures grow: of a larger one a smaller share are edges, which get more samples; strokes are
// longer; records of indirect light are shared by more pixels.
struct Law {
    double photons = 0, pixels = 0;
};
double grown(double seconds, Law law, const Scale& scale) {
    return std::max(0.0, seconds) * std::pow(scale.photons, law.photons) * std::pow(scale.pixels, law.pixels);
}
constexpr Law photons_law{1, 0}, kdtree_law{1, 0}, gbuffer_law{0, 0.75}, orient_law{1, 0},
    informative_law{0, 1.25}, ilic_law{0, 1.1};
constexpr Law sparse_law{1, 0},
    sparse_records_law{0.4, 0.2}; // source photons' light; the records that it asks for
constexpr Law render_law{0, 0.85}, render_records_law{0.2, 0};
// Writing a PNG: s and s a pixel, where the above was measured (2.6 GHz); and keeping what a painted picture is made of for
// later runs.
constexpr double write_s = 0.002, write_s_pixel = 2.6e-7, keep_s_pixel = 5e-7;

// ---- the small run
// ---------------------------------------------------------------------------------------------------

// CPU seconds of its parts.
struct Taken {
    double photons_fixed = 0, photons = 0, kdtree = 0, gbuffer = 0;
    double sparse = 0, sparse_again = 0; // the second time all records that it asks for are there
    double fields = 0, orient = 0; // the field's making, which no number of photons changes, and the rest
    double informative = 0, ilic = 0, render = 0, render_again = 0;
    double fields_bytes = 0, fields_brief_bytes = 0; // kept, and beside it while it is made
};

double resident_bytes() {
    std::ifstream file("/proc/self/statm");
    double size = 0, resident = 0;
    file >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024;
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
    const double before = resident_bytes(), peak_before = peak_bytes();
    taken.fields = timed("orient", [&](const Progress&) { p.fields = make_orientation_fields(r.world); });
    taken.fields_bytes = std::max(0.0, resident_bytes() - before);
    if (peak_bytes() > peak_before) taken.fields_brief_bytes = std::max(0.0, peak_bytes() - resident_bytes());
    taken.orient = timed("orient", [&](const Progress& progress) {
        p.oriented = orient_photons(r.world, r.photons, p.fields, progress);
        orient_strokes(p.sparse, r.world, r.gbuffer, r.photons, p.oriented);
    });
    taken.informative = timed("informative", [&](const Progress& progress) {
        p.informative = make_informative_map(p.sparse, r.world, r.gbuffer, seed, progress);
    });
    taken.ilic = timed("ilic", [&](const Progress& progress) {
        p.layer = convolve(p.informative, find_seats(r.world, r.gbuffer, r.photons), r.world, r.gbuffer, seed,
                           progress);
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
        return grown(t.sparse_again, sparse_law, scale) +
               grown(t.sparse - t.sparse_again, sparse_records_law, scale);
    if (pass == "orient") return t.fields + grown(t.orient, orient_law, scale);
    if (pass == "informative") return grown(t.informative, informative_law, scale);
    if (pass == "ilic") return grown(t.ilic, ilic_law, scale);
    if (pass == "render")
        return grown(t.render_again, render_law, scale) +
               grown(t.render - t.render_again, render_records_law, scale);
    return pass == "write" ? write_s + (write_s_pixel + (t.sparse > 0 ? keep_s_pixel : 0)) * pixels : 0;
}

// The part of an irradiance field that keeps light at places among the photons (lit_places.h): a record and a
// tree's entry a place, and a table of at least four slots a place.
double lit_bytes(double photons) {
    const auto places = static_cast<std::size_t>(photons / lit_stride);
    const double table =
        static_cast<double>(std::bit_ceil(std::max<std::size_t>(1024, 4 * places)) * sizeof(LitCells::Slot));
    return table + static_cast<double>(places * (sizeof(LitPlaces::Place) + 18));
}

// The other part, sites at distances that the scene's size gives, hardly grows with the photons, but that
// more of them allow finer levels, each with four times the sites (irradiance_field.cpp).
double level_sites(double scene_radius, double gather_radius) {
    const double photon_distance = std::sqrt(pi / 100) * gather_radius;
    double sites = 0, of_level = 1;
    int levels = 0;
    for (double s = scene_radius / 10; levels < 4 && s > photon_distance; s /= 2, ++levels, of_level *= 4)
        sites += of_level;
    return std::max(1.0, sites);
}

double field_bytes_of(const Rendering& small, double bytes, const Scale& scale) {
    const PhotonMap& map = small.photons;
    if (!map.field) return 0;
    const auto photons = static_cast<double>(map.tree.count), radius = static_cast<double>(map.radius);
    const double finer = level_sites(small.world.radius, radius / std::sqrt(scale.photons)) /
                         level_sites(small.world.radius, radius);
    return std::max(0.0, bytes - lit_bytes(photons)) * std::max(finer, std::pow(scale.photons, 0.2)) +
           lit_bytes(photons * scale.photons);
}

// Of the rendering, in bytes.
struct Sizes {
    double bvh = 0, photons = 0, kdtree = 0, field = 0, gbuffer = 0, picture = 0;
    double sparse = 0, oriented = 0, informative = 0,
           layer = 0;               // together what structure_sizes calls `paint`
    double stored = 0, painted = 0; // numbers of photons
};

Sizes foretell_sizes(const Rendering& small, const Scale& scale) {
    const auto bytes = [](const auto& values) {
        return static_cast<double>(values.size() * sizeof(values[0]));
    };
    Sizes s;
    for (const StructureSize& size : structure_sizes(small)) {
        if (size.name == "bvh") s.bvh = size.bytes;
        if (size.name == "photons") s.photons = size.bytes * scale.photons;
        if (size.name == "kdtree") s.kdtree = size.bytes * scale.photons;
        if (size.name == "field") s.field = field_bytes_of(small, size.bytes, scale);
        if (size.name == "gbuffer") s.gbuffer = size.bytes * scale.pixels;
        if (size.name == "picture") s.picture = size.bytes * scale.pixels;
    }
    const PaintResult& paint = small.paint;
    s.sparse = bytes(paint.sparse.pixels) * scale.pixels;
    s.informative = bytes(paint.informative.pixels) * scale.pixels;
    s.layer = (bytes(paint.layer.color.pixels) + bytes(paint.layer.alpha.pixels)) * scale.pixels;
    s.oriented = bytes(paint.oriented) * scale.photons;
    const std::vector<Photon>& photons = small.photons.photons;
    const auto painted =
        std::count_if(photons.begin(), photons.end(), [](const Photon& photon) { return photon.npr(); });
    s.stored = static_cast<double>(photons.size()) * scale.photons;
    s.painted = static_cast<double>(painted) * scale.photons;
    return s;
}

// What the passes hold, and beside it for a while, in the order in which they come: copies of the photons
// while they are joined and sorted, a pixel's sums of samples, what is kept for later runs as it is written. Fitted
// to the same scenes.
void foretell_memory(Forecast& f, const Sizes& s, const Taken& taken) {
    const double pixels = static_cast<double>(f.width) * f.height, painted_pixels = s.sparse > 0 ? pixels : 0;
    constexpr double photon_bytes = 52, seen_bytes = 2 * 112; // in a file to be; an entry and its file
    double held = f.passes[1].peak_rss_mb * mega, peak = held;
    const auto pass = [&](const char* name, double kept, double brief) {
        held += kept;
        peak = std::max(peak, held + brief);
        for (PassForecast& p : f.passes)
            if (p.name == name && (kept + brief > 0 || p.cpu_s > 0)) p.peak_rss_mb = peak / mega;
    };
    pass("photons", s.photons, 0.6 * s.photons);
    pass("kdtree", s.kdtree + s.field, std::max(0.0, 48 * s.stored - s.field));
    pass("gbuffer", s.gbuffer, 0);
    pass("sparse", s.sparse, 0);
    pass("orient", s.oriented + taken.fields_bytes, taken.fields_brief_bytes);
    pass("informative", s.informative, 0);
    pass("ilic", s.layer, 160 * painted_pixels + 60 * s.painted);
    pass("render", s.picture, 270 * pixels);
    pass("write", 0, 16 * pixels + std::max(photon_bytes * s.stored, seen_bytes * painted_pixels));
}

} // namespace

Forecast forecast(World world, const Settings& settings, const Plan& plan,
                  const std::vector<PassTime>& times) {
    Forecast f;
    const PictureSize size = picture_size(world.camera, settings.render);
    f.width = size.width, f.height = size.height;
    Rendering small;
    small.plan = plan;
    small.settings = settings;
    RenderSettings& picture = small.settings.render;
    f.small_width = picture.width = std::min(size.width, std::clamp(size.width / 3, least_width, most_width));
    picture.height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(picture.width) / size.width * size.height)));
    Scale scale;
    const double pixels = static_cast<double>(size.width) * size.height;
    scale.pixels = pixels / (static_cast<double>(picture.width) * picture.height);
    f.photons = plan.photons ? plan_emission(world, settings.photons).everywhere : 0;
    const double like = static_cast<double>(f.photons) / scale.pixels;
    f.small_photons = std::min(f.photons, static_cast<std::int64_t>(std::max(like, fewest_photons)));
    if (f.small_photons > 0)
        scale.photons = static_cast<double>(f.photons) / static_cast<double>(f.small_photons);
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
    const Sizes sizes = foretell_sizes(small, scale);
    f.structures = {{"bvh", sizes.bvh},
                    {"photons", sizes.photons},
                    {"kdtree", sizes.kdtree},
                    {"field", sizes.field},
                    {"gbuffer", sizes.gbuffer},
                    {"paint", sizes.sparse + sizes.oriented + sizes.informative + sizes.layer},
                    {"picture", sizes.picture}};
    for (std::size_t i = 0; i < 2; ++i) f.passes[i].peak_rss_mb = times[i].peak_rss_mb; // parse and build
    foretell_memory(f, sizes, taken);
    return f;
}

} // namespace pnr
