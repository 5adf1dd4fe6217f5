// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sobol.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <array>

namespace pnr {

namespace {

// Primitive polynomial (degree, inner coefficients) and first direction numbers of dimensions 2..8 [Joe and
// Kuo 2008].
struct Polynomial {
    int degree;
    std::uint32_t coefficients;
    std::array<std::uint32_t, 5> m;
};
constexpr std::array<Polynomial, sobol_dimensions - 1> polynomials{{{1, 0, {1}},
                                                                    {2, 1, {1, 3}},
                                                                    {3, 1, {1, 3, 1}},
                                                                    {3, 2, {1, 1, 1}},
                                                                    {4, 1, {1, 1, 3, 3}},
                                                                    {4, 4, {1, 3, 5, 13}},
                                                                    {5, 2, {1, 1, 5, 5, 17}}}};

using Directions = std::array<std::array<std::uint32_t, 32>, sobol_dimensions>;

constexpr Directions make_directions() {
    Directions v{};
    for (std::size_t bit = 0; bit < 32; ++bit) v[0][bit] = 0x80000000u >> bit;
    for (std::size_t d = 1; d < sobol_dimensions; ++d) {
        const Polynomial& p = polynomials[d - 1];
        const std::size_t s = static_cast<std::size_t>(p.degree);
        for (std::size_t bit = 0; bit < 32; ++bit) {
            if (bit < s) {
                v[d][bit] = p.m[bit] << (31 - bit);
                continue;
            }
            v[d][bit] = v[d][bit - s] ^ (v[d][bit - s] >> s);
            for (std::size_t k = 1; k < s; ++k)
                if ((p.coefficients >> (s - 1 - k)) & 1u) v[d][bit] ^= v[d][bit - k];
        }
    }
    return v;
}

constexpr Directions directions = make_directions();

} // namespace

double sobol(std::uint64_t index, int dimension, std::uint64_t seed) {
    const auto& v = directions[static_cast<std::size_t>(dimension)];
    std::uint32_t bits = 0;
    for (std::uint32_t i = static_cast<std::uint32_t>(index), bit = 0; i != 0; i >>= 1, ++bit)
        if (i & 1u) bits ^= v[bit];
    // Beyond 2^32 points a new scramble.
    const std::uint64_t key =
        hash_words(hash_words(seed, static_cast<std::uint64_t>(dimension)), index >> 32);
    return static_cast<double>(owen_scramble(bits, static_cast<std::uint32_t>(key))) * 0x1p-32;
}

} // namespace pnr
