// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/converge.h"

#include "cli/flip.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace pnr {

namespace {

double mean_of(const Image<Color>& image, const Image<float>& mask) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] <= 0) continue;
        const Color& c = image.pixels[i];
        sum += static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z);
        count += 3;
    }
    return count > 0 ? sum / count : 0;
}

double seconds_of_cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Relative mean squares of a picture's blocks: their mean, and its standard error as the blocks' spread tells
// it.
struct BlockMeans {
    int across = 1;
    std::vector<double> sums, counts;

    explicit BlockMeans(int width, int height)
        : across((width + side - 1) / side),
          sums(static_cast<std::size_t>(across * ((height + side - 1) / side)), 0.0), counts(sums) {}
    void add(int x, int y, double value) {
        const auto block = static_cast<std::size_t>(y / side * across + x / side);
        sums[block] += value;
        counts[block] += 1;
    }
    double mean() const {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < sums.size(); ++i) sum += sums[i], count += counts[i];
        return count > 0 ? sum / count : 0;
    }
    double standard_error() const {
        const double m = mean();
        double squares = 0, count = 0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const double off = sums[i] - m * counts[i];
            squares += off * off;
            count += counts[i];
        }
        return count > 0 ? std::sqrt(squares) / count : 0;
    }
    static constexpr int side = 16; // pixels; photons are blurred over less
};

// Relative roots of the mean squares of noise and bias, against the picture's own light, from each pixel's
// own batches: their squares are right in the mean, so the sum over all pixels needs no smoothing (which
// pictures of the error need, and which carries the noise at a lamp's rim to the dark pixels beside it). What
// noise alone makes of the slope over the batches' widths is taken off the bias; of few batches it makes
// several times the noise itself, and neighbours share it, so that the rest counts only where it stands out
// of its own standard error over blocks of pixels.
void add_estimate(const Rendering& r, Snapshot& snapshot) {
    const ProgressiveSum& sum = r.progressive;
    const double n = sum.batches, mean_shrink = sum.shrinks / n;
    const double spread = sum.shrinks2 - sum.shrinks * mean_shrink;
    if (sum.batches < 2) return;
    constexpr double sure = 2;         // standard errors
    constexpr double batch_passes = 4; // progressive.h
    const double floor = 0.1 * mean_of(snapshot.photoreal, snapshot.mask);
    BlockMeans noise(snapshot.mask.width, snapshot.mask.height), bias = noise;
    for (int y = 0; y < snapshot.mask.height; ++y)
        for (int x = 0; x < snapshot.mask.width; ++x) {
            const double light = static_cast<double>(luminance(snapshot.photoreal.at(x, y)));
            const double scale = light * light + floor * floor;
            if (snapshot.mask.at(x, y) <= 0 || !(scale > 0)) continue;
            const double own2 = static_cast<double>(sum.batch_squares.at(x, y)) / (n * (n - 1));
            noise.add(x, y, own2 / scale);
            if (sum.batches < 3 || spread < 1e-9) continue;
            const double along = static_cast<double>(sum.batch_slope.at(x, y)) -
                                 sum.shrinks * static_cast<double>(sum.batch_mean.at(x, y));
            const double slope = along / spread * mean_shrink;
            bias.add(x, y, (slope * slope - own2 * n / spread * mean_shrink * mean_shrink) / scale);
        }
    // The picture also holds the passes of the batch under way.
    snapshot.noise = std::sqrt(noise.mean() * std::min(1.0, n * batch_passes / sum.passes));
    const double bias2 = bias.mean();
    snapshot.bias = bias2 > sure * bias.standard_error() ? std::sqrt(bias2) : 0.0;
}

} // namespace

