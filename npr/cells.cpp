// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/cells.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "npr/footprint.h"
#include "npr/point_buckets.h"
#include "npr/seen_photons.h"

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

CellSite make_site(Vec2f at, Vec3f position, std::uint64_t hash) {
    return {at, position, 0, hash, unit_float(hash_words(hash, 1))};
}

// A place that may become a site, and how far it must lie from those before it.
struct Candidate {
    CellSite site;
    float distance;
};

float brush_at(const CellPlan& plan, int x, int y) {
    return brush_pixel(plan.scale, x - plan.region.box.x0, y - plan.region.box.y0);
}

float least_distance(const CellPlan& plan, int x, int y) {
    return static_cast<float>(thinning * plan.cell) * brush_at(plan, x, y);
}

constexpr float growing = 0.25f; // a cell that has just found room grows over so much more of it

// Photons in an order of their own, which is the same from everywhere: who is seated stays so when the camera
// moves.
std::vector<Candidate> seat_photons(const CellPlan& plan, std::uint64_t key) {
    std::vector<Candidate> seated;
    if (plan.region.object >= plan.seats.photons.size()) return seated;
    const PixelRect box = plan.region.box;
    std::vector<std::uint32_t> numbers;
    float finest = std::numeric_limits<float>::infinity();
    for (const Seat& seat : plan.seats.seen) {
        if (seat.object != plan.region.object || seat.via != plan.region.via) continue;
        const int x = static_cast<int>(seat.at.x), y = static_cast<int>(seat.at.y);
        if (!box.contains(x, y) || plan.mask.at(x - box.x0, y - box.y0) == 0) continue;
        const float distance = least_distance(plan, x, y);
        seated.push_back({make_site(seat.at, seat.position, hash_place(key, seat.position)), distance});
        numbers.push_back(seat.number);
        finest = std::min(finest, distance);
    }
    if (seated.empty()) return seated;
    const std::vector<float> spacing = spread_points(plan.seats.photons[plan.region.object], key, finest);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < seated.size(); ++i) {
        const float distance = seated[i].distance, room = spacing[numbers[i]] / distance;
        if (room < 1) continue;
        seated[kept] = seated[i];
        seated[kept++].site.radius2 = distance * distance * std::min(1.0f, (room - 1) / growing);
    }
    seated.resize(kept);
    return seated;
}

// A random point of each cube of a lattice in space, laid on the surface: at the pixel that shows the foot of
// its perpendicular, if that lies in the cube. Nothing of this hangs on the view but the width of the cubes,
// which goes in steps of powers of two.
void add_lattice_points(const CellPlan& plan, std::uint64_t key, int x, int y,
                        std::vector<Candidate>& found) {
    const Seen& seen = plan.gbuffer.seen.at(x, y);
    const int level = std::ilogb(static_cast<float>(plan.cell) * brush_at(plan, x, y));
    const float side = std::ldexp(1.0f, level);
    const Vec3f reach = 0.5f * (glm::abs(seen.dpdx) + glm::abs(seen.dpdy));
    const glm::ivec3 first(glm::floor((seen.position - reach) / side)),
        last(glm::floor((seen.position + reach) / side));
    if (glm::any(glm::greaterThan(last - first, glm::ivec3(3)))) return; // nearly edge-on
    for (int i = first.x; i <= last.x; ++i)
        for (int j = first.y; j <= last.y; ++j)
            for (int k = first.z; k <= last.z; ++k) {
                const Vec3f corner(glm::ivec3(i, j, k));
                const std::uint64_t hash =
                    hash_place(hash_words(key, static_cast<std::uint64_t>(level)), corner);
                const Vec3f inside(unit_float(hash_words(hash, 2)), unit_float(hash_words(hash, 3)),
                                   unit_float(hash_words(hash, 4)));
                const Vec3f off = (corner + inside) * side - seen.position;
                const Vec3f along = off - seen.normal * glm::dot(off, seen.normal);
                const auto steps = footprint_offset(seen, Vec3(along));
                if (!steps || !(std::abs(steps->x) <= 0.5 && std::abs(steps->y) <= 0.5)) continue;
                const Vec3f foot = seen.position + along;
                if (glm::floor(foot / side) != corner) continue;
                CellSite site = make_site(Vec2f(Vec2(x + 0.5, y + 0.5) + *steps), foot, hash);
                const float distance = least_distance(plan, x, y);
                site.radius2 = distance * distance;
                found.push_back({site, distance});
            }
}

