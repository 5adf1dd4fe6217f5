// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/hidden_sources.h"

#include "npr/folds.h"
#include "npr/footprint.h"

#include <map>

namespace pnr {

bool is_hidden(const Seen& seen, Vec3f position, Vec3f normal) {
    const float pixel = footprint_of(seen).least;
    return pixel > 0 && is_fold(seen.position, seen.normal, position, normal, pixel);
}

std::optional<SparseMap> without_hidden(const SparseMap& sparse, const World& world, const GBuffer& gbuffer,
                                        const PhotonMap& map) {
    std::map<std::uint64_t, std::int64_t> left; // sources of each region that are not hidden
    std::vector<std::size_t> hidden;
    for (std::size_t i = 0; i < sparse.pixels.size(); ++i) {
        const SourcePixel& source = sparse.pixels[i];
        if (source.photon < 0) continue;
        const auto photon = static_cast<std::size_t>(source.photon);
        if (!world.objects[source.object].paint.paper_mode &&
            is_hidden(gbuffer.seen.pixels[i], map.photons[photon].position, map.normals[photon]))
            hidden.push_back(i);
        else
            ++left[region_key(source.object, source.via)];
    }
    std::erase_if(hidden, [&](std::size_t i) {
        return left.count(region_key(sparse.pixels[i].object, sparse.pixels[i].via)) == 0;
    });
    if (hidden.empty()) return {};
    SparseMap shown = sparse;
    for (const std::size_t i : hidden) shown.pixels[i] = {};
    return shown;
}

} // namespace pnr
