// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/seats.h"

#include "core/rng.h"
#include "npr/point_buckets.h"
#include "npr/seen_photons.h"

#include <bit>

namespace pnr {

std::uint64_t hash_place(std::uint64_t key, Vec3f place) {
    for (int c = 0; c < 3; ++c) key = hash_words(key, std::bit_cast<std::uint32_t>(place[c]));
    return key;
}

namespace {

// Cosine between a seat's normal and that of the pixel that shows it: photons on the rim of a thin part would
// else give its face a colour that it has nowhere.
constexpr float least_alike = 0.5f;

} // namespace

Seats find_seats(const World& world, const GBuffer& gbuffer, const PhotonMap& map) {
    Seats seats;
    seats.photons.resize(world.objects.size());
    if (map.normals.size() != map.photons.size()) return seats;
    std::vector<std::uint32_t> numbers(map.photons.size(), 0);
    for (std::size_t i = 0; i < map.photons.size(); ++i) {
        const Photon& photon = map.photons[i];
        const auto object = static_cast<std::size_t>(photon.object());
        if (!photon.npr() || object >= world.objects.size() || !world.objects[object].npr) continue;
        numbers[i] = static_cast<std::uint32_t>(seats.photons[object].size());
        seats.photons[object].push_back(photon.position);
    }
    for (const auto& chunk : see_photons(world, gbuffer, map)) {
        for (const SeenPhoton& seen : chunk) {
            const Seen& pixel = gbuffer.seen.at(seen.x, seen.y);
            if (glm::dot(map.normals[seen.photon], pixel.normal) < least_alike) continue;
            seats.seen.push_back(
                {seen.at, map.photons[seen.photon].position, numbers[seen.photon], pixel.object, pixel.via});
        }
    }
    return seats;
}

namespace {

float extent_of(std::span<const Vec3f> points) {
    Vec3f low = points.front(), high = low;
    for (const Vec3f& p : points) low = glm::min(low, p), high = glm::max(high, p);
    return glm::distance(low, high);
}

} // namespace

// Rounds of dart throwing, each with darts closer than the round before. Who was refused lately need not ask
// again until the distance is smaller than that to the dart in its way; who is taken learns its distance to
// all taken before it, so that any value between two rounds' parts the points as cleanly as the rounds do.
std::vector<float> spread_points(std::span<const Vec3f> points, std::uint64_t key, float finest) {
    std::vector<float> spacing(points.size(), std::numeric_limits<float>::infinity());
    if (points.empty()) return spacing;
    std::vector<std::pair<std::uint64_t, std::int32_t>> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        order[i] = {hash_place(key, points[i]), static_cast<std::int32_t>(i)};
    std::sort(order.begin(), order.end());
    std::vector<std::int32_t> waiting(points.size()), taken, still;
    std::transform(order.begin(), order.end(), waiting.begin(), [](const auto& o) { return o.second; });
    int round = static_cast<int>(std::ceil(3 * std::log2(std::max(extent_of(points), finest))));
    const auto distance_of = [](int r) { return std::exp2(static_cast<float>(r) / 3); };
    for (; !waiting.empty(); --round) {
        const float distance = distance_of(round), wider = distance_of(round + 1);
        PointBuckets near(wider, points.size());
        for (const std::int32_t i : taken) near.add(points[static_cast<std::size_t>(i)]);
        still.clear();
        for (const std::int32_t i : waiting) {
            float& own = spacing[static_cast<std::size_t>(i)];
            if (own >= distance)
                own = std::min(own, near.nearest(points[static_cast<std::size_t>(i)], wider));
            if (own < distance) {
                still.push_back(i);
                continue;
            }
            near.add(points[static_cast<std::size_t>(i)]);
            taken.push_back(i);
        }
        waiting.swap(still);
        if (distance < finest) break;
    }
    for (const std::int32_t i : waiting) spacing[static_cast<std::size_t>(i)] = 0;
    return spacing;
}

} // namespace pnr
