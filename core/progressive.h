// SPDX-License-Identifier: GPL-3.0-or-later
// Progressive rendering: passes whose mean converges, and what their differences tell of its error.
//
// Passes come in batches that share a photon map. Each batch has photons and random numbers of its own and blurs
// over a smaller area than the one before [Knaus and Zwicker 2011], so that the mean's noise and bias both go to
// zero while the memory stays that of one batch. What a pass does depends on its number alone: a run that was
// ended by the clock is repeated bit for bit by asking for as many passes.
#pragma once

#include "core/image.h"
#include "core/render.h"
#include "core/settings.h"

#include <cstdint>

namespace pnr {

// What pass number `pass` (from 0) of a run does.
struct ProgressiveStep {
    int batch = 0;
    bool begins_batch = false; // its photon map is still to be traced
    // The very first look at a large picture of a photon-mapped scene: light straight from the photon map, blurred but soon
    // there. It counts for nothing as soon as another pass is done.
    bool preview = false;
    SampleRange samples;
    double shrink = 1; // area over which this batch blurs, as a share of the first one's, in (0, 1]
};
// `large`: as large_picture says.
ProgressiveStep progressive_step(int pass, Illumination illumination, Integrator integrator, bool large);

// Whether a picture's first pass takes so long that a preview is worth its time.
bool large_picture(int width, int height);

// The settings of a step's batch: seed, photons in a gather, gather radius.
Settings settings_of(const ProgressiveStep& step, const Settings& settings);

// Running means over the passes of one picture. All images have its size; pixels outside the window stay 0.
struct ProgressiveSum {
    int passes = 0;           // that count in `mean`
    int batches = 0;          // whole ones
    bool preview = false;     // `mean` is a preview
    Layer mean;               // of all passes
    LightParts parts;         // likewise
    std::int64_t camera_rays = 0, gathers = 0;
    SampleFaults faults;
    std::vector<FaultPlace> fault_places;
    // Of the luminance of whole batches: mean, sum of squared differences from it, sum of shrink times luminance.
    Image<float> batch_mean, batch_squares, batch_slope;
    double shrinks = 0, shrinks2 = 0; // sums over batches
    Image<float> open_batch;          // sum of luminance of the batch under way
    int open_passes = 0;
    // How many samples a pixel takes in each pass of the batch under way: more where those so far differ much. Empty: one.
    Image<std::uint8_t> shares;
    Image<float> open_squares, spread; // sum of squared luminance, and of a single sample's variance, whole batches'
};
// The samples of a step, with what the passes so far tell about where they are wanted. The result refers to `sum`.
SampleRange samples_of(const ProgressiveStep& step, const ProgressiveSum& sum);
// Adds a pass's picture; a preview is replaced by the first pass that is none.
void add_pass(ProgressiveSum& sum, const ProgressiveStep& step, RenderResult pass);

// Standard error of the mean's luminance by noise, and its bias (signed: mean minus truth), per pixel.
// [Hachisuka, Jarosz and Jensen 2010] bound the bias by derivatives of the kernel; here the batches' own areas differ, so
// that bias, which is proportional to the area, shows as a slope over them; a slope that noise alone explains counts as
// none. Both are averaged over the `apron` nearest pixels each way, noise in the square.
// Empty before two whole batches.
struct ErrorEstimate {
    Image<float> noise, bias;
    int batches = 0;
    bool empty() const { return noise.empty(); }
};
ErrorEstimate estimate_error(const ProgressiveSum& sum, PixelRect window);

// Half the width of the interval that holds the truth with 90 % confidence: Student's t with 2 (batches - 1) degrees
// of freedom times the noise, plus the bias.
float error_bound_90(float noise, float bias, int batches);

// The 90th percentile over the window of (estimated error) / (L + 0.01 mean L), the estimated error being the root of
// noise^2 + bias^2: what `--error E` compares with E. Infinite while there is no estimate.
double relative_error_90(const ProgressiveSum& sum, const ErrorEstimate& error, PixelRect window);

} // namespace pnr
