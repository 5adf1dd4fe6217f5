// SPDX-License-Identifier: GPL-3.0-or-later
// Gaussian blur of the values inside a mask, normalised by the mask, so that nothing leaks in from outside
// it.
#pragma once

#include "core/image.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pnr {

// One side of a Gaussian and its centre, cut at three standard deviations; not normalised.
inline std::vector<float> gaussian_taps(double sigma) {
    const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
    std::vector<float> taps;
    for (int i = 0; i <= reach; ++i)
        taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    return taps;
}

// Values times weights, and the weights.
template <class T>
struct WeightedImage {
    Image<T> sums;
    Image<float> weights;
};

template <class T>
WeightedImage<T> blur_rows(const WeightedImage<T>& from, const std::vector<float>& taps) {
    const int reach = static_cast<int>(taps.size()) - 1, width = from.sums.width, height = from.sums.height;
    WeightedImage<T> to{Image<T>(width, height, T(0.0f)), Image<float>(width, height, 0.0f)};
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                const float weight = from.weights.at(x, y);
                if (!(weight > 0)) continue; // scatter: masks are often sparse in their box
                const T value = from.sums.at(x, y);
                const int first = std::max(0, x - reach), last = std::min(width - 1, x + reach);
                for (int i = first; i <= last; ++i) {
                    const float w = taps[static_cast<std::size_t>(std::abs(i - x))];
                    to.sums.at(i, y) += w * value;
                    to.weights.at(i, y) += w * weight;
                }
            }
        }
    });
    return to;
}

template <class T>
WeightedImage<T> blur_columns(const WeightedImage<T>& from, const std::vector<float>& taps) {
    const int reach = static_cast<int>(taps.size()) - 1, width = from.sums.width, height = from.sums.height;
    WeightedImage<T> to{Image<T>(width, height, T(0.0f)), Image<float>(width, height, 0.0f)};
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            T* sum = &to.sums.at(0, y);
            float* weight = &to.weights.at(0, y);
            for (int j = std::max(0, y - reach); j <= std::min(height - 1, y + reach); ++j) {
                const float w = taps[static_cast<std::size_t>(std::abs(j - y))];
                const T* value = &from.sums.at(0, j);
                const float* share = &from.weights.at(0, j);
                for (int x = 0; x < width; ++x) {
                    sum[x] += w * value[x];
                    weight[x] += w * share[x];
                }
            }
        }
    });
    return to;
}

// The sums over blocks of side x side pixels.
template <class T>
WeightedImage<T> sum_blocks(const Image<T>& image, const Image<std::uint8_t>& mask, int side) {
    const int width = (image.width + side - 1) / side, height = (image.height + side - 1) / side;
    WeightedImage<T> to{Image<T>(width, height, T(0.0f)), Image<float>(width, height, 0.0f)};
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin) * side; y < std::min(image.height, static_cast<int>(end) * side);
             ++y)
            for (int x = 0; x < image.width; ++x)
                if (mask.at(x, y) != 0) {
                    to.sums.at(x / side, y / side) += image.at(x, y);
                    to.weights.at(x / side, y / side) += 1;
                }
    });
    return to;
}

// The quotients of both, bilinear between the blocks' middles, at the mask's pixels.
template <class T>
void divide_blocks(const WeightedImage<T>& blocks, int side, const Image<std::uint8_t>& mask,
                   Image<T>& image) {
    const float inverse = 1.0f / static_cast<float>(side);
    const int corners = side > 1 ? 4 : 1;
    parallel_for(image.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            const float fy = (static_cast<float>(y) + 0.5f) * inverse - 0.5f, v = fy - std::floor(fy);
            for (int x = 0; x < image.width; ++x) {
                T sum(0.0f);
                float weight = 0;
                const float fx = (static_cast<float>(x) + 0.5f) * inverse - 0.5f, u = fx - std::floor(fx);
                for (int corner = 0; mask.at(x, y) != 0 && corner < corners; ++corner) {
                    const int i = std::clamp(static_cast<int>(std::floor(fx)) + (corner & 1), 0,
                                             blocks.sums.width - 1),
                              j = std::clamp(static_cast<int>(std::floor(fy)) + corner / 2, 0,
                                             blocks.sums.height - 1);
                    const float w = (corner & 1 ? u : 1 - u) * (corner / 2 ? v : 1 - v);
                    sum += w * blocks.sums.at(i, j);
                    weight += w * blocks.weights.at(i, j);
                }
                image.at(x, y) = weight > 0 ? sum / weight : T(0.0f);
            }
        }
    });
}

// sigma in pixels of the image; 0 or less changes nothing. T is float or a glm vector. Where mask is 0 the
// result is T{0}. Wide Gaussians are those of blocks a quarter as wide, less what blocks and the bilinear way
// back blur by themselves, so that the work does not grow with sigma.
template <class T>
void masked_blur(Image<T>& image, const Image<std::uint8_t>& mask, double sigma) {
    constexpr double wide = 8;
    if (!(sigma > 0) || image.empty()) return;
    const int side = sigma >= wide ? static_cast<int>(sigma / 4) : 1;
    const double own = side > 1 ? (side * side - 1) / 12.0 + side * side / 6.0 : 0;
    const std::vector<float> taps = gaussian_taps(std::sqrt(sigma * sigma - own) / side);
    const WeightedImage<T> blurred = blur_columns(blur_rows(sum_blocks(image, mask, side), taps), taps);
    divide_blocks(blurred, side, mask, image);
}

} // namespace pnr
