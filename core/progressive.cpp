// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/progressive.h"

#include "core/rng.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pnr {
namespace {

// Passes that share a photon map, or count as one independent look at the scene where there is none.
constexpr int batch_length = 4;
// Share of the photons that a shrinking area keeps [Knaus and Zwicker 2011, alpha]: with 2/3 noise and bias
// of the mean fall alike.
constexpr double alpha = 2.0 / 3;
// The estimates of a pixel are averaged with those so far around it: a pixel's own few batches tell little.
constexpr int noise_apron = 1, bias_apron = 4;

// (1 + alpha)/2 (2 + alpha)/3 ... : the area of batch b over the first one's.
double shrink_of(int batch) {
    double shrink = 1;
    for (int i = 1; i <= batch; ++i) shrink *= (i - 1 + alpha) / i;
    return shrink;
}

// A pixel takes more samples a pass where a single one is off by more than this, as a share of what is shown
// of it.
constexpr double sample_noise = 0.06;
constexpr int most_samples = 4;

// From the standard deviation of a sample and the mean. Above white nothing is seen, and near black noise is
// judged against 2 % of white. It is the pixel's own affair, so that a crop takes the samples that the whole
// picture does.
std::uint8_t share_of(double deviation, double mean) {
    const double seen = deviation / (std::min(mean, 1.0) + 0.02);
    return static_cast<std::uint8_t>(std::clamp(std::lround(seen / sample_noise), 1L, long{most_samples}));
}

// What the passes of a batch tell of a single sample's variance.
void add_spread(ProgressiveSum& sum) {
    const int passes = sum.open_passes;
    const SampleRange used = {0, 1, sum.shares.empty() ? nullptr : &sum.shares};
    Image<std::uint8_t> next(sum.spread.width, sum.spread.height, std::uint8_t{1});
    for (int y = 0; y < sum.spread.height; ++y)
        for (int x = 0; x < sum.spread.width; ++x) {
            const double mean = static_cast<double>(sum.open_batch.at(x, y)) / passes;
            const double squares = static_cast<double>(sum.open_squares.at(x, y)) - passes * mean * mean;
            sum.spread.at(x, y) +=
                static_cast<float>(std::max(0.0, squares) * used.share(x, y) / (passes - 1));
            const double variance = static_cast<double>(sum.spread.at(x, y)) / (sum.batches + 1);
            next.at(x, y) =
                share_of(std::sqrt(variance), static_cast<double>(luminance(sum.mean.color.at(x, y))));
            sum.open_squares.at(x, y) = 0;
        }
    sum.shares = std::move(next);
}

template <class T>
void blend_in(Image<T>& mean, const Image<T>& next, float share) {
    if (next.empty()) return;
    if (mean.empty()) {
        mean = next;
        return;
    }
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
        mean.pixels[i] += (next.pixels[i] - mean.pixels[i]) * share;
}

void close_batch(ProgressiveSum& sum, double shrink) {
    add_spread(sum);
    const int n = ++sum.batches;
    sum.shrinks += shrink;
    sum.shrinks2 += shrink * shrink;
    for (std::size_t i = 0; i < sum.open_batch.pixels.size(); ++i) {
        const float value = sum.open_batch.pixels[i] / static_cast<float>(sum.open_passes);
        const float off = value - sum.batch_mean.pixels[i];
        sum.batch_mean.pixels[i] += off / static_cast<float>(n);
        sum.batch_squares.pixels[i] += off * (value - sum.batch_mean.pixels[i]);
        sum.batch_slope.pixels[i] += static_cast<float>(shrink) * value;
        sum.open_batch.pixels[i] = 0;
    }
    sum.open_passes = 0;
}

// Means over squares of side 2 apron + 1 within the window, by running sums.
Image<float> box_mean(const Image<float>& image, PixelRect window, int apron) {
    Image<float> rows(image.width, image.height, 0.0f), result(image.width, image.height, 0.0f);
    const auto run = [&](int from, int to, auto read, auto write) {
        double sum = 0;
        int count = 0;
        for (int i = from; i < std::min(to, from + apron); ++i) sum += static_cast<double>(read(i)), ++count;
        for (int i = from; i < to; ++i) {
            if (i + apron < to) sum += static_cast<double>(read(i + apron)), ++count;
            if (i - apron - 1 >= from) sum -= static_cast<double>(read(i - apron - 1)), --count;
            write(i, static_cast<float>(sum / count));
        }
    };
    for (int y = window.y0; y < window.y1; ++y)
        run(
            window.x0, window.x1, [&](int x) { return image.at(x, y); },
            [&](int x, float v) { rows.at(x, y) = v; });
    for (int x = window.x0; x < window.x1; ++x)
        run(
            window.y0, window.y1, [&](int y) { return rows.at(x, y); },
            [&](int y, float v) { result.at(x, y) = v; });
    return result;
}

} // namespace

