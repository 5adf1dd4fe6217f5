// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/coat.h"

#include "core/rng.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"

namespace pnr {

namespace {

// ---- one path
// -----------------------------------------------------------------------------------------------------

struct Brush {
    Walk walk;
    std::vector<float> weights; // k(s) of each step: Hann over the whole path, or box
};

// `length` is the whole path's, in canvas pixels, `step` at most so long.
Brush make_brush(double length, double step, bool box) {
    Brush brush;
    Walk& walk = brush.walk;
    const double half = length / 2;
    walk.count = static_cast<int>(std::ceil(half / step - 1e-9));
    if (walk.count <= 0) return brush;
    walk.step = static_cast<float>(half / walk.count);
    for (int k = 0; k < walk.count; ++k)
        brush.weights.push_back(box ? 1.0f
                                    : static_cast<float>(0.5 + 0.5 * std::cos(pi * (k + 0.5) / walk.count)));
    return brush;
}

// Paths through some canvas pixels: at most `lanes`, then walked together.
struct Bundle {
    Starts starts;
    int count = 0;
    std::array<std::vector<MetRow>, 2> met; // on the way ahead, and on the way back
};

void add_path(Bundle& bundle, int x, int y) {
    const auto i = static_cast<std::size_t>(bundle.count++);
    bundle.starts.x[i] = x, bundle.starts.y[i] = y;
    bundle.starts.turn[i] = static_cast<std::uint32_t>(mix_bits(
        static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(static_cast<std::uint32_t>(x))));
}

void walk_bundle(const Canvas& canvas, const Walk& walk, Bundle& bundle) {
    const auto last = static_cast<std::size_t>(bundle.count - 1);
    for (std::size_t i = last + 1; i < lanes; ++i) {
        bundle.starts.x[i] = bundle.starts.x[last], bundle.starts.y[i] = bundle.starts.y[last];
        bundle.starts.turn[i] = bundle.starts.turn[last];
    }
    for (const int side : {0, 1})
        walk_paths(canvas, walk, bundle.starts, side, bundle.met[static_cast<std::size_t>(side)]);
}

// Calls flush(cell, weight) for each run of samples in one cell along a path of the bundle; `weight` is the
// sum of k(s) over the run.
template <class Flush>
inline void integrate_path(const Bundle& bundle, int path, const Brush& brush, Flush&& flush) {
    const auto lane = static_cast<std::size_t>(path);
    std::uint32_t run_cell = no_cell;
    float run_weight = 0;
    for (const std::vector<MetRow>& met : bundle.met) {
        for (const MetRow* row = met.data(); row->way[lane] > 0; ++row) {
            if (row->cell[lane] != run_cell) {
                if (run_weight > 0) flush(run_cell, run_weight);
                run_cell = row->cell[lane];
                run_weight = 0;
            }
            run_weight += row->way[lane] * brush.weights[static_cast<std::size_t>(row->place[lane])];
        }
    }
    if (run_weight > 0) flush(run_cell, run_weight);
}

// Calls body(canvas x, canvas y, bundle, path), both without the rim, for the canvas pixels of a row whose
// columns are multiples of `stride`.
template <class Body>
inline void follow_row(const RegionWork& work, const Brush& brush, int y, int stride, Bundle& bundle,
                       Body&& body) {
    const int rim = work.canvas.rim, columns = work.mask.width * work.scale;
    const auto finish = [&] {
        if (bundle.count == 0) return;
        walk_bundle(work.canvas, brush.walk, bundle);
        for (int path = 0; path < bundle.count; ++path)
            body(bundle.starts.x[static_cast<std::size_t>(path)] - rim, y, bundle, path);
        bundle.count = 0;
    };
    for (int x = 0; x < columns; x += stride) {
        if (work.mask.at(x / work.scale, y / work.scale) == 0) continue;
        add_path(bundle, x + rim, y + rim);
        if (bundle.count == lanes) finish();
    }
    finish();
}

// The same for every canvas pixel of the region, rows in parallel.
template <class Body>
void follow_all(const RegionWork& work, const Brush& brush, Body&& body) {
    parallel_for(work.mask.height * work.scale, 8, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        Bundle bundle;
        for (std::int64_t y = begin; y < end; ++y)
            follow_row(work, brush, static_cast<int>(y), 1, bundle, body);
    });
}

struct Stroke {
    Color base{0}, deviates{0};
    float height = 0, priority = 0;
};

// `own`: the cell that the path begins in.
Stroke convolve_path(const Bundle& bundle, int path, const Brush& brush,
                     const std::vector<CellRecord>& records, std::uint32_t own) {
    glm::dvec3 base(0), deviates(0);
    double height = 0, priority = 0, weight = 0;
    integrate_path(bundle, path, brush, [&](std::uint32_t cell, float run) {
        const CellRecord& record = records[cell];
        const double w = static_cast<double>(run) * record.weight;
        weight += w;
        base += w * glm::dvec3(record.base);
        deviates += w * glm::dvec3(record.deviates);
        height += w * static_cast<double>(record.height);
        priority += w * static_cast<double>(record.priority);
    });
    if (!(weight > 0)) { // length 0, or a region too thin to walk in
        const CellRecord& record = records[own];
        return {record.base, record.deviates, record.height, record.priority};
    }
    return {Color(base / weight), Color(deviates / weight), static_cast<float>(height / weight),
            static_cast<float>(priority / weight)};
}

// What a coat comes to, from some canvas pixels of a region in rows and columns.
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
PathSample sample_path(const Bundle& bundle, int path, const Brush& brush,
                       const std::vector<CellRecord>& records, std::uint32_t own,
                       std::vector<std::pair<std::uint32_t, double>>& met) {
    met.clear();
    integrate_path(bundle, path, brush, [&](std::uint32_t cell, float run) {
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
    if (!(total > 0)) return {1, static_cast<double>(records[own].priority)};
    return {squares / (total * total), priority / total};
}

std::uint32_t cell_at(const RegionWork& work, int x, int y) {
    return work.canvas.at(x + work.canvas.rim, y + work.canvas.rim).cell;
}

// Of so many pixels every n-th each way, that some 16,000 are left.
int sample_stride(std::int64_t pixels) {
    return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(pixels) / 16384)), 1, 8);
}

