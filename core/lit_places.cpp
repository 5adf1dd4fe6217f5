// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lit_places.h"

#include "core/rng.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace pnr {
namespace {

// Width of a cell over the mean distance of places. With 0.7 the pictures are no better, and take 5 % longer:
// fewer cells stay in the cache.
constexpr float cell_share = 1.4f;
// Where the photons about a place lie so far to one side, in radii, a wall is looked for on the other.
constexpr float lopsided = 0.12f;
// Slots that are tried before an answer is found without being kept.
constexpr int most_probes = 8;

// One in `lit_stride` photons of PhotonMap::tree marks a place, by chance; the others tell the light there.
// Were these the same photons, a place would seem too bright by its own photon, and as the nearest place of
// points about it too dark again: what has no other place near lies where photons are few.
bool marks_place(std::size_t photon) { return hash_words(photon, 0x3c6ef372fe94f82bull) % lit_stride == 0; }

// Walls that stand on a surface about a point of it: unit normals towards the point, and how far away they
// are.
struct Walls {
    std::array<Vec3f, 4> normals{};
    std::array<float, 4> away{};
    std::size_t count = 0;

    bool hide(Vec3f offset) const {
        for (std::size_t i = 0; i < count; ++i)
            if (-glm::dot(offset, normals[i]) > 0.99f * away[i]) return true;
        return false;
    }
};

// As four rays along the surface find them. `turn` in [0, 1) says where the first one goes.
Walls find_walls(const World& world, Vec3 at, Vec3 normal, double radius, double turn) {
    const Frame frame = make_frame(normal);
    const Vec3 above = at + normal * (0.02 * radius);
    Walls walls;
    for (int i = 0; i < 4; ++i) {
        const double angle = 2 * pi * (turn + 0.25 * i);
        const Vec3 along = std::cos(angle) * frame.x + std::sin(angle) * frame.y;
        const std::optional<Hit> met = closest_hit(world, Ray{above, along, 0, radius}, RayKind::photon);
        if (!met) continue;
        Vec3 wall = met->normal - glm::dot(met->normal, normal) * normal;
        if (!(glm::length(wall) > 0.5)) continue; // hardly one
        wall = glm::normalize(glm::dot(wall, along) < 0 ? wall : -wall);
        const auto known = walls.normals.begin() + static_cast<std::ptrdiff_t>(walls.count);
        if (std::any_of(walls.normals.begin(), known, [&](Vec3f w) { return glm::dot(Vec3(w), wall) > 0.9; }))
            continue;
        walls.normals[walls.count] = Vec3f(wall);
        walls.away[walls.count] = static_cast<float>(glm::dot(above - met->position, wall));
        ++walls.count;
    }
    return walls;
}

// Share of the Epanechnikov kernel's disc that a wall leaves, `away` radii from the middle.
double share_before(double away) {
    const double t = std::clamp(away, 0.0, 1.0);
    return 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t) * (5 - 2 * t * t) / 3) / pi;
}

// Sum of flux times the kernel's weight, over the photons of the surface.
struct KernelSum {
    Color flux{0};
    Vec3f middle{0}; // of the photons, as seen from the point
    float count = 0;
};

KernelSum kernel_sum(const PhotonMap& map, std::span<const Neighbour> photons, Vec3f at, Vec3f normal,
                     float radius2, const Walls& walls) {
    const float thickness = 0.5f * std::sqrt(radius2);
    KernelSum sum;
    for (const Neighbour& near : photons) {
        const Photon& photon = map.photons[near.index];
        const Vec3f offset = photon.position - at;
        if (near.distance2 >= radius2 || glm::dot(photon.direction, normal) >= 0) continue;
        if (std::abs(glm::dot(offset, normal)) > thickness || walls.hide(offset)) continue;
        sum.flux += photon.flux * (2 * (1 - near.distance2 / radius2));
        sum.middle += offset;
        ++sum.count;
    }
    return sum;
}

