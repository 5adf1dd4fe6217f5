// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

#include <algorithm>

#include <stdexcept>

namespace pnr {

PixelRect grow(PixelRect rect, int apron, int width, int height) {
    return {std::clamp(rect.x0 - apron, 0, width), std::clamp(rect.y0 - apron, 0, height),
            std::clamp(rect.x1 + apron, 0, width), std::clamp(rect.y1 + apron, 0, height)};
}

Image<Color> over(const Layer& painted, const Layer& photoreal) {
    if (painted.color.empty()) return photoreal.color;
    if (photoreal.color.empty()) return painted.color;
    if (painted.color.width != photoreal.color.width || painted.color.height != photoreal.color.height)
        throw std::invalid_argument("layers of different sizes");
    Image<Color> sum = photoreal.color;
    for (std::size_t i = 0; i < painted.color.pixels.size(); ++i) sum.pixels[i] += painted.color.pixels[i];
    return sum;
}

} // namespace pnr
