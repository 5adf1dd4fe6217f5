// SPDX-License-Identifier: GPL-3.0-or-later
// Constructive solid geometry. A tree of solids is not a primitive of its own: each of its leaves stands in
// the scene's BVH with the tightest box that the tree leaves it, and a hit on a leaf counts if the rest of
// the tree lets it be seen there. That needs no list of a ray's hits, only whether points are inside solids,
// so a tree of thousands of leaves costs a ray what thousands of plain shapes cost.
//
// Where surfaces of two solids coincide, rounding would decide. So points are asked just before and just
// behind a hit: a solid that holds one of them but not the other has its surface there too, and the hit is
// shown if the whole tree changes there, on the leaf that stands first.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <vector>

namespace pnr {

enum class CsgKind : std::uint8_t {
    leaf,
    any,     // union
    merged,  // union without its inner surfaces
    all,     // intersection; a difference is one with inverse leaves
    clipped, // the first child, as far as it is inside all the others, whose surfaces are not there
};

// `inverse` stands in the items of leaves alone: de Morgan's laws have brought it down there.
struct CsgNode {
    CsgKind kind = CsgKind::leaf;
    bool cutaway = false;     // bare leaves show the textures of what they cut through
    bool first_alone = false; // of these textures: the first child's only (a difference)
    bool bare = false;        // a leaf without a texture
    std::uint32_t item = 0;   // of a leaf
    std::vector<std::uint32_t>
        children; // their numbers are lower; a child of several parents is never seen in them
};

// What the tree must know of its leaves, in world space, `inverse` taken into account.
struct CsgLeaf {
    Bounds surface; // where the surface is
    Bounds inside,
        outside; // no point outside of the one is inside the solid, every point outside of the other is
    bool inverse = false;
};

inline constexpr std::uint32_t no_csg = 0xffffffffu;

struct Csg {
    struct Pick { // boxes over the children of a node with many, depth first
        Bounds box;
        std::uint32_t child = no_csg; // or an inner box
        std::uint32_t skip = 0;       // the next one outside this box
    };
    struct Node {
        CsgKind kind = CsgKind::leaf;
        bool cutaway = false, first_alone = false, bare = false, inverse = false;
        std::uint32_t item = 0, parent = no_csg, order = 0; // order: among the parent's children
        std::vector<std::uint32_t> children;
        Bounds inside, outside; // as of a leaf
        std::vector<Pick> picks;
    };
    std::vector<Node> nodes;
    std::vector<std::uint32_t> leaf_of_item; // no_csg for those in no tree
    std::vector<Bounds> seen;                // of each item: where it can be seen at all, given the tree
};

// `items` has an entry for every item of the scene; of those in no tree it may be anything.
Csg make_csg(const std::vector<CsgNode>& nodes, const std::vector<CsgLeaf>& items);

// Tells whether a point is inside the shape of an item, as if that were not inverse.
struct CsgInside {
    const void* context = nullptr;
    bool (*inside)(const void* context, std::uint32_t item, Vec3 p) = nullptr;
};

bool csg_contains(const Csg& csg, std::uint32_t node, Vec3 p, const CsgInside& solids);

// Whether a hit on the leaf's surface is seen; `before` and `behind` lie on the ray close to it, to either
// side.
bool csg_shows(const Csg& csg, std::uint32_t leaf, Vec3 before, Vec3 behind, const CsgInside& solids);

// The item whose texture a hit at p on the leaf shows: its own, or that of what it cuts through.
std::uint32_t csg_textured_item(const Csg& csg, std::uint32_t leaf, Vec3 p, const CsgInside& solids);

} // namespace pnr
