// SPDX-License-Identifier: GPL-3.0-or-later
// A balanced kd-tree over points: k nearest within a radius, and all within a radius. Exact. Serves photons,
// and with z = 0 source pixels and stroke sites.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace pnr {

struct Neighbour {
    float distance2;     // squared
    std::uint32_t index; // into the points as given to build_kdtree
};

// A complete binary tree of 2^levels leaves; node 1 is the root, node i has the children 2 i and 2 i + 1.
// Leaf l holds the points [l n / 2^levels, (l + 1) n / 2^levels). Coordinates lie apart, padded so that a
// leaf may be read past its end.
struct KdTree {
    std::vector<float> x, y, z;       // in leaf order
    std::vector<std::uint32_t> order; // leaf order -> index as given
    std::vector<Vec3f> low, high;     // tight boxes of the nodes
    std::size_t count = 0;
    int levels = 0;
    Bounds bounds;
};

// Non-finite points are invalid input (the caller removes them). At most 2^31 points.
KdTree build_kdtree(std::span<const Vec3f> points);
// The same tree over its own points given in leaf order, in a fraction of the time and without `order`: for
// data that was sorted by an earlier tree's order.
KdTree kdtree_of_leaf_order(std::span<const Vec3f> points);

// The k nearest with distance <= radius, nearest first, ties by index. `found` is cleared first and may be
// reused between calls to save allocations. radius may be infinity.
void find_nearest(const KdTree& tree, Vec3f point, int k, float radius, std::vector<Neighbour>& found);
// All with distance <= radius, in the tree's leaf order.
void find_within(const KdTree& tree, Vec3f point, float radius, std::vector<Neighbour>& found);

} // namespace pnr