CoatSample sample_coat(const RegionWork& work, const Brush& brush, const std::vector<CellRecord>& records) {
    constexpr float largest_gain = 16;
    const int rows = work.mask.height * work.scale;
    const int stride = sample_stride(work.region.pixels * work.scale * work.scale);
    const int sampled_rows = (rows + stride - 1) / stride;
    struct Row {
        double variance = 0;
        std::vector<float> priorities;
    };
    std::vector<Row> by_row(static_cast<std::size_t>(sampled_rows));
    parallel_for(sampled_rows, 4, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<std::pair<std::uint32_t, double>> met;
        Bundle bundle;
        for (std::int64_t r = begin; r < end; ++r) {
            Row& row = by_row[static_cast<std::size_t>(r)];
            const int y = static_cast<int>(r) * stride;
            follow_row(work, brush, y, stride, bundle, [&](int x, int, const Bundle& paths, int path) {
                const PathSample sampled = sample_path(paths, path, brush, records, cell_at(work, x, y), met);
                row.variance += sampled.variance;
                row.priorities.push_back(static_cast<float>(sampled.priority));
            });
        }
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
    const Brush brush =
        make_brush(scaled(coat.length, height) * work.scale, canvas_step(work), work.style.box_weights);
    const CoatSample sample = sample_coat(work, brush, records);
    const Color noise = work.style.paper_mode
                            ? Color(static_cast<float>(coat.noise_lightness))
                            : sample.gain * Color(coat.noise_lightness, coat.noise_chroma, coat.noise_chroma);
    const bool covers = coat_number == 0 || (coat.bare == 0 && coat.bare_plain == 0);
    const int columns = work.mask.width * work.scale;
    follow_all(work, brush, [&](int x, int y, const Bundle& bundle, int path) {
        const Stroke stroke = convolve_path(bundle, path, brush, records, cell_at(work, x, y));
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
    const Brush brush =
        make_brush(scaled(bristle_length, work.picture_height) * work.scale, canvas_step(work), false);
    const float gain = sample_coat(work, brush, records).gain;
    Image<float> marks(work.mask.width * work.scale, work.mask.height * work.scale, 0.0f);
    follow_all(work, brush, [&](int x, int y, const Bundle& bundle, int path) {
        marks.at(x, y) = gain * convolve_path(bundle, path, brush, records, cell_at(work, x, y)).deviates.x;
    });
    return marks;
}

} // namespace pnr
