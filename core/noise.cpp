// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace pnr {

namespace {

// A lattice cell's hash: a permutation of 0..4095 looked up three times. The permutation is a shuffle by the
// linear congruential generator that POV-Ray's manual of solid textures inherits from DKBTrace; that it is
// this one, and this seed, was found by comparing its values with those that POV-Ray prints at lattice
// points.
using HashTable = std::array<std::uint16_t, 4096>;
constexpr HashTable make_hash_table() {
    HashTable table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::uint16_t>(i);
    std::uint32_t state = 0;
    for (std::size_t i = table.size(); i-- > 0;) {
        state = next_lattice_random(state);
        std::swap(table[i], table[lattice_random_value(state) % 4096]);
    }
    return table;
}
constexpr HashTable hash_table = make_hash_table();

// What a corner of the lattice gives: entry h is its value (doubled), the three behind it are its slope. Read
// from POV-Ray 3.7 at lattice points, where noise is half the entry.
constexpr std::array<double, 267> corner_table{
    -1,        0.604974,   -0.937102, 0.414115,   0.576226,  -0.0161593, 0.432334,  0.103685,   0.590539,
    0.0286412, 0.46981,    -0.84622,  -0.0734112, -0.304097, -0.40206,   -0.210132, -0.919127,  0.652033,
    -0.83151,  -0.183948,  -0.671107, 0.852476,   0.043595,  -0.404532,  0.75494,   -0.335653,  0.618433,
    0.605707,  0.708583,   -0.477195, 0.899474,   0.490623,  0.221729,   -0.400381, -0.853727,  -0.932586,
    0.659113,  0.961303,   0.325948,  -0.750851,  0.842466,  0.734401,   -0.649866, 0.394491,   -0.466056,
    -0.434073, 0.109026,   0.0847028, -0.738857,  0.241505,  0.16228,    -0.71426,  -0.883665,  -0.150408,
    -0.90396,  -0.686549,  -0.785214, 0.488548,   0.0246433, 0.142473,   -0.602136, 0.375845,   -0.0077974,
    0.498955,  -0.268147,  0.856382,  -0.386007,  -0.596094, -0.867735,  -0.570977, -0.914366,  0.28896,
    0.672206,  -0.233783,  0.94815,   0.895262,   0.343252,  -0.173388,  -0.767971, -0.314748,  0.824308,
    -0.342092, 0.721431,   -0.24004,  -0.63653,   0.553277,  0.376272,   0.158984,  -0.452659,  0.396323,
    -0.420676, -0.454154,  0.122179,  0.295857,   0.0664225, -0.202075,  -0.724788, 0.453513,   0.224567,
    -0.908812, 0.176349,   -0.320516, -0.697139,  0.742702,  -0.900786,  0.471489,  -0.133532,  0.119127,
    -0.889769, -0.23183,   -0.669673, -0.046891,  -0.803433, -0.966735,  0.475578,  -0.652644,  0.0112459,
    -0.730007, 0.128283,   0.145647,  -0.619318,  0.272023,  0.392966,   0.646418,  -0.0207675, -0.315908,
    0.480797,  0.535668,   -0.250172, -0.83093,   -0.653773, -0.443809,  0.119982,  -0.897642,  0.89453,
    0.165789,  0.633875,   -0.886839, 0.930877,   -0.537194, 0.587732,   0.722011,  -0.209461,  -0.0424659,
    -0.814267, -0.919432,  0.280262,  -0.66302,   -0.558099, -0.537469,  -0.598779, 0.929656,   -0.170794,
    -0.537163, 0.312581,   0.959442,  0.722652,   0.499931,  0.175616,   -0.534874, -0.685115,  0.444999,
    0.17171,   0.108202,   -0.768704, -0.463828,  0.254231,  0.546014,   0.869474,  0.875212,   -0.944427,
    0.130724,  -0.110185,  0.312184,  -0.33138,   -0.629206, 0.0606546,  0.722866,  -0.0979477, 0.821561,
    0.0931258, -0.972808,  0.0318151, -0.867033,  -0.387228, 0.280995,   -0.218189, -0.539178,  -0.427359,
    -0.602075, 0.311971,   0.277974,  0.773159,   0.592493,  -0.0331884, -0.630854, -0.269947,  0.339132,
    0.581079,  0.209461,   -0.317433, -0.284993,  0.181323,  0.341634,   0.804959,  -0.229572,  -0.758907,
    -0.336721, 0.605463,   -0.991272, -0.0188754, -0.300191, 0.368307,   -0.176135, -0.3832,    -0.749569,
    0.62356,   -0.573938,  0.278309,  -0.971313,  0.839994,  -0.830686,  0.439078,  0.66128,    0.694514,
    0.0565042, 0.54342,    -0.438804, -0.0228428, -0.687068, 0.857267,   0.301991,  -0.494255,  -0.941039,
    0.775509,  0.410575,   -0.362081, -0.671534,  -0.348379, 0.932433,   0.886442,  0.868681,   -0.225666,
    -0.062211, -0.0976425, -0.641444, -0.848112,  0.724697,  0.473503,   0.998749,  0.174701,   0.559625,
    -0.029099, -0.337392,  -0.958129, -0.659785,  0.236042,  -0.246937,  0.659449,  -0.027512,  0.821897,
    -0.226215, 0.0181735,  0.500481,  -0.420127,  -0.427878, 0.566186,
};

// The lattice cell that holds a point: the smooth weights of its corners along each axis, and the corners'
// hashes.
struct Cell {
    double x[2], y[2], z[2];    // from the low and the high corner
    double wx[2], wy[2], wz[2]; // weights of them
    std::uint32_t hash[8];      // x the slowest, z the fastest; 0..255
};

double smooth(double t) { return t * t * (3 - 2 * t); }

// Far from the origin cells are no longer told apart; nothing there may overflow an integer.
std::int64_t cell_number(double floored) {
    return static_cast<std::int64_t>(std::clamp(floored, -1e15, 1e15)) + 10000;
}

Cell make_cell(Vec3 p) {
    Cell cell;
    const Vec3 low = glm::floor(p);
    const Vec3 f = p - low;
    const auto axis = [](double(&offset)[2], double(&weight)[2], double t) {
        offset[0] = t, offset[1] = t - 1;
        weight[1] = smooth(t), weight[0] = 1 - weight[1];
    };
    axis(cell.x, cell.wx, f.x), axis(cell.y, cell.wy, f.y), axis(cell.z, cell.wz, f.z);
    const std::int64_t ix = cell_number(low.x), iy = cell_number(low.y), iz = cell_number(low.z);
    std::uint32_t* hash = cell.hash;
    for (std::int64_t dx = 0; dx < 2; ++dx) {
        const std::uint32_t hx = hash_table[static_cast<std::uint32_t>((ix + dx) & 4095)];
        for (std::int64_t dy = 0; dy < 2; ++dy) {
            const std::uint32_t hxy = hash_table[hx ^ static_cast<std::uint32_t>((iy + dy) & 4095)];
            for (std::int64_t dz = 0; dz < 2; ++dz)
                *hash++ = hash_table[hxy ^ static_cast<std::uint32_t>((iz + dz) & 4095)] & 255;
        }
    }
    return cell;
}

// Adds up the corners' planes; `shift` selects one of three independent fields.
double sum_corners(const Cell& cell, std::uint32_t shift) {
    double sum = 0;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const std::uint32_t i = corner >> 2, j = (corner >> 1) & 1, k = corner & 1;
        const double* r = corner_table.data() + cell.hash[corner] + shift;
        sum += cell.wx[i] * cell.wy[j] * cell.wz[k] *
               (0.5 * r[0] + r[1] * cell.x[i] + r[2] * cell.y[j] + r[3] * cell.z[k]);
    }
    return sum;
}

} // namespace

