// SPDX-License-Identifier: GPL-3.0-or-later
#include "similarity.h"

#include "core/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace pnr {

namespace {

constexpr int window = 11;
constexpr double sigma = 1.5;

std::array<double, window> gaussian() {
    std::array<double, window> weights{};
    double sum = 0;
    for (int i = 0; i < window; ++i) {
        const double x = i - window / 2;
        sum += weights[static_cast<std::size_t>(i)] = std::exp(-x * x / (2 * sigma * sigma));
    }
    for (double& w : weights) w /= sum;
    return weights;
}

// Weighted means over the windows that fit; smaller than the picture by window - 1.
template <class Value>
Image<double> window_means(int width, int height, const Value& value) {
    const std::array<double, window> weights = gaussian();
    const int w = width - window + 1, h = height - window + 1;
    Image<double> rows(w, height), means(w, h);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < w; ++x)
            for (int i = 0; i < window; ++i)
                rows.at(x, y) += weights[static_cast<std::size_t>(i)] * value(x + i, y);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int i = 0; i < window; ++i)
                means.at(x, y) += weights[static_cast<std::size_t>(i)] * rows.at(x, y + i);
    return means;
}

double encoded(float linear) {
    if (!std::isfinite(linear)) return 0;
    return std::round(255.0 * srgb_encode(std::clamp(linear, 0.0f, 1.0f)));
}

} // namespace

Image<double> luma_of(const Image<glm::vec4>& linear) {
    Image<double> luma(linear.width, linear.height);
    for (std::size_t i = 0; i < luma.pixels.size(); ++i) {
        const glm::vec4 c = linear.pixels[i];
        luma.pixels[i] = std::round(0.299 * encoded(c.x) + 0.587 * encoded(c.y) + 0.114 * encoded(c.z));
    }
    return luma;
}

double similarity(const Image<double>& a, const Image<double>& b) {
    if (a.width != b.width || a.height != b.height || a.width < window || a.height < window) return 0;
    const auto means = [&](const auto& value) { return window_means(a.width, a.height, value); };
    const Image<double> ma = means([&](int x, int y) { return a.at(x, y); });
    const Image<double> mb = means([&](int x, int y) { return b.at(x, y); });
    const Image<double> aa = means([&](int x, int y) { return a.at(x, y) * a.at(x, y); });
    const Image<double> bb = means([&](int x, int y) { return b.at(x, y) * b.at(x, y); });
    const Image<double> ab = means([&](int x, int y) { return a.at(x, y) * b.at(x, y); });
    const double c1 = std::pow(0.01 * 255, 2), c2 = std::pow(0.03 * 255, 2);
    double sum = 0;
    for (std::size_t i = 0; i < ma.pixels.size(); ++i) {
        const double x = ma.pixels[i], y = mb.pixels[i];
        const double covariance = ab.pixels[i] - x * y;
        const double variances = aa.pixels[i] - x * x + bb.pixels[i] - y * y;
        sum += (2 * x * y + c1) * (2 * covariance + c2) / ((x * x + y * y + c1) * (variances + c2));
    }
    return sum / static_cast<double>(ma.pixels.size());
}

double mean_luma(const Image<double>& luma) {
    if (luma.empty()) return 0;
    return std::accumulate(luma.pixels.begin(), luma.pixels.end(), 0.0) /
           static_cast<double>(luma.pixels.size());
}

} // namespace pnr
