// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/regions.h"

#include <map>

namespace pnr {

Regions find_regions(const InformativeMap& informative) {
    Regions found;
    found.label = Image<std::uint32_t>(informative.width, informative.height);
    std::map<std::uint64_t, std::uint32_t> labels;
    std::uint64_t last_key = 0;
    std::uint32_t last_label = 0;
    for (int y = 0; y < informative.height; ++y) {
        for (int x = 0; x < informative.width; ++x) {
            const Informed& pixel = informative.at(x, y);
            if (pixel.kind == PixelKind::outside) continue;
            const std::uint64_t key = region_key(pixel.object, pixel.via);
            if (key != last_key) {
                const auto [it, is_new] = labels.emplace(key, static_cast<std::uint32_t>(labels.size() + 1));
                if (is_new) found.regions.push_back({pixel.object, pixel.via, {x, y, x + 1, y + 1}, 0});
                last_key = key;
                last_label = it->second;
            }
            found.label.at(x, y) = last_label;
            Region& region = found.regions[last_label - 1];
            ++region.pixels;
            region.box.x0 = std::min(region.box.x0, x);
            region.box.x1 = std::max(region.box.x1, x + 1);
            region.box.y1 = y + 1;
        }
    }
    return found;
}

Image<std::uint8_t> region_mask(const Regions& regions, std::uint32_t label) {
    const PixelRect box = regions.regions[label - 1].box;
    Image<std::uint8_t> mask(box.x1 - box.x0, box.y1 - box.y0);
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x)
            mask.at(x, y) = regions.label.at(box.x0 + x, box.y0 + y) == label ? 1 : 0;
    return mask;
}

} // namespace pnr
