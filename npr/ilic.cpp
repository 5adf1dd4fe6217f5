// SPDX-License-Identifier: GPL-3.0-or-later
// Impressionistic line integral convolution [LW10 3.2.4; Wang and Lee 2003] with cells that win their paths.
#include "core/parallel.h"
#include "core/rng.h"
#include "npr/cells.h"
#include "npr/direction_field.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"
#include "npr/relief.h"
#include "npr/streamline.h"
#include "npr/tone.h"

#include <atomic>

namespace pnr {

namespace {

// The painter works on a canvas finer than the picture, so that the edges of strokes are smooth.
int canvas_scale(const PaintStyle& style, int height) { return style.paper_mode || height > 1200 ? 1 : 2; }

// ---- cells
// ------------------------------------------------------------------------------------------------------

struct CellRecord {
    Color base{0};     // paint space
    Color deviates{0}; // unit variance
    float height = 0;  // of the paint, 0..1
    float priority = 0;
    double weight = 1; // exp(edge (priority - 1))
};

struct Work { // all that is fixed for one region
    const Region& region;
    const PaintStyle& style;
    Image<std::uint8_t> mask;
    Image<Vec2f> axes;
    Image<Color> toned;
    Image<float> detail; // empty when no coat asks for it
    Canvas canvas;
    int scale = 1; // canvas pixels a picture pixel
    int picture_height = 512;
    std::uint64_t seed = 0;
};

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

// Length of a step in canvas pixels: as asked, but never over a pixel of the picture, so that no gap is
// missed.
double canvas_step(const Work& work) {
    return std::min(scaled(work.style.step, work.picture_height), 1.0) * work.scale;
}

// Directions once a region; the cells change with every coat.
Canvas make_canvas(const Work& work, double step) {
    Canvas canvas;
    canvas.rim = static_cast<int>(std::ceil(step)) + 1;
    canvas.width = work.mask.width * work.scale + 2 * canvas.rim;
    canvas.height = work.mask.height * work.scale + 2 * canvas.rim;
    canvas.points.resize(static_cast<std::size_t>(canvas.width) * static_cast<std::size_t>(canvas.height));
    const float inverse = 1.0f / static_cast<float>(work.scale);
    parallel_for(work.mask.height, 8, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin) * work.scale; y < static_cast<int>(end) * work.scale; ++y)
            for (int x = 0; x < work.mask.width * work.scale; ++x)
                if (work.mask.at(x / work.scale, y / work.scale) != 0)
                    canvas.at(x + canvas.rim, y + canvas.rim).direction =
                        direction_at(work.axes, work.mask, Vec2f(Vec2(x + 0.5, y + 0.5)) * inverse);
    });
    return canvas;
}

// Calls body(canvas x, canvas y, picture x in the window, picture y) for every canvas pixel of the region,
// rows in parallel.
template <class Body>
void for_each_canvas_row(const Work& work, Body&& body) {
    parallel_for(work.mask.height * work.scale, 8,
                 [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
                     for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                         for (int x = 0; x < work.mask.width * work.scale; ++x)
                             if (work.mask.at(x / work.scale, y / work.scale) != 0) body(x, y, chunk);
                 });
}

CellRecord make_record(const Work& work, const PaintLayer& coat, Color base, std::uint64_t hash,
                       float priority) {
    CellRecord record;
    record.base = base;
    record.deviates = work.style.paper_mode ? cell_uniform_deviates(hash) : cell_deviates(hash);
    record.height = unit_float(hash_words(hash, 20));
    record.priority = priority;
    record.weight = std::exp(std::max(-690.0, coat.edge * (static_cast<double>(priority) - 1)));
    return record;
}

// [LW10]: noise a pixel of a 512-high picture, each on the pixel's own colour; `cell` is such a pixel's side
// in pixels of this picture.
std::vector<CellRecord> make_pixel_cells(Work& work, const PaintLayer& coat, const Image<Color>& base,
                                         double cell, int coat_number) {
    const auto side = static_cast<int>(std::max(1L, std::lround(cell)));
    std::vector<CellRecord> records(base.pixels.size());
    const std::uint64_t key = hash_words(hash_words(work.seed, static_cast<std::uint64_t>(Pass::noise)),
                                         static_cast<std::uint64_t>(coat_number));
    for (int y = 0; y < base.height; ++y) {
        for (int x = 0; x < base.width; ++x) {
            const std::uint64_t place = static_cast<std::uint64_t>((work.region.box.y0 + y) / side) << 32 |
                                        static_cast<std::uint64_t>((work.region.box.x0 + x) / side);
            const std::uint64_t hash = hash_words(key, place);
            records[static_cast<std::size_t>(y) * static_cast<std::size_t>(base.width) +
                    static_cast<std::size_t>(x)] =
                make_record(work, coat, base.at(x, y), hash, unit_float(hash_words(hash, 1)));
        }
    }
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        work.canvas.at(x + work.canvas.rim, y + work.canvas.rim).cell =
            static_cast<std::uint32_t>((y / work.scale) * base.width + x / work.scale);
    });
    return records;
}

