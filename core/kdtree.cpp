// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/kdtree.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace pnr {

namespace {

constexpr std::size_t leaf_points = 16; // at most
constexpr std::size_t padding = 16;     // floats that may be read behind the last point

std::size_t leaf_begin(const KdTree& tree, std::size_t leaf) { return (leaf * tree.count) >> tree.levels; }

// Nodes take two levels at a time; with an odd number of levels the root has two children only. Depth 0 is
// the root, depth `depth_of(tree)` are the leaves.
int depth_of(const KdTree& tree) { return (tree.levels + 1) / 2; }
int root_bits(const KdTree& tree) { return tree.levels % 2 == 1 ? 1 : 2; } // binary levels in the root

// ---- four lanes
// -----------------------------------------------------------------------------------------------------

#if defined(__SSE2__)
struct Lanes {
    __m128 v;
    static Lanes load(const float* p) { return {_mm_loadu_ps(p)}; }
    static Lanes all(float x) { return {_mm_set1_ps(x)}; }
    void store(float* p) const { _mm_storeu_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm_mul_ps(a.v, b.v)}; }
    friend Lanes larger(Lanes a, Lanes b) { return {_mm_max_ps(a.v, b.v)}; }
    friend unsigned at_most(Lanes a, Lanes b) {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v)));
    }
};
#else
struct Lanes {
    float v[4];
    static Lanes load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
    static Lanes all(float x) { return {{x, x, x, x}}; }
    void store(float* p) const { std::copy(v, v + 4, p); }
    template <class F>
    static Lanes map(Lanes a, Lanes b, F f) {
        return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        return map(a, b, [](float x, float y) { return x + y; });
    }
    friend Lanes operator-(Lanes a, Lanes b) {
        return map(a, b, [](float x, float y) { return x - y; });
    }
    friend Lanes operator*(Lanes a, Lanes b) {
        return map(a, b, [](float x, float y) { return x * y; });
    }
    friend Lanes larger(Lanes a, Lanes b) {
        return map(a, b, [](float x, float y) { return x > y ? x : y; });
    }
    friend unsigned at_most(Lanes a, Lanes b) {
        unsigned mask = 0;
        for (unsigned i = 0; i < 4; ++i) mask |= a.v[i] <= b.v[i] ? 1u << i : 0u;
        return mask;
    }
};
#endif

// A query's point in all lanes.
struct Query {
    Lanes x, y, z;
    explicit Query(Vec3f p) : x(Lanes::all(p.x)), y(Lanes::all(p.y)), z(Lanes::all(p.z)) {}

    // Squared distances are rounded alike for boxes and points, and rounding is monotonic, so pruning by a
    // box is exact.
    Lanes to_boxes(const KdNode& node) const {
        const Lanes zero = Lanes::all(0);
        const auto outside = [&zero](const float* low, const float* high, Lanes p) {
            return larger(larger(Lanes::load(low) - p, p - Lanes::load(high)), zero);
        };
        const Lanes dx = outside(node.low[0], node.high[0], x);
        const Lanes dy = outside(node.low[1], node.high[1], y);
        const Lanes dz = outside(node.low[2], node.high[2], z);
        return dx * dx + dy * dy + dz * dz;
    }
    Lanes to_points(const KdTree& tree, std::size_t i) const {
        const Lanes dx = Lanes::load(&tree.x[i]) - x, dy = Lanes::load(&tree.y[i]) - y,
                    dz = Lanes::load(&tree.z[i]) - z;
        return dx * dx + dy * dy + dz * dz;
    }
};

// ---- building
// -------------------------------------------------------------------------------------------------------

struct Item {
    Vec3f p;
    std::uint32_t index;
};

struct Builder {
    const KdTree& tree;
    std::vector<Item>& items;

