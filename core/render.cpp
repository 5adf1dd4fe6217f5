// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render.h"

#include "core/image_io.h"
#include "core/light.h"
#include "core/path_trace.h"
#include "core/radiosity.h"
#include "core/sampling.h"
#include "core/shade.h"

#include <atomic>
#include <mutex>
#include <tuple>

namespace pnr {
namespace {

constexpr int tile = 16; // pixels; tiles lie on the picture's own grid

// Sums over a pixel's samples. Samples whose chain leads to paint are kept apart, so that their share can be
// the G-buffer's coverage and not another estimate of it.
struct PixelSums {
    struct Group {
        Color radiance{0}, direct{0}, indirect{0}, caustic{0}, specular{0};
        float alpha = 0;
        int count = 0;
    };
    Group plain, painted;

    int count() const { return plain.count + painted.count; }
};

struct Counts {
    SampleFaults faults;
    std::vector<FaultPlace> places;
    std::int64_t rays = 0, gathers = 0;
};

// How many rays a pixel gets at first, and where it differs from its neighbours.
struct SampleCounts {
    int first = 1, most = 1;
    bool grid = false; // POV-Ray's method 1
};

struct Job {
    const Shading& shading;
    const GBuffer& gbuffer;
    const Settings& settings;
    SampleCounts samples;
    PixelRect window; // pixels with sums: the picture's window and an apron of one pixel
    SampleRange range; // of each pixel's sequence, where a pass takes a part of it
    std::vector<PixelSums> sums;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.x1 - window.x0) +
               static_cast<std::size_t>(x - window.x0);
    }
};

std::uint64_t pixel_place(int x, int y) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32 | static_cast<std::uint32_t>(x);
}

// Counts what is no number or less than nothing, and makes it 0.
Color checked(Color c, SampleFaults& faults) {
    bool nan = false, inf = false, negative = false;
    for (int i = 0; i < 3; ++i) {
        nan = nan || std::isnan(c[i]);
        inf = inf || std::isinf(c[i]);
        negative = negative || c[i] < 0;
        if (!(c[i] >= 0) || std::isinf(c[i])) c[i] = 0;
    }
    faults.nan += nan;
    faults.inf += inf;
    faults.negative += negative;
    return c;
}

// Books what a sample added to the counts for its pixel.
void note_faults(const SampleFaults& before, int x, int y, std::uint32_t object, Counts& counts) {
    const SampleFaults& now = counts.faults;
    if (now.sum() == before.sum()) return;
    const SampleFaults more{now.nan - before.nan, now.inf - before.inf, now.negative - before.negative};
    if (counts.places.empty() || counts.places.back().x != x || counts.places.back().y != y)
        counts.places.push_back({x, y, object, {}});
    counts.places.back().faults += more;
}

// Sample i of POV-Ray's method 1: the centre, then the grid's places [POV-Ray 3.7 reference, "Anti-Aliasing Options"].
Vec2 grid_sample(const RenderSettings& settings, int x, int y, int i) {
    const GridSampling& grid = settings.grid;
    if (i == 0) return Vec2(x, y) + 0.5;
    Vec2 place((i - 1) % grid.depth + 0.5, (i - 1) / grid.depth + 0.5);
    if (grid.jitter > 0) place += grid.jitter * (pixel_sample(settings.seed, x, y, i) - Vec2(x, y) - 0.5);
    return Vec2(x, y) + place / static_cast<double>(grid.depth);
}

// The camera ray of sample i of a pixel.
Ray sample_ray(const Job& job, int x, int y, int i) {
    const RenderSettings& settings = job.settings.render;
    const Vec2 pixel = job.samples.grid ? grid_sample(settings, x, y, i) : pixel_sample(settings.seed, x, y, i);
    if (!(job.gbuffer.view.camera.lens.aperture > 0)) return pixel_ray(job.gbuffer.view, pixel);
    const std::uint64_t key = make_rng(settings.seed, Pass::render, pixel_place(x, y)).key;
    return lens_ray(job.gbuffer.view, pixel, square_to_disc(sobol_point(static_cast<std::uint32_t>(i), hash_words(key, 7))));
}

