// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/brush_scale.h"

#include "core/parallel.h"
#include "npr/footprint.h"

namespace pnr {

namespace {

constexpr float give = 1.5f;

// Of a region seen directly in perspective: the median angle of a pixel times the distance to the photons'
// middle, which stays when the view goes round it. Else the median of what its pixels span.
bool has_middle(const GBuffer& gbuffer, const Seats& seats, const Region& region) {
    return region.via == 0 && gbuffer.view.camera.projection == Projection::perspective &&
           region.object < seats.photons.size() && !seats.photons[region.object].empty();
}

float distance_to_middle(const GBuffer& gbuffer, const std::vector<Vec3f>& photons) {
    Vec3 low(photons.front()), high = low;
    for (const Vec3f& p : photons) low = glm::min(low, Vec3(p)), high = glm::max(high, Vec3(p));
    return static_cast<float>(glm::distance(gbuffer.view.camera.location, 0.5 * (low + high)));
}

} // namespace

BrushScale find_brush_scale(const GBuffer& gbuffer, const Seats& seats, const Region& region,
                            const Image<std::uint8_t>& mask) {
    const bool middle = has_middle(gbuffer, seats, region);
    const PixelRect box = region.box;
    BrushScale scale;
    scale.spans = Image<float>(mask.width, mask.height, 0.0f);
    parallel_for(mask.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < mask.width; ++x)
                if (mask.at(x, y) != 0)
                    scale.spans.at(x, y) = footprint_of(gbuffer.seen.at(box.x0 + x, box.y0 + y)).least;
    });
    std::vector<float> widths;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (mask.at(x, y) == 0) continue;
            const float width =
                scale.spans.at(x, y) / (middle ? gbuffer.seen.at(box.x0 + x, box.y0 + y).z : 1);
            if (width > 0 && std::isfinite(width)) widths.push_back(width);
        }
    }
    if (widths.empty()) return scale;
    const auto half = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), half, widths.end());
    scale.usual = middle ? *half * distance_to_middle(gbuffer, seats.photons[region.object]) : *half;
    return scale;
}

float brush_pixel(const BrushScale& scale, int x, int y) {
    const float pixel = scale.spans.at(x, y);
    if (!(pixel > 0) || !std::isfinite(pixel)) return scale.usual;
    return std::clamp(scale.usual, pixel / give, pixel * give);
}

} // namespace pnr
