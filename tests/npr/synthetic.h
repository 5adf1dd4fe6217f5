// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures made by hand for the tests of the NPR pass: what pixels see, without a world of rays behind it.
#pragma once

#include "core/rng.h"
#include "npr/paint.h"

namespace pnr::test {

inline World world_with_objects(int count, const PaintStyle& style) {
    World world;
    world.objects.resize(static_cast<std::size_t>(count) + 1);
    for (int i = 1; i <= count; ++i) {
        world.objects[static_cast<std::size_t>(i)].npr = true;
        world.objects[static_cast<std::size_t>(i)].paint = style;
    }
    return world;
}

inline GBuffer empty_gbuffer(int width, int height) {
    GBuffer g;
    g.view.width = width;
    g.view.height = height;
    g.window = {0, 0, width, height};
    g.seen = Image<Seen>(width, height);
    g.coverage = Image<float>(width, height, 0.0f);
    return g;
}

// `object_at(x, y)`: the painted object a pixel's centre sees, 0 for none.
template <class ObjectAt>
GBuffer gbuffer_of(int width, int height, ObjectAt&& object_at) {
    GBuffer g = empty_gbuffer(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto object = static_cast<std::uint32_t>(object_at(x, y));
            if (object == 0) continue;
            Seen& seen = g.seen.at(x, y);
            seen.object = object;
            seen.npr = true;
            seen.z = 1;
            seen.position = Vec3f(Vec2f(Vec2(x + 0.5, y + 0.5)), 0); // flat, facing the viewer, a unit a pixel
            seen.normal = {0, 0, -1};
            seen.dpdx = {1, 0, 0}, seen.dpdy = {0, 1, 0};
            g.coverage.at(x, y) = 1;
        }
    }
    return g;
}

// A share of the painted pixels made sources, each with its own colour and direction from the hash.
inline SparseMap random_sources(const GBuffer& g, double share, std::uint64_t seed) {
    SparseMap sparse(g.seen.width, g.seen.height);
    std::int32_t photon = 0;
    for (int y = 0; y < sparse.height; ++y) {
        for (int x = 0; x < sparse.width; ++x) {
            Rng rng = make_rng(seed, Pass::test, static_cast<std::uint64_t>(y * sparse.width + x));
            if (g.seen.at(x, y).object == 0 || rng.uniform() >= share) continue;
            SourcePixel& s = sparse.at(x, y);
            s.photon = photon++;
            s.radiance = Color(rng.uniform(), rng.uniform(), rng.uniform());
            const double angle = 2 * pi * rng.uniform();
            s.direction = canonical_direction({std::cos(angle), std::sin(angle)});
            s.at = Vec2f(Vec2(x + rng.uniform(), y + rng.uniform()));
            s.z = 1;
            s.normal = g.seen.at(x, y).normal;
            s.object = g.seen.at(x, y).object;
            s.via = g.seen.at(x, y).via;
        }
    }
    return sparse;
}

// Seats at such sources.
inline Seats random_seats(const GBuffer& g, double share, std::uint64_t seed) {
    Seats seats;
    for (const SourcePixel& s : random_sources(g, share, seed).pixels) {
        if (s.photon < 0) continue;
        if (seats.photons.size() <= s.object) seats.photons.resize(s.object + 1);
        std::vector<Vec3f>& photons = seats.photons[s.object];
        seats.seen.push_back({s.at, Vec3f(s.at, 0), static_cast<std::uint32_t>(photons.size()), s.object, s.via});
        photons.emplace_back(s.at, 0);
    }
    return seats;
}

} // namespace pnr::test
