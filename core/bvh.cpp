// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/bvh.h"

#include "core/bvh_lanes.h"
#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pnr {

namespace {

using Four = Lanes<4>;

constexpr int bins = 16;        // 32 take a fifth longer to build, and no ray is faster
constexpr int sah_depth = 40;   // deeper than this, ranges are halved: bounds the depth, and so the stack
constexpr float step_cost = 1;  // of visiting a node ...
constexpr float block_cost = 1; // ... and a block, in the same unit
constexpr std::size_t parallel_from = 1 << 15; // triangles; smaller ranges are not worth a thread

struct Box4 { // three coordinates; the fourth lane is not used
    Four low = Four::all(std::numeric_limits<float>::infinity());
    Four high = Four::all(-std::numeric_limits<float>::infinity());

    void add(const Box4& b) {
        low = min(low, b.low);
        high = max(high, b.high);
    }
    float half_area() const {
        alignas(16) float size[4];
        (high - low).store(size);
        return size[0] * (size[1] + size[2]) + size[1] * size[2];
    }
};

// A primitive while the tree is built: its box, and its number in the fourth lane of `low` (as bits).
struct alignas(16) Reference {
    float low[4], high[4];
    std::uint32_t number() const { return std::bit_cast<std::uint32_t>(low[3]); }
    bool is_other() const { return (number() & other_bit) != 0; }
    Box4 box() const { return {Four::load(low), Four::load(high)}; }
};

struct BinaryNode {
    Box4 box;
    std::uint32_t first = 0; // of a leaf: into the references; else the left child, the right one is next
    std::uint32_t count = 0; // 0: an inner node
};

struct Range {
    std::uint32_t first = 0, count = 0;
    Box4 box, centers; // centers: twice the boxes' centres
};

struct Binning {
    alignas(16) float origin[4];
    alignas(16) float scale[4];

    explicit Binning(const Box4& centers) {
        alignas(16) float high[4];
        centers.low.store(origin);
        centers.high.store(high);
        for (int k = 0; k < 4; ++k) {
            const float extent = high[k] - origin[k];
            // Extents that underflow give a scale of infinity; then the axis has one bin.
            scale[k] = k < 3 && extent > 0 && bins / extent < 1e30f ? bins * 0.999f / extent : 0;
        }
    }
    void bin_of(const Reference& r, int (&bin)[3]) const {
        alignas(16) float at[4];
        ((Four::load(r.low) + Four::load(r.high) - Four::load(origin)) * Four::load(scale)).store(at);
        for (int k = 0; k < 3; ++k) bin[k] = static_cast<int>(at[k]);
    }
};

struct Bins {
    Box4 box[3][bins];
    std::uint32_t count[3][bins] = {};

    void add(const Bins& b) {
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < bins; ++i) {
                box[k][i].add(b.box[k][i]);
                count[k][i] += b.count[k][i];
            }
    }
};

struct Split {
    int axis = -1, bin = 0; // bins up to and including this go left
    float cost = std::numeric_limits<float>::infinity();
};

Split best_split(const Bins& b, const Binning& binning, std::uint32_t block_size) {
    const auto blocks_of = [&](std::uint32_t count) {
        return static_cast<float>((count + block_size - 1) / block_size);
    };
    Split best;
    for (int k = 0; k < 3; ++k) {
        if (binning.scale[k] == 0) continue;
        float right_cost[bins];
        Box4 box;
        std::uint32_t count = 0;
        for (int i = bins - 1; i > 0; --i) {
            box.add(b.box[k][i]);
            count += b.count[k][i];
            right_cost[i] = count ? box.half_area() * blocks_of(count) : -1;
        }
        box = {};
        count = 0;
        for (int i = 0; i + 1 < bins; ++i) {
            box.add(b.box[k][i]);
            count += b.count[k][i];
            if (count == 0 || right_cost[i + 1] < 0) continue;
            const float cost = box.half_area() * blocks_of(count) + right_cost[i + 1];
            if (cost < best.cost) best = {k, i, cost};
        }
    }
    return best;
}

