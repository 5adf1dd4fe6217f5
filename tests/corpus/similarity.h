// SPDX-License-Identifier: GPL-3.0-or-later
// How alike two pictures look.
#pragma once

#include "core/image.h"

namespace pnr {

// What is compared: luma 0.299 R' + 0.587 G' + 0.114 B' of the sRGB values as an 8-bit file holds them,
// rounded to a whole number in 0 .. 255. Light that is not finite counts as black.
Image<double> luma_of(const Image<glm::vec4>& linear);

// Mean structural similarity [Wang et al. 2004, "Image quality assessment"]: windows of
// 11 x 11 with a Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 255, over all windows that lie wholly in
// the picture. Pictures of different sizes, or smaller than a window: 0.
double similarity(const Image<double>& a, const Image<double>& b);

double mean_luma(const Image<double>& luma);

} // namespace pnr
