// SPDX-License-Identifier: GPL-3.0-or-later
// Seats of strokes: where painted photons lie on their object, in an order that has nothing to do with the
// picture. The first so many of an order are spread evenly at every number [blue noise; McCool and Fiume
// 1992], so the strokes of a coat can be seated as far apart as their width asks for and stay where they are
// when the camera moves.
#pragma once

#include "core/gbuffer.h"
#include "core/photon_map.h"

#include <span>
#include <vector>

namespace pnr {

struct Seat {
    Vec2f at{0};              // where the picture shows it, in pixels
    Vec3f position{0};        // world space
    std::uint32_t number = 0; // index into Seats::photons of its object
    std::uint32_t object = 0, via = 0;
};

struct Seats {
    std::vector<Seat> seen; // those the picture shows, also in mirrors and through glass
    std::vector<std::vector<Vec3f>>
        photons; // places of every painted photon of each object, by object number
};

// Without PhotonMap::normals there are none.
Seats find_seats(const World& world, const GBuffer& gbuffer, const PhotonMap& map);

// How far each point lies from those before it in an order drawn by hashes of the points and `key`: the
// points whose value is s or more are about s apart and leave no hole much wider. Infinite for the first; 0
// for points that lie closer than `finest` (> 0) to one before.
std::vector<float> spread_points(std::span<const Vec3f> points, std::uint64_t key, float finest);

// A number that hangs on the place alone.
std::uint64_t hash_place(std::uint64_t key, Vec3f place);

} // namespace pnr
