// SPDX-License-Identifier: GPL-3.0-or-later
// A balanced kd-tree over points: k nearest within a radius, and all within a radius. Exact. Serves photons,
// and with z = 0 source pixels and stroke sites.
//
// Leaves of 8 to 16 points, found through nodes that test four children's tight boxes at once. Measured by
// bench_photons on a million photons, k = 50 and 100, against nanoflann's queries a second in the same run:
// uniform photons 6.9 and 10.7 times, caustic ones 2.1 and 4.4 times, built in 0.70 of its time, 14
// bytes a photon beside the photon (CGAL's Kd_tree: 1.5, 1.5, 0.8, 0.8 times, built in twice the time).
// Without a hint and sorted by distance (find_nearest) the same tree reaches 1.2, 1.5, 0.5, 0.8 times, so
// sums over photons should use find_nearest_near.
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

// The tight boxes of four children: coordinate, child. A child that does not exist is infinitely far.
struct alignas(16) KdNode {
    float low[3][4], high[3][4];
};

// A complete tree of 2^levels leaves. Leaf l holds the points [l n / 2^levels, (l + 1) n / 2^levels).
// Coordinates lie apart, padded so that a leaf may be read past its end.
struct KdTree {
    std::vector<float> x, y, z; // in leaf order
    std::vector<std::uint32_t>
        order;                 // leaf order -> index as given; empty: the points were given in leaf order
    std::vector<KdNode> nodes; // level by level from the root; see kdtree.cpp
    std::size_t count = 0;
    int levels = 0; // of two children each; the nodes take two at a time
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

// Where a search before this one was, and how far it had to go for its k-th point; 0: none yet.
struct SearchHint {
    Vec3f point{0};
    float distance = 0;
};
// The k nearest with distance <= radius, as find_nearest, but in the tree's leaf order, and ties by that
// order: several times faster, for sums over photons. `hint` is from a search nearby for the same k, and is
// left for the next one; the result does not depend on it, the time does. Returns the largest squared
// distance found; 0 if none.
float find_nearest_near(const KdTree& tree, Vec3f point, int k, float radius, SearchHint& hint,
                        std::vector<Neighbour>& found);

} // namespace pnr