// Irradiance by direct and indirect light from the photons that mark no place, at a point of the side
// `normal`; kernel and limits as in radiance.cpp's density estimate, but that beside a wall the disc is what
// lies before it: there the photons of the wall would be counted and those behind it be missed.
Color irradiance_by_others(const World& world, const PhotonMap& map, int neighbours, Vec3f at, Vec3f normal,
                           std::vector<Neighbour>& scratch) {
    constexpr auto share = static_cast<float>(lit_stride - 1) / static_cast<float>(lit_stride);
    const int count = static_cast<int>(std::lround(static_cast<float>(neighbours) / share));
    SearchHint hint;
    find_nearest_near(map.tree, at, count, map.radius, hint, scratch);
    const bool full = static_cast<int>(scratch.size()) >= count;
    std::erase_if(scratch, [](const Neighbour& near) { return marks_place(near.index); });
    if (scratch.empty()) return Color{0};
    float radius2 = map.radius * map.radius;
    if (full) { // the last one ended the search and is left out
        radius2 = 0;
        for (const Neighbour& near : scratch) radius2 = std::max(radius2, near.distance2);
    }
    if (!(radius2 > 0)) return Color{0};
    KernelSum sum = kernel_sum(map, scratch, at, normal, radius2, {});
    double left = 1;
    const float radius = std::sqrt(radius2);
    if (glm::length(sum.middle) > lopsided * radius * sum.count) {
        const double turn = unit_double(mix_bits(scratch.front().index));
        const Walls walls = find_walls(world, Vec3(at), Vec3(normal), static_cast<double>(radius), turn);
        for (std::size_t i = 0; i < walls.count; ++i)
            left *= share_before(static_cast<double>(walls.away[i] / radius));
        if (walls.count > 0) sum = kernel_sum(map, scratch, at, normal, radius2, walls);
    }
    return sum.flux / (static_cast<float>(pi * std::max(left, 0.2)) * radius2 * share);
}

// Irradiance by caustics, within a disc that holds about one place.
Color caustic_irradiance(const PhotonMap& map, float radius, Vec3f at, Vec3f normal,
                         std::vector<Neighbour>& scratch) {
    if (map.caustic.count == 0) return Color{0};
    find_within(map.caustic, at, radius, scratch);
    Color sum{0};
    for (const Neighbour& near : scratch) {
        const Photon& photon = map.photons[near.index];
        if (glm::dot(photon.direction, normal) >= 0) continue;
        if (std::abs(glm::dot(photon.position - at, normal)) > 0.5f * radius) continue;
        sum += photon.flux * (2 * (1 - near.distance2 / (radius * radius)));
    }
    return sum / (static_cast<float>(pi) * radius * radius);
}

// ---- cells
// --------------------------------------------------------------------------------------------------------

// The axis and sign that a normal leans to most: 0..5.
int side_of(Vec3 normal) {
    const Vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

struct Cell {
    glm::ivec3 at;
    int side;

    // Never 0. Cells farther than a million widths from the origin share keys with others; there are none so
    // far out.
    std::uint64_t key() const {
        return 1ull << 63 | static_cast<std::uint64_t>(side) << 60 |
               static_cast<std::uint64_t>(at.x & 0xfffff) << 40 |
               static_cast<std::uint64_t>(at.y & 0xfffff) << 20 | static_cast<std::uint64_t>(at.z & 0xfffff);
    }
};

// The light of the place nearest to a cell's middle among those that face its side.
LitIrradiance cell_irradiance(const LitPlaces& lit, const Cell& cell, std::vector<Neighbour>& scratch) {
    const Vec3f middle = (Vec3f(cell.at) + 0.5f) * lit.cells.width;
    const int axis = cell.side / 2;
    const float sign = cell.side % 2 == 0 ? 1.0f : -1.0f;
    for (const int neighbours : {1, 8, 32}) { // most often the nearest will do
        find_nearest(lit.tree, middle, neighbours, std::numeric_limits<float>::infinity(), scratch);
        for (const Neighbour& near : scratch)
            if (lit.places[near.index].normal[axis] * sign > 0.5f) return lit.places[near.index].light;
    }
    return {};
}

LitCells make_cells(std::size_t places, float width) {
    LitCells cells;
    cells.width = width;
    cells.mask = std::bit_ceil(std::max<std::size_t>(1024, 4 * places)) - 1;
    cells.slots = std::make_unique<LitCells::Slot[]>(cells.mask + 1);
    return cells;
}

} // namespace