struct Builder {
    std::vector<Reference>& references;
    std::uint32_t block_size;

    Range measure(std::uint32_t first, std::uint32_t count) const {
        Range r{first, count, {}, {}};
        for (std::uint32_t i = first; i < first + count; ++i) {
            const Box4 b = references[i].box();
            r.box.add(b);
            const Four center = b.low + b.high;
            r.centers.add({center, center});
        }
        return r;
    }

    void fill(const Binning& binning, std::size_t begin, std::size_t end, Bins& out) const {
        for (std::size_t i = begin; i < end; ++i) {
            int bin[3];
            binning.bin_of(references[i], bin);
            const Box4 b = references[i].box();
            for (int k = 0; k < 3; ++k) {
                out.box[k][bin[k]].add(b);
                ++out.count[k][bin[k]];
            }
        }
    }

    Bins bin(const Binning& binning, const Range& r) const {
        Bins all;
        if (r.count < 2 * parallel_from) {
            fill(binning, r.first, r.first + r.count, all);
            return all;
        }
        std::vector<Bins> parts((r.count + parallel_from - 1) / parallel_from);
        parallel_for(r.count, parallel_from, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
            fill(binning, r.first + static_cast<std::size_t>(begin), r.first + static_cast<std::size_t>(end),
                 parts[static_cast<std::size_t>(chunk)]);
        });
        for (const Bins& part : parts) all.add(part);
        return all;
    }

    bool all_triangles(const Range& r) const {
        return std::none_of(references.begin() + r.first, references.begin() + r.first + r.count,
                            [](const Reference& x) { return x.is_other(); });
    }

    // Cuts the range in two; false if it should be a leaf.
    bool split(const Range& r, int depth, Range& left, Range& right) const {
        if (r.count == 1) return false;
        const bool may_be_leaf = r.count <= block_size && all_triangles(r);
        std::uint32_t middle = r.first;
        if (depth < sah_depth) {
            const Binning binning(r.centers);
            const Split s = best_split(bin(binning, r), binning, block_size);
            if (may_be_leaf &&
                block_cost <= step_cost + block_cost * s.cost / std::max(r.box.half_area(), 1e-30f))
                return false;
            if (s.axis >= 0) {
                const auto begin = references.begin() + r.first;
                const auto cut = std::partition(begin, begin + r.count, [&](const Reference& x) {
                    int at[3];
                    binning.bin_of(x, at);
                    return at[s.axis] <= s.bin;
                });
                middle = r.first + static_cast<std::uint32_t>(cut - begin);
            }
        } else if (may_be_leaf) {
            return false;
        }
        // All centres at one place, or too deep: halves.
        if (middle == r.first || middle == r.first + r.count) middle = r.first + r.count / 2;
        left = measure(r.first, middle - r.first);
        right = measure(middle, r.first + r.count - middle);
        return true;
    }

    // Builds below nodes[at]. Ranges of at most `stop` references are left as leaves, to be built by somebody
    // else.
    void build(std::vector<BinaryNode>& nodes, std::uint32_t at, const Range& r, int depth,
               std::uint32_t stop, std::vector<std::pair<std::uint32_t, int>>* left_over) const {
        nodes[at] = {r.box, r.first, r.count};
        if (left_over && r.count <= stop) {
            left_over->push_back({at, depth});
            return;
        }
        Range left, right;
        if (!split(r, depth, left, right)) return;
        const auto child = static_cast<std::uint32_t>(nodes.size());
        nodes.resize(nodes.size() + 2);
        nodes[at].first = child;
        nodes[at].count = 0;
        build(nodes, child, left, depth + 1, stop, left_over);
        build(nodes, child + 1, right, depth + 1, stop, left_over);
    }

    std::vector<BinaryNode> build_all() const;
};

