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
    s.box_weights = true;
    s.vectors = true;
    return s;
}

} // namespace pnr
