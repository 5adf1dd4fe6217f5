// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/coat.h"

#include "core/rng.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"

#include <boost/container/small_vector.hpp>

#include <span>

namespace pnr {

namespace {

// ---- one path
// -----------------------------------------------------------------------------------------------------

struct Walk {
    int count = 0;              // steps to each side
    float step = 1;             // canvas pixels
    std::vector<float> weights; // k(s) of each step: Hann over the whole path, or box
};

// `length` is the whole path's, in canvas pixels, `step` at most so long.
Walk make_walk(double length, double step, bool box) {
    Walk walk;
    const double half = length / 2;
    walk.count = static_cast<int>(std::ceil(half / step - 1e-9));
    if (walk.count <= 0) return walk;
    walk.step = static_cast<float>(half / walk.count);
    for (int k = 0; k < walk.count; ++k)
        walk.weights.push_back(box ? 1.0f
                                   : static_cast<float>(0.5 + 0.5 * std::cos(pi * (k + 0.5) / walk.count)));
    return walk;
}

// One side's samples: cell and k(s) times the way, in the path's order.
struct Side {
    Path path;
    std::uint32_t turn = 0; // of the sample in the next step
    std::size_t count = 0;
    std::vector<std::uint32_t> cells;
    std::vector<float> weights;

    void start(Vec2f at, Vec2f heading, std::uint32_t first) {
        path = {at, heading};
        turn = first;
        count = 0;
    }
};

// The path through a canvas pixel, both ways.
struct PixelPath {
    int x = 0, y = 0;             // canvas pixel, without the rim
    std::uint32_t here = no_cell; // its own cell
    Side sides[2];
};

// Calls flush(cell, weight) for each run of samples in one cell along the path; `weight` is the sum of k(s)
// over the run.
template <class Flush>
inline void for_each_run(const PixelPath& path, Flush&& flush) {
    std::uint32_t run_cell = path.here;
    float run_weight = 0;
    for (const Side& side : path.sides)
        for (std::size_t i = 0; i < side.count; ++i) {
            if (side.cells[i] != run_cell) {
                if (run_weight > 0) flush(run_cell, run_weight);
                run_cell = side.cells[i];
                run_weight = 0;
            }
            run_weight += side.weights[i];
        }
    if (run_weight > 0) flush(run_cell, run_weight);
}

// A step waits for what the one before has read; paths that are walked side by side wait together. Measured,
// 26 steps each way: see bench_ilic.
constexpr int abreast = 2; // pixels, with two sides each

void walk_abreast(const Canvas& canvas, const Walk& walk, std::span<PixelPath> paths) {
    const auto whole = static_cast<float>(walk.count);
    for (PixelPath& path : paths) {
        const int x = path.x + canvas.rim, y = path.y + canvas.rim;
        const CanvasPoint& here = canvas.at(x, y);
        const Vec2f start(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        // One sample a stratum; its place goes round by the golden ratio from a start hashed from the pixel.
        const auto first = static_cast<std::uint32_t>(mix_bits(
            static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(static_cast<std::uint32_t>(x))));
        path.here = here.cell;
        path.sides[0].start(start, here.direction, first);
        path.sides[1].start(start, -here.direction, first * 747796405u + 2891336453u);
    }
    bool going = true;
    for (int k = 0; k < longest_way * walk.count && going; ++k) {
        going = false;
        for (PixelPath& path : paths)
            for (Side& side : path.sides) {
                if (!side.path.going) continue;
                const float share = static_cast<float>(side.turn >> 8) * 0x1p-24f;
                side.turn += 2654435769u;
                step_path(canvas, side.path, walk.step, share, whole,
                          [&](float before, float stretch, std::uint32_t cell) {
                              side.cells[side.count] = cell;
                              side.weights[side.count++] =
                                  stretch * walk.weights[static_cast<std::size_t>(before)];
                          });
                going = going || side.path.going;
            }
    }
}

// Calls body(path) for every stride-th canvas pixel of the region each way, rows in parallel.
template <class Body>
void for_each_path(const RegionWork& work, const Walk& walk, int stride, Body&& body) {
    const int rows = (work.mask.height * work.scale + stride - 1) / stride,
              columns = work.mask.width * work.scale;
    parallel_for(rows, 4, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::array<PixelPath, abreast> paths;
        for (PixelPath& path : paths)
            for (Side& side : path.sides) {
                side.cells.resize(static_cast<std::size_t>(longest_way * walk.count));
                side.weights.resize(side.cells.size());
            }
        std::size_t ready = 0;
        const auto finish = [&] {
            const std::span<PixelPath> some(paths.data(), ready);
            walk_abreast(work.canvas, walk, some);
            for (const PixelPath& path : some) body(path);
            ready = 0;
        };
        for (int y = static_cast<int>(begin) * stride; y < static_cast<int>(end) * stride; y += stride)
            for (int x = 0; x < columns; x += stride) {
                if (work.mask.at(x / work.scale, y / work.scale) == 0) continue;
                paths[ready].x = x;
                paths[ready].y = y;
                if (++ready == paths.size()) finish();
            }
        if (ready > 0) finish();
    });
}

struct Stroke {
    Color base{0}, deviates{0};
    float height = 0, priority = 0;
};

Stroke convolve_at(const PixelPath& path, const std::vector<CellRecord>& records) {
    glm::dvec3 base(0), deviates(0);
    double height = 0, priority = 0, weight = 0;
    for_each_run(path, [&](std::uint32_t cell, float run) {
        const CellRecord& record = records[cell];
        const double w = static_cast<double>(run) * record.weight;
        weight += w;
        base += w * glm::dvec3(record.base);
        deviates += w * glm::dvec3(record.deviates);
        height += w * static_cast<double>(record.height);
        priority += w * static_cast<double>(record.priority);
    });
    if (!(weight > 0)) { // length 0, or a region too thin to walk in
        const CellRecord& record = records[path.here];
        return {record.base, record.deviates, record.height, record.priority};
    }
    return {Color(base / weight), Color(deviates / weight), static_cast<float>(height / weight),
            static_cast<float>(priority / weight)};
}

// What a coat comes to, from every fourth canvas pixel each way.
struct CoatSample {
    // By how much the noise must be raised so that its standard deviation after the convolution is the one
    // asked for: from the expected variance of the weighted means.
    float gain = 1;
    std::vector<float>
        priorities; // of the strokes lying there, sorted: a place in the list is a share of the area
};

// The priority below which the strokes on the given share of the area lie.
float priority_below(const CoatSample& sample, float share) {
    if (!(share > 0) || sample.priorities.empty()) return -1;
    const auto place = static_cast<std::size_t>(share * static_cast<float>(sample.priorities.size()));
    return place < sample.priorities.size() ? sample.priorities[place] : 2;
}

// The variance that the weighted mean of independent unit values keeps, and the mean priority.
struct PathSample {
    double variance = 1, priority = 0;
};
PathSample sample_path(const PixelPath& path, const std::vector<CellRecord>& records) {
    boost::container::small_vector<std::pair<std::uint32_t, double>, 32> met;
    for_each_run(path, [&](std::uint32_t cell, float run) {
        const double w = static_cast<double>(run) * records[cell].weight;
        const auto known =
            std::find_if(met.begin(), met.end(), [&](const auto& m) { return m.first == cell; });
        if (known != met.end())
            known->second += w;
        else
            met.emplace_back(cell, w);
    });
    double total = 0, squares = 0, priority = 0;
    for (const auto& [cell, w] : met) {
        total += w;
        squares += w * w;
        priority += w * static_cast<double>(records[cell].priority);
    }
    if (!(total > 0)) return {1, static_cast<double>(records[path.here].priority)};
    return {squares / (total * total), priority / total};
}

CoatSample sample_coat(const RegionWork& work, const Walk& walk, const std::vector<CellRecord>& records) {
    constexpr float largest_gain = 16;
    const int stride = work.region.pixels * work.scale * work.scale > 4096 ? 4 : 1;
    struct Row {
        double variance = 0;
        std::vector<float> priorities;
    };
    std::vector<Row> by_row(static_cast<std::size_t>(work.mask.height * work.scale));
    for_each_path(work, walk, stride, [&](const PixelPath& path) {
        const PathSample found = sample_path(path, records);
        Row& row = by_row[static_cast<std::size_t>(path.y)];
        row.variance += found.variance;
        row.priorities.push_back(static_cast<float>(found.priority));
    });
    CoatSample sample;
    double variance = 0;
    for (const Row& row : by_row) {
        variance += row.variance;
        sample.priorities.insert(sample.priorities.end(), row.priorities.begin(), row.priorities.end());
    }
    std::sort(sample.priorities.begin(), sample.priorities.end());
    const auto count = static_cast<double>(sample.priorities.size());
    if (variance > 0) sample.gain = std::min(largest_gain, static_cast<float>(std::sqrt(count / variance)));
    return sample;
}

// ---- coats
// --------------------------------------------------------------------------------------------------------

// Where strokes begin to be left out their edge is this soft, in priority.
constexpr float bare_softness = 0.01f;

constexpr double bristle_length = 24; // of a bristle's mark, pixels at 512
constexpr double bristle_width = 1.2;
constexpr int bristle_coat = 1000; // its cells are no coat's

} // namespace

std::vector<PaintLayer> coats_of(const PaintStyle& style) {
    std::vector<PaintLayer> coats = style.layers;
    if (coats.empty()) {
        PaintLayer coat;
        coat.length = style.length;
        coat.cell = style.cell;
        coat.noise_lightness = style.noise_lightness;
        coat.noise_chroma = style.noise_chroma;
        coat.edge = style.edge;
        coats.push_back(coat);
    }
    for (PaintLayer& coat : coats) {
        coat.length *= style.size;
        coat.cell *= style.size;
        coat.blur *= style.size;
    }
    return coats;
}

double canvas_step(const RegionWork& work) {
    return std::min(scaled(work.style.step, work.picture_height), 1.0) * work.scale;
}

SiteGrid coat_sites(const RegionWork& work, const PaintLayer& coat, int coat_number) {
    const double cell = scaled(coat.cell, work.picture_height);
    if (cell <= 1 || (work.style.paper_mode && coat.cell <= 1)) return {};
    return make_sites(work, cell, coat_number);
}

SiteGrid bristle_sites(const RegionWork& work) {
    return make_sites(work, scaled(bristle_width, work.picture_height), bristle_coat);
}

void paint_coat(RegionWork& work, const PaintLayer& coat, int coat_number, const SiteGrid& sites,
                std::vector<Painted>& painted) {
    const int height = work.picture_height;
    Image<Color> base = work.toned;
    masked_blur(base, work.mask, scaled(coat.blur, height));
    const std::vector<CellRecord> records =
        sites.sites.empty() ? make_pixel_cells(work, coat, base, scaled(coat.cell, height), coat_number)
                            : make_site_cells(work, coat, base, sites);
    const Walk walk =
        make_walk(scaled(coat.length, height) * work.scale, canvas_step(work), work.style.box_weights);
    const CoatSample sample = sample_coat(work, walk, records);
    const Color noise = work.style.paper_mode
                            ? Color(static_cast<float>(coat.noise_lightness))
                            : sample.gain * Color(coat.noise_lightness, coat.noise_chroma, coat.noise_chroma);
    const bool covers = coat_number == 0 || (coat.bare == 0 && coat.bare_plain == 0);
    const int columns = work.mask.width * work.scale;
    for_each_path(work, walk, 1, [&](const PixelPath& path) {
        const int x = path.x, y = path.y;
        const Stroke stroke = convolve_at(path, records);
        float alpha = coat_number == 0 ? 1.0f : static_cast<float>(coat.opacity);
        if (!covers) {
            const float detail = work.detail.at(x / work.scale, y / work.scale);
            const float bare =
                glm::mix(static_cast<float>(coat.bare_plain), static_cast<float>(coat.bare), detail);
            alpha *= std::clamp((stroke.priority - priority_below(sample, bare)) / bare_softness, 0.0f, 1.0f);
        }
        Painted& out = painted[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                               static_cast<std::size_t>(x)];
        const float lift = coat_number == 0 ? 0.0f : 0.5f; // later paint lies on top
        out.paint = glm::mix(out.paint, stroke.base + noise * stroke.deviates, alpha);
        out.height = glm::mix(out.height, stroke.height + lift, alpha);
    });
}

Image<float> make_bristles(RegionWork& work, const SiteGrid& sites) {
    PaintLayer hairs;
    hairs.edge = 0;
    const std::vector<CellRecord> records = make_site_cells(work, hairs, work.toned, sites);
    const Walk walk =
        make_walk(scaled(bristle_length, work.picture_height) * work.scale, canvas_step(work), false);
    const float gain = sample_coat(work, walk, records).gain;
    Image<float> marks(work.mask.width * work.scale, work.mask.height * work.scale, 0.0f);
    for_each_path(work, walk, 1, [&](const PixelPath& path) {
        marks.at(path.x, path.y) = gain * convolve_at(path, records).deviates.x;
    });
    return marks;
}

} // namespace pnr
