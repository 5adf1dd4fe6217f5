// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray_kernels.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <malloc.h>

namespace pnr::bench {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;

struct CgalTree : RayKernel {
    std::vector<Kernel::Triangle_3> triangles;
    std::vector<std::uint32_t> numbers;
    std::unique_ptr<Tree> tree;
    std::size_t heap = 0;

    void build(std::span<const float> corners) override {
        const std::size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
        tree.reset();
        triangles.clear();
        numbers.clear();
        for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
            const auto point = [&](std::size_t k) {
                return Kernel::Point_3(corners[i + k], corners[i + k + 1], corners[i + k + 2]);
            };
            const Kernel::Triangle_3 triangle(point(0), point(3), point(6));
            if (triangle.is_degenerate()) continue;
            triangles.push_back(triangle);
            numbers.push_back(static_cast<std::uint32_t>(i / 9));
        }
        tree = std::make_unique<Tree>(triangles.cbegin(), triangles.cend());
        tree->build();
        if (!heap) heap = mallinfo2().uordblks + mallinfo2().hblkhd - before;
    }
    std::size_t bytes() const override { return heap; }
    static Kernel::Point_3 origin(const FloatRay& r) { return {r.origin[0], r.origin[1], r.origin[2]}; }
    static Kernel::Vector_3 direction(const FloatRay& r) {
        return {r.direction[0], r.direction[1], r.direction[2]};
    }
    void closest(std::span<const FloatRay> rays, std::uint32_t* met) const override {
        for (const FloatRay& r : rays) {
            const auto hit = tree->first_intersected_primitive(Kernel::Ray_3(origin(r), direction(r)));
            *met++ = hit ? numbers[static_cast<std::size_t>(*hit - triangles.cbegin())] : nothing;
        }
    }
    void occluded(std::span<const FloatRay> rays, std::uint8_t* blocked) const override {
        for (const FloatRay& r : rays)
            *blocked++ = tree->do_intersect(
                Kernel::Segment_3(origin(r), origin(r) + static_cast<double>(r.t_max) * direction(r)));
    }
};

} // namespace

std::unique_ptr<RayKernel> make_cgal_tree() {
    auto made = std::make_unique<CgalTree>();
    made->name = "cgal-aabb";
    made->slow = true;
    return made;
}

} // namespace pnr::bench