    // Splits [first, last) leaves at the median of their widest axis, so that the tree stays complete.
    void split(std::size_t first, std::size_t last) {
        if (last - first == 1) return;
        const std::size_t begin = leaf_begin(tree, first), end = leaf_begin(tree, last);
        // A sample's extent will do to choose an axis; the boxes are exact, from the leaves up.
        const std::size_t step = 1 + (end - begin) / 1024;
        Vec3f low(items[begin].p), high(low);
        for (std::size_t i = begin; i < end; i += step) {
            low = glm::min(low, items[i].p);
            high = glm::max(high, items[i].p);
        }
        const Vec3f size = high - low;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        const std::size_t middle = (first + last) / 2, cut = leaf_begin(tree, middle);
        const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
        // By index where coordinates are equal: which points go left does not depend on the library's
        // nth_element.
        std::nth_element(at(begin), at(cut), at(end), [axis](const Item& a, const Item& b) {
            return a.p[axis] < b.p[axis] || (a.p[axis] == b.p[axis] && a.index < b.index);
        });
        if (end - begin < 32768) {
            split(first, middle);
            split(middle, last);
            return;
        }
        parallel_for(2, 1, [&](std::int64_t side, std::int64_t, std::int64_t) {
            if (side == 0)
                split(first, middle);
            else
                split(middle, last);
        });
    }
};

// An empty tree of the right size.
KdTree shape_tree(std::size_t count) {
    KdTree tree;
    tree.count = count;
    if (count == 0) return tree;
    while ((leaf_points << tree.levels) < count) ++tree.levels;
    for (std::vector<float>* axis : {&tree.x, &tree.y, &tree.z}) axis->assign(count + padding, 0.f);
    return tree;
}

struct Box {
    Vec3f low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
};

// Boxes from the leaves up, a level of nodes at a time.
void fill_nodes(KdTree& tree) {
    const std::size_t leaves = std::size_t{1} << tree.levels;
    std::vector<Box> below(leaves);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf)
        for (std::size_t i = leaf_begin(tree, leaf); i < leaf_begin(tree, leaf + 1); ++i) {
            const Vec3f p{tree.x[i], tree.y[i], tree.z[i]};
            below[leaf] = {glm::min(below[leaf].low, p), glm::max(below[leaf].high, p)};
        }
    std::size_t total = 0;
    for (int d = 0, level = 0; d < depth_of(tree); ++d) {
        total += std::size_t{1} << level;
        level += d == 0 ? root_bits(tree) : 2;
    }
    tree.nodes.resize(total);
    std::size_t first = total;
    for (int d = depth_of(tree) - 1; d >= 0; --d) {
        const std::size_t children = d == 0 ? std::size_t{1} << root_bits(tree) : 4;
        const std::size_t count = below.size() / children;
        first -= count;
        std::vector<Box> boxes(count);
        for (std::size_t i = 0; i < count; ++i) {
            KdNode& node = tree.nodes[first + i];
            for (std::size_t c = 0; c < 4; ++c) {
                const Box box = c < children ? below[i * children + c] : Box{};
                boxes[i] = {glm::min(boxes[i].low, box.low), glm::max(boxes[i].high, box.high)};
                for (int axis = 0; axis < 3; ++axis) {
                    node.low[axis][c] = box.low[axis];
                    node.high[axis][c] = box.high[axis];
                }
            }
        }
        below = std::move(boxes);
    }
    tree.bounds = {Vec3(below[0].low), Vec3(below[0].high)};
}

void set_point(KdTree& tree, std::size_t i, Vec3f p) {
    tree.x[i] = p.x;
    tree.y[i] = p.y;
    tree.z[i] = p.z;
}

} // namespace

KdTree build_kdtree(std::span<const Vec3f> points) {
    KdTree tree = shape_tree(points.size());
    if (points.empty()) return tree;
    std::vector<Item> items(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) items[i] = {points[i], static_cast<std::uint32_t>(i)};
    Builder{tree, items}.split(0, std::size_t{1} << tree.levels);
    tree.order.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        tree.order[i] = items[i].index;
        set_point(tree, i, items[i].p);
    }
    fill_nodes(tree);
    return tree;
}

KdTree kdtree_of_leaf_order(std::span<const Vec3f> points) {
    KdTree tree = shape_tree(points.size());
    if (points.empty()) return tree;
    for (std::size_t i = 0; i < points.size(); ++i) set_point(tree, i, points[i]);
    fill_nodes(tree);
    return tree;
}

// ---- walking
// --------------------------------------------------------------------------------------------------------

