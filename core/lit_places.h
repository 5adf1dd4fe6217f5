// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiances computed beforehand from the photons, where the rays of a final gather end [Christensen 1999].
#pragma once

#include "core/photon_map.h"
#include "core/world.h"

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace pnr {

// The surface under a photon, met again by its ray: a photon's record knows neither surface nor normal.
// Nothing if something else is met first (a sheet thinner than the step back).
std::optional<Hit> hit_of_photon(const World& world, const Photon& photon);
// The hit's normal on the side that the photon came to.
Vec3 lit_side(const Hit& hit, const Photon& photon);

// One in so many photons marks a place.
inline constexpr std::size_t lit_stride = 4;

// Irradiance by direct and indirect light, and by caustics.
struct LitIrradiance {
    Color plain{0}, caustic{0};
};

// Answers that were given before, by small cells of space and the side that they are asked for. A cell's answer depends on
// the cell alone, so it is the same whoever asks first.
struct LitCells {
    struct Slot {
        std::atomic<std::uint64_t> key{0}; // 0: free
        std::atomic<bool> known{false};
        LitIrradiance light;
    };
    float width = 0; // world units
    std::size_t mask = 0;
    std::unique_ptr<Slot[]> slots; // mask + 1 of them
};

struct LitPlaces {
    struct Place {
        Vec3f normal{0}; // 0: unknown, never taken
        LitIrradiance light;
    };
    std::vector<Place> places;
    KdTree tree; // over their positions
    mutable LitCells cells;
};

// `neighbours` photons tell the light at a place, caustics about as blurred as the places lie apart. `map` must have
// its trees.
LitPlaces make_lit_places(const World& world, const PhotonMap& map, int neighbours, const Progress& progress = {});

// Irradiance about a point of the side `normal` (unit), as the nearest place knows it that faces the same way. From any
// thread.
LitIrradiance lit_irradiance(const LitPlaces& lit, Vec3 position, Vec3 normal, std::vector<Neighbour>& scratch);

} // namespace pnr
