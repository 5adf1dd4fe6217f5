// SPDX-License-Identifier: GPL-3.0-or-later
#include "bvh_oracle.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace pnr::test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Iterator>;

struct TreeOracle::Tree {
    std::vector<Kernel::Triangle_3> triangles;
    std::vector<std::uint32_t> numbers;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

TreeOracle::TreeOracle(std::span<const float> corners) : tree_(new Tree) {
    for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
        const auto point = [&](std::size_t k) {
            return Kernel::Point_3(corners[i + k], corners[i + k + 1], corners[i + k + 2]);
        };
        const Kernel::Triangle_3 triangle(point(0), point(3), point(6));
        if (triangle.is_degenerate()) continue;
        tree_->triangles.push_back(triangle);
        tree_->numbers.push_back(static_cast<std::uint32_t>(i / 9));
    }
    tree_->tree.insert(tree_->triangles.begin(), tree_->triangles.end());
    tree_->tree.build();
}
TreeOracle::~TreeOracle() = default;

std::vector<std::uint32_t> TreeOracle::met_by(const double (&p)[3], const double (&q)[3]) const {
    const Kernel::Ray_3 ray(Kernel::Point_3(p[0], p[1], p[2]), Kernel::Point_3(q[0], q[1], q[2]));
    std::vector<Iterator> met;
    tree_->tree.all_intersected_primitives(ray, std::back_inserter(met));
    std::vector<std::uint32_t> numbers;
    for (const Iterator& it : met)
        numbers.push_back(tree_->numbers[static_cast<std::size_t>(it - tree_->triangles.cbegin())]);
    return numbers;
}

} // namespace pnr::test
