// SPDX-License-Identifier: GPL-3.0-or-later
// Lines, dots and small numbers on pictures of linear light.
#pragma once

#include "core/image.h"

#include <string_view>

namespace pnr {

// A colour given by how it is displayed: sRGB values 0 to 1.
Color displayed(float r, float g, float b);
// A stroke of one pixel's width, its ends round; coordinates are pixels, (0.5, 0.5) the middle of the first.
void draw_line(Image<Color>& picture, Vec2 from, Vec2 to, Color color);
void draw_dot(Image<Color>& picture, Vec2 middle, double radius, Color color);
// Digits and `%.-`, five pixels high times `size`, top left at (x, y), on a dark ground. What leaves the
// picture is cut.
void draw_number(Image<Color>& picture, int x, int y, std::string_view text, int size, Color color);
int number_width(std::string_view text, int size);

// Colours of numbered things, far apart for small numbers: hues go round by the golden angle. 0 is black.
Color number_color(std::uint32_t number);
// A value from 0 to 1 as heat: black, blue, red, yellow, white, ever lighter; clipped.
Color heat(double value);

} // namespace pnr
