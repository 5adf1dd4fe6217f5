// SPDX-License-Identifier: GPL-3.0-or-later
// What bench_rays compares: ray tracers behind one small interface, fed with the same float rays.
#pragma once

#include "core/bvh.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pnr::bench {

struct FloatRay {
    float origin[3], direction[3]; // unit
    float t_max;
};

inline constexpr std::uint32_t nothing = 0xffffffffu;

class RayKernel {
public:
    std::string name;
    bool slow = false; // timed on a part of the rays
    double build_seconds = 0;
    double bytes_per_triangle = 0;

    virtual ~RayKernel() = default;
    virtual void build(std::span<const float> corners) = 0; // nine floats a triangle
    virtual std::size_t bytes() const = 0;
    // The triangle met, or `nothing`.
    virtual void closest(std::span<const FloatRay> rays, std::uint32_t* met) const = 0;
    virtual void occluded(std::span<const FloatRay> rays, std::uint8_t* blocked) const = 0;
};

std::unique_ptr<RayKernel> make_pnr(const BvhKernel& kernel, const std::string& name);
std::unique_ptr<RayKernel> make_pnr_scene(); // through core/geometry.h
std::unique_ptr<RayKernel> make_embree(bool robust);
std::unique_ptr<RayKernel> make_cgal_tree();

} // namespace pnr::bench
