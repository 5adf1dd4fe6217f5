// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's solid noise, value for value: lattice noise of [Perlin 1985] in the form that DKBTrace gave it, a
// plane at each corner of an integer lattice, blended by smoothsteps.
#pragma once

#include "core/types.h"
#include "core/warp.h"

#include <cstdint>

namespace pnr {

// In [0, 1]. generator: 1 as before POV-Ray 3.5, which clips at both ends; 2 the same brought into range
// (3.7's default); 3 gradient noise. Far beyond 1e15 it is constant.
double noise(Vec3 point, int generator);
// Three independent fields of the lattice, each about -1 to 1 (the first is generator 1's noise less 0.5,
// unclipped).
Vec3 noise_vector(Vec3 point);

// Sums of `octaves` noises, each at `lambda` times the frequency and `omega` times the weight of the one
// before; the words' amount is not applied.
double turbulence(Vec3 point, const Turbulence& words, int generator);
Vec3 turbulence_vector(Vec3 point, const Turbulence& words);

// Three random numbers in [0, 1) of a cell of the integer lattice (`cell` has whole coordinates, which count
// modulo 4096): what `cells`, crackle's points and scattered black holes are made of.
Vec3 cell_numbers(Vec3 cell);
// The linear congruential generator behind the lattice: state to state, and state to 0..32767.
constexpr std::uint32_t next_lattice_random(std::uint32_t state) { return state * 1812433253u + 12345u; }
constexpr std::uint32_t lattice_random_value(std::uint32_t state) { return (state >> 16) & 0x7FFFu; }

} // namespace pnr
