// SPDX-License-Identifier: GPL-3.0-or-later
// Steps 1 and 2 of [LW10 3.2.2], and the projection that ends step 3.
#include "core/radiance.h"
#include "npr/footprint.h"
#include "npr/paint.h"
#include "npr/seen_photons.h"

#include <atomic>
#include <map>
#include <set>

namespace pnr {

namespace {

constexpr std::uint64_t bare_stream = 1ull << 61; // random numbers of pixels, apart from those of photons

// The nearest to the viewer wins the pixel; of equals the lower photon index, since candidates come in that
// order.
SparseMap keep_nearest(const GBuffer& gbuffer, const std::vector<std::vector<SeenPhoton>>& chunks) {
    SparseMap sparse(gbuffer.seen.width, gbuffer.seen.height);
    Image<double> nearest(sparse.width, sparse.height, infinity);
    for (const auto& chunk : chunks) {
        for (const SeenPhoton& c : chunk) {
            double& z = nearest.at(c.x, c.y);
            if (!(c.z < z)) continue;
            z = c.z;
            const Seen& seen = gbuffer.seen.at(c.x, c.y);
            SourcePixel& source = sparse.at(c.x, c.y);
            source.photon = static_cast<std::int32_t>(c.photon);
            source.z = static_cast<float>(c.z);
            source.at = c.at;
            source.object = seen.object;
            source.via = seen.via;
        }
    }
    return sparse;
}

Vec3 toward_viewer_of(const GBuffer& gbuffer, const Seen& seen, Vec3 position) {
    const Camera& camera = gbuffer.view.camera;
    if (seen.via != 0) return glm::normalize(Vec3(seen.last_specular) - position);
    if (camera.projection == Projection::orthographic) return -glm::normalize(camera.direction);
    return glm::normalize(camera.location - position);
}

// Marks the painted pixels of regions that no photon came to: what they show must take its colour from
// itself.
void mark_bare_regions(const GBuffer& gbuffer, SparseMap& sparse) {
    std::set<std::uint64_t> regions;
    for (const SourcePixel& s : sparse.pixels)
        if (s.photon >= 0) regions.insert(region_key(s.object, s.via));
    for (std::size_t i = 0; i < sparse.pixels.size(); ++i) {
        const Seen& seen = gbuffer.seen.pixels[i];
        if (!is_painted(seen) || regions.contains(region_key(seen.object, seen.via))) continue;
        sparse.pixels[i].object = seen.object;
        sparse.pixels[i].via = seen.via;
    }
}

bool is_finite(Color c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

} // namespace

SparseMap make_sparse_map(const World& world, const GBuffer& gbuffer, const PhotonMap& map,
                          const Settings& settings, const Progress& progress) {
    SparseMap sparse(gbuffer.seen.width, gbuffer.seen.height);
    if (map.normals.size() == map.photons.size()) // else traced for a scene that was not painted then
        sparse = keep_nearest(gbuffer, see_photons(world, gbuffer, map));
    mark_bare_regions(gbuffer, sparse);

    const GatherSettings gather = default_gather(world, map, settings.photons);
    std::atomic<std::int64_t> rows_done{0};
    parallel_for(sparse.height, 4, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<Neighbour> scratch;
        for (std::int64_t row = begin; row < end; ++row) {
            for (int x = 0; x < sparse.width; ++x) {
                const int y = static_cast<int>(row);
                SourcePixel& source = sparse.at(x, y);
                if (source.object == 0) continue;
                const Seen& seen = gbuffer.seen.at(x, y);
                const bool own = source.photon < 0;
                const auto photon = static_cast<std::size_t>(own ? 0 : source.photon);
                const Vec3 position(own ? seen.position : map.photons[photon].position);
                const Vec3 normal(own ? seen.normal : map.normals[photon]);
                source.normal = Vec3f(normal);
                // Hashed from the photon alone: its colour stays when the camera moves, but for the view's
                // own share.
                const std::uint64_t pixel =
                    static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(x) | bare_stream;
                Rng rng = make_rng(settings.render.seed, Pass::paint, own ? pixel : photon);
                const Color light = radiance_at(world, map, gather, position, normal, seen.surface,
                                                toward_viewer_of(gbuffer, seen, position),
                                                settings.render.shadow_samples, rng, scratch);
                source.radiance = is_finite(light) ? glm::max(light, Color(0)) : Color(0);
            }
        }
        const std::int64_t done = rows_done += end - begin;
        if (progress && !progress(done, sparse.height)) throw Interrupted{};
    });
    return sparse;
}

void orient_strokes(SparseMap& sparse, const World&, const GBuffer& gbuffer, const PhotonMap& map,
                    std::span<const Vec3f> oriented) {
    parallel_for(sparse.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < sparse.width; ++x) {
                SourcePixel& source = sparse.at(x, y);
                if (source.photon < 0) continue;
                const auto photon = static_cast<std::size_t>(source.photon);
                const Vec3 axis(oriented[photon]);
                Vec2 direction(0);
                if (source.via == 0)
                    direction = project_direction(gbuffer.view, Vec3(map.photons[photon].position), axis);
                else if (const auto steps = footprint_offset(gbuffer.seen.at(x, y), axis))
                    direction = *steps;
                source.direction = canonical_direction(direction);
                source.turned = is_turned(direction);
            }
        }
    });
}

} // namespace pnr
