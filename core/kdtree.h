// SPDX-License-Identifier: GPL-3.0-or-later
// A balanced kd-tree over points: k nearest within a radius, and all within a radius. Exact. Serves photons, and with z = 0
// source pixels and stroke sites.
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

struct KdNode; // kdtree.cpp

struct KdTree {
    std::vector<Vec3f> points;         // in leaf order
    std::vector<std::uint32_t> order;  // leaf order -> index as given
    std::vector<float> splits;         // implicit balanced tree, see kdtree.cpp
    std::vector<std::uint8_t> axes;
    Bounds bounds;
};

// Non-finite points are invalid input (the caller removes them).
KdTree build_kdtree(std::span<const Vec3f> points);

// The k nearest with distance <= radius, nearest first, ties by index. `found` is cleared first and may be reused between
// calls to save allocations. radius may be infinity.
void find_nearest(const KdTree& tree, Vec3f point, int k, float radius, std::vector<Neighbour>& found);
// All with distance <= radius, in index order of the tree (deterministic).
void find_within(const KdTree& tree, Vec3f point, float radius, std::vector<Neighbour>& found);

} // namespace pnr
