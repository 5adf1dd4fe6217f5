// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/settings.h"

namespace pnr {

PaintStyle default_style() { return {}; }

PaintStyle paper_style() {
    PaintStyle s;
    s.paper_mode = true;
    s.fill = Fill::random; // [LW10 3.2.3]
    s.length = 20;         // [LW10 Table 1]
    s.cell = 1;            // noise a pixel
    s.edge = 0;            // the mean along the path
    // [LW10] names no amount of noise: uniform in the display's RGB, +-0.35.
    s.noise_lightness = s.noise_chroma = 0.20;
    s.gaussian_first = 15; // [LW10 3.2.4], whatever the field
    s.gaussian_second = 7;
    s.box_weights = true;
    s.vectors = true;
    return s;
}

} // namespace pnr
