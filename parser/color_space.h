// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that stand for light: linear, through the sRGB curve, or a scene's working values.
#pragma once

namespace pnr {

// A linear value as the scene's working value (Scene::assumed_gamma), for `srgb` colours: decode sRGB, then
// this.
double to_working(double linear, double assumed_gamma);
double srgb_to_linear(double encoded); // the sRGB curve, odd for negative values
double linear_to_srgb(double linear);

} // namespace pnr
