// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/progressive.h"

#include "light_scenes.h"
#include "run_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pnr {
namespace {

RenderResult flat_pass(int width, int height, float value) {
    RenderResult pass;
    pass.layer = {Image<Color>(width, height, Color{value}), Image<float>(width, height, 1.0f)};
    return pass;
}

ProgressiveStep mapped_step(int pass) {
    return progressive_step(pass, Illumination::photon_mapped, Integrator::photons, true);
}

TEST(ProgressiveStep, AreasShrinkAsKnausAndZwickerSay) {
    // Gamma(b + 2/3) / (Gamma(2/3) Gamma(b + 1)) is the product (2/3)/1 (1 + 2/3)/2 ... in closed form.
    for (const int batch : {0, 1, 2, 10, 100}) {
        const double expected = std::exp(std::lgamma(batch + 2.0 / 3) - std::lgamma(2.0 / 3) - std::lgamma(batch + 1.0));
        EXPECT_NEAR(mapped_step(1 + 4 * batch).shrink, expected, 1e-12 * expected) << "batch " << batch;
    }
}

TEST(ProgressiveStep, EveryBatchTakesEachSampleOnceAndTracesItsPhotonsFirst) {
    EXPECT_TRUE(mapped_step(0).preview);
    for (int pass = 1; pass <= 40; ++pass) {
        const ProgressiveStep step = mapped_step(pass);
        EXPECT_FALSE(step.preview);
        EXPECT_EQ(step.batch * 4 + step.samples.first, pass - 1);
        EXPECT_EQ(step.begins_batch, pass > 1 && step.samples.first == 0);
    }
    const ProgressiveStep small = progressive_step(4, Illumination::photon_mapped, Integrator::photons, false);
    EXPECT_TRUE(small.begins_batch) << "without a preview the passes count from the first one";
    EXPECT_EQ(small.batch, 1);
    EXPECT_FALSE(progressive_step(0, Illumination::photon_mapped, Integrator::photons, false).preview);
    const ProgressiveStep plain = progressive_step(4, Illumination::raytraced, Integrator::photons, true);
    EXPECT_FALSE(plain.begins_batch) << "nothing to trace";
    EXPECT_EQ(plain.batch, 1);
}

TEST(AddPass, TheMeanIsThatOfAllPassesButThePreview) {
    ProgressiveSum sum;
    add_pass(sum, mapped_step(0), flat_pass(3, 2, 100));
    EXPECT_TRUE(sum.preview);
    EXPECT_FLOAT_EQ(sum.mean.color.at(0, 0).x, 100);
    double total = 0;
    for (int pass = 1; pass <= 8; ++pass) {
        add_pass(sum, mapped_step(pass), flat_pass(3, 2, static_cast<float>(pass)));
        total += pass;
    }
    EXPECT_FALSE(sum.preview);
    EXPECT_EQ(sum.passes, 8);
    EXPECT_EQ(sum.batches, 2);
    EXPECT_NEAR(sum.mean.color.at(2, 1).y, total / 8, 1e-6);
    // Two batches of means 2.5 and 6.5: the standard error of their mean is |6.5 - 2.5| / 2.
    const ErrorEstimate error = estimate_error(sum, {0, 0, 3, 2});
    EXPECT_NEAR(error.noise.at(1, 1), 2, 1e-5);
}

// Pixels that are independent draws of truth + slope * shrink + noise.
ProgressiveSum made_up_run(int batches, double slope, double noise, int side) {
    std::mt19937 rng(7);
    std::normal_distribution<float> normal(0, static_cast<float>(noise));
    ProgressiveSum sum;
    for (int pass = 1; pass <= 4 * batches; ++pass) {
        const ProgressiveStep step = mapped_step(pass);
        RenderResult result = flat_pass(side, side, static_cast<float>(1 + slope * step.shrink));
        for (Color& c : result.layer.color.pixels) c += Color{normal(rng)};
        add_pass(sum, step, std::move(result));
    }
    return sum;
}

TEST(Shares, NoisyPixelsTakeMoreSamplesAndQuietOnesOne) {
    std::mt19937 rng(3);
    std::normal_distribution<float> normal(0, 1);
    ProgressiveSum sum;
    // Columns whose samples are off by 1 %, 18 % and 200 % of what they show.
    const float noise[3] = {0.01f, 0.18f, 2.0f};
    for (int pass = 1; pass <= 4 * 40; ++pass) {
        RenderResult result = flat_pass(3, 1, 0.5f);
        for (int x = 0; x < 3; ++x) { // as a pass that took its share of samples
            const float share = static_cast<float>(samples_of(mapped_step(pass), sum).share(x, 0));
            result.layer.color.at(x, 0) += Color{0.52f * noise[x] * normal(rng) / std::sqrt(share)};
        }
        add_pass(sum, mapped_step(pass), std::move(result));
    }
    EXPECT_EQ(sum.shares.at(0, 0), 1);
    EXPECT_EQ(sum.shares.at(1, 0), 3) << "18 % over 6 %, whatever it took so far";
    EXPECT_EQ(sum.shares.at(2, 0), 4) << "the most";
}

TEST(Shares, APixelTakesItsShareOfSamples) {
    Scene scene = test::furnace(4, 1, 0.5f, 1);
    Settings settings;
    settings.render.width = settings.render.height = 8;
    const World world = build_world(scene, settings);
    const PictureView view{world.camera, 8, 8};
    const PixelRect window{0, 0, 8, 8};
    const GBuffer gbuffer = make_gbuffer(world, view, window, settings.render);
    Image<std::uint8_t> shares(8, 8, std::uint8_t{1});
    shares.at(2, 3) = 4;
    const SampleRange one{1, 1, nullptr}, more{1, 1, &shares};
    const std::int64_t rays = render(world, gbuffer, {}, settings, window, false, {}, one).camera_rays;
    EXPECT_EQ(rays, 64);
    EXPECT_EQ(render(world, gbuffer, {}, settings, window, false, {}, more).camera_rays, 67);
}

TEST(EstimateError, NoiseIsTheStandardErrorOfTheMean) {
    const ProgressiveSum sum = made_up_run(12, 0, 0.2, 64);
    const ErrorEstimate error = estimate_error(sum, {0, 0, 64, 64});
    double squares = 0;
    for (const float n : error.noise.pixels) squares += static_cast<double>(n) * static_cast<double>(n);
    EXPECT_NEAR(std::sqrt(squares / 4096), 0.2 / std::sqrt(48.0), 0.02 * 0.2 / std::sqrt(48.0));
}

TEST(EstimateError, BiasIsTheSlopeOverTheAreas) {
    const ProgressiveSum sum = made_up_run(12, 0.5, 0.01, 64);
    double mean_shrink = 0;
    for (int b = 0; b < 12; ++b) mean_shrink += mapped_step(1 + 4 * b).shrink / 12;
    const ErrorEstimate error = estimate_error(sum, {0, 0, 64, 64});
    EXPECT_NEAR(error.bias.at(32, 32), 0.5 * mean_shrink, 0.03 * 0.5 * mean_shrink);
    EXPECT_LT(estimate_error(made_up_run(12, -0.5, 0.01, 16), {0, 0, 16, 16}).bias.at(8, 8), 0);
}

double covered(const ProgressiveSum& sum, PixelRect window, const std::function<double(int, int)>& truth) {
    const ErrorEstimate error = estimate_error(sum, window);
    int inside = 0, all = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x, ++all)
            inside += std::abs(static_cast<double>(luminance(sum.mean.color.at(x, y))) - truth(x, y)) <=
                      static_cast<double>(error_bound_90(error.noise.at(x, y), error.bias.at(x, y), error.batches));
    return static_cast<double>(inside) / all;
}

