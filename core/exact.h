// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as CGAL keeps them, and the exact side of the ray test. CGAL's headers and its compiler flags
// (-frounding-math) stay in exact.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace pnr {

// The authoritative triangles, CGAL::Triangle_3<CGAL::Simple_cartesian<float>>; all else is a cache of them.
class ExactTriangles {
public:
    // Nine floats each: three corners, x y z.
    explicit ExactTriangles(std::span<const float> corners);
    ~ExactTriangles();
    ExactTriangles(const ExactTriangles&) = delete;
    ExactTriangles& operator=(const ExactTriangles&) = delete;

    std::size_t size() const;
    void corners(std::uint32_t triangle, float (&nine)[9]) const;

    // Whether the line through p and q meets the triangle or its border, decided without rounding: the signs
    // of the volumes that p and q make with each edge. A line in the triangle's plane does not meet it.
    bool meets_line(std::uint32_t triangle, const double (&p)[3], const double (&q)[3]) const;

private:
    struct Store;
    std::unique_ptr<Store> store_;
};

} // namespace pnr