Vec3 cell_numbers(Vec3 cell) {
    // The first outputs of a Mersenne twister as it is seeded by default, over 2^32; cell number h takes h, h
    // + 1, h + 2.
    static const std::vector<double> numbers = [] {
        std::mt19937 twister;
        std::vector<double> made(hash_table.size() + 2);
        for (double& number : made) number = static_cast<double>(twister()) * 0x1p-32;
        return made;
    }();
    const auto low = [](double i) {
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(i, -1e15, 1e15)) & 4095);
    };
    const std::uint32_t hash = hash_table[hash_table[hash_table[low(cell.x)] ^ low(cell.y)] ^ low(cell.z)];
    const double* own = numbers.data() + hash;
    return {own[0], own[1], own[2]};
}

double noise(Vec3 point, int generator) {
    const double sum = sum_corners(make_cell(point), 0);
    if (generator == 1) return std::clamp(sum + 0.5, 0.0, 1.0);
    // The sum's own range, -1.05242 to 0.988997, brought to 0..1.
    return std::clamp((sum + 1.05242) * (1 / 2.041417), 0.0, 1.0);
}

Vec3 noise_vector(Vec3 point) {
    const Cell cell = make_cell(point);
    return {sum_corners(cell, 0), sum_corners(cell, 4), sum_corners(cell, 8)};
}

double turbulence(Vec3 point, const Turbulence& words, int generator) {
    const auto octave = [&](Vec3 p) {
        const double value = noise(p, generator);
        return generator == 1 ? value : 2 * value - 0.5;
    };
    double sum = octave(point);
    if (generator != 1) sum = std::clamp(sum, 0.0, 1.0);
    double scale = words.lambda, weight = words.omega;
    for (int i = 2; i <= words.octaves; ++i, scale *= words.lambda, weight *= words.omega)
        sum += weight * octave(point * scale);
    return sum;
}

Vec3 turbulence_vector(Vec3 point, const Turbulence& words) {
    Vec3 sum = noise_vector(point);
    double scale = words.lambda, weight = words.omega;
    for (int i = 2; i <= words.octaves; ++i, scale *= words.lambda, weight *= words.omega)
        sum += weight * noise_vector(point * scale);
    return sum;
}

} // namespace pnr
