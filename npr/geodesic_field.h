// SPDX-License-Identifier: GPL-3.0-or-later
// The values of seeds carried along a mesh instead of straight through space (`rbf { distance geodesic }`), so
// that the strokes of one ear are not turned by the seeds of the other.
//
// The smoothest function on the surface itself that meets the seeds: the least integral of the squared
// Laplacian, a thin plate without its bending in space (the biharmonic kernel's like on a surface). Laplacian:
// cotangents with lumped areas [Pinkall and Polthier 1993; Meyer et al. 2003]. Kernels of geodesic distances
// were tried and left: such distances are of no Euclidean space, so that the systems lose their sign. On a
// sphere -d leaves 26 degrees with 128 seeds (it is odd about the equator, so half of all functions are beyond
// it); exp(-d/s) leaves 0.44 there but 17 on a torus, and more with more seeds (bench_fields has what is kept).
#pragma once

#include "core/closest_point.h"
#include "npr/surface_mesh.h"

#include <memory>
#include <span>
#include <vector>

namespace pnr {

struct GeodesicField {
    std::shared_ptr<const SurfaceIndex> surface;
    int components = 0;
    SurfaceMesh mesh;
    std::vector<std::uint32_t> first_triangle; // by surface: what its triangle 0 is in `mesh`
    std::vector<std::uint8_t> reached;         // by piece: it has seeds
    std::vector<double> values;                // [corner][component], linear in between
};

// `values`: [seed][component]; seeds must lie on the object. `smooth`, 0 or more, loosens the fit. Null where
// the object is no mesh alone.
std::shared_ptr<const GeodesicField> make_geodesic_field(const World& world, int object,
                                                         std::span<const Vec3> seeds,
                                                         std::span<const double> values, int components,
                                                         double smooth);

// The value at the point of the mesh nearest to `position`; false, and nothing written, on a piece without
// seeds.
bool eval_geodesic_field(const GeodesicField& field, Vec3 position, std::span<double> result);

} // namespace pnr
