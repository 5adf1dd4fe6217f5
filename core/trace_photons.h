// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 1: the photon tracing pass [LW10 3.1; Jensen 2001 ch. 5].
#pragma once

#include "core/parallel.h"
#include "core/photon_map.h"
#include "core/world.h"

namespace pnr {

// Emits `settings.count` photons over all lights by their power, follows them by Russian roulette and stores
// one at every diffuse hit. `keep_normals`: fill PhotonMap::normals (painted scenes, --maps). `pass` numbers
// progressive passes from 0. Does not build the kd-tree: build_photon_tree (photon_map.h) does, so that the
// two are timed apart.
PhotonMap trace_photons(const World& world, const PhotonSettings& settings, std::uint64_t seed, int pass,
                        bool keep_normals, const Progress& progress = {});

} // namespace pnr
