// SPDX-License-Identifier: GPL-3.0-or-later
// Principal curvature of an object as a field of axes: strokes along ridges and limbs.
#pragma once

#include "core/closest_point.h"
#include "core/world.h"

#include <array>
#include <memory>
#include <vector>

namespace pnr {

// A symmetric 3 x 3 matrix: xx, yy, zz, xy, xz, yz.
using SymmetricTensor = std::array<double, 6>;

// The axis of least |curvature| at every vertex of an object's meshes, times how clearly it is the least;
// analytic shapes are asked when a place on them is met.
//
// On meshes the curvature is that of the normal cycle [Cohen-Steiner and Morvan 2003]: every edge gives its
// length times its dihedral angle, along itself. It is spread over a thirtieth of the object's extent, made
// an axis as strong as its anisotropy, and the axes are spread once more, so that flat and round parts take
// theirs from the ridges near them and a swap of the two curvatures is a bend instead of a crack.
struct CurvatureField {
    std::shared_ptr<const SurfaceIndex> surface;
    const World* world = nullptr;                        // for the analytic shapes; outlives the field
    std::vector<SymmetricTensor> axes;                   // at the vertices
    std::vector<std::array<std::uint32_t, 3>> triangles; // vertices of each triangle of all meshes
    std::vector<std::uint32_t> first_triangle;           // by surface: where its mesh's triangles start
};

// The meshes' vertices are welded where they coincide, across meshes too (a teapot of patches is one
// surface).
CurvatureField make_curvature_field(const World& world, int object);

// The axis of least |curvature| at a place of the object, in its tangent plane; length says how clearly it is
// the least: zero where both are equal (planes, spheres). `largest`: that of greatest |curvature|, at right
// angles to it.
Vec3 eval_curvature_axis(const CurvatureField& field, Vec3 position, Vec3 normal, bool largest);

} // namespace pnr
