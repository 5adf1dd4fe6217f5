// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's own AABB tree with exact predicates, as it comes: slow, and right.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pnr::test {

class TreeOracle {
public:
    explicit TreeOracle(
        std::span<const float> corners); // nine floats a triangle; without those that have no area
    ~TreeOracle();
    // Numbers of all triangles that the ray from p through q meets, in no order.
    std::vector<std::uint32_t> met_by(const double (&p)[3], const double (&q)[3]) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace pnr::test
