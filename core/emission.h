// SPDX-License-Identifier: GPL-3.0-or-later
// How photons leave the lights: how many each light sends, where they start and what they carry.
//
// Starts are points of an Owen-scrambled Sobol sequence. Measured on 64 squares of a floor under a hemisphere
// emitter: the standard deviation of a square's flux is 1.05, 1.10, 1.16 and 1.34 times smaller than with
// independent photons at 4,096, 16,384, 65,536 and 262,144 photons, at no cost.
#pragma once

#include "core/light.h"
#include "core/settings.h"
#include "core/world.h"

#include <cstdint>
#include <vector>

namespace pnr {

// A cone of directions (about a point) or a disc of a parallel beam's cross-section, into which photons go
// evenly.
struct Aim {
    Vec3 axis{0, 0, 1};       // unit
    double one_minus_cos = 2; // cone; 2: every direction
    Vec3 center{0};           // disc, in the light's plane ...
    double radius = 0;        // ... of a parallel light
    double measure = 0;       // solid angle of the cone or area of the disc
    double share = 1;         // of the light's photons
};

// One light's part of a pass.
struct LightShare {
    int light = 0;          // index into World::lights
    std::int64_t first = 0; // its photons are [first, first + count) of the pass
    std::int64_t count = 0;
    std::vector<Aim> aims; // of a POV-Ray light; shares add up to 1. Empty for emitters.
    bool caustics = false; // its photons aim at EmissionPlan::targets, for caustics alone ...
    std::vector<std::uint16_t> cells; // ... by these cells of their grid of directions alone; empty: by all
};

// The sphere that holds all bounded surfaces and, where unbounded ones stand beside them, the camera.
// World::radius holds POV-Ray's lights too, which often stand a thousand radii away.
struct Focus {
    Vec3 center{0};
    double radius = 1;
};

struct EmissionPlan {
    Focus focus;
    std::vector<LightShare> shares; // by light: those of all light, then those of caustics alone
    std::int64_t count = 0;         // photons of a pass
    std::int64_t everywhere = 0;    // of them those that bring all light: the first ones
    bool targeted = false;          // some object said `photons { target }`: others throw no caustics
    // What the shares of caustics aim at: spheres about objects that reflect or refract, and which objects
    // these are. Caustics whose light comes to such an object first are left to those shares.
    std::vector<Focus> targets;
    std::vector<char> aimed_at; // by object; empty without such shares
};

// Shares the pass' photons out by power; for POV-Ray's lights by the flux that meets the scene. Lights
// without power get none, others at least one. Photons of POV-Ray's lights aim at the scene's sphere and,
// where unbounded objects stand in it, half of them at the sphere of `reach` scene radii within which photons
// matter. Where all light is wanted, as many photons again are aimed at what throws caustics: the few that
// meet a glass ball by chance would show it blurred.
EmissionPlan plan_emission(const World& world, const PhotonSettings& settings);
inline constexpr double emission_reach = 4; // radii of the focus

// Finds the cells of directions that lead to a target, for shares of caustics that are worth it: a projection map
// [Jensen 2001, 5.3], made by rays from all over the light. A sphere about a thing holds much beside it.
void find_cells(const World& world, EmissionPlan& plan, std::uint64_t seed);

// A photon as it starts. flux of an emitter's photon: W. Of a POV-Ray light's: pi c / (N density); it becomes
// the design's pi c s W d^2 f(d) / N at the hits, where s, d and f are known.
struct EmittedPhoton {
    Ray ray; // unit direction
    Color flux{0};
};
// index counts the share's photons over all passes. Black where nothing leaves the light that way.
EmittedPhoton emit_photon(const World& world, const EmissionPlan& plan, const LightShare& share,
                          std::uint64_t index, std::uint64_t seed);

} // namespace pnr
