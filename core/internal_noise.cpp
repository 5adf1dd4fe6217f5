// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of noise at rising frequencies: the multifractals of [Musgrave 1994] and a ridged sum.
#include "core/internal_functions_impl.h"

#include "core/noise.h"

#include <algorithm>

namespace pnr {

namespace {

constexpr double most_octaves = 64; // more than a number can tell apart

Vec3 point_of(const double* a) { return {a[0], a[1], a[2]}; }

// The generators are 1, 2 and 3; any other number is 1.
double noise_at(Vec3 point, double generator) {
    return noise(point, generator == 2 || generator == 3 ? static_cast<int>(generator) : 1);
}

double signed_noise(Vec3 point, double generator) { return 2 * noise_at(point, generator) - 1; }

// How far from the ridge, 1 at the farthest.
double ridged(double value, double ridge) { return std::abs(value - ridge) / std::max(ridge, 1 - ridge); }

} // namespace

double noise_noise_generator(const double* a) { return noise_at(point_of(a), a[3]); }

// a[3] H, a[4] lacunarity, a[5] octaves, a[6] offset, a[7] how often a sum so far multiplies what is added,
// a[8] generator.
double noise_hetero_mf(const double* a) {
    const double lacunarity = a[4], octaves = std::min(a[5], most_octaves), offset = a[6];
    const double power = std::floor(std::clamp(a[7], 0.0, 100.0));
    Vec3 point = point_of(a);
    double value = signed_noise(point, a[8]) + offset, frequency = 1;
    int i = 1;
    const auto addition = [&] {
        point *= lacunarity;
        frequency *= lacunarity;
        return (signed_noise(point, a[8]) + offset) * std::pow(frequency, -a[3]) * std::pow(value, power);
    };
    for (; i < octaves; ++i) value += addition();
    const double rest = octaves - std::floor(octaves);
    return rest > 0 ? value + rest * addition() : value;
}

// a[3] H, a[4] lacunarity, a[5] octaves, a[6] offset, a[7] gain, a[8] generator.
double noise_ridged_mf(const double* a) {
    const double lacunarity = a[4], octaves = std::min(a[5], most_octaves);
    Vec3 point = point_of(a);
    const auto signal_here = [&] { return sqr(a[6] - std::abs(signed_noise(point, a[8]))); };
    double signal = signal_here(), value = signal, frequency = 1;
    for (int i = 1; i < octaves; ++i) {
        point *= lacunarity;
        frequency *= lacunarity;
        signal = signal_here() * std::clamp(signal * a[7], 0.0, 1.0);
        value += signal * std::pow(frequency, -a[3]);
    }
    return value;
}

// a[3] lambda, a[4] octaves, a[5] omega, a[6] offset, a[7] ridge, a[8] generator.
double noise_ridge(const double* a) {
    const double octaves = std::min(a[4], most_octaves);
    Vec3 point = point_of(a);
    double value = ridged(noise_at(point, a[8]), a[7]), weights = 1, weight = 1;
    for (double left = octaves - 1; left > 0; left -= 1) {
        point *= a[3];
        weight *= a[5];
        const double share = weight * std::min(left, 1.0);
        value += share * ridged(noise_at(point, a[8]), a[7]);
        weights += share;
    }
    return (value / weights - a[6]) / std::max(a[6], 1 - a[6]);
}

} // namespace pnr
