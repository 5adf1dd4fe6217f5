// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/seen_photons.h"

#include "npr/footprint.h"
#include "npr/maps.h"

#include <map>

namespace pnr {

namespace {

constexpr double depth_tolerance = 0.02; // of the G-buffer's z: design.md section 5

bool is_inside(const PixelRect& r, int x, int y) { return x >= r.x0 && y >= r.y0 && x < r.x1 && y < r.y1; }

bool near_in_depth(double z, double seen_z) { return std::abs(z - seen_z) <= depth_tolerance * seen_z; }

bool is_paint_photon(const World& world, const Photon& photon) {
    if (!photon.npr()) return false;
    const auto object = static_cast<std::size_t>(photon.object());
    return object < world.objects.size() && world.objects[object].npr;
}

// The pixel that a photon is seen at directly, if the picture shows it there.
std::optional<SeenPhoton> project_photon(const GBuffer& gbuffer, const Photon& photon, Vec3f normal,
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
    return SeenPhoton{x, y, index, projected->distance, Vec2f(projected->pixel)};
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

std::optional<SeenPhoton> project_through_chain(const GBuffer& gbuffer, const ChainView& view,
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
    return SeenPhoton{x, y, index, z, Vec2f(x + 0.5 + offset->x, y + 0.5 + offset->y)};
}

} // namespace

std::vector<std::vector<SeenPhoton>> see_photons(const World& world, const GBuffer& gbuffer,
                                                 const PhotonMap& map) {
    const auto chains = collect_chain_views(gbuffer);
    const auto count = static_cast<std::int64_t>(map.photons.size());
    constexpr std::int64_t grain = 4096;
    std::vector<std::vector<SeenPhoton>> chunks(static_cast<std::size_t>((count + grain - 1) / grain));
    parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
        std::vector<SeenPhoton>& out = chunks[static_cast<std::size_t>(chunk)];
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

} // namespace pnr