TEST(ErrorBound, HoldsTheTruthForNineTenthsOfPixels) {
    // With a bias far above the noise the bound, one for both sides, holds more.
    for (const double slope : {0.0, 0.02, 0.1})
        for (const int batches : {4, 8, 16}) {
            const double share = covered(made_up_run(batches, slope, 0.1, 64), {0, 0, 64, 64},
                                         [](int, int) { return 1.0; });
            EXPECT_GE(share, 0.85) << "slope " << slope << ", " << batches << " batches";
            EXPECT_LE(share, 0.97) << "slope " << slope << ", " << batches << " batches";
        }
    EXPECT_TRUE(std::isinf(error_bound_90(1, 0, 1)));
}

// The photons of a furnace lie under all its pixels at once, so one run's pixels are right or wrong together: the share is
// taken over several runs.
TEST(Progressive, TheFurnaceIsWithinTheStatedError) {
    Scene scene = test::furnace(4, 1, 0.5f, 1);
    scene.lights.front().no_image = true; // the wall behind it is as bright as anywhere
    const double truth = test::furnace_radiance(4, 1, 0.5, 1);
    constexpr int runs = 6, side = 12;
    double mean = 0, share = 0;
    for (int run = 0; run < runs; ++run) {
        Settings settings = test::small_settings(side, side);
        settings.photons.count = 6000;
        settings.render.seed = static_cast<std::uint64_t>(100 + run);
        const ProgressiveSum sum = test::run_passes(build_world(scene, settings), settings, 1 + 4 * 6, true);
        for (const Color c : sum.mean.color.pixels) mean += static_cast<double>(luminance(c)) / (runs * side * side);
        share += covered(sum, {0, 0, side, side}, [&](int, int) { return truth; }) / runs;
    }
    EXPECT_NEAR(mean, truth, 0.005 * truth);
    EXPECT_GE(share, 0.75);
}

} // namespace
} // namespace pnr
