// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/texture_mix.h"

namespace pnr {

void for_each_texture(const World& world, const Hit& hit, bool inside, const SurfacePoint& at, const TextureUse& use) {
    const auto texture_of = [&](std::uint32_t surface) -> const Texture& {
        return side_texture(world.materials[static_cast<std::size_t>(world.surfaces[surface].material)], inside);
    };
    if (hit.shares[0] == 0) return for_each_texture(texture_of(hit.surface), at, use);
    for (int k = 0; k < 3; ++k) {
        const double whole = hit.shares[k];
        if (!(whole > 0)) continue;
        for_each_texture(texture_of(hit.mixed[static_cast<std::size_t>(k)]), at,
                         [&](const Texture& plain, const SurfacePoint& here, double share) {
                             use(plain, here, whole * share);
                         });
    }
}

} // namespace pnr
