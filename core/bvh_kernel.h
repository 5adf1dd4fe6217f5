// SPDX-License-Identifier: GPL-3.0-or-later
// What the traversal kernels share with the rest: plain data only. The kernels are compiled with instruction
// sets that the machine may lack, so their files include nothing that defines inline functions others also
// use.
//
// Kernel space is world space times a power of two that makes the scene's radius about 1: exact, and free of
// overflow and underflow for scenes of any size.
#pragma once

#include <cstdint>

namespace pnr {

class ExactTriangles;

inline constexpr std::uint32_t no_primitive = 0xffffffffu;
inline constexpr int bvh_max_depth = 72; // of the binary tree, which bounds the stack

// Up to B triangles, lane by lane; lanes that are left over repeat the first's corners, and have no number.
template <int B>
struct alignas(64) TriangleBlock {
    float corner[3][3][B]; // [corner][axis][lane]
    std::uint32_t triangle[B];
};

// Boxes of W children and where they lie: an inner node, a block of triangles, or another primitive. Boxes of
// children that are not there are empty.
template <int W>
struct alignas(64) WideNode {
    float bound[6][W]; // low x y z, high x y z
    std::uint32_t child[W];
};
// A reference to a child: what it is, and its place in the tree in units of a cache line, or another
// primitive's number.
inline constexpr std::uint64_t line_size = 64;
inline constexpr std::uint32_t leaf_bit = 0x80000000u, other_bit = 0x40000000u, index_mask = 0x3fffffffu;

// Direction scaled by a power of two so that its largest component is in [1, 2), t accordingly; |origin| is
// below 16.
struct KernelRay {
    double origin[3], t_min; // in this order: the kernels read four numbers at once
    double direction[3], t_max;
};

struct KernelHit {
    double t;                               // in: t_max
    std::uint32_t primitive = no_primitive; // smaller wins at equal t
    std::uint32_t item = 0; // of primitives that are no triangle of this BVH: as the callback likes
    std::uint32_t triangle = no_primitive; // of this BVH, or as the callback likes
    const float* corners = nullptr;        // of a triangle of this BVH: nine numbers, block_size apart
};

struct BvhView {
    const char* tree = nullptr; // WideNode<W>s and TriangleBlock<B>s, side by side as they are met
    const ExactTriangles* triangles = nullptr;
    std::uint32_t root = 0; // a child reference
    float extent = 0;       // the largest coordinate of a box
};

// The rest of a ray query, by function so that the kernel needs no type of the scene. `meets` tries the other
// primitive `index` and, where it finds a closer hit (or one of equal t and smaller number) than `hit`,
// overwrites it and returns true. `sees` (may be null: all) tells whether the ray meets the triangle at t; it
// is asked about those that would be the best hit so far, in any order.
struct KernelCalls {
    const void* context = nullptr;
    bool (*meets)(const void* context, std::uint32_t index, const KernelRay& ray, KernelHit& hit) = nullptr;
    bool (*sees)(const void* context, std::uint32_t triangle, double t) = nullptr;
};

struct BvhKernel {
    const char* name;
    int width;      // W: children of a node
    int block_size; // B: triangles of a block
    void (*closest)(const BvhView&, const KernelRay&, const KernelCalls&, KernelHit&);
    bool (*occluded)(const BvhView&, const KernelRay&, const KernelCalls&);
};

// Null where this build has none for the machine's kind of processor; whether the processor itself can run it
// is asked by available_kernels (bvh.h).
const BvhKernel* scalar_kernel();
const BvhKernel* baseline_kernel(); // 4 wide: SSE2, NEON
const BvhKernel* avx2_kernel();     // 8 wide
const BvhKernel* avx512_kernel();   // 8 wide, with twice the registers

} // namespace pnr
