// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy points in the unit square: a (0, 2)-sequence in base 2 [Sobol 1967; Kollig and Keller
// 2002], Owen-scrambled and shuffled by hashing [Laine and Karras 2011; Burley 2020], so that sequences with
// unrelated keys can be paired dimension by dimension.
#pragma once

#include "core/types.h"

#include <cstdint>

namespace pnr {

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = x << 16 | x >> 16;
    x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

// A random nested permutation of the binary digits: each bit is flipped depending on the key and all higher
// bits.
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t key) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

// Second coordinate of the sequence; its generator matrix is Pascal's triangle modulo 2.
inline std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
        if (index & 1u) result ^= v;
    return result;
}

// Point `index` of the sequence named by `key`, in [0, 1)^2. Any power of two of first points is stratified.
inline Vec2 sobol_point(std::uint32_t index, std::uint64_t key) {
    const auto low = static_cast<std::uint32_t>(key), high = static_cast<std::uint32_t>(key >> 32);
    const std::uint32_t shuffled = owen_scramble(index, low ^ 0x9e3779b9u);
    return {owen_scramble(reverse_bits(shuffled), low) * 0x1p-32,
            owen_scramble(sobol_second(shuffled), high) * 0x1p-32};
}

} // namespace pnr