// The top of the tree first, then its subtrees at the same time, then all joined in order.
std::vector<BinaryNode> Builder::build_all() const {
    const auto total = static_cast<std::uint32_t>(references.size());
    std::vector<BinaryNode> nodes(1);
    nodes.reserve(total);
    std::vector<std::pair<std::uint32_t, int>> roots;
    build(nodes, 0, measure(0, total), 0, std::max<std::uint32_t>(4096, total / 64), &roots);
    std::vector<std::vector<BinaryNode>> subtrees(roots.size());
    parallel_for(static_cast<std::int64_t>(roots.size()), 1,
                 [&](std::int64_t begin, std::int64_t, std::int64_t) {
                     const auto i = static_cast<std::size_t>(begin);
                     const auto [root, depth] = roots[i];
                     subtrees[i].resize(1);
                     subtrees[i].reserve(nodes[root].count);
                     build(subtrees[i], 0, measure(nodes[root].first, nodes[root].count), depth, 0, nullptr);
                 });
    for (std::size_t i = 0; i < roots.size(); ++i) {
        // A subtree's node 0 replaces its root; the others follow behind, moved by this much.
        const auto moved = static_cast<std::uint32_t>(nodes.size()) - 1;
        for (BinaryNode& node : subtrees[i])
            if (node.count == 0) node.first += moved;
        nodes[roots[i].first] = subtrees[i][0];
        nodes.insert(nodes.end(), subtrees[i].begin() + 1, subtrees[i].end());
    }
    return nodes;
}

// ---- wide nodes
// -----------------------------------------------------------------------------------------------

template <int W, int B>
struct Collapser {
    const std::vector<BinaryNode>& binary;
    const std::vector<Reference>& references;
    std::span<const float> corners;
    TreeLines& tree;
    std::size_t node_count = 0, block_count = 0;

    template <class T>
    std::uint32_t reserve() {
        const std::size_t at = tree.size();
        tree.resize(at + sizeof(T) / line_size);
        return static_cast<std::uint32_t>(at);
    }

    std::uint32_t leaf(const BinaryNode& node) {
        const Reference* r = &references[node.first];
        if (r->is_other()) return leaf_bit | r->number();
        TriangleBlock<B> block;
        for (std::uint32_t lane = 0; lane < B; ++lane) {
            const std::uint32_t number = r[lane < node.count ? lane : 0].number();
            block.triangle[lane] = lane < node.count ? number : no_primitive;
            for (std::size_t v = 0; v < 3; ++v)
                for (std::size_t k = 0; k < 3; ++k)
                    block.corner[v][k][lane] = corners[9 * std::size_t{number} + 3 * v + k];
        }
        ++block_count;
        const std::uint32_t at = reserve<TriangleBlock<B>>();
        std::memcpy(&tree[at], &block, sizeof block);
        return leaf_bit | at;
    }

    // The cheapest way to make up to k + 1 children of a node out of a binary subtree: its expected cost, and
    // how many of them the left half gets (0: the subtree is one child).
    struct Plan {
        float cost[W];
        std::uint8_t left[W];
        std::uint8_t left_of_node; // where the subtree's root is the node
    };
    std::vector<Plan> plans{};

    // The least cost of all ways to collapse the tree [Ylitie, Karras and Laine 2017, section 3.2]. Opening
    // the child of the largest surface instead costs 2 to 6 % of the rays, and 3 to 6 bytes a triangle.
    void make_plans() {
        plans.resize(binary.size());
        for (std::size_t i = binary.size(); i-- > 0;) { // children lie behind their parents
            const BinaryNode& node = binary[i];
            const float area = node.box.half_area();
            Plan& p = plans[i];
            if (node.count > 0) {
                std::fill_n(p.cost, W, area * block_cost);
                std::fill_n(p.left, W, std::uint8_t{0});
                continue;
            }
            const Plan &l = plans[node.first], &r = plans[node.first + 1];
            for (int k = 1; k < W; ++k) {
                p.cost[k] = std::numeric_limits<float>::infinity();
                p.left[k] = 1;
                for (int m = 0; m < k; ++m)
                    if (const float cost = l.cost[m] + r.cost[k - 1 - m]; cost < p.cost[k])
                        p.cost[k] = cost, p.left[k] = static_cast<std::uint8_t>(m + 1);
            }
            p.cost[0] = p.cost[W - 1] + area * step_cost;
            p.left[0] = 0;
            p.left_of_node = p.left[W - 1];
            for (int k = 1; k < W; ++k)
                if (p.cost[k - 1] <= p.cost[k]) p.cost[k] = p.cost[k - 1], p.left[k] = p.left[k - 1];
        }
    }

