// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D orientation field that an object's seed directions span [LW10 3.2.2, step 3].
#pragma once

#include "core/parallel.h"
#include "core/photon_map.h"
#include "core/world.h"

#include <memory>
#include <vector>

namespace pnr {

// A seed snapped to the nearest point of its object, its direction laid into the tangent plane there.
struct SnappedSeed {
    Vec3 position{0}, normal{0}, axis{0}; // world space; axis unit, tangent
};

// What the field of one object looks like, for stats and notes.
struct FieldReport {
    int object = 0;
    int seeds = 0;
    double condition = 1;           // of the RBF matrix
    double residual = 0;            // largest angle at a seed, radians
    std::vector<std::string> notes; // e.g. "seed 3: direction is along the normal; taken as ..."
};

struct OrientationField; // orientation.cpp

struct OrientationFields { // one per painted object, indexed by object number (null where not painted)
    std::vector<std::shared_ptr<const OrientationField>> fields;
    std::vector<FieldReport> reports;
};

OrientationFields make_orientation_fields(const World& world);
const std::vector<SnappedSeed>& snapped_seeds(const OrientationField& field);

// The oriented vector T at a point of the object: unit, perpendicular to `normal` within 1e-6, also where the
// field vanishes (then some tangent). Sign is meaningless but deterministic.
Vec3 eval_orientation(const OrientationField& field, Vec3 position, Vec3 normal);

// T at each painted photon; zero for others. For paper_mode objects the local rule: the seeds among the Q
// = 20..30 nearest photons, Q doubled until two are found.
std::vector<Vec3f> orient_photons(const World& world, const PhotonMap& map, const OrientationFields& fields,
                                  const Progress& progress = {});

} // namespace pnr
