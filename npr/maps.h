// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of the NPR pass [LW10 3.2]: sparse, then informative.
//
// Axes. A stroke has no head or tail. In the picture its axis is the vector (cos 2t, sin 2t) times a
// coherence in [0, 1], t the angle from the x axis (right) towards the y axis (down); means of these are
// right at 180 degrees where means of plain vectors cancel. In space it is the tensor T T^t (orientation.h).
#pragma once

#include "core/gbuffer.h"
#include "core/image.h"
#include "core/photon_map.h"

namespace pnr {

// One source photon a pixel, the nearest to the viewer; elsewhere photon is -1 and all else 0, but that
// painted pixels of a region (object and via) without any source carry object, via and the radiance of their
// own seen point.
struct SourcePixel {
    std::int32_t photon = -1; // index into PhotonMap::photons
    Color radiance{0};        // leaving the photon's point towards the viewer
    Vec2f direction{0};       // unit, x right, y down, x > 0 or x = 0 and y > 0
    Vec2f at{0};              // where in the picture the photon is seen, in pixels; inside its pixel
    float z = 0;              // as in gbuffer.exr
    std::uint32_t object = 0, via = 0;
    bool turned = false; // the photon's T goes against `direction`; matters to plain vectors alone
    Vec3f normal{0};     // the photon's
};
using SparseMap = Image<SourcePixel>;

enum class PixelKind : std::uint8_t { outside = 0, source = 1, interpolated = 2, filled = 3 };

struct Informed {
    Color radiance{0};
    Vec2f axis{
        0}; // (cos 2t, sin 2t), unit as written; the smoothing in direction_field.cpp gives it a coherence
    std::uint32_t object = 0, via = 0;
    PixelKind kind = PixelKind::outside;
    bool turned = false; // as a plain vector (paper_mode) it goes against axis_direction(axis)
};
using InformativeMap = Image<Informed>;

// Unit direction with x > 0, or x = 0 and y > 0, of an axis (design.md section 5); x axis for a zero one.
Vec2f axis_direction(Vec2f axis);
Vec2f direction_axis(Vec2f direction); // (cos 2t, sin 2t) of a direction; zero for a zero one
Vec2f canonical_direction(
    Vec2 direction); // unit and turned so that x > 0, or x = 0 and y > 0; (1, 0) for a zero one
// Whether canonical_direction turns it round.
bool is_turned(Vec2 direction);

// A pixel that pass 2 paints: its centre sees a painted object with mix > 0.
inline bool is_painted(const Seen& seen) { return seen.npr && seen.object != 0; }
// What strokes never cross: the object and the mirror or glass it is seen in.
inline std::uint64_t region_key(std::uint32_t object, std::uint32_t via) {
    return std::uint64_t{object} << 32 | via;
}

} // namespace pnr