std::vector<Candidate> find_lattice_points(const CellPlan& plan, std::uint64_t key) {
    const PixelRect box = plan.region.box;
    constexpr std::int64_t grain = 16;
    std::vector<std::vector<Candidate>> chunks(
        static_cast<std::size_t>((box.y1 - box.y0 + grain - 1) / grain));
    parallel_for(box.y1 - box.y0, grain, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
        for (int y = box.y0 + static_cast<int>(begin); y < box.y0 + static_cast<int>(end); ++y)
            for (int x = box.x0; x < box.x1; ++x)
                if (plan.mask.at(x - box.x0, y - box.y0) != 0)
                    add_lattice_points(plan, key, x, y, chunks[static_cast<std::size_t>(chunk)]);
    });
    std::vector<Candidate> found;
    for (const auto& chunk : chunks) found.insert(found.end(), chunk.begin(), chunk.end());
    return found;
}

// Takes candidates, in the order of their hashes, into the sites where those so far leave room.
void take_in_order(std::vector<Candidate>& candidates, std::vector<CellSite>& sites) {
    if (candidates.empty()) return;
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.site.hash < b.site.hash; });
    float widest = 0;
    for (const Candidate& c : candidates) widest = std::max(widest, c.distance);
    PointBuckets taken(widest, candidates.size());
    for (const CellSite& site : sites) taken.add(site.position);
    for (const Candidate& c : candidates) {
        if (std::isfinite(taken.nearest(c.site.position, c.distance))) continue;
        taken.add(c.site.position);
        sites.push_back(c.site);
    }
}

} // namespace

std::vector<CellSite> make_cell_sites(const CellPlan& plan) {
    const std::uint64_t key = coat_key(plan.seed, plan.coat);
    std::vector<CellSite> sites;
    for (const Candidate& seated : seat_photons(plan, key)) sites.push_back(seated.site);
    std::vector<Candidate> lattice = find_lattice_points(plan, key);
    take_in_order(lattice, sites);
    if (!sites.empty()) return sites;
    // A region so small that every point of the lattice missed it.
    const PixelRect box = plan.region.box;
    int x = box.x0;
    while (x + 1 < box.x1 && plan.mask.at(x - box.x0, 0) == 0) ++x;
    sites.push_back(make_site(Vec2f(Vec2(x + 0.5, box.y0 + 0.5)), plan.gbuffer.seen.at(x, box.y0).position,
                              hash_words(key, 7)));
    return sites;
}

SiteGrid build_site_grid(std::vector<CellSite> sites, PixelRect box, double bucket) {
    SiteGrid grid;
    grid.bucket = static_cast<float>(bucket);
    grid.origin = Vec2f(box.x0, box.y0);
    grid.columns = static_cast<int>((box.x1 - box.x0) / bucket) + 1;
    grid.rows = static_cast<int>((box.y1 - box.y0) / bucket) + 1;
    grid.sites = std::move(sites);
    for (const CellSite& site : grid.sites)
        grid.largest_radius2 = std::max(grid.largest_radius2, site.radius2);
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

std::uint32_t nearest_site(const SiteGrid& grid, Vec2f at, Vec3f place, float pixel) {
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
            const Vec3f d = grid.sites[grid.entries[e]].position - place;
            const float distance2 = glm::dot(d, d) - grid.sites[grid.entries[e]].radius2;
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
        const float reach = static_cast<float>(ring) * grid.bucket * pixel;
        if (best_distance2 + grid.largest_radius2 <= reach * reach) break;
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