SampleCounts sample_counts(const World& world, const RenderSettings& settings) {
    SampleCounts counts;
    const bool path = settings.integrator == Integrator::path;
    const int blur = world.camera.lens.aperture > 0 ? world.camera.lens.samples_max : 0;
    counts.grid = !path && world.illumination != Illumination::photon_mapped && blur == 0;
    counts.first = counts.grid ? 1 : std::max({1, blur, path ? settings.samples_max : settings.samples_min});
    counts.most = counts.grid ? 1 + settings.grid.depth * settings.grid.depth : settings.samples_max;
    counts.most = std::max(counts.first, counts.most);
    return counts;
}

void add_photon_mapped_sample(const Job& job, int x, int y, int i, std::vector<KeptIrradiance>& kept,
                              std::vector<Neighbour>& scratch, PixelSums& sums, Counts& counts) {
    const RenderSettings& settings = job.settings.render;
    const Rng pixel = make_rng(settings.seed, Pass::render, pixel_place(x, y));
    SampleState state;
    state.rng = {hash_words(pixel.key, static_cast<std::uint64_t>(i)), 0};
    // The first samples share the shadow rays asked for; those that refine a pixel bring a quarter as many
    // each.
    const int base = std::max(1, settings.samples_min);
    const int early = std::max(1, (settings.shadow_samples + base - 1) / base), late = (early + 3) / 4;
    state.shadow_samples = i < base ? early : late;
    state.points = {pixel.key,
                    static_cast<std::uint32_t>(i < base ? i * early : base * early + (i - base) * late)};
    state.kept = &kept;
    state.scratch = &scratch;
    const Ray ray = sample_ray(job, x, y, i);
    if (sees_nothing(ray)) {
        ++sums.plain.count;
        return;
    }
    if (job.shading.gathered) state.pixel_width = pixel_width(job.gbuffer.view, Vec2(x + 0.5, y + 0.5));
    const SampleFaults before = counts.faults;
    const Color radiance = checked(shade(job.shading, ray, state), counts.faults);
    note_faults(before, x, y, state.faulty, counts);
    PixelSums::Group& group = state.painted ? sums.painted : sums.plain;
    group.radiance += radiance;
    group.alpha += 1 - (state.painted_weight.x + state.painted_weight.y + state.painted_weight.z) / 3;
    ++group.count;
    if (job.shading.parts) {
        SampleFaults ignored;
        group.direct += checked(state.direct, ignored);
        group.indirect += checked(state.indirect, ignored);
        group.caustic += checked(state.caustic, ignored);
        group.specular += checked(state.specular, ignored);
    }
    counts.rays += state.rays;
    counts.gathers += state.gathers;
}

void add_path(const Job& job, int x, int y, int i, PixelSums& sums, Counts& counts) {
    const RenderSettings& settings = job.settings.render;
    Rng rng = make_rng(settings.seed, Pass::render, pixel_place(x, y));
    rng.key = hash_words(rng.key, static_cast<std::uint64_t>(i));
    const Ray ray = sample_ray(job, x, y, i);
    ++sums.plain.count;
    if (sees_nothing(ray)) return;
    const SampleFaults before = counts.faults;
    sums.plain.radiance += checked(path_radiance(job.shading.world, ray, settings, true, rng), counts.faults);
    note_faults(before, x, y, job.gbuffer.seen.at(x, y).object, counts);
    sums.plain.alpha += 1;
    ++counts.rays;
}

void add_samples(const Job& job, int x, int y, int end, PixelSums& sums, Counts& counts) {
    std::vector<KeptIrradiance> kept;
    std::vector<Neighbour> scratch;
    const int share = job.range.share(x, y);
    for (int n = sums.count(); n < share * end; ++n) {
        const int i = share * job.range.first + n;
        if (job.settings.render.integrator == Integrator::path)
            add_path(job, x, y, i, sums, counts);
        else
            add_photon_mapped_sample(job, x, y, i, kept, scratch, sums, counts);
    }
}

