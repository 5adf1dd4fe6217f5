// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/masked_blur.h"

#include "core/rng.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

// A disc with a hole, and a field of soft hills of height 1 with noise on it.
struct Case {
    Image<float> values{120, 90};
    Image<std::uint8_t> mask{120, 90, 0};
};
Case hills() {
    Case c;
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 120; ++x) {
            const int r2 = (x - 60) * (x - 60) + (y - 45) * (y - 45);
            c.mask.at(x, y) = r2 < 44 * 44 && r2 > 9 * 9 ? 1 : 0;
            Rng rng = make_rng(4, Pass::test, static_cast<std::uint64_t>(y * 120 + x));
            c.values.at(x, y) = static_cast<float>(std::sin(x * 0.1) * std::cos(y * 0.13) + rng.uniform() - 0.5);
        }
    return c;
}

double by_definition(const Case& c, int x, int y, double sigma) {
    double sum = 0, weight = 0;
    for (int j = 0; j < 90; ++j)
        for (int i = 0; i < 120; ++i) {
            if (c.mask.at(i, j) == 0) continue;
            const double w = std::exp(-0.5 * ((i - x) * (i - x) + (j - y) * (j - y)) / (sigma * sigma));
            sum += w * static_cast<double>(c.values.at(i, j));
            weight += w;
        }
    return sum / weight;
}

TEST(MaskedBlur, IsTheGaussianMeanOverTheMask) {
    const Case c = hills();
    for (const double sigma : {0.7, 2.5, 7.9, 8.0, 12.5, 20.0}) { // from 8 on by blocks
        Image<float> blurred = c.values;
        masked_blur(blurred, c.mask, sigma);
        for (int y = 0; y < 90; y += 3)
            for (int x = 0; x < 120; x += 3) {
                if (c.mask.at(x, y) == 0)
                    EXPECT_EQ(blurred.at(x, y), 0);
                else
                    EXPECT_NEAR(static_cast<double>(blurred.at(x, y)), by_definition(c, x, y, sigma), 0.02)
                        << x << ' ' << y << ' ' << sigma;
            }
    }
}

} // namespace
} // namespace pnr
