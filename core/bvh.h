// SPDX-License-Identifier: GPL-3.0-or-later
// The bounding volume hierarchy: wide nodes over blocks of triangles and over boxes of other things, in
// kernel space (see bvh_kernel.h).
#pragma once

#include "core/bvh_kernel.h"
#include "core/exact.h"

#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

namespace pnr {

struct FloatBox {
    float low[3], high[3];
};

struct alignas(line_size) CacheLine {
    char bytes[line_size];
};

// Memory in huge pages where the system has them: a ray that goes anywhere meets few pages twice (4 to 6 % on
// 200,000 triangles and more, up to 15 % of rays in no order). Null is never returned.
void* allocate_pages(std::size_t bytes);

template <class T>
struct PageAllocator {
    using value_type = T;
    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(allocate_pages(n * sizeof(T))); }
    void deallocate(T* p, std::size_t) { std::free(p); }
    bool operator==(const PageAllocator&) const = default;
};
using TreeLines = std::vector<CacheLine, PageAllocator<CacheLine>>;

struct Bvh {
    const BvhKernel* kernel = nullptr; // whose width the nodes have
    BvhView view;
    bool empty = true;
    std::size_t node_count = 0, block_count = 0, triangle_count = 0;
    std::size_t bytes = 0; // of nodes, blocks and CGAL's triangles

    TreeLines tree;
    std::unique_ptr<const ExactTriangles> triangles;
};

// Binned SAH [Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"], collapsed to
// the kernel's width [Wald, Benthin and Boulos 2008] at the least expected cost [Ylitie, Karras and Laine
// 2017]. `corners` holds nine finite floats a triangle, largest about 1; triangles without area are left out.
// `others` are the boxes of other primitives, numbered as given. The result does not depend on the number of
// threads.
Bvh build_bvh(std::span<const float> corners, std::span<const FloatBox> others, const BvhKernel& kernel);

// All kernels that this processor can run, the plainest first, and the one that is fastest on it.
std::vector<const BvhKernel*> available_kernels();
const BvhKernel& best_kernel();

inline void closest(const Bvh& bvh, const KernelRay& ray, const KernelCalls& calls, KernelHit& hit) {
    if (!bvh.empty) bvh.kernel->closest(bvh.view, ray, calls, hit);
}
inline bool occluded(const Bvh& bvh, const KernelRay& ray, const KernelCalls& calls) {
    return !bvh.empty && bvh.kernel->occluded(bvh.view, ray, calls);
}

} // namespace pnr