// Mix of the painted object that a pixel's centre sees; 0 if none.
double seen_mix(const World& world, const Seen& seen) {
    return seen.npr ? world.objects[seen.object].paint.mix : 0;
}

// Nothing of the pixel is left for this pass.
bool wholly_painted(const Job& job, int x, int y) {
    const Seen& seen = job.gbuffer.seen.at(x, y);
    return job.gbuffer.coverage.at(x, y) >= 1 && seen.via == 0 && seen_mix(job.shading.world, seen) >= 1;
}

bool needs_rays(const Job& job, int x, int y) {
    return !job.settings.render.prune || !wholly_painted(job, x, y);
}

bool on_painted_border(const Job& job, int x, int y) {
    const float coverage = job.gbuffer.coverage.at(x, y);
    return coverage > 0 && coverage < 1;
}

Color mean_radiance(const PixelSums::Group& group) {
    return group.radiance / static_cast<float>(std::max(1, group.count));
}

// Whether two pixels differ by more than the contrast asked for, in any channel as it is shown: above white
// nothing is seen, and near black differences are judged against 2 % of white.
bool contrasts(Color a, Color b, double contrast) {
    for (int i = 0; i < 3; ++i) {
        const double u = std::min(a[i], 1.0f), v = std::min(b[i], 1.0f);
        if (std::abs(u - v) > contrast * (u + v + 0.02)) return true;
    }
    return false;
}

// As a display shows a value about which POV-Ray compares pixels.
float encoded(float value, const GridSampling& grid) {
    const double light = std::clamp(linear_from_working(value, grid.value_gamma), 0.0f, 1.0f);
    return static_cast<float>(std::pow(light, 1 / grid.gamma));
}

bool grid_contrasts(Color a, Color b, const GridSampling& grid) {
    if (a == b) return false;
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::abs(encoded(a[i], grid) - encoded(b[i], grid));
    return sum >= grid.threshold;
}

// Whether the pixel differs from one beside it.
bool grid_wants_more(const Job& job, const std::vector<PixelSums>& first, int x, int y) {
    const Color mine = mean_radiance(first[job.index(x, y)].plain);
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
        if (job.window.contains(x + dx, y + dy) &&
            grid_contrasts(mine, mean_radiance(first[job.index(x + dx, y + dy)].plain), job.settings.render.grid))
            return true;
    return false;
}

bool wants_more(const Job& job, const std::vector<PixelSums>& first, int x, int y) {
    if (on_painted_border(job, x, y)) return true;
    if (job.samples.grid) return grid_wants_more(job, first, x, y);
    const PixelSums& here = first[job.index(x, y)];
    const Color mine = mean_radiance(here.plain);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (!job.window.contains(x + dx, y + dy)) continue;
            // Without pruning such a pixel may hold samples through a gap; they must not count here either.
            if (wholly_painted(job, x + dx, y + dy)) continue;
            const PixelSums& other = first[job.index(x + dx, y + dy)];
            if (other.plain.count == 0) continue;
            if (contrasts(mine, mean_radiance(other.plain), job.settings.render.contrast)) return true;
        }
    return false;
}

