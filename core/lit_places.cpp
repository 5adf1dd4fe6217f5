// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lit_places.h"

#include "core/rng.h"

#include <bit>
#include <cmath>
#include <limits>

namespace pnr {
namespace {

// Width of a cell over the mean distance of places. With 0.7 the pictures are no better, and take 5 % longer: fewer cells stay
// in the cache.
constexpr float cell_share = 1.4f;
// Slots that are tried before an answer is found without being kept.
constexpr int most_probes = 8;

// One in `lit_stride` photons of PhotonMap::tree marks a place, by chance; the others tell the light there.
// Were these the same photons, a place would seem too bright by its own photon, and as the nearest place of
// points about it too dark again: what has no other place near lies where photons are few.
bool marks_place(std::size_t photon) { return hash_words(photon, 0x3c6ef372fe94f82bull) % lit_stride == 0; }

// Irradiance by direct and indirect light from the photons that mark no place, at a point of the side
// `normal`; kernel and limits as in radiance.cpp's density estimate.
Color irradiance_by_others(const PhotonMap& map, int neighbours, Vec3f at, Vec3f normal,
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
    const float thickness = 0.5f * std::sqrt(radius2);
    Color sum{0};
    for (const Neighbour& near : scratch) {
        const Photon& photon = map.photons[near.index];
        if (near.distance2 >= radius2 || glm::dot(photon.direction, normal) >= 0) continue;
        if (std::abs(glm::dot(photon.position - at, normal)) > thickness) continue;
        sum += photon.flux * (2 * (1 - near.distance2 / radius2));
    }
    return sum / (static_cast<float>(pi) * radius2 * share);
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
    parallel_for(
        static_cast<std::int64_t>(count), 1024, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
            std::vector<Neighbour> scratch;
            for (std::int64_t n = begin; n < end && !stop; ++n) {
                const auto i = static_cast<std::size_t>(n);
                const Photon& photon = map.photons[marks[i]];
                positions[i] = photon.position;
                const std::optional<Hit> hit = hit_of_photon(world, photon);
                if (!hit) continue; // its normal stays 0: no ray takes it
                const Vec3f normal(lit_side(*hit, photon));
                lit.places[i] = {normal,
                                 {irradiance_by_others(map, neighbours, photon.position, normal, scratch),
                                  caustic_irradiance(map, caustic_radius, photon.position, normal, scratch)}};
            }
            if (progress && !progress(done += end - begin, static_cast<std::int64_t>(count))) stop = true;
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
