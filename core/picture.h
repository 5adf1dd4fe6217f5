// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures in patterns: how a point finds its pixel, and the values between pixels, as POV-Ray's image_map.
#pragma once

#include "core/image.h"
#include "core/pattern.h"

#include <optional>

namespace pnr {

// RGBA in working values at a point of the pattern's own space. None outside a picture that is shown once,
// and of a picture that was not read.
std::optional<glm::vec4> picture_at(const ImagePattern& pattern, Vec3 point);

} // namespace pnr