    // The children of at most `room` that the plan makes of a subtree, which is opened in any case if it is
    // the node itself.
    void open(std::uint32_t at, int room, bool is_node, std::uint32_t (&children)[W], int& count) const {
        const int left = is_node ? plans[at].left_of_node : plans[at].left[room - 1];
        if (left == 0) {
            children[count++] = at;
            return;
        }
        open(binary[at].first, left, false, children, count);
        open(binary[at].first + 1, room - left, false, children, count);
    }

    int gather(std::uint32_t at, std::uint32_t (&children)[W]) const {
        int count = 0;
        open(at, W, true, children, count);
        // Rays that look for anything at all try the first child first: the largest is met most often.
        const auto area = [&](std::uint32_t child) { return binary[child].box.half_area(); };
        for (int i = 1; i < count; ++i)
            for (int k = i; k > 0 && area(children[k - 1]) < area(children[k]); --k)
                std::swap(children[k - 1], children[k]);
        return count;
    }

    // How much there will be of it all below a node.
    std::size_t lines_below(std::uint32_t binary_at) const {
        const BinaryNode& node = binary[binary_at];
        if (node.count > 0)
            return references[node.first].is_other() ? 0 : sizeof(TriangleBlock<B>) / line_size;
        std::uint32_t children[W];
        const int count = gather(binary_at, children);
        std::size_t lines = sizeof(WideNode<W>) / line_size;
        for (int i = 0; i < count; ++i) lines += lines_below(children[i]);
        return lines;
    }

    // A node, the blocks below it, then its children with all that is theirs. Returns its place.
    std::uint32_t fill(std::uint32_t binary_at) {
        const std::uint32_t at = reserve<WideNode<W>>();
        std::uint32_t children[W];
        const int count = gather(binary_at, children);
        WideNode<W> wide{}; // padding too: the tree is the same bytes each time
        for (int i = 0; i < W; ++i) {
            for (int k = 0; k < 3; ++k) {
                wide.bound[k][i] = std::numeric_limits<float>::infinity();
                wide.bound[3 + k][i] = -std::numeric_limits<float>::infinity();
            }
            wide.child[i] = leaf_bit;
        }
        for (int i = 0; i < count; ++i) {
            const BinaryNode& child = binary[children[i]];
            alignas(16) float low[4], high[4];
            child.box.low.store(low);
            child.box.high.store(high);
            for (int k = 0; k < 3; ++k) wide.bound[k][i] = low[k], wide.bound[3 + k][i] = high[k];
            if (child.count > 0) wide.child[i] = leaf(child);
        }
        for (int i = 0; i < count; ++i)
            if (binary[children[i]].count == 0) wide.child[i] = fill(children[i]);
        ++node_count;
        std::memcpy(&tree[at], &wide, sizeof wide);
        return at;
    }
};

template <int W, int B>
void collapse(Bvh& bvh, const std::vector<BinaryNode>& binary, const std::vector<Reference>& references,
              std::span<const float> corners) {
    Collapser<W, B> c{binary, references, corners, bvh.tree};
    c.make_plans();
    bvh.tree.reserve(c.lines_below(0));
    bvh.view.root = binary[0].count > 0 ? c.leaf(binary[0]) : c.fill(0);
    bvh.view.tree = reinterpret_cast<const char*>(bvh.tree.data());
    bvh.node_count = c.node_count;
    bvh.block_count = c.block_count;
    bvh.bytes = bvh.tree.size() * line_size + corners.size() * sizeof(float);
}

