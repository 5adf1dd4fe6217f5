// SPDX-License-Identifier: GPL-3.0-or-later
// Where a line meets a shape, and which points are inside it: all that CSG and the rays ask of a shape.
#pragma once

#include "core/shape.h"

#include <boost/container/small_vector.hpp>

namespace pnr {

// A hit in the shape's own space. `normal` points to the outside as modelled (for a mesh: by the winding),
// not unit.
struct ShapeHit {
    double t = infinity;
    Vec3 normal{0};
    Vec2 uv{0};       // of some shapes; see uv_of
    double error = 0; // bound on the distance to the surface, where it is more than coordinates' rounding
    Vec3 shading{0};  // of what is lit as if smooth: its normal there, on the side of `normal`; else 0
};
// Most shapes are met four times at most; clear() keeps what was grown for more.
using HitList = boost::container::small_vector<ShapeHit, 4>;
inline constexpr int all_hits = std::numeric_limits<int>::max();

// Fills `hits` with all hits of an analytic shape with t_min < t < t_max, in increasing t, and returns their
// number. Computed in double, roots polished so that |f(p)| at the hit is at rounding level. Mesh,
// BicubicPatch and Parametric are not handled here (they live in the BVH): 0 hits. Once it has the first
// `enough` hits it may leave out those behind them.
int intersect_shape(const Shape& shape, const Ray& ray, HitList& hits, int enough = all_hits);

// The surface's own coordinates at a hit of the shape. A sphere's cost more than the hit itself, so they are
// found only here, for the few hits that are shown.
Vec2 uv_of(const Shape& shape, const ShapeHit& hit);

// Whether hits of the shape have coordinates of their own; other shapes have the first two of the place in
// the scene.
bool has_uv(const Shape& shape);

// Whether a point of the shape's own space is inside, as POV-Ray's CSG sees it: a plane's and a disc's inside
// is the half space against the normal; cylinders and cones end at their lids even where these are open;
// shapes without an inside (Mesh, BicubicPatch and Parametric here) have no such point. Points on the surface
// may be either.
bool inside_shape(const Shape& shape, Vec3 p);
// Whether there are points inside that lie outside of the shape's bounds: behind a plane, around an ellipsoid
// that is said the other way round.
bool has_endless_inside(const Shape& shape);

} // namespace pnr
