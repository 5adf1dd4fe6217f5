// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/cells.h"

#include "core/rng.h"

namespace pnr {

namespace {

constexpr double thinning = 0.8; // of the cell width: least distance of two sites
constexpr double deviate_cut = 2.2;
constexpr double deviate_scale =
    1 / 0.97501; // one over the standard deviation of a normal deviate clamped at 2.2

std::uint64_t coat_key(std::uint64_t seed, int coat) {
    return hash_words(hash_words(seed, static_cast<std::uint64_t>(Pass::noise)),
                      static_cast<std::uint64_t>(coat));
}

CellSite make_site(Vec2f at, std::uint64_t hash) { return {at, hash, unit_float(hash_words(hash, 1))}; }

// Occupancy of the plane by sites already placed: buckets so small that each holds few.
class Occupied {
public:
    Occupied(PixelRect box, double bucket)
        : bucket_(bucket), origin_(box.x0, box.y0), columns_(count(box.x1 - box.x0)),
          rows_(count(box.y1 - box.y0)),
          first_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1) {}

    bool any_within(const std::vector<CellSite>& sites, Vec2 at, double distance) const {
        const int reach = static_cast<int>(std::ceil(distance / bucket_));
        const int cx = column(at.x), cy = row(at.y);
        for (int j = std::max(0, cy - reach); j <= std::min(rows_ - 1, cy + reach); ++j)
            for (int i = std::max(0, cx - reach); i <= std::min(columns_ - 1, cx + reach); ++i)
                for (int s = first_[slot(i, j)]; s >= 0; s = next_[static_cast<std::size_t>(s)])
                    if (glm::distance(Vec2(sites[static_cast<std::size_t>(s)].at), at) < distance)
                        return true;
        return false;
    }
    // Must be called for the sites in their order.
    void add(Vec2 at) {
        const std::size_t s = slot(column(at.x), row(at.y));
        next_.push_back(first_[s]);
        first_[s] = static_cast<int>(next_.size()) - 1;
    }

private:
    int count(int length) const { return static_cast<int>(length / bucket_) + 1; }
    int column(double x) const {
        return std::clamp(static_cast<int>((x - origin_.x) / bucket_), 0, columns_ - 1);
    }
    int row(double y) const { return std::clamp(static_cast<int>((y - origin_.y) / bucket_), 0, rows_ - 1); }
    std::size_t slot(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
    }

    double bucket_;
    Vec2 origin_;
    int columns_, rows_;
    std::vector<int> first_, next_;
};

std::vector<CellSite> collect_source_sites(const SparseMap& sparse, const Regions& regions,
                                           std::uint32_t label, std::uint64_t key) {
    std::vector<CellSite> candidates;
    const PixelRect box = regions.regions[label - 1].box;
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            if (regions.label.at(x, y) != label || sparse.at(x, y).photon < 0) continue;
            const auto photon = static_cast<std::uint64_t>(sparse.at(x, y).photon);
            candidates.push_back(make_site(sparse.at(x, y).at, hash_words(key, photon)));
        }
    }
    return candidates;
}

// Sites of a jittered grid wherever no source site is within a cell width.
void fill_holes(std::vector<CellSite>& sites, Occupied& occupied, const Regions& regions, std::uint32_t label,
                double cell, std::uint64_t key) {
    const PixelRect box = regions.regions[label - 1].box;
    for (int j = static_cast<int>(std::floor(box.y0 / cell)); j * cell < box.y1; ++j) {
        for (int i = static_cast<int>(std::floor(box.x0 / cell)); i * cell < box.x1; ++i) {
            const std::uint64_t hash = hash_words(key, 1ull << 63 | static_cast<std::uint64_t>(j) << 31 |
                                                           static_cast<std::uint64_t>(i));
            const Vec2 at((i + unit_double(hash_words(hash, 2))) * cell,
                          (j + unit_double(hash_words(hash, 3))) * cell);
            const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
            if (x < box.x0 || y < box.y0 || x >= box.x1 || y >= box.y1 || regions.label.at(x, y) != label)
                continue;
            if (occupied.any_within(sites, at, cell)) continue;
            sites.push_back(make_site(Vec2f(at), hash));
        }
    }
}

} // namespace

