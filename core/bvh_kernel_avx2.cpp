// SPDX-License-Identifier: GPL-3.0-or-later
// Eight boxes at a time; compiled with -mavx2 -mfma.
#include "core/bvh_traverse.h"

namespace pnr {

#if defined(__AVX2__) && defined(__FMA__)
namespace {
constexpr BvhKernel kernel{"avx2", 8, 8, &closest<8, 8>, &occluded<8, 8>};
}
const BvhKernel* avx2_kernel() { return &kernel; }
#else
const BvhKernel* avx2_kernel() { return nullptr; }
#endif

} // namespace pnr
