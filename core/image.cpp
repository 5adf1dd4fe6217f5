// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

namespace pnr {

Image<Color> over(const Layer& painted, const Layer& photoreal) {
    Image<Color> sum = photoreal.color;
    for (std::size_t i = 0; i < painted.color.pixels.size(); ++i) sum.pixels[i] += painted.color.pixels[i];
    return sum;
}

} // namespace pnr
