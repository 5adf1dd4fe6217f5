// SPDX-License-Identifier: GPL-3.0-or-later
// Impressionistic line integral convolution [LW10 3.2.4; Wang and Lee 2003] with cells that win their paths.
#include "npr/coat.h"
#include "npr/direction_field.h"
#include "npr/paint.h"
#include "npr/relief.h"
#include "npr/seats.h"
#include "npr/tone.h"

namespace pnr {

namespace {

// The painter works on a canvas finer than the picture, so that the edges of strokes are smooth.
int canvas_scale(const PaintStyle& style, int height) { return style.paper_mode || height > 1200 ? 1 : 2; }

const Seen& seen_at(const RegionWork& work, int canvas_x, int canvas_y) {
    return work.gbuffer.seen.at(work.region.box.x0 + canvas_x / work.scale,
                                work.region.box.y0 + canvas_y / work.scale);
}

constexpr float least_stretch = 0.5f,
                most_stretch = 4; // strokes at a silhouette would else be shorter than wide

// How many pixels of the brush a step of one pixel along the direction is on the surface.
float stretch_along(float brush_pixel, const Seen& seen, Vec2f direction) {
    const float length = glm::length(seen.dpdx * direction.x + seen.dpdy * direction.y);
    return length > 0 ? std::clamp(length / brush_pixel, least_stretch, most_stretch) : 1;
}

// Directions once a region; the cells change with every coat.
Canvas make_canvas(const RegionWork& work, double step) {
    Canvas canvas;
    canvas.scale = work.scale;
    canvas.rim = static_cast<int>(std::ceil(2 * step)) + 1;
    canvas.width = work.mask.width * work.scale + 2 * canvas.rim;
    canvas.height = work.mask.height * work.scale + 2 * canvas.rim;
    canvas.points.resize(static_cast<std::size_t>(canvas.width) * static_cast<std::size_t>(canvas.height));
    const float inverse = 1.0f / static_cast<float>(work.scale);
    parallel_for(work.mask.height, 8, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin) * work.scale; y < static_cast<int>(end) * work.scale; ++y)
            for (int x = 0; x < work.mask.width * work.scale; ++x)
                if (work.mask.at(x / work.scale, y / work.scale) != 0) {
                    CanvasPoint& point = canvas.at(x + canvas.rim, y + canvas.rim);
                    point.direction =
                        direction_at(work.axes, work.mask, Vec2f(Vec2(x + 0.5, y + 0.5)) * inverse);
                    if (!work.style.paper_mode)
                        point.stretch = stretch_along(brush_pixel(work.brush, x / work.scale, y / work.scale),
                                                      seen_at(work, x, y), point.direction);
                }
    });
    return canvas;
}

void add_walls(const Folds& folds, const Region& region, Canvas& canvas) {
    const PixelRect box = region.box;
    canvas.walls = Image<std::uint8_t>(box.x1 - box.x0, box.y1 - box.y0);
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) canvas.walls.at(x - box.x0, y - box.y0) = folds.walls.at(x, y);
    const auto is_near = [&](int x, int y) {
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i)
                if (canvas.walls.contains(x + i, y + j) && canvas.walls.at(x + i, y + j) != 0) return true;
        return false;
    };
    for (int y = 0; y < canvas.walls.height; ++y)
        for (int x = 0; x < canvas.walls.width; ++x) {
            if (!is_near(x, y)) continue;
            for (int j = 0; j < canvas.scale; ++j)
                for (int i = 0; i < canvas.scale; ++i) {
                    float& stretch =
                        canvas.at(x * canvas.scale + i + canvas.rim, y * canvas.scale + j + canvas.rim)
                            .stretch;
                    stretch = -stretch;
                }
        }
}

constexpr double bristle_height = 0.12; // of a mark of one standard deviation, in strokes

bool has_surface(const PaintStyle& style) {
    return !style.paper_mode && (style.bristle != 0 || style.relief != 0);
}

// Bristle marks and relief, added to the lightness.
void finish_surface(RegionWork& work, const SiteGrid& bristles, std::vector<Painted>& painted) {
    const PaintStyle& style = work.style;
    const Image<float> marks = make_bristles(work, bristles);
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
Image<Color> finish_region(const RegionWork& work, const std::vector<Painted>& painted) {
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

// Where the cells of all coats are, then those of the bristles, if the style has any.
std::vector<SiteGrid> find_sites(const RegionWork& work, const std::vector<PaintLayer>& coats) {
    std::vector<SiteGrid> sites(coats.size() + (has_surface(work.style) ? 1 : 0));
    parallel_for(static_cast<std::int64_t>(sites.size()), 1,
                 [&](std::int64_t begin, std::int64_t, std::int64_t) {
                     const auto i = static_cast<std::size_t>(begin);
                     sites[i] = i < coats.size() ? coat_sites(work, coats[i], static_cast<int>(i))
                                                 : bristle_sites(work);
                 });
    return sites;
}

Image<Color> paint_region(const InformativeMap& informative, const Seats& seats, const World& world,
                          const GBuffer& gbuffer, const Folds& folds, const Regions& regions,
                          std::uint32_t label, std::uint64_t seed) {
    const Region& region = regions.regions[label - 1];
    const int height = gbuffer.view.height;
    RegionWork work{region,
                    world.objects[region.object].paint,
                    gbuffer,
                    seats,
                    region_mask(regions, label),
                    {},
                    {},
                    {},
                    {},
                    {}};
    work.brush = find_brush_scale(gbuffer, seats, region, work.mask);
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
    if (folds.any && !work.style.paper_mode) add_walls(folds, region, work.canvas);
    std::vector<Painted> painted(work.mask.pixels.size() * static_cast<std::size_t>(work.scale * work.scale));
    const std::vector<SiteGrid> sites = find_sites(work, coats);
    for (std::size_t i = 0; i < coats.size(); ++i)
        paint_coat(work, coats[i], static_cast<int>(i), sites[i], painted);
    if (has_surface(work.style)) finish_surface(work, sites.back(), painted);
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

// What the painted light of each pixel's object comes to in the picture.
void compose(const Regions& regions, const GBuffer& gbuffer, const World& world, const Image<Color>& light,
             Layer& layer) {
    parallel_for(light.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < light.width; ++x) {
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
    });
}

} // namespace

Layer convolve(const InformativeMap& informative, const Seats& seats, const World& world,
               const GBuffer& gbuffer, std::uint64_t seed, const Progress& progress) {
    const int width = informative.width, height = informative.height;
    Layer layer{Image<Color>(width, height, Color(0)), Image<float>(width, height, 0.0f)};
    const Regions regions = find_regions(informative);
    const Folds folds = find_folds(gbuffer);
    Image<Color> light(width, height, Color(0));
    const auto count = static_cast<std::int64_t>(regions.regions.size());
    for (std::int64_t r = 0; r < count; ++r) {
        const auto label = static_cast<std::uint32_t>(r + 1);
        const Image<Color> window =
            paint_region(informative, seats, world, gbuffer, folds, regions, label, seed);
        const PixelRect box = regions.regions[static_cast<std::size_t>(r)].box;
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x)
                if (regions.label.at(x, y) == label) light.at(x, y) = window.at(x - box.x0, y - box.y0);
        if (progress && !progress(r + 1, count)) throw Interrupted{};
    }
    compose(regions, gbuffer, world, light, layer);
    return layer;
}

} // namespace pnr