namespace {

float square_of(float radius) {
    if (!(radius >= 0)) return -1;
    return radius * radius;
}

// First node of each depth.
std::array<std::uint32_t, 20> node_offsets(const KdTree& tree) {
    std::array<std::uint32_t, 20> first{};
    std::uint32_t level_nodes = 1;
    for (std::size_t d = 1; d < static_cast<std::size_t>(depth_of(tree)); ++d) {
        first[d] = first[d - 1] + level_nodes;
        level_nodes *= d == 1 ? 1u << root_bits(tree) : 4;
    }
    return first;
}

struct Entry {
    std::uint32_t node; // within its depth
    std::int32_t depth;
    float distance2;
};

// Calls visit(begin, end) for the leaves whose box is no further than `bound`, in leaf order, until it
// returns false.
template <class Visit>
void walk_in_order(const KdTree& tree, const Query& query, float bound, Visit visit) {
    const int bottom = depth_of(tree);
    if (bottom == 0) {
        visit(std::size_t{0}, tree.count);
        return;
    }
    const auto first = node_offsets(tree);
    const Lanes reach = Lanes::all(bound);
    Entry stack[64];
    int size = 1;
    stack[0] = {0, 0, 0};
    while (size > 0) {
        const Entry at = stack[--size];
        const KdNode& node = tree.nodes[first[static_cast<std::size_t>(at.depth)] + at.node];
        unsigned mask = at_most(query.to_boxes(node), reach);
        if (at.depth + 1 == bottom) {
            for (; mask != 0; mask &= mask - 1) {
                const std::size_t leaf = at.node * 4 + static_cast<std::uint32_t>(std::countr_zero(mask));
                if (!visit(leaf_begin(tree, leaf), leaf_begin(tree, leaf + 1))) return;
            }
            continue;
        }
        while (mask != 0) { // the first child ends on top
            const auto c = static_cast<std::uint32_t>(31 - std::countl_zero(mask));
            stack[size++] = {at.node * 4 + c, at.depth + 1, 0};
            mask ^= 1u << c;
        }
    }
}

// The same with nearest boxes first; visit may lower bound.
template <class Visit>
void walk_nearest(const KdTree& tree, const Query& query, const float& bound, Visit visit) {
    const int bottom = depth_of(tree);
    const auto first = node_offsets(tree);
    Entry stack[64];
    int size = 1;
    stack[0] = {0, 0, 0};
    while (size > 0) {
        const Entry at = stack[--size];
        if (at.distance2 > bound) continue;
        if (at.depth == bottom) {
            visit(leaf_begin(tree, at.node), leaf_begin(tree, at.node + 1));
            continue;
        }
        const KdNode& node = tree.nodes[first[static_cast<std::size_t>(at.depth)] + at.node];
        const Lanes d2 = query.to_boxes(node);
        const unsigned mask = at_most(d2, Lanes::all(bound));
        float distances[4];
        d2.store(distances);
        const int base = size;
        for (unsigned c = 0; c < 4; ++c) {
            if (!(mask >> c & 1u)) continue;
            int place = size++; // by insertion: the nearest ends on top
            for (; place > base && stack[place - 1].distance2 < distances[c]; --place)
                stack[place] = stack[place - 1];
            stack[place] = {at.node * 4 + c, at.depth + 1, distances[c]};
        }
    }
}

// Nearer, or as near and given earlier; indices are in leaf order.
struct Nearer {
    const std::uint32_t* order; // null: given in leaf order
    explicit Nearer(const KdTree& tree) : order(tree.order.empty() ? nullptr : tree.order.data()) {}
    bool operator()(const Neighbour& a, const Neighbour& b) const {
        if (a.distance2 != b.distance2) return a.distance2 < b.distance2;
        return order ? order[a.index] < order[b.index] : a.index < b.index;
    }
};

// Appends what lies within bound of the leaf's points, without branching on each.
void scan(const KdTree& tree, const Query& query, std::size_t begin, std::size_t end, float bound,
          Neighbour* out, std::size_t& n) {
    for (std::size_t i = begin; i < end; i += 4) {
        const Lanes d2 = query.to_points(tree, i);
        unsigned mask = at_most(d2, Lanes::all(bound));
        if (end - i < 4) mask &= (1u << (end - i)) - 1;
        if (mask == 0) continue;
        float distances[4];
        d2.store(distances);
        for (unsigned j = 0; j < 4; ++j) {
            out[n] = {distances[j], static_cast<std::uint32_t>(i + j)};
            n += mask >> j & 1u;
        }
    }
}

// From leaf order to the indices as given.
void name_originals(const KdTree& tree, std::vector<Neighbour>& found) {
    if (tree.order.empty()) return;
    for (Neighbour& neighbour : found) neighbour.index = tree.order[neighbour.index];
}

} // namespace

