// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy points: the Sobol sequence with Owen's scrambling by hashing. Point i depends on (seed, i,
// dimension) alone, so points may be drawn in any order and a later pass goes on where an earlier one ended.
#pragma once

#include "core/types.h"

#include <cstdint>

namespace pnr {

inline constexpr int sobol_dimensions = 8;

// Coordinate `dimension` in [0, sobol_dimensions) of point `index`, in [0, 1). Each dimension is scrambled on
// its own, so any 2^m consecutive points from a multiple of 2^m on are a net. [Joe and Kuo 2008; Burley 2020]
double sobol(std::uint64_t index, int dimension, std::uint64_t seed);
inline Vec2 sobol2(std::uint64_t index, int dimension, std::uint64_t seed) {
    return {sobol(index, dimension, seed), sobol(index, dimension + 1, seed)};
}

} // namespace pnr
