// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/warp.h"

#include "core/noise.h"

namespace pnr {

namespace {

struct Bend {
    Vec3 p;

    Vec3 operator()(const TransformWarp& warp) const { return transform_point(warp.transform.inverse, p); }
    Vec3 operator()(const Turbulence& warp) const { return p + warp.amount * turbulence_vector(p, warp); }
    Vec3 operator()(const auto&) const { return p; }
};

} // namespace

Vec3 warp_point(const Warp& warp, Vec3 point) { return std::visit(Bend{point}, warp); }

} // namespace pnr
