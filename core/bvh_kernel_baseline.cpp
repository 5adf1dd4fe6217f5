// SPDX-License-Identifier: GPL-3.0-or-later
// Four boxes at a time: every x86-64 and arm64.
#include "core/bvh_traverse.h"

namespace pnr {

#if defined(__SSE2__) || defined(__ARM_NEON)
namespace {
constexpr BvhKernel kernel{"baseline", 4, 4, &closest<4, 4>, &occluded<4, 4>};
}
const BvhKernel* baseline_kernel() { return &kernel; }
#else
const BvhKernel* baseline_kernel() { return nullptr; }
#endif

} // namespace pnr
