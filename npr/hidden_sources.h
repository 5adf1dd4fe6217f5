// SPDX-License-Identifier: GPL-3.0-or-later
// Source photons that their pixel does not show. The sparse map takes a photon by its object and by its depth,
// within two parts in a hundred of the pixel's; behind a thin part of the object that lets through photons of
// what lies there, often in shadow, where no nearer photon fell: dark tiles along silhouettes and in grooves.
// Maps keep them, paint does not.
#pragma once

#include "npr/paint.h"

namespace pnr {

// Whether a photon of the pixel lies beyond a fold (folds.h) from the point that its centre sees.
bool is_hidden(const Seen& seen, Vec3f position, Vec3f normal);

// The sparse map without its hidden sources, but for objects in paper_mode, and for regions that would have
// none left. Nothing where none is hidden.
std::optional<SparseMap> without_hidden(const SparseMap& sparse, const World& world, const GBuffer& gbuffer,
                                        const PhotonMap& map);

} // namespace pnr