std::vector<CellSite> make_cell_sites(const SparseMap& sparse, const Regions& regions, std::uint32_t label,
                                      double cell, std::uint64_t seed, int coat) {
    const std::uint64_t key = coat_key(seed, coat);
    std::vector<CellSite> candidates = collect_source_sites(sparse, regions, label, key);
    // The order of the thinning belongs to the photons, not to the screen.
    std::sort(candidates.begin(), candidates.end(),
              [](const CellSite& a, const CellSite& b) { return a.hash < b.hash; });
    const PixelRect box = regions.regions[label - 1].box;
    const double spacing = thinning * cell;
    Occupied occupied(box, spacing);
    std::vector<CellSite> sites;
    for (const CellSite& candidate : candidates) {
        if (occupied.any_within(sites, Vec2(candidate.at), spacing)) continue;
        occupied.add(Vec2(candidate.at));
        sites.push_back(candidate);
    }
    fill_holes(sites, occupied, regions, label, cell, key);
    if (sites.empty()) { // a region smaller than a cell that the grid missed
        for (int y = box.y0; y < box.y1 && sites.empty(); ++y)
            for (int x = box.x0; x < box.x1 && sites.empty(); ++x)
                if (regions.label.at(x, y) == label)
                    sites.push_back(make_site(Vec2f(Vec2(x + 0.5, y + 0.5)), hash_words(key, 7)));
    }
    return sites;
}

SiteGrid build_site_grid(std::vector<CellSite> sites, PixelRect box, double bucket) {
    SiteGrid grid;
    grid.bucket = static_cast<float>(bucket);
    grid.origin = Vec2f(box.x0, box.y0);
    grid.columns = static_cast<int>((box.x1 - box.x0) / bucket) + 1;
    grid.rows = static_cast<int>((box.y1 - box.y0) / bucket) + 1;
    grid.sites = std::move(sites);
    const auto slot = [&](const CellSite& site) {
        const Vec2f p = (site.at - grid.origin) / grid.bucket;
        const int i = std::clamp(static_cast<int>(p.x), 0, grid.columns - 1);
        const int j = std::clamp(static_cast<int>(p.y), 0, grid.rows - 1);
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns) +
               static_cast<std::size_t>(i);
    };
    const std::size_t buckets = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    grid.begin.assign(buckets + 1, 0);
    for (const CellSite& site : grid.sites) ++grid.begin[slot(site) + 1];
    for (std::size_t b = 0; b < buckets; ++b) grid.begin[b + 1] += grid.begin[b];
    grid.entries.resize(grid.sites.size());
    std::vector<std::uint32_t> next(grid.begin.begin(), grid.begin.end() - 1);
    for (std::uint32_t s = 0; s < grid.sites.size(); ++s) grid.entries[next[slot(grid.sites[s])]++] = s;
    return grid;
}

std::uint32_t nearest_site(const SiteGrid& grid, Vec2f at) {
    const Vec2f p = (at - grid.origin) / grid.bucket;
    const int ci = std::clamp(static_cast<int>(p.x), 0, grid.columns - 1);
    const int cj = std::clamp(static_cast<int>(p.y), 0, grid.rows - 1);
    std::uint32_t best = 0;
    float best_distance2 = std::numeric_limits<float>::infinity();
    const auto visit = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) return;
        const std::size_t slot = static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns) +
                                 static_cast<std::size_t>(i);
        for (std::uint32_t e = grid.begin[slot]; e < grid.begin[slot + 1]; ++e) {
            const Vec2f d = grid.sites[grid.entries[e]].at - at;
            const float distance2 = d.x * d.x + d.y * d.y;
            if (distance2 < best_distance2 || (distance2 == best_distance2 && grid.entries[e] < best)) {
                best_distance2 = distance2;
                best = grid.entries[e];
            }
        }
    };
    // Rings of buckets until nothing outside them can be nearer.
    for (int ring = 0; ring <= std::max(grid.columns, grid.rows); ++ring) {
        if (ring == 0) visit(ci, cj);
        for (int k = -ring; k < ring; ++k) {
            visit(ci + k, cj - ring);
            visit(ci + ring, cj + k);
            visit(ci - k, cj + ring);
            visit(ci - ring, cj - k);
        }
        const float reach = static_cast<float>(ring) * grid.bucket;
        if (best_distance2 <= reach * reach) break;
    }
    return best;
}

Color cell_deviates(std::uint64_t hash) {
    const auto clamped = [](double v) {
        return static_cast<float>(std::clamp(v, -deviate_cut, deviate_cut) * deviate_scale);
    };
    // Box and Muller's pairs; 1 - u is never 0.
    const auto pair = [&](std::uint64_t k) {
        const double radius = std::sqrt(-2 * std::log(1 - unit_double(hash_words(hash, k))));
        const double angle = 2 * pi * unit_double(hash_words(hash, k + 1));
        return Vec2(radius * std::cos(angle), radius * std::sin(angle));
    };
    const Vec2 first = pair(10), second = pair(12);
    return {clamped(first.x), clamped(first.y), clamped(second.x)};
}

Color cell_uniform_deviates(std::uint64_t hash) {
    const auto deviate = [&](std::uint64_t k) {
        return static_cast<float>((2 * unit_double(hash_words(hash, k)) - 1) * 1.7320508075688772);
    };
    return {deviate(10), deviate(11), deviate(12)};
}

} // namespace pnr
