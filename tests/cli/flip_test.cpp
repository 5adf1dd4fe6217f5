// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/flip.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

constexpr int side = 48;

double mean(const Image<float>& image) {
    double sum = 0;
    for (const float v : image.pixels) sum += static_cast<double>(v);
    return sum / static_cast<double>(image.pixels.size());
}
Image<Color> plain(Color c) { return Image<Color>(side, side, c); }

TEST(Flip, OfThePictureItselfIsNothing) {
    Image<Color> picture = plain(Color(0));
    Rng rng = make_rng(1, Pass::test, 0);
    for (Color& c : picture.pixels) c = Color(rng.uniform(), rng.uniform(), rng.uniform());
    EXPECT_EQ(mean(flip(picture, picture)), 0);
}

// Lightness 100, no chroma: 100^0.7 = 25.12. The largest difference, of green and blue, is by CIELAB
// (87.73, -86.18, 83.18) and (32.30, 79.19, -107.86), chroma times lightness / 100: 55.43 + |(-101.2, 107.8)|
// = 203.3, to the power of 0.7 41.26; so 0.95 + (25.12 - 16.50) / (41.26 - 16.50) * 0.05 = 0.9674.
TEST(Flip, OfBlackAndWhite) {
    EXPECT_NEAR(mean(flip(plain(Color(0)), plain(Color(1)))), 0.9674, 2e-4);
    EXPECT_NEAR(mean(flip(plain(Color(1)), plain(Color(0)))), 0.9674, 2e-4);
}

TEST(Flip, OfGreenAndBlueIsAllThereIs) {
    EXPECT_NEAR(mean(flip(plain(Color(0, 1, 0)), plain(Color(0, 0, 1)))), 1, 1e-5);
}

// A grey of lightness 50 beside one of lightness 51: 0.95 / (0.4 * 41.26) * 1^0.7.
TEST(Flip, OfOneStepOfLightness) {
    const auto grey = [](double lightness) {
        return plain(Color(static_cast<float>(std::pow((lightness + 16) / 116, 3))));
    };
    EXPECT_NEAR(mean(flip(grey(50), grey(51))), 0.95 / (0.4 * 41.26), 2e-4);
}

// What the eye does not resolve is less of an error than what it does: noise beside the same noise in blocks.
TEST(Flip, ForgivesWhatIsTooFineToSee) {
    Image<Color> fine = plain(Color(0.5f)), coarse = fine;
    Rng rng = make_rng(1, Pass::test, 0);
    for (Color& c : fine.pixels) c = Color(rng.uniform() < 0.5 ? 0.4f : 0.6f);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) coarse.at(x, y) = fine.at(x / 12, y / 12);
    EXPECT_LT(mean(flip(plain(Color(0.5f)), fine)), 0.8 * mean(flip(plain(Color(0.5f)), coarse)));
    EXPECT_THROW(flip(fine, Image<Color>(2, 2)), std::invalid_argument);
}

} // namespace
} // namespace pnr