namespace {

// The k nearest within radius in any order, by their places in leaf order; ties as Order has them.
template <class Order>
void search_nearest(const KdTree& tree, Vec3f point, std::size_t wanted, float radius2, Order nearer,
                    std::vector<Neighbour>& found) {
    float bound = radius2;
    // Candidates pile up to a few times k before the k nearest of them are kept: cheaper than a heap.
    const std::size_t full = 3 * wanted + leaf_points;
    found.resize(full + leaf_points + 4);
    std::size_t n = 0;
    const auto keep_nearest = [&] {
        const auto kth = found.begin() + static_cast<std::ptrdiff_t>(wanted - 1);
        std::nth_element(found.begin(), kth, found.begin() + static_cast<std::ptrdiff_t>(n), nearer);
        bound = kth->distance2;
        n = wanted;
    };
    bool first = true;
    const Query query(point);
    walk_nearest(tree, query, bound, [&](std::size_t begin, std::size_t end) {
        scan(tree, query, begin, end, bound, found.data(), n);
        // The first k found give a radius at once, later ones only lower it.
        if (n > full || (first && n >= wanted)) {
            first = false;
            keep_nearest();
        }
    });
    if (n > wanted) keep_nearest();
    found.resize(n);
}

} // namespace

void find_nearest(const KdTree& tree, Vec3f point, int k, float radius, std::vector<Neighbour>& found) {
    found.clear();
    if (tree.count == 0 || k <= 0) return;
    const std::size_t wanted = std::min(static_cast<std::size_t>(k), tree.count);
    search_nearest(tree, point, wanted, square_of(radius), Nearer(tree), found);
    std::sort(found.begin(), found.end(), Nearer(tree));
    name_originals(tree, found);
}

void find_within(const KdTree& tree, Vec3f point, float radius, std::vector<Neighbour>& found) {
    found.clear();
    if (tree.count == 0) return;
    const float bound = square_of(radius);
    const Query query(point);
    std::size_t n = 0;
    walk_in_order(tree, query, bound, [&](std::size_t begin, std::size_t end) {
        if (found.size() < n + leaf_points + 4) found.resize(2 * n + 8 * leaf_points);
        scan(tree, query, begin, end, bound, found.data(), n);
        return true;
    });
    found.resize(n);
    name_originals(tree, found);
}

// ---- with a hint
// ----------------------------------------------------------------------------------------------------