bool has_area(const float* t) {
    const double e[3] = {double{t[3]} - t[0], double{t[4]} - t[1], double{t[5]} - t[2]};
    const double f[3] = {double{t[6]} - t[0], double{t[7]} - t[1], double{t[8]} - t[2]};
    return e[1] * f[2] != e[2] * f[1] || e[2] * f[0] != e[0] * f[2] || e[0] * f[1] != e[1] * f[0];
}

std::vector<Reference> make_references(std::span<const float> corners, std::span<const FloatBox> others) {
    std::vector<Reference> references;
    references.reserve(corners.size() / 9 + others.size());
    for (std::size_t i = 0; 9 * i < corners.size(); ++i) {
        const float* t = &corners[9 * i];
        if (!has_area(t)) continue;
        Reference r;
        for (int k = 0; k < 3; ++k) {
            r.low[k] = std::min({t[k], t[3 + k], t[6 + k]});
            r.high[k] = std::max({t[k], t[3 + k], t[6 + k]});
        }
        r.low[3] = std::bit_cast<float>(static_cast<std::uint32_t>(i));
        r.high[3] = 0;
        references.push_back(r);
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
        Reference r;
        for (int k = 0; k < 3; ++k) r.low[k] = others[i].low[k], r.high[k] = others[i].high[k];
        r.low[3] = std::bit_cast<float>(static_cast<std::uint32_t>(i) | other_bit);
        r.high[3] = 0;
        references.push_back(r);
    }
    return references;
}

} // namespace

void* allocate_pages(std::size_t bytes) {
    constexpr std::size_t huge = std::size_t{2} << 20;
    const std::size_t page = bytes < huge ? line_size : huge;
    void* p = std::aligned_alloc(page, (bytes + page - 1) / page * page);
    if (!p) throw std::bad_alloc();
#if defined(__linux__)
    if (page == huge) madvise(p, bytes, MADV_HUGEPAGE); // if not, then not
#endif
    return p;
}

Bvh build_bvh(std::span<const float> corners, std::span<const FloatBox> others, const BvhKernel& kernel) {
    Bvh bvh;
    bvh.kernel = &kernel;
    std::vector<Reference> references = make_references(corners, others);
    bvh.triangle_count = references.size() - others.size();
    if (references.empty()) return bvh;
    bvh.empty = false;
    bvh.triangles = std::make_unique<const ExactTriangles>(corners);
    const std::vector<BinaryNode> binary =
        Builder{references, static_cast<std::uint32_t>(kernel.block_size)}.build_all();
    switch (kernel.width) {
    case 4:
        collapse<4, 4>(bvh, binary, references, corners);
        break;
    default:
        collapse<8, 8>(bvh, binary, references, corners);
        break;
    }
    bvh.view.triangles = bvh.triangles.get();
    alignas(16) float low[4], high[4];
    binary[0].box.low.store(low);
    binary[0].box.high.store(high);
    for (int k = 0; k < 3; ++k)
        bvh.view.extent = std::max({bvh.view.extent, std::abs(low[k]), std::abs(high[k])});
    return bvh;
}

std::vector<const BvhKernel*> available_kernels() {
    std::vector<const BvhKernel*> kernels{scalar_kernel()};
    if (baseline_kernel()) kernels.push_back(baseline_kernel());
#if defined(__x86_64__)
    const bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi");
    if (avx2_kernel() && avx2) kernels.push_back(avx2_kernel());
    if (avx512_kernel() && avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
        kernels.push_back(avx512_kernel());
#endif
    return kernels;
}

// Sixteen boxes at a time were 15 to 20 % slower than eight on an Intel processor of 2024, and 5 to 10 %
// faster on an AMD one: what pays everywhere is AVX-512's registers (2 to 4 %).
const BvhKernel& best_kernel() { return *available_kernels().back(); }

} // namespace pnr
