// SPDX-License-Identifier: GPL-3.0-or-later
// What one rendering leaves behind and a later one need not make again: of the frame before, of the last time
// that the scene was saved, or of an earlier run. Each value has a key, the hash of all that it is made from,
// so that a value under the right key has the bits that making it anew would give.
//
//  photons   from the world, its lights and which objects are painted; not from cameras or how paint is laid
//  seen      the G-buffer: from the world and the camera
//  sources   the sparse map but for its directions: from both
//  light     the photoreal layer: from both and how far objects are painted
#pragma once

#include "cli/disk_cache.h"
#include "cli/identity.h"
#include "core/emission.h"
#include "core/gbuffer.h"
#include "core/photon_map.h"
#include "core/render.h"
#include "npr/maps.h"
#include "parser/load_scene.h"

#include <cstdint>
#include <optional>

namespace pnr {

struct Rendering;
struct Wishes;

struct ReuseKeys { // 0: there is none, or it may not be used
    std::uint64_t photons = 0, seen = 0, sources = 0, light = 0;
    std::uint64_t photons_about = 0; // `photons` without the sphere that they were sent to, ...
    Focus focus;                     // ... which hangs on the camera where planes are endless
};

// What is known of a scene before its world is built.
struct SceneIdentity {
    std::uint64_t world = 0, camera = 0, paint = 0;
    AssetsRead assets;
};
SceneIdentity identity_of(const LoadResult& loaded);

struct Reuse {
    std::optional<SceneIdentity> scene; // of the rendering to come; unset: nothing is used again
    std::optional<DiskCache> disk;
    // Frames of one film: where planes are endless and photons fall about the first frame's camera too, they
    // are kept as long as the camera stands in their midst. Strokes that hang on photons would else swim.
    bool film = false;
    ReuseKeys keys; // of the rendering under way

    // What the rendering before left, and its keys.
    ReuseKeys kept;
    PhotonMap photons;
    GBuffer seen;
    SparseMap sources;
    RenderResult light;
};

// Fills reuse.keys for a rendering that has its world, plan and window; its settings hold the picture's size.
void find_keys(Reuse& reuse, const Rendering& r, const Wishes& wishes);

// Each takes its value into the rendering if it is kept, and says so in the plan.
bool take_photons(Reuse& reuse, Rendering& r);
bool take_seen(Reuse& reuse, Rendering& r);
bool take_sources(Reuse& reuse, Rendering& r);
bool take_light(Reuse& reuse, Rendering& r);

// Writes to the disk what the rendering made anew.
void store_on_disk(const Reuse& reuse, const Rendering& r);
// Keeps all of it for the next one, of a rendering that was stopped what it had finished: the rendering loses
// it.
void keep(Reuse& reuse, Rendering& r);

// What an earlier run's values would spare this rendering: for `pnr plan`.
void note_stored(const Reuse& reuse, Rendering& r);

} // namespace pnr