PictureError picture_error(const Image<Color>& x, const Reference& reference, const Image<float>& mask) {
    const auto fits = [&](const auto& image) { return image.width == x.width && image.height == x.height; };
    if (!fits(reference.a) || !fits(reference.b) || !fits(mask))
        throw std::invalid_argument("the reference has another size than the picture");
    Image<Color> truth(x.width, x.height);
    for (std::size_t i = 0; i < truth.pixels.size(); ++i)
        truth.pixels[i] = 0.5f * (reference.a.pixels[i] + reference.b.pixels[i]);
    const double mean = mean_of(truth, mask), floor = 0.1 * mean;
    const Image<float> seen = flip(truth, x);
    double squares = 0, relative = 0, flips = 0, pixels = 0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        if (mask.pixels[i] <= 0) continue;
        ++pixels;
        flips += static_cast<double>(seen.pixels[i]);
        for (int k = 0; k < 3; ++k) {
            const auto value = [&](const Image<Color>& image) {
                return static_cast<double>(image.pixels[i][k]);
            };
            const double square = (value(x) - value(reference.a)) * (value(x) - value(reference.b));
            const double r = value(truth);
            squares += square;
            if (const double scale = r * r + floor * floor; scale > 0) relative += square / scale;
            ratios.push_back(r + floor > 0 ? std::abs(value(x) - r) / (r + floor) : 0);
        }
    }
    if (pixels == 0) throw std::invalid_argument("no pixel is photoreal: there is nothing to compare");
    PictureError error;
    error.rmse = std::sqrt(std::max(0.0, squares / (3 * pixels)));
    error.relative_rmse = std::sqrt(std::max(0.0, relative / (3 * pixels)));
    error.mean_ratio = mean > 0 ? mean_of(x, mask) / mean : 1;
    const auto rank =
        ratios.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(ratios.size() - 1));
    std::nth_element(ratios.begin(), rank, ratios.end());
    error.relative_99 = *rank;
    error.flip = flips / pixels;
    return error;
}

Image<float> photoreal_mask(const Rendering& r) {
    Image<float> mask(r.picture.color.width, r.picture.color.height, 0.0f);
    for (int y = r.window.y0; y < r.window.y1; ++y)
        for (int x = r.window.x0; x < r.window.x1; ++x) {
            const bool painted = r.gbuffer.coverage.at(x, y) > 0 ||
                                 (!r.paint.layer.alpha.empty() && r.paint.layer.alpha.at(x, y) > 0);
            mask.at(x, y) = painted ? 0.0f : 1.0f;
        }
    return mask;
}

std::vector<Snapshot> run_budgets(const Scene& scene, const Settings& settings, const Budgets& limits,
                                  const std::vector<double>& budgets, ProgressMode progress) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const double cpu_begin = seconds_of_cpu();
    std::vector<Snapshot> snapshots;
    Passes passes(progress, false);
    Wishes wishes;
    wishes.budgets = limits;
    wishes.refinement = Refinement{};
    std::size_t next = 0;
    wishes.after_pass = [&](Rendering& r) {
        const double wall = std::chrono::duration<double>(Clock::now() - begin).count();
        if (wall < budgets[next]) return true;
        complete_picture(r);
        Snapshot s;
        while (next < budgets.size() && wall >= budgets[next]) s.budget_s = budgets[next++];
        s.wall_s = wall;
        s.cpu_s = seconds_of_cpu() - cpu_begin;
        s.passes = r.passes_done;
        s.picture = r.picture.color;
        s.photoreal = r.rendered.layer.color;
        s.mask = photoreal_mask(r);
        add_estimate(r, s);
        s.times = passes.times();
        snapshots.push_back(std::move(s));
        return next < budgets.size();
    };
    Reuse none;
    render_scene(scene, settings, wishes, none, passes);
    return snapshots;
}

std::optional<double> log_slope(const std::vector<std::pair<double, double>>& points) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& [px, py] : points) {
        if (!(px > 0 && py > 0)) continue;
        const double x = std::log(px), y = std::log(py);
        ++n, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double spread = n * sxx - sx * sx;
    if (n < 2 || !(spread > 1e-12 * n * n)) return {};
    return (n * sxy - sx * sy) / spread;
}

} // namespace pnr