// Runs body(x, y, counts) for the pixels of a rectangle, tile by tile on all cores. False: progress said
// stop, and some pixels were left.
template <class Body>
bool for_pixels(PixelRect r, const Progress& progress, std::int64_t done_before, std::int64_t total,
                Counts& counts, const Body& body) {
    if (r.empty()) return true;
    const int tx0 = r.x0 / tile, tx1 = (r.x1 + tile - 1) / tile, ty0 = r.y0 / tile,
              ty1 = (r.y1 + tile - 1) / tile;
    const int across = tx1 - tx0;
    std::atomic<std::int64_t> done{done_before};
    std::atomic<bool> stop{false};
    std::mutex guard;
    parallel_for(static_cast<std::int64_t>(across) * (ty1 - ty0), 1,
                 [&](std::int64_t begin, std::int64_t end, std::int64_t) {
                     if (stop) return;
                     Counts mine;
                     std::int64_t pixels = 0;
                     for (std::int64_t t = begin; t < end; ++t) {
                         const int left = (tx0 + static_cast<int>(t % across)) * tile;
                         const int top = (ty0 + static_cast<int>(t / across)) * tile;
                         for (int y = std::max(top, r.y0); y < std::min(top + tile, r.y1); ++y)
                             for (int x = std::max(left, r.x0); x < std::min(left + tile, r.x1);
                                  ++x, ++pixels)
                                 body(x, y, mine);
                     }
                     const std::lock_guard lock(guard);
                     counts.faults += mine.faults;
                     counts.places.insert(counts.places.end(), mine.places.begin(), mine.places.end());
                     counts.rays += mine.rays;
                     counts.gathers += mine.gathers;
                     if (progress && !progress(done += pixels, total)) stop = true;
                 });
    return !stop;
}

std::int64_t area(PixelRect r) {
    return r.empty() ? 0 : static_cast<std::int64_t>(r.x1 - r.x0) * (r.y1 - r.y0);
}

// A pixel's two groups joined by its coverage; where one group is empty the other stands for all.
template <class T>
T joined(const PixelSums& sums, float coverage, T PixelSums::Group::*what) {
    const T plain = sums.plain.count > 0 ? sums.plain.*what / static_cast<float>(sums.plain.count) : T{0};
    const T painted =
        sums.painted.count > 0 ? sums.painted.*what / static_cast<float>(sums.painted.count) : T{0};
    const float share = sums.plain.count == 0 ? 1.0f : (sums.painted.count == 0 ? 0.0f : coverage);
    return plain * (1 - share) + painted * share;
}

void write_pixel(const Job& job, int x, int y, RenderResult& result) {
    const PixelSums& sums = job.sums[job.index(x, y)];
    const float coverage = job.gbuffer.coverage.at(x, y);
    if (sums.count() == 0 || wholly_painted(job, x, y)) return;
    result.layer.color.at(x, y) = joined(sums, coverage, &PixelSums::Group::radiance);
    result.layer.alpha.at(x, y) = std::clamp(joined(sums, coverage, &PixelSums::Group::alpha), 0.0f, 1.0f);
    if (!result.parts.wanted) return;
    result.parts.direct.at(x, y) = joined(sums, coverage, &PixelSums::Group::direct);
    result.parts.indirect.at(x, y) = joined(sums, coverage, &PixelSums::Group::indirect);
    result.parts.caustic.at(x, y) = joined(sums, coverage, &PixelSums::Group::caustic);
    result.parts.specular.at(x, y) = joined(sums, coverage, &PixelSums::Group::specular);
    const Seen& seen = job.gbuffer.seen.at(x, y);
    const GatherSettings& gathers =
        job.shading.indirect.count > 0 ? job.shading.indirect : job.shading.caustic;
    if (seen.z > 0 && gathers.count > 0 && !job.shading.map.photons.empty()) {
        std::vector<Neighbour> found;
        const PhotonMap& map = job.shading.map;
        find_within(map.tree.count > 0 ? map.tree : map.caustic, seen.position, gathers.radius, found);
        result.parts.photon_density.at(x, y) =
            static_cast<float>(static_cast<double>(found.size()) / (pi * gathers.radius * gathers.radius));
    }
}

// What the map is asked for: nothing where there is none, caustics alone in POV-Ray's `photons {}` scenes.
void choose_gathers(Shading& shading, const PhotonSettings& photons) {
    shading.indirect.count = shading.caustic.count = 0;
    const World& world = shading.world;
    const bool lit = world.illumination == Illumination::photon_mapped || world.caustics_apart;
    if (shading.map.photons.empty() || !lit) return; // a map may be there for paint's sake, or unpruned
    const GatherSettings both = default_gather(world, shading.map, photons);
    shading.caustic = both;
    shading.caustic.direct = shading.caustic.indirect = false;
    if (shading.map.caustic.count == 0) shading.caustic.count = 0;
    if (world.illumination != Illumination::photon_mapped) return;
    shading.indirect = both;
    shading.indirect.caustic = false;
    shading.indirect.sharp = shading.settings.sharp;
}