namespace {

// The k-th smallest of n > k squared distances that are all <= bound, and how many lie below it.
constexpr std::size_t most_candidates = 1024;
struct Kth {
    float distance2;
    std::size_t below, equal;
};

// By a histogram: on a surface squared distances are spread evenly, so the k-th one's bucket holds few.
// Counted from the far end, where the k-th lies when the search radius was a good guess.
Kth find_kth(const Neighbour* candidates, std::size_t n, std::size_t k, float bound) {
    static constexpr std::size_t buckets = 64;
    std::array<std::uint16_t, buckets + 1> counts{};
    const float scale = bound > 0 ? static_cast<float>(buckets) / bound : 0;
    const auto bucket = [scale](float d2) {
        return std::min(static_cast<int>(buckets), static_cast<int>(d2 * scale));
    };
    for (std::size_t i = 0; i < n; ++i) ++counts[static_cast<std::size_t>(bucket(candidates[i].distance2))];
    std::size_t at = buckets, before = n - counts[at];
    while (before >= k) before -= counts[--at];
    std::array<float, most_candidates + 1> values; // not initialised
    std::size_t m = 0;
    for (std::size_t i = 0; i < n; ++i) {
        values[m] = candidates[i].distance2;
        m += bucket(candidates[i].distance2) == static_cast<int>(at) ? 1 : 0;
    }
    const std::size_t rank = k - before - 1;
    std::nth_element(values.begin(), values.begin() + rank, values.begin() + m);
    const float kth = values[rank];
    std::size_t below = before, equal = 0;
    for (std::size_t i = 0; i < m; ++i) {
        below += values[i] < kth ? 1 : 0;
        equal += values[i] == kth ? 1 : 0;
    }
    return {kth, below, equal};
}

// Copies the k nearest in their order to `kept` (room for k + 1): all nearer than the k-th, then the first
// ones at just its distance.
void keep_within(const Neighbour* candidates, std::size_t n, std::size_t k, Kth kth, Neighbour* kept) {
    std::size_t m = 0;
    if (kth.below + kth.equal == k) { // no tie is left out
        for (std::size_t i = 0; i < n; ++i) {
            kept[m] = candidates[i];
            m += candidates[i].distance2 <= kth.distance2 ? 1 : 0;
        }
        return;
    }
    std::size_t ties = k - kth.below;
    for (std::size_t i = 0; m < k && i < n; ++i) {
        const float d2 = candidates[i].distance2;
        const std::size_t tie = d2 == kth.distance2 && ties > 0 ? 1 : 0;
        kept[m] = candidates[i];
        m += d2 < kth.distance2 ? 1 : tie;
        ties -= tie;
    }
}

// A guess at the search radius: a little more than the hint's, but no more than what must hold k by the
// triangle inequality; without a hint all of a finite radius. 0: none.
float guess_bound(const SearchHint& hint, Vec3f point, float radius2) {
    if (!(hint.distance > 0)) return std::isfinite(radius2) ? radius2 : 0;
    const float sure = 1.0001f * (hint.distance + glm::distance(point, hint.point));
    return std::min({radius2, 1.2f * hint.distance * hint.distance, sure * sure});
}

// All within `bound` in leaf order; false when there are more than `most` (out has room for a leaf more).
bool collect(const KdTree& tree, const Query& query, float bound, std::size_t most, Neighbour* out,
             std::size_t& n) {
    n = 0;
    walk_in_order(tree, query, bound, [&](std::size_t begin, std::size_t end) {
        scan(tree, query, begin, end, bound, out, n);
        return n <= most;
    });
    return n <= most;
}

} // namespace

float find_nearest_near(const KdTree& tree, Vec3f point, int k, float radius, SearchHint& hint,
                        std::vector<Neighbour>& found) {
    const float radius2 = square_of(radius);
    if (tree.count == 0 || k <= 0 || radius2 < 0) {
        found.clear();
        return 0;
    }
    const std::size_t wanted = std::min(static_cast<std::size_t>(k), tree.count);
    const Query query(point);
    std::array<Neighbour, most_candidates>
        room; // not initialised: a vector's filling would cost as much as a search
    constexpr std::size_t most = most_candidates - leaf_points - 4;
    const auto by_place = [](const Neighbour& a, const Neighbour& b) {
        return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.index < b.index);
    };
    std::size_t n = 0;
    float bound = guess_bound(hint, point, radius2);
    bool fits = wanted < most && (bound > 0 || radius2 == 0);
    while (fits && (fits = collect(tree, query, bound, most, room.data(), n)) && n < wanted &&
           bound < radius2) {
        const float missing = static_cast<float>(wanted) / static_cast<float>(n + 1);
        bound = std::min(radius2, bound * std::clamp(1.3f * missing, 1.5f, 16.f));
    }
    float largest = 0;
    if (!fits) { // no hint, a poor one, or very many
        search_nearest(tree, point, wanted, radius2, by_place, found);
        std::sort(found.begin(), found.end(),
                  [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
        n = found.size();
        for (const Neighbour& neighbour : found) largest = std::max(largest, neighbour.distance2);
    } else if (n > wanted) {
        const Kth kth = find_kth(room.data(), n, wanted, bound);
        found.resize(wanted + 1);
        keep_within(room.data(), n, wanted, kth, found.data());
        n = wanted;
        found.resize(n);
        largest = kth.distance2;
    } else {
        found.assign(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(n));
        for (const Neighbour& neighbour : found) largest = std::max(largest, neighbour.distance2);
    }
    if (n == wanted) hint = {point, std::sqrt(largest)};
    name_originals(tree, found);
    return largest;
}

} // namespace pnr