bool large_picture(int width, int height) { return static_cast<std::int64_t>(width) * height > 400'000; }

ProgressiveStep progressive_step(int pass, Illumination illumination, Integrator integrator, bool large) {
    ProgressiveStep step;
    const bool previewed =
        large && illumination == Illumination::photon_mapped && integrator == Integrator::photons;
    const bool photons = illumination != Illumination::raytraced && integrator == Integrator::photons;
    step.preview = previewed && pass == 0;
    const int n = previewed ? std::max(0, pass - 1) : pass;
    step.batch = n / batch_length;
    step.begins_batch = photons && !(previewed && pass == 1) && n % batch_length == 0;
    step.samples = {n % batch_length, 1};
    step.shrink = photons ? shrink_of(step.batch) : 1;
    return step;
}

Settings settings_of(const ProgressiveStep& step, const Settings& settings) {
    Settings own = settings;
    if (step.batch > 0)
        own.render.seed = hash_words(settings.render.seed, static_cast<std::uint64_t>(step.batch));
    own.render.gather_effort = 0;          // the batches' mean knows more
    own.render.samples_min = batch_length; // the shadow rays asked for are shared by the passes of a batch
    own.photons.gather_max =
        std::max(8, static_cast<int>(std::lround(settings.photons.gather_max * step.shrink)));
    own.photons.gather_min = std::min(own.photons.gather_max, settings.photons.gather_min);
    own.photons.radius *= std::sqrt(step.shrink);
    return own;
}

SampleRange samples_of(const ProgressiveStep& step, const ProgressiveSum& sum) {
    return {step.samples.first, step.samples.count, sum.shares.empty() ? nullptr : &sum.shares};
}

void add_pass(ProgressiveSum& sum, const ProgressiveStep& step, RenderResult pass) {
    if (sum.preview || sum.passes == 0) {
        const std::int64_t rays = sum.camera_rays, gathers = sum.gathers;
        sum = {};
        sum.camera_rays = rays, sum.gathers = gathers;
    }
    sum.preview = step.preview;
    const float share = 1.0f / static_cast<float>(++sum.passes);
    if (sum.open_batch.empty()) {
        sum.open_batch = Image<float>(pass.layer.color.width, pass.layer.color.height, 0.0f);
        sum.batch_mean = sum.batch_squares = sum.batch_slope = sum.open_squares = sum.spread = sum.open_batch;
    }
    for (std::size_t i = 0; i < pass.layer.color.pixels.size(); ++i) {
        const float l = luminance(pass.layer.color.pixels[i]);
        sum.open_batch.pixels[i] += l;
        sum.open_squares.pixels[i] += l * l;
    }
    ++sum.open_passes;
    blend_in(sum.mean.color, pass.layer.color, share);
    blend_in(sum.mean.alpha, pass.layer.alpha, share);
    sum.parts.wanted = pass.parts.wanted;
    blend_in(sum.parts.direct, pass.parts.direct, share);
    blend_in(sum.parts.indirect, pass.parts.indirect, share);
    blend_in(sum.parts.caustic, pass.parts.caustic, share);
    blend_in(sum.parts.specular, pass.parts.specular, share);
    blend_in(sum.parts.photon_density, pass.parts.photon_density, share);
    sum.camera_rays += pass.camera_rays;
    sum.gathers += pass.gathers;
    sum.faults.nan += pass.faults.nan;
    sum.faults.inf += pass.faults.inf;
    sum.faults.negative += pass.faults.negative;
    merge_faults(sum.fault_places, std::move(pass.fault_places));
    if (!step.preview && sum.open_passes == batch_length) close_batch(sum, step.shrink);
}

ErrorEstimate estimate_error(const ProgressiveSum& sum, PixelRect window) {
    if (sum.batches < 2) return {};
    const int width = sum.batch_mean.width, height = sum.batch_mean.height;
    const double n = sum.batches, mean_shrink = sum.shrinks / n;
    // A third batch is needed to tell a slope from noise.
    const double spread = n > 2 ? sum.shrinks2 - sum.shrinks * mean_shrink : 0;
    Image<float> variance(width, height, 0.0f), slope(width, height, 0.0f);
    for (std::size_t i = 0; i < variance.pixels.size(); ++i) {
        double squares = std::max(0.0, static_cast<double>(sum.batch_squares.pixels[i]));
        if (spread > 1e-9) {
            const double along = static_cast<double>(sum.batch_slope.pixels[i]) -
                                 sum.shrinks * static_cast<double>(sum.batch_mean.pixels[i]);
            slope.pixels[i] = static_cast<float>(along / spread);
        }
        variance.pixels[i] = static_cast<float>(squares / (n * (n - 1)));
    }
    ErrorEstimate error{box_mean(variance, window, noise_apron), box_mean(slope, window, bias_apron),
                        sum.batches};
    for (std::size_t i = 0; i < error.noise.pixels.size(); ++i) {
        const double noise2 = static_cast<double>(error.noise.pixels[i]);
        error.noise.pixels[i] = static_cast<float>(std::sqrt(noise2));
        const double bias = static_cast<double>(error.bias.pixels[i]) * mean_shrink;
        // What the noise of the batches alone makes of the slope. Neighbours share photons: their mean is as
        // sure as that of few independent ones.
        constexpr double independent = 16;
        const double chance2 =
            spread > 1e-9 ? noise2 * n / spread * mean_shrink * mean_shrink / independent : 0;
        const double kept2 = bias * bias - chance2;
        error.bias.pixels[i] = kept2 > 0 ? static_cast<float>(std::copysign(std::sqrt(kept2), bias)) : 0.0f;
    }
    return error;
}

float error_bound_90(float noise, float bias, int batches) {
    if (batches < 2) return std::numeric_limits<float>::infinity();
    // A variance that is a mean over neighbours has more degrees of freedom than a pixel's own.
    const boost::math::students_t_distribution<double> t(2 * (batches - 1));
    return static_cast<float>(boost::math::quantile(t, 0.95)) * noise + std::abs(bias);
}

double relative_error_90(const ProgressiveSum& sum, const ErrorEstimate& error, PixelRect window) {
    if (error.empty() || window.empty()) return infinity;
    double total = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            total += static_cast<double>(luminance(sum.mean.color.at(x, y)));
    const double pixels = static_cast<double>(window.x1 - window.x0) * (window.y1 - window.y0);
    const double floor = 0.01 * total / pixels;
    if (!(floor > 0)) return 0; // a black picture is what it is
    std::vector<double> relative;
    relative.reserve(static_cast<std::size_t>(pixels));
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            relative.push_back(std::hypot(error.noise.at(x, y), error.bias.at(x, y)) /
                               (static_cast<double>(luminance(sum.mean.color.at(x, y))) + floor));
    const auto place =
        relative.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(relative.size() - 1));
    std::nth_element(relative.begin(), place, relative.end());
    return *place;
}

} // namespace pnr