std::vector<CellRecord> make_site_cells(Work& work, const PaintLayer& coat, const Image<Color>& base,
                                        const SparseMap& sparse, const Regions& regions, std::uint32_t label,
                                        double cell, int coat_number) {
    const SiteGrid grid = build_site_grid(
        make_cell_sites(sparse, regions, label, cell, work.seed, coat_number), work.region.box, cell);
    std::vector<CellRecord> records;
    records.reserve(grid.sites.size());
    for (const CellSite& site : grid.sites) {
        const int x = std::clamp(static_cast<int>(site.at.x) - work.region.box.x0, 0, base.width - 1);
        const int y = std::clamp(static_cast<int>(site.at.y) - work.region.box.y0, 0, base.height - 1);
        records.push_back(make_record(work, coat, base.at(x, y), site.hash, site.priority));
    }
    const float inverse = 1.0f / static_cast<float>(work.scale);
    const Vec2f corner(work.region.box.x0, work.region.box.y0);
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        work.canvas.at(x + work.canvas.rim, y + work.canvas.rim).cell =
            nearest_site(grid, corner + Vec2f(Vec2(x + 0.5, y + 0.5)) * inverse);
    });
    return records;
}

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

// Calls flush(cell, weight) for each run of samples in one cell along the path through a canvas pixel;
// `weight` is the sum of k(s) over the run.
template <class Flush>
inline void integrate_path(const Canvas& canvas, const Walk& walk, int x, int y, Flush&& flush) {
    const CanvasPoint& here = canvas.at(x, y);
    const Vec2f start(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    // One sample a stratum; its place goes round by the golden ratio from a start hashed from the pixel.
    const auto first = static_cast<std::uint32_t>(mix_bits(
        static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(static_cast<std::uint32_t>(x))));
    std::uint32_t run_cell = here.cell;
    float run_weight = 0;
    for (const float side : {1.0f, -1.0f}) {
        const std::uint32_t offset = side > 0 ? first : first * 747796405u + 2891336453u;
        walk_path(
            canvas, start, here.direction * side, walk.count, walk.step,
            [&](int k) {
                const std::uint32_t turn = offset + static_cast<std::uint32_t>(k) * 2654435769u;
                return static_cast<float>(turn >> 8) * 0x1p-24f;
            },
            [&](int k, std::uint32_t cell) {
                if (cell != run_cell) {
                    if (run_weight > 0) flush(run_cell, run_weight);
                    run_cell = cell;
                    run_weight = 0;
                }
                run_weight += walk.weights[static_cast<std::size_t>(k)];
            });
    }
    if (run_weight > 0) flush(run_cell, run_weight);
}

struct Stroke {
    Color base{0}, deviates{0};
    float height = 0, priority = 0;
};

Stroke convolve_at(const Canvas& canvas, const Walk& walk, const std::vector<CellRecord>& records, int x,
                   int y) {
    glm::dvec3 base(0), deviates(0);
    double height = 0, priority = 0, weight = 0;
    integrate_path(canvas, walk, x, y, [&](std::uint32_t cell, float run) {
        const CellRecord& record = records[cell];
        const double w = static_cast<double>(run) * record.weight;
        weight += w;
        base += w * glm::dvec3(record.base);
        deviates += w * glm::dvec3(record.deviates);
        height += w * static_cast<double>(record.height);
        priority += w * static_cast<double>(record.priority);
    });
    if (!(weight > 0)) { // length 0, or a region too thin to walk in
        const CellRecord& record = records[canvas.at(x, y).cell];
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
PathSample sample_path(const Canvas& canvas, const Walk& walk, const std::vector<CellRecord>& records, int x,
                       int y, std::vector<std::pair<std::uint32_t, double>>& met) {
    met.clear();
    integrate_path(canvas, walk, x, y, [&](std::uint32_t cell, float run) {
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
    if (!(total > 0)) return {1, static_cast<double>(records[canvas.at(x, y).cell].priority)};
    return {squares / (total * total), priority / total};
}

CoatSample sample_coat(const Work& work, const Walk& walk, const std::vector<CellRecord>& records) {
    constexpr float largest_gain = 16;
    const int rows = work.mask.height * work.scale, columns = work.mask.width * work.scale;
    const int stride = work.region.pixels * work.scale * work.scale > 4096 ? 4 : 1;
    const int sampled_rows = (rows + stride - 1) / stride;
    struct Row {
        double variance = 0;
        std::vector<float> priorities;
    };
    std::vector<Row> by_row(static_cast<std::size_t>(sampled_rows));
    parallel_for(sampled_rows, 4, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<std::pair<std::uint32_t, double>> met;
        for (std::int64_t r = begin; r < end; ++r) {
            Row& row = by_row[static_cast<std::size_t>(r)];
            const int y = static_cast<int>(r) * stride;
            for (int x = 0; x < columns; x += stride) {
                if (work.mask.at(x / work.scale, y / work.scale) == 0) continue;
                const PathSample path =
                    sample_path(work.canvas, walk, records, x + work.canvas.rim, y + work.canvas.rim, met);
                row.variance += path.variance;
                row.priorities.push_back(static_cast<float>(path.priority));
            }
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

struct Painted { // a canvas pixel
    Color paint{0};
    float height = 0;
};

// Where strokes begin to be left out their edge is this soft, in priority.
constexpr float bare_softness = 0.01f;

void paint_coat(Work& work, const PaintLayer& coat, int coat_number, const SparseMap& sparse,
                const Regions& regions, std::uint32_t label, std::vector<Painted>& painted) {
    const int height = work.picture_height;
    Image<Color> base = work.toned;
    masked_blur(base, work.mask, scaled(coat.blur, height));
    const double cell = scaled(coat.cell, height);
    const std::vector<CellRecord> records =
        cell <= 1 || (work.style.paper_mode && coat.cell <= 1)
            ? make_pixel_cells(work, coat, base, cell, coat_number)
            : make_site_cells(work, coat, base, sparse, regions, label, cell, coat_number);
    const Walk walk =
        make_walk(scaled(coat.length, height) * work.scale, canvas_step(work), work.style.box_weights);
    const CoatSample sample = sample_coat(work, walk, records);
    const Color noise = work.style.paper_mode
                            ? Color(static_cast<float>(coat.noise_lightness))
                            : sample.gain * Color(coat.noise_lightness, coat.noise_chroma, coat.noise_chroma);
    const bool covers = coat_number == 0 || (coat.bare == 0 && coat.bare_plain == 0);
    const int columns = work.mask.width * work.scale;
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        const Stroke stroke =
            convolve_at(work.canvas, walk, records, x + work.canvas.rim, y + work.canvas.rim);
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

// ---- the brush's own marks
// ------------------------------------------------------------------------------------------

constexpr double bristle_length = 24; // of a bristle's mark, pixels at 512
constexpr double bristle_width = 1.2;
constexpr double bristle_height = 0.12; // of a mark of one standard deviation, in strokes
constexpr int bristle_coat = 1000;      // its cells are no coat's

// Fine noise drawn out along the strokes, unit variance, on the canvas.
Image<float> make_bristles(Work& work, const SparseMap& sparse, const Regions& regions, std::uint32_t label) {
    PaintLayer hairs;
    hairs.edge = 0;
    const double cell = scaled(bristle_width, work.picture_height);
    const std::vector<CellRecord> records =
        make_site_cells(work, hairs, work.toned, sparse, regions, label, cell, bristle_coat);
    const Walk walk =
        make_walk(scaled(bristle_length, work.picture_height) * work.scale, canvas_step(work), false);
    const float gain = sample_coat(work, walk, records).gain;
    Image<float> marks(work.mask.width * work.scale, work.mask.height * work.scale, 0.0f);
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        marks.at(x, y) =
            gain *
            convolve_at(work.canvas, walk, records, x + work.canvas.rim, y + work.canvas.rim).deviates.x;
    });
    return marks;
}

// Bristle marks and relief, added to the lightness.
void finish_surface(Work& work, const SparseMap& sparse, const Regions& regions, std::uint32_t label,
                    std::vector<Painted>& painted) {
    const PaintStyle& style = work.style;
    if (style.paper_mode || (style.bristle == 0 && style.relief == 0)) return;
    const Image<float> marks = make_bristles(work, sparse, regions, label);
    Image<float> change(marks.width, marks.height, 0.0f);
    if (style.relief != 0) {
        Image<float> height(marks.width, marks.height);
        Image<std::uint8_t> mask(marks.width, marks.height);
        for (int y = 0; y < marks.height; ++y) {
            for (int x = 0; x < marks.width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(marks.width) +
                                      static_cast<std::size_t>(x);
                mask.pixels[i] = work.mask.at(x / work.scale, y / work.scale);
                height.pixels[i] = painted[i].height + static_cast<float>(bristle_height) * marks.pixels[i];
            }
        }
        change =
            light_relief(std::move(height), mask, style.relief, scaled(1, work.picture_height) * work.scale);
    }
    for (std::size_t i = 0; i < painted.size(); ++i)
        painted[i].paint.x += change.pixels[i] + static_cast<float>(style.bristle) * marks.pixels[i];
}

// The mean of the canvas pixels of each picture pixel, in light.
Image<Color> finish_region(const Work& work, const std::vector<Painted>& painted) {
    Image<Color> light(work.mask.width, work.mask.height, Color(0));
    const int columns = work.mask.width * work.scale;
    const float share = 1.0f / static_cast<float>(work.scale * work.scale);
    parallel_for(light.height, 8, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < light.width; ++x) {
                if (work.mask.at(x, y) == 0) continue;
                Color sum(0);
                for (int j = 0; j < work.scale; ++j)
                    for (int i = 0; i < work.scale; ++i)
                        sum += from_paint_space(painted[static_cast<std::size_t>(y * work.scale + j) *
                                                            static_cast<std::size_t>(columns) +
                                                        static_cast<std::size_t>(x * work.scale + i)]
                                                    .paint,
                                                work.style);
                light.at(x, y) = sum * share;
            }
        }
    });
    return light;
}

Image<Color> paint_region(const InformativeMap& informative, const SparseMap& sparse, const World& world,
                          const Regions& regions, std::uint32_t label, int height, std::uint64_t seed) {
    const Region& region = regions.regions[label - 1];
    Work work{region, world.objects[region.object].paint, region_mask(regions, label), {}, {}, {}, {}};
    work.scale = canvas_scale(work.style, height);
    work.picture_height = height;
    work.seed = seed;
    work.axes = smooth_directions(informative, regions, label, work.mask, work.style, height);
    work.toned = tone_region(informative, regions, label, work.mask, work.style);
    const std::vector<PaintLayer> coats = coats_of(work.style);
    if (std::any_of(coats.begin(), coats.end(),
                    [](const PaintLayer& c) { return c.bare_plain > 0 || c.bare > 0; }))
        work.detail = find_detail(work.toned, work.mask, height);
    work.canvas = make_canvas(work, canvas_step(work));
    std::vector<Painted> painted(work.mask.pixels.size() * static_cast<std::size_t>(work.scale * work.scale));
    for (std::size_t i = 0; i < coats.size(); ++i)
        paint_coat(work, coats[i], static_cast<int>(i), sparse, regions, label, painted);
    finish_surface(work, sparse, regions, label, painted);
    return finish_region(work, painted);
}

bool is_finite(Color c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

// The painted pixel nearest to a border pixel whose own centre is not painted; within two pixels, ties in
// scan order.
std::optional<std::pair<int, int>> nearest_painted(const Regions& regions, int x, int y) {
    std::optional<std::pair<int, int>> best;
    int best_distance2 = std::numeric_limits<int>::max();
    for (int j = y - 2; j <= y + 2; ++j) {
        for (int i = x - 2; i <= x + 2; ++i) {
            if (!regions.label.contains(i, j) || regions.label.at(i, j) == 0) continue;
            const int distance2 = (i - x) * (i - x) + (j - y) * (j - y);
            if (distance2 >= best_distance2) continue;
            best_distance2 = distance2;
            best = {i, j};
        }
    }
    return best;
}

} // namespace

Layer convolve(const InformativeMap& informative, const SparseMap& sparse, const World& world,
               const GBuffer& gbuffer, std::uint64_t seed, const Progress& progress) {
    const int width = informative.width, height = informative.height;
    Layer layer{Image<Color>(width, height, Color(0)), Image<float>(width, height, 0.0f)};
    const Regions regions = find_regions(informative);
    Image<Color> light(width, height, Color(0));
    const auto count = static_cast<std::int64_t>(regions.regions.size());
    for (std::int64_t r = 0; r < count; ++r) {
        const auto label = static_cast<std::uint32_t>(r + 1);
        const Image<Color> window =
            paint_region(informative, sparse, world, regions, label, gbuffer.view.height, seed);
        const PixelRect box = regions.regions[static_cast<std::size_t>(r)].box;
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x)
                if (regions.label.at(x, y) == label) light.at(x, y) = window.at(x - box.x0, y - box.y0);
        if (progress && !progress(r + 1, count)) throw Interrupted{};
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float coverage = gbuffer.coverage.at(x, y);
            if (!(coverage > 0)) continue;
            const bool own = regions.label.at(x, y) != 0;
            const auto from = own ? std::optional(std::pair{x, y}) : nearest_painted(regions, x, y);
            if (!from) continue;
            const Seen& seen = gbuffer.seen.at(from->first, from->second);
            const Color share =
                seen.weight * (coverage * static_cast<float>(world.objects[seen.object].paint.mix));
            const Color color = light.at(from->first, from->second) * share;
            if (!is_finite(color)) continue;
            layer.color.at(x, y) = color;
            layer.alpha.at(x, y) = (share.x + share.y + share.z) / 3;
        }
    }
    return layer;
}

} // namespace pnr
