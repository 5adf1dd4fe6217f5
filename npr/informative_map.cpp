// SPDX-License-Identifier: GPL-3.0-or-later
// The informative interpolation process [LW10 3.2.3].
#include "core/rng.h"
#include "npr/color_space.h"
#include "npr/folds.h"
#include "npr/paint.h"

#include <atomic>
#include <map>

namespace pnr {

namespace {

// The sources row by row, each row from the left, so that those of one row of a disc lie side by side.
struct SourceRows {
    struct Source {
        std::int32_t x, y;
        std::uint64_t region;
        Color radiance;
        Vec3f normal;
        Vec2f axis;      // (cos 2t, sin 2t)
        Vec2f direction; // as a plain vector with its sign, for paper_mode
    };
    std::vector<Source> sources;
    Image<std::uint32_t> before; // how many sources come before this pixel; one column more than the picture
};

SourceRows collect_sources(const SparseMap& sparse) {
    SourceRows rows;
    rows.before = Image<std::uint32_t>(sparse.width + 1, sparse.height);
    for (int y = 0; y < sparse.height; ++y) {
        for (int x = 0; x < sparse.width; ++x) {
            rows.before.at(x, y) = static_cast<std::uint32_t>(rows.sources.size());
            const SourcePixel& s = sparse.at(x, y);
            if (s.photon < 0) continue;
            rows.sources.push_back({x, y, region_key(s.object, s.via), s.radiance, s.normal,
                                    direction_axis(s.direction), s.turned ? -s.direction : s.direction});
        }
        rows.before.at(sparse.width, y) = static_cast<std::uint32_t>(rows.sources.size());
    }
    return rows;
}

struct WeightedSum {
    double weight = 0;
    glm::dvec3 radiance{0};
    Vec2 axis{0}, direction{0};
};

// `folds`: null where the disc may reach over them.
WeightedSum sum_over_disc(const SourceRows& rows, int x, int y, double radius, std::uint64_t region,
                          const Folds* folds) {
    WeightedSum sum;
    const int reach = static_cast<int>(std::floor(radius));
    const int width = rows.before.width - 1;
    for (int row = std::max(0, y - reach); row <= std::min(rows.before.height - 1, y + reach); ++row) {
        const double dy = row - y;
        const int half = static_cast<int>(std::floor(std::sqrt(radius * radius - dy * dy)));
        const std::uint32_t begin = rows.before.at(std::max(0, x - half), row);
        const std::uint32_t end = rows.before.at(std::min(width, x + half + 1), row);
        for (std::uint32_t i = begin; i < end; ++i) {
            const SourceRows::Source& s = rows.sources[i];
            if (s.region != region) continue;
            if (folds != nullptr && is_folded_between(*folds, x, y, s.x, s.y)) continue;
            const double dx = s.x - x;
            const double w = 1 / (dx * dx + dy * dy);
            sum.weight += w;
            sum.radiance += w * glm::dvec3(s.radiance);
            sum.axis += w * Vec2(s.axis);
            sum.direction += w * Vec2(s.direction);
        }
    }
    return sum;
}

// Where the sum cancels there is no axis to be had; the x axis, as everywhere.
Vec2f unit_axis(Vec2 axis) {
    const double length = glm::length(axis);
    return length > 1e-12 ? Vec2f(axis / length) : Vec2f(1, 0);
}

// Every source of a region as a point in the picture, for pixels whose disc holds none.
struct NearestSources {
    std::map<std::uint64_t, std::pair<KdTree, std::vector<std::uint32_t>>>
        regions; // points -> index of the source
    std::map<std::uint32_t, std::pair<KdTree, std::vector<std::uint32_t>>> objects;

