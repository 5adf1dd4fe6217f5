// SPDX-License-Identifier: GPL-3.0-or-later
// How far a picture is from the truth, and how that falls with time.
#pragma once

#include "cli/pipeline.h"

#include <optional>
#include <vector>

namespace pnr {

// Two independent pictures of the same truth, so that their own noise drops out of mean squares: the mean of
// (x - A)(x - B) is that of (x - truth)^2. The same picture twice where only one is known.
struct Reference {
    Image<Color> a, b;
};

// Over the pixels that count (`mask` above 0), all channels; r is the mean of A and B.
struct PictureError {
    double rmse = 0;          // root of the mean of (x - A)(x - B); 0 where the noise of A and B hides it
    double relative_rmse = 0; // the same of (x - A)(x - B) / (r^2 + (mean r / 10)^2)
    double mean_ratio = 1;    // mean x / mean r
    double relative_99 = 0;   // 99th percentile of |x - r| / (r + mean r / 10)
    double flip = 0;          // mean of FLIP (flip.h): 0 nothing is seen to differ .. 1
};
// Throws std::invalid_argument if sizes differ or no pixel counts.
PictureError picture_error(const Image<Color>& x, const Reference& reference, const Image<float>& mask);

// Pixels that no paint touches: a path tracer knows the truth of these alone.
Image<float> photoreal_mask(const Rendering& r);

// A picture at some time of a progressive run.
struct Snapshot {
    double budget_s = 0, wall_s = 0, cpu_s = 0;
    int passes = 0;
    Image<Color> picture, photoreal; // the latter without what is painted
    Image<float> mask;
    // Root mean squares over the mask of the run's own estimate, relative as in relative_rmse; unset before
    // there are batches enough.
    std::optional<double> noise, bias;
    // The same of causes apart, with their own random numbers alone changed: photons (and what is gathered of them),
    // and samples (anti-aliasing and shadow rays). Unset without add_causes.
    std::optional<double> photon_noise, sample_noise;
    std::vector<PassTime> times;
};
// One progressive run, looked at when each of the budgets (seconds of wall time, rising) is used up, at the
// end of the pass under way. The last one ends the run.
std::vector<Snapshot> run_budgets(const Scene& scene, const Settings& settings, const Budgets& limits,
                                  const std::vector<double>& budgets, ProgressMode progress);

// Fills the causes' noise by two more runs of as many passes, one with other photons and one with other samples: half the
// mean square of the difference is each one's variance.
void add_causes(const Scene& scene, const Settings& settings, const Budgets& limits, std::vector<Snapshot>& snapshots,
                ProgressMode progress);

// What the painting's own steps are off by, with so many photons.
struct PaintCauses {
    double photons = 0; // share of those that the scene asks for
    double cpu_s = 0;   // of the photons and the maps
    double field = 0;   // degrees, root mean square: the informative map's axes beside the field at the seen points
    double map = 0;     // relative to light, root mean square: the map's colours from other photons, over sqrt 2
    double ilic = 0;    // in each channel, root mean square: the painting with paths of half as long steps
};
// For photons times 1/4, 1 and 4; empty if nothing is painted.
std::vector<PaintCauses> paint_causes(const Scene& scene, const Settings& settings);

// Slope of the least-squares line through (log x, log y) of the points above 0; unset for fewer than two.
std::optional<double> log_slope(const std::vector<std::pair<double, double>>& points);

} // namespace pnr