RenderResult empty_result(int width, int height, bool want_parts) {
    RenderResult result;
    result.layer = {Image<Color>(width, height), Image<float>(width, height)};
    result.parts.wanted = want_parts;
    if (want_parts) {
        for (Image<Color>* part :
             {&result.parts.direct, &result.parts.indirect, &result.parts.caustic, &result.parts.specular})
            *part = Image<Color>(width, height);
        result.parts.photon_density = Image<float>(width, height);
    }
    return result;
}

} // namespace

void merge_faults(std::vector<FaultPlace>& places, std::vector<FaultPlace> more) {
    if (more.empty()) return;
    places.insert(places.end(), more.begin(), more.end());
    const auto before = [](const FaultPlace& a, const FaultPlace& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); };
    std::stable_sort(places.begin(), places.end(), before);
    std::size_t kept = 0;
    for (std::size_t i = 1; i < places.size(); ++i) {
        FaultPlace& last = places[kept];
        if (before(last, places[i])) {
            places[++kept] = places[i];
            continue;
        }
        last.faults += places[i].faults;
    }
    places.resize(kept + 1);
}

RenderResult render(const World& world, const GBuffer& gbuffer, const PhotonMap& map,
                    const Settings& settings, PixelRect window, bool want_parts, const Progress& progress,
                    std::optional<SampleRange> samples) {
    const int width = gbuffer.view.width, height = gbuffer.view.height;
    RenderResult result = empty_result(width, height, want_parts);
    Shading shading{world, map, settings.render, {}, {}, want_parts, nullptr, nullptr};
    choose_gathers(shading, settings.photons);

    const bool gathers = world.illumination == Illumination::radiosity && settings.render.integrator == Integrator::photons;
    if (gathers) shading.radiosity = &settings.radiosity;
    const auto gathered = gathers ? make_gathered_light(shading, gbuffer.view, {}) : nullptr;
    shading.gathered = gathered.get();
    // Samples that are given need no look at the neighbours.
    const SampleCounts counted =
        samples ? SampleCounts{samples->count, samples->count} : sample_counts(world, settings.render);
    const int first = counted.first, most = counted.most;
    Job job{shading,
            gbuffer,
            settings,
            counted,
            grow(window, samples ? 0 : 1, width, height),
            samples.value_or(SampleRange{}),
            {}};
    job.sums.resize(static_cast<std::size_t>(area(job.window)));
    const PixelRect inner = grow(window, 0, width, height);
    const std::int64_t total = std::max<std::int64_t>(1, area(job.window) + area(inner));
    Counts counts;
    const bool sampled = for_pixels(job.window, progress, 0, total, counts, [&](int x, int y, Counts& mine) {
        if (needs_rays(job, x, y)) add_samples(job, x, y, first, job.sums[job.index(x, y)], mine);
    });
    // Which pixels want more is read from the first samples alone, so that no order of pixels can matter.
    const std::vector<PixelSums> before = sampled && most > first ? job.sums : std::vector<PixelSums>{};
    const auto refine = [&](int x, int y, Counts& mine) {
        if (most > first && needs_rays(job, x, y) && wants_more(job, before, x, y))
            add_samples(job, x, y, most, job.sums[job.index(x, y)], mine);
        write_pixel(job, x, y, result);
    };
    result.stopped = !sampled || !for_pixels(inner, progress, area(job.window), total, counts, refine);
    if (result.stopped) // what there is of each pixel
        for (int y = inner.y0; y < inner.y1; ++y)
            for (int x = inner.x0; x < inner.x1; ++x) write_pixel(job, x, y, result);
    result.faults = counts.faults;
    merge_faults(result.fault_places, std::move(counts.places));
    result.camera_rays = counts.rays;
    result.gathers = counts.gathers;
    return result;
}

} // namespace pnr
