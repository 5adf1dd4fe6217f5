// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

namespace pnr {

using Stored = CGAL::Simple_cartesian<float>;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;

struct ExactTriangles::Store {
    std::vector<Stored::Triangle_3> triangles;
};

ExactTriangles::ExactTriangles(std::span<const float> corners) : store_(new Store) {
    static_assert(sizeof(Stored::Triangle_3) == 9 * sizeof(float));
    store_->triangles.reserve(corners.size() / 9);
    for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
        const auto point = [&](std::size_t k) {
            return Stored::Point_3(corners[i + k], corners[i + k + 1], corners[i + k + 2]);
        };
        store_->triangles.emplace_back(point(0), point(3), point(6));
    }
}
ExactTriangles::~ExactTriangles() = default;

std::size_t ExactTriangles::size() const { return store_->triangles.size(); }

void ExactTriangles::corners(std::uint32_t triangle, float (&nine)[9]) const {
    const Stored::Triangle_3& t = store_->triangles[triangle];
    for (int v = 0; v < 3; ++v)
        for (int k = 0; k < 3; ++k) nine[3 * v + k] = t[v][k];
}

bool ExactTriangles::meets_line(std::uint32_t triangle, const double (&p)[3], const double (&q)[3]) const {
    const Stored::Triangle_3& t = store_->triangles[triangle];
    const auto corner = [&](int v) { return Exact::Point_3(t[v][0], t[v][1], t[v][2]); };
    const Exact::Point_3 from(p[0], p[1], p[2]), to(q[0], q[1], q[2]), a = corner(0), b = corner(1),
                                                                       c = corner(2);
    const int u = CGAL::orientation(from, to, c, b);
    const int v = CGAL::orientation(from, to, a, c);
    if (u * v < 0) return false;
    const int w = CGAL::orientation(from, to, b, a);
    if (u * w < 0 || v * w < 0) return false;
    return u != 0 || v != 0 || w != 0;
}

} // namespace pnr
