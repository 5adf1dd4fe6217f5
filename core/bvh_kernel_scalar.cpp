// SPDX-License-Identifier: GPL-3.0-or-later
// Four boxes at a time by plain code, without vector instructions: for processors that have none, and as the
// yardstick of the others.
#define PNR_PLAIN_LANES 1
#include "core/bvh_traverse.h"

namespace pnr {

namespace {
constexpr BvhKernel kernel{"scalar", 4, 4, &closest<4, 4>, &occluded<4, 4>};
}
const BvhKernel* scalar_kernel() { return &kernel; }

} // namespace pnr