// The surface under a photon, met again by its ray: a photon's record knows neither surface nor normal.
// Nothing if something else is met first (a sheet thinner than the step back).
std::optional<Hit> hit_of_photon(const World& world, const Photon& photon) {
    const Vec3 direction = glm::normalize(Vec3(photon.direction));
    const double back = 0x1p-12 * world.radius, slack = 0x1p-20 * world.radius;
    const Ray ray{Vec3(photon.position) - direction * back, direction, 0, 2 * back};
    std::optional<Hit> hit = closest_hit(world, ray, RayKind::photon);
    if (!hit || glm::length(hit->position - Vec3(photon.position)) > slack) return std::nullopt;
    return hit;
}

Vec3 lit_side(const Hit& hit, const Photon& photon) {
    return glm::dot(hit.normal, Vec3(photon.direction)) < 0 ? hit.normal : -hit.normal;
}

LitPlaces make_lit_places(const World& world, const PhotonMap& map, int neighbours,
                          const Progress& progress) {
    std::vector<std::uint32_t> marks;
    for (std::size_t i = 0; i < map.tree.count; ++i)
        if (marks_place(i)) marks.push_back(static_cast<std::uint32_t>(i));
    const std::size_t count = marks.size();
    LitPlaces lit;
    lit.places.resize(count);
    std::vector<Vec3f> positions(count);
    // The map's radius holds 100 photons.
    const float apart = map.radius * std::sqrt(static_cast<float>(pi) * lit_stride / 100);
    const float caustic_radius = std::max(map.caustic_radius, 1.5f * apart);
    std::atomic<std::int64_t> done{0};
    std::atomic<bool> stop{false};
    parallel_for(static_cast<std::int64_t>(count), 1024,
                 [&](std::int64_t begin, std::int64_t end, std::int64_t) {
                     std::vector<Neighbour> scratch;
                     for (std::int64_t n = begin; n < end && !stop; ++n) {
                         const auto i = static_cast<std::size_t>(n);
                         const Photon& photon = map.photons[marks[i]];
                         positions[i] = photon.position;
                         const std::optional<Hit> hit = hit_of_photon(world, photon);
                         if (!hit) continue; // its normal stays 0: no ray takes it
                         const Vec3f normal(lit_side(*hit, photon));
                         lit.places[i] = {
                             normal,
                             {irradiance_by_others(world, map, neighbours, photon.position, normal, scratch),
                              caustic_irradiance(map, caustic_radius, photon.position, normal, scratch)}};
                     }
                     if (progress && !progress(done += end - begin, static_cast<std::int64_t>(count)))
                         stop = true;
                 });
    if (stop) throw Interrupted{};
    lit.tree = build_kdtree(positions);
    lit.cells = make_cells(count, std::max(cell_share * apart, static_cast<float>(world.radius) * 1e-5f));
    return lit;
}

LitIrradiance lit_irradiance(const LitPlaces& lit, Vec3 position, Vec3 normal,
                             std::vector<Neighbour>& scratch) {
    if (lit.places.empty()) return {};
    const Cell cell{glm::ivec3(glm::floor(Vec3f(position) / lit.cells.width)), side_of(normal)};
    const std::uint64_t key = cell.key();
    std::uint64_t hash = mix_bits(key);
    for (int probe = 0; probe < most_probes; ++probe, ++hash) {
        LitCells::Slot& slot = lit.cells.slots[hash & lit.cells.mask];
        std::uint64_t held = slot.key.load(std::memory_order_acquire);
        if (held == key) {
            if (slot.known.load(std::memory_order_acquire)) return slot.light;
            break; // somebody is at it
        }
        if (held != 0) continue;
        if (!slot.key.compare_exchange_strong(held, key, std::memory_order_acq_rel)) {
            if (held == key) break;
            continue;
        }
        slot.light = cell_irradiance(lit, cell, scratch);
        slot.known.store(true, std::memory_order_release);
        return slot.light;
    }
    return cell_irradiance(lit, cell, scratch);
}

} // namespace pnr
