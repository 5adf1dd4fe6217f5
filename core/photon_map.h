// SPDX-License-Identifier: GPL-3.0-or-later
// What the photon tracing pass leaves behind: the paper's enhanced photon record [LW10 Fig. 2] and its
// kd-tree.
#pragma once

#include "core/kdtree.h"
#include "core/types.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace pnr {

// Caustic: every diffuse or glossy surface before the last one was met, and the last one is met, through mirrors or glass.
enum class PhotonPath : std::uint8_t { direct = 0, indirect = 1, caustic = 2 };

// 40 bytes. The surface normal of [LW10 Fig. 2] is kept beside it (PhotonMap::normals), since only painted
// scenes need it.
struct Photon {
    Vec3f position;        // world space
    Vec3f direction;       // unit, the way the photon goes (towards the surface)
    Color flux;            // W, already divided by the number emitted
    std::uint32_t tag = 0; // object << 3 | npr << 2 | path

    int object() const { return static_cast<int>(tag >> 3); }
    bool npr() const { return (tag & 4u) != 0; }
    PhotonPath path() const { return static_cast<PhotonPath>(tag & 3u); }
};
inline std::uint32_t photon_tag(int object, bool npr, PhotonPath path) {
    return static_cast<std::uint32_t>(object) << 3 | (npr ? 4u : 0u) | static_cast<std::uint32_t>(path);
}
static_assert(sizeof(Photon) == 40);

struct IrradianceField; // irradiance_field.h

// Flux in W, for the balance emitted = absorbed + escaped (in expectation; design.md section 5).
struct PowerBalance {
    glm::dvec3 emitted{0}, absorbed{0}, escaped{0};
};

struct PhotonMap {
    std::vector<Photon> photons; // in emission order, after build_photon_tree first those of `tree` in its
                                 // leaf order, then the caustic ones; the same for any number of threads
    std::vector<Vec3f> normals;  // unit, of the side hit, one per photon; empty when nothing is painted
    KdTree tree;                 // over the positions of all photons but the caustic ones
    KdTree caustic;              // over those of the caustic ones; `order` holds indices into photons
    std::int64_t emitted = 0;    // without those aimed at what throws caustics
    int pass = 0; // of progressive passes; others than the first have other random numbers
    PowerBalance balance;
    float radius = 0;         // gather radius cap in world units that suits this map
    float caustic_radius = 0; // likewise for its caustic photons; 0 if there are none
    std::shared_ptr<const IrradianceField>
        field; // smooth indirect light over this map; null: density estimates alone
};

// Sorts photons and normals into the leaf order of two kd-trees over them, so that neighbours lie together in
// memory, and names a gather radius if the map has none: what holds 100 photons for nine tenths of the tree's
// photons. Caustic photons get a radius of their own: beside other light what one of them cannot show as a spot
// within, where they are alone what holds 50 of them.
void build_photon_tree(PhotonMap& map);

// Own versioned binary file with a checksum and the scene's hash. load throws FileError for a file that can't
// be read and SceneError for one that does not fit the scene, saying what differs. The loaded map has its
// tree if the saved one had, and gives the same bits.
void save_photons(const PhotonMap& map, std::uint64_t scene_hash, const std::filesystem::path& file);
PhotonMap load_photons(std::uint64_t scene_hash, const std::filesystem::path& file);

} // namespace pnr