    // The nearest where the surface lies as it does here: what a thin part's rim looks like says nothing of
    // its face.
    template <class Key>
    static std::optional<std::uint32_t>
    find(const std::map<Key, std::pair<KdTree, std::vector<std::uint32_t>>>& trees, Key key,
         const SourceRows& rows, int x, int y, Vec3f normal, std::vector<Neighbour>& found) {
        constexpr std::size_t asked = 12;
        constexpr float edge_on = 0.1f; // cosine below which one is as bad as another
        const auto it = trees.find(key);
        if (it == trees.end()) return {};
        const Vec3f at(static_cast<float>(x), static_cast<float>(y), 0);
        find_nearest(it->second.first, at, asked, std::numeric_limits<float>::infinity(), found);
        std::optional<std::uint32_t> best;
        float least = std::numeric_limits<float>::infinity();
        for (const Neighbour& n : found) {
            const std::uint32_t i = it->second.second[n.index];
            const SourceRows::Source& s = rows.sources[i];
            const float dx = static_cast<float>(s.x - x), dy = static_cast<float>(s.y - y),
                        alike = std::max(edge_on, glm::dot(s.normal, normal));
            const float cost = (dx * dx + dy * dy) / (alike * alike * alike * alike);
            if (cost < least || (cost == least && best && i < *best)) least = cost, best = i;
        }
        return best;
    }
};

NearestSources index_sources(const SourceRows& rows) {
    std::map<std::uint64_t, std::vector<std::uint32_t>> regions;
    std::map<std::uint32_t, std::vector<std::uint32_t>> objects;
    for (std::uint32_t i = 0; i < rows.sources.size(); ++i) {
        regions[rows.sources[i].region].push_back(i);
        objects[static_cast<std::uint32_t>(rows.sources[i].region >> 32)].push_back(i);
    }
    const auto build = [&](const std::vector<std::uint32_t>& members) {
        std::vector<Vec3f> points;
        points.reserve(members.size());
        for (const std::uint32_t i : members)
            points.emplace_back(static_cast<float>(rows.sources[i].x), static_cast<float>(rows.sources[i].y),
                                0.0f);
        return std::pair{build_kdtree(points), members};
    };
    NearestSources nearest;
    for (const auto& [key, members] : regions) nearest.regions.emplace(key, build(members));
    for (const auto& [key, members] : objects) nearest.objects.emplace(key, build(members));
    return nearest;
}

// [LW10]: "we assign a random color and direction to this pixel of interest"; uniform in the display's 8-bit
// space.
void fill_at_random(Informed& pixel, std::uint64_t seed, std::uint64_t index) {
    Rng rng = make_rng(seed, Pass::paint, index | 1ull << 62);
    for (int c = 0; c < 3; ++c) pixel.radiance[c] = linear_from_display(static_cast<float>(rng.uniform()));
    const double angle = 2 * pi * rng.uniform();
    pixel.axis = Vec2f(std::cos(angle), std::sin(angle));
    pixel.turned = rng.uniform() < 0.5;
}

} // namespace

InformativeMap make_informative_map(const SparseMap& sparse, const World& world, const GBuffer& gbuffer,
                                    std::uint64_t seed, const Progress& progress) {
    InformativeMap informative(sparse.width, sparse.height);
    const SourceRows rows = collect_sources(sparse);
    const NearestSources nearest = index_sources(rows);
    const bool any_folds = std::any_of(world.objects.begin(), world.objects.end(),
                                       [](const WorldObject& o) { return o.npr && o.paint.folds; });
    const Folds folds = any_folds ? find_folds(gbuffer) : Folds{};
    std::vector<double> radii;
    for (const WorldObject& object : world.objects)
        radii.push_back(scaled(object.paint.radius, gbuffer.view.height));

    std::atomic<std::int64_t> rows_done{0};
    parallel_for(sparse.height, 8, [&](std::int64_t first, std::int64_t last, std::int64_t) {
        std::vector<Neighbour> found;
        for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
            for (int x = 0; x < sparse.width; ++x) {
                const Seen& seen = gbuffer.seen.at(x, y);
                if (!is_painted(seen)) continue;
                Informed& pixel = informative.at(x, y);
                pixel.object = seen.object;
                pixel.via = seen.via;
                const SourcePixel& source = sparse.at(x, y);
                if (source.photon >= 0) {
                    pixel.kind = PixelKind::source;
                    pixel.radiance = source.radiance;
                    pixel.axis = direction_axis(source.direction);
                    pixel.turned = source.turned;
                    continue;
                }
                const PaintStyle& style = world.objects[seen.object].paint;
                const std::uint64_t region = region_key(seen.object, seen.via);
                const WeightedSum sum = sum_over_disc(rows, x, y, radii[seen.object], region,
                                                      style.folds && folds.any ? &folds : nullptr);
                if (sum.weight > 0) {
                    pixel.kind = PixelKind::interpolated;
                    pixel.radiance = Color(sum.radiance / sum.weight);
                    pixel.axis = style.vectors ? direction_axis(canonical_direction(sum.direction))
                                               : unit_axis(sum.axis);
                    pixel.turned = is_turned(sum.direction);
                    continue;
                }
                pixel.kind = PixelKind::filled;
                if (style.fill == Fill::random) {
                    fill_at_random(pixel, seed,
                                   static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(sparse.width) +
                                       static_cast<std::uint64_t>(x));
                    continue;
                }
                auto match = NearestSources::find(nearest.regions, region, rows, x, y, seen.normal, found);
                // A region without a source, such as a small reflection, has its own light and takes the
                // direction from the object's other views.
                pixel.radiance = match ? rows.sources[*match].radiance : source.radiance;
                if (!match)
                    match =
                        NearestSources::find(nearest.objects, seen.object, rows, x, y, seen.normal, found);
                pixel.axis = match ? rows.sources[*match].axis : Vec2f(1, 0);
                pixel.turned = match && is_turned(Vec2(rows.sources[*match].direction));
            }
        }
        const std::int64_t done = rows_done += last - first;
        if (progress && !progress(done, sparse.height)) throw Interrupted{};
    });
    return informative;
}

} // namespace pnr
