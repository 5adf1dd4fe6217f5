// SPDX-License-Identifier: GPL-3.0-or-later
// Steps 1 and 2 of [LW10 3.2.2], and the projection that ends step 3.
#include "core/radiance.h"
#include "npr/paint.h"

#include <atomic>
#include <map>
#include <set>

namespace pnr {

namespace {

constexpr std::uint64_t bare_stream = 1ull << 61; // random numbers of pixels, apart from those of photons
constexpr double depth_tolerance = 0.02;          // of the G-buffer's z: design.md section 5

// A photon that may become the source of a pixel.
struct Candidate {
    std::int32_t x, y;
    std::uint32_t photon;
    double z;
    Vec2f at;
};

bool is_inside(const PixelRect& r, int x, int y) { return x >= r.x0 && y >= r.y0 && x < r.x1 && y < r.y1; }

bool near_in_depth(double z, double seen_z) { return std::abs(z - seen_z) <= depth_tolerance * seen_z; }

bool is_paint_photon(const World& world, const Photon& photon) {
    if (!photon.npr()) return false;
    const auto object = static_cast<std::size_t>(photon.object());
    return object < world.objects.size() && world.objects[object].npr;
}

// The pixel that a photon is seen at directly, if the picture shows it there.
std::optional<Candidate> project_photon(const GBuffer& gbuffer, const Photon& photon, Vec3f normal,
                                        std::uint32_t index) {
    const Vec3 position(photon.position);
    const Camera& camera = gbuffer.view.camera;
    const Vec3 toward_viewer =
        camera.projection == Projection::perspective ? camera.location - position : -camera.direction;
    if (!(glm::dot(Vec3(normal), toward_viewer) > 0)) return {};
    const auto projected = project(gbuffer.view, position);
    if (!projected) return {};
    const double fx = std::floor(projected->pixel.x), fy = std::floor(projected->pixel.y);
    if (!(fx >= 0 && fy >= 0 && fx < gbuffer.view.width && fy < gbuffer.view.height)) return {};
    const int x = static_cast<int>(fx), y = static_cast<int>(fy);
    if (!gbuffer.seen.contains(x, y) || !is_inside(gbuffer.window, x, y)) return {};
    const Seen& seen = gbuffer.seen.at(x, y);
    if (!is_painted(seen) || seen.via != 0 || seen.object != static_cast<std::uint32_t>(photon.object()))
        return {};
    if (!near_in_depth(projected->distance, static_cast<double>(seen.z))) return {};
    return Candidate{x, y, index, projected->distance, Vec2f(projected->pixel)};
}

// The seen points behind specular chains, one tree for each object and the mirror or glass it is seen in.
struct ChainView {
    std::vector<std::uint32_t> pixels; // index into GBuffer::seen
    std::vector<Vec3f> points;
    KdTree tree;
};

std::map<std::uint32_t, std::vector<ChainView>> collect_chain_views(const GBuffer& gbuffer) {
    std::map<std::uint64_t, ChainView> by_key;
    for (int y = gbuffer.window.y0; y < gbuffer.window.y1; ++y) {
        for (int x = gbuffer.window.x0; x < gbuffer.window.x1; ++x) {
            const Seen& seen = gbuffer.seen.at(x, y);
            if (!is_painted(seen) || seen.via == 0) continue;
            ChainView& view = by_key[region_key(seen.object, seen.via)];
            view.pixels.push_back(static_cast<std::uint32_t>(y * gbuffer.seen.width + x));
            view.points.push_back(seen.position);
        }
    }
    std::map<std::uint32_t, std::vector<ChainView>> by_object;
    for (auto& [key, view] : by_key) {
        view.tree = build_kdtree(view.points);
        by_object[static_cast<std::uint32_t>(key >> 32)].push_back(std::move(view));
    }
    return by_object;
}

// The offset from the seen point in steps of its footprint: least squares over the tangent plane. Nothing if
// the footprint is degenerate.
std::optional<Vec2> footprint_offset(const Seen& seen, Vec3 offset) {
    const Vec3 u(seen.dpdx), v(seen.dpdy);
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return {};
    const double du = glm::dot(offset, u), dv = glm::dot(offset, v);
    return Vec2(vv * du - uv * dv, uu * dv - uv * du) / determinant;
}

std::optional<Candidate> project_through_chain(const GBuffer& gbuffer, const ChainView& view,
                                               const Photon& photon, Vec3f normal, std::uint32_t index,
                                               std::vector<Neighbour>& found) {
    find_nearest(view.tree, photon.position, 1, std::numeric_limits<float>::infinity(), found);
    if (found.empty()) return {};
    const std::uint32_t pixel = view.pixels[found.front().index];
    const Seen& seen = gbuffer.seen.pixels[pixel];
    if (!(glm::dot(normal, seen.toward_viewer) > 0) || !(glm::dot(normal, seen.normal) > 0)) return {};
    const auto offset = footprint_offset(seen, Vec3(photon.position) - Vec3(seen.position));
    if (!offset || std::abs(offset->x) > 0.5 || std::abs(offset->y) > 0.5) return {};
    const double z =
        static_cast<double>(seen.z_specular) + glm::distance(Vec3(seen.last_specular), Vec3(photon.position));
    if (!near_in_depth(z, static_cast<double>(seen.z))) return {};
    const int width = gbuffer.seen.width;
    const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
    return Candidate{x, y, index, z, Vec2f(x + 0.5 + offset->x, y + 0.5 + offset->y)};
}

std::vector<std::vector<Candidate>> collect_candidates(const World& world, const GBuffer& gbuffer,
                                                       const PhotonMap& map) {
    const auto chains = collect_chain_views(gbuffer);
    const auto count = static_cast<std::int64_t>(map.photons.size());
    constexpr std::int64_t grain = 4096;
    std::vector<std::vector<Candidate>> chunks(static_cast<std::size_t>((count + grain - 1) / grain));
    parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
        std::vector<Candidate>& out = chunks[static_cast<std::size_t>(chunk)];
        std::vector<Neighbour> found;
        for (std::int64_t i = begin; i < end; ++i) {
            const auto index = static_cast<std::size_t>(i);
            const Photon& photon = map.photons[index];
            if (!is_paint_photon(world, photon)) continue;
            const Vec3f normal = map.normals[index];
            const auto number = static_cast<std::uint32_t>(i);
            if (const auto direct = project_photon(gbuffer, photon, normal, number)) out.push_back(*direct);
            const auto views = chains.find(static_cast<std::uint32_t>(photon.object()));
            if (views == chains.end()) continue;
            for (const ChainView& view : views->second)
                if (const auto seen = project_through_chain(gbuffer, view, photon, normal, number, found))
                    out.push_back(*seen);
        }
    });
    return chunks;
}

// The nearest to the viewer wins the pixel; of equals the lower photon index, since candidates come in that
// order.
SparseMap keep_nearest(const GBuffer& gbuffer, const std::vector<std::vector<Candidate>>& chunks) {
    SparseMap sparse(gbuffer.seen.width, gbuffer.seen.height);
    Image<double> nearest(sparse.width, sparse.height, infinity);
    for (const auto& chunk : chunks) {
        for (const Candidate& c : chunk) {
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
        sparse = keep_nearest(gbuffer, collect_candidates(world, gbuffer, map));
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
