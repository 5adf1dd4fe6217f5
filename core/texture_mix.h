// SPDX-License-Identifier: GPL-3.0-or-later
// Textures of a shape's own parts, where they run into one another: triangles with three, blobs.
#pragma once

#include "core/texture.h"
#include "core/world.h"

namespace pnr {

// Whether a hit shows a single plain texture, that of its surface's material on this side.
inline bool is_single(const Hit& hit, const Texture& texture) { return hit.shares[0] == 0 && is_plain(texture); }

// As for_each_texture, for all that a hit shows, `inside`: from the back.
void for_each_texture(const World& world, const Hit& hit, bool inside, const SurfacePoint& at, const TextureUse& use);

} // namespace pnr
