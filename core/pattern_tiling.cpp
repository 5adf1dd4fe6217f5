// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pattern_values.h"

namespace pnr {

double value_of(const TilingPattern& kind, const SurfacePoint& at) { return at.point.x * 0 * kind.type; }

} // namespace pnr
