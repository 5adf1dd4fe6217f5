// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers as functions of (seed, pass, index, dimension), so that a picture has the same bits for any
// number of threads, any order of tiles, and for a crop.
//
// Each pixel or photon gets its own `Rng`, whose key hashes seed, pass and index; each draw hashes the key with a
// counter (the dimension). There is no state to share and no stream to overlap.
#pragma once

#include "core/types.h"

#include <cstdint>

namespace pnr {

// Which part of the program draws; streams of different passes are unrelated.
enum class Pass : std::uint32_t { photons = 1, gbuffer = 2, render = 3, paint = 4, noise = 5, test = 99 };

// A bijective mixing of 64 bits [Stafford 2011, variant 13, the finaliser of SplitMix64].
inline std::uint64_t mix_bits(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

// A hash of two words; chain it for more.
inline std::uint64_t hash_words(std::uint64_t a, std::uint64_t b) {
    return mix_bits(mix_bits(a + 0x9e3779b97f4a7c15ull) ^ (b * 0xd1342543de82ef95ull + 0x632be59bd9b4e019ull));
}

// Uniform in [0, 1): 24 bits, exact in float.
inline float unit_float(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }
// Uniform in [0, 1): 53 bits.
inline double unit_double(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

struct Rng {
    std::uint64_t key = 0;
    std::uint64_t dimension = 0;

    std::uint64_t bits() { return hash_words(key, dimension++); }
    double uniform() { return unit_double(bits()); }
    Vec2 uniform2() {
        const double u = uniform();
        return {u, uniform()};
    }
};

inline Rng make_rng(std::uint64_t seed, Pass pass, std::uint64_t index) {
    return {hash_words(hash_words(seed, static_cast<std::uint64_t>(pass)), index), 0};
}

} // namespace pnr
