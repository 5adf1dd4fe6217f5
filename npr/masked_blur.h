// SPDX-License-Identifier: GPL-3.0-or-later
// Gaussian blur of the values inside a mask, normalised by the mask, so that nothing leaks in from outside
// it.
#pragma once

#include "core/image.h"
#include "core/parallel.h"

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

// sigma in pixels of the image; 0 or less changes nothing. T is float or a glm vector. Where mask is 0 the
// result is T{0}.
template <class T>
void masked_blur(Image<T>& image, const Image<std::uint8_t>& mask, double sigma) {
    if (!(sigma > 0) || image.empty()) return;
    const std::vector<float> taps = gaussian_taps(sigma);
    const int reach = static_cast<int>(taps.size()) - 1, width = image.width, height = image.height;
    Image<T> sums(width, height, T(0.0f));
    Image<float> weights(width, height, 0.0f);
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                if (mask.at(x, y) == 0) continue; // scatter: masks are often sparse in their box
                const T value = image.at(x, y);
                const int first = std::max(0, x - reach), last = std::min(width - 1, x + reach);
                for (int i = first; i <= last; ++i) {
                    const float w = taps[static_cast<std::size_t>(std::abs(i - x))];
                    sums.at(i, y) += w * value;
                    weights.at(i, y) += w;
                }
            }
        }
    });
    parallel_for(height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<T> row_sum(static_cast<std::size_t>(width));
        std::vector<float> row_weight(static_cast<std::size_t>(width));
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            std::fill(row_sum.begin(), row_sum.end(), T(0.0f));
            std::fill(row_weight.begin(), row_weight.end(), 0.0f);
            for (int j = std::max(0, y - reach); j <= std::min(height - 1, y + reach); ++j) {
                const float w = taps[static_cast<std::size_t>(std::abs(j - y))];
                const T* sum = &sums.at(0, j);
                const float* weight = &weights.at(0, j);
                for (int x = 0; x < width; ++x) {
                    row_sum[static_cast<std::size_t>(x)] += w * sum[x];
                    row_weight[static_cast<std::size_t>(x)] += w * weight[x];
                }
            }
            for (int x = 0; x < width; ++x) {
                const auto i = static_cast<std::size_t>(x);
                image.at(x, y) =
                    mask.at(x, y) != 0 && row_weight[i] > 0 ? row_sum[i] / row_weight[i] : T(0.0f);
            }
        }
    });
}

} // namespace pnr
