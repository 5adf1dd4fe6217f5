// SPDX-License-Identifier: GPL-3.0-or-later
// The two spaces in which paint is mixed: Oklab, and in paper_mode the display's own encoded RGB. Both go
// beyond 1 for light brighter than white.
#pragma once

#include "core/types.h"

#include <cmath>

namespace pnr {

// Linear Rec.709 to Oklab (L, a, b) [Ottosson 2020, "A perceptual color space for image processing"].
// Negative cone responses are kept by an odd cube root.
inline Color oklab_from_linear(Color c) {
    const float l = std::cbrt(0.4122214708f * c.x + 0.5363325363f * c.y + 0.0514459929f * c.z);
    const float m = std::cbrt(0.2119034982f * c.x + 0.6806995451f * c.y + 0.1073969566f * c.z);
    const float s = std::cbrt(0.0883024619f * c.x + 0.2817188376f * c.y + 0.6299787005f * c.z);
    return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
            1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
            0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

inline Color linear_from_oklab(Color lab) {
    const float l = lab.x + 0.3963377774f * lab.y + 0.2158037573f * lab.z;
    const float m = lab.x - 0.1055613458f * lab.y - 0.0638541728f * lab.z;
    const float s = lab.x - 0.0894841775f * lab.y - 1.2914855480f * lab.z;
    const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    return {4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
            -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
            -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3};
}

// The sRGB transfer (IEC 61966-2-1), continued above 1 by its power and below 0 as an odd function.
inline float display_from_linear(float v) {
    const float a = std::abs(v);
    const float e = a <= 0.0031308f ? 12.92f * a : 1.055f * std::pow(a, 1 / 2.4f) - 0.055f;
    return std::copysign(e, v);
}
inline float linear_from_display(float v) {
    const float a = std::abs(v);
    const float l = a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f);
    return std::copysign(l, v);
}
inline Color display_from_linear(Color c) {
    return {display_from_linear(c.x), display_from_linear(c.y), display_from_linear(c.z)};
}
inline Color linear_from_display(Color c) {
    return {linear_from_display(c.x), linear_from_display(c.y), linear_from_display(c.z)};
}

} // namespace pnr
