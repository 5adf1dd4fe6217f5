// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen boxes at a time; compiled with -mavx512f.
#include "core/bvh_traverse.h"

namespace pnr {

#if defined(__AVX512F__)
namespace {
constexpr BvhKernel kernel{"avx512", 16, 8, &closest<16, 8>, &occluded<16, 8>};
}
const BvhKernel* avx512_kernel() { return &kernel; }
#else
const BvhKernel* avx512_kernel() { return nullptr; }
#endif

} // namespace pnr
