// SPDX-License-Identifier: GPL-3.0-or-later
// Eight boxes at a time, as with AVX2; compiled with -mavx512vl, which has 32 registers: all that is constant
// for a ray stays in them.
#include "core/bvh_traverse.h"

namespace pnr {

#if defined(__AVX512VL__)
namespace {
constexpr BvhKernel kernel{"avx512", 8, 8, &closest<8, 8>, &occluded<8, 8>};
}
const BvhKernel* avx512_kernel() { return &kernel; }
#else
const BvhKernel* avx512_kernel() { return nullptr; }
#endif

} // namespace pnr
