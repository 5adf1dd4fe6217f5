// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/kdtree.h"

#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pnr {

namespace {

constexpr std::size_t leaf_points = 16; // at most, about
constexpr std::size_t padding = 16;     // floats that may be read behind the last point

struct Item {
    Vec3f p;
    std::uint32_t index;
};

struct Builder {
    KdTree& tree;
    std::vector<Item>& items;

    std::size_t leaf_begin(std::size_t leaf) const { return (leaf * tree.count) >> tree.levels; }

    // Splits [first, last) leaves below `node` at the median of the box' widest axis, so that the tree stays
    // complete.
    void build(std::size_t node, std::size_t first, std::size_t last) {
        const std::size_t begin = leaf_begin(first), end = leaf_begin(last);
        Vec3f low(items[begin].p), high(low);
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, items[i].p);
            high = glm::max(high, items[i].p);
        }
        tree.low[node] = low;
        tree.high[node] = high;
        if (last - first == 1) return;
        const Vec3f size = high - low;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        const std::size_t middle = (first + last) / 2, cut = leaf_begin(middle);
        const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
        // By index where coordinates are equal: the tree does not depend on the library's nth_element.
        std::nth_element(at(begin), at(cut), at(end), [axis](const Item& a, const Item& b) {
            return a.p[axis] < b.p[axis] || (a.p[axis] == b.p[axis] && a.index < b.index);
        });
        if (end - begin < 32768) {
            build(2 * node, first, middle);
            build(2 * node + 1, middle, last);
            return;
        }
        parallel_for(2, 1, [&](std::int64_t side, std::int64_t, std::int64_t) {
            if (side == 0)
                build(2 * node, first, middle);
            else
                build(2 * node + 1, middle, last);
        });
    }
};

float squared_distance_to_box(const KdTree& tree, std::size_t node, Vec3f p) {
    const Vec3f d = glm::max(glm::max(tree.low[node] - p, p - tree.high[node]), Vec3f(0));
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

// Squared distances are rounded alike in boxes and points, and rounding is monotonic, so pruning by a box is
// exact.
float squared_distance(const KdTree& tree, std::size_t i, Vec3f p) {
    const float dx = tree.x[i] - p.x, dy = tree.y[i] - p.y, dz = tree.z[i] - p.z;
    return dx * dx + dy * dy + dz * dz;
}

std::uint32_t original(const KdTree& tree, std::size_t i) {
    return tree.order.empty() ? static_cast<std::uint32_t>(i) : tree.order[i];
}

bool nearer(const Neighbour& a, const Neighbour& b) {
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.index < b.index);
}

float square_of(float radius) {
    if (!(radius >= 0)) return -1;
    return radius * radius;
}

// Calls visit(begin, end) for the leaves whose box is no further than `bound`: the nearer subtree first, or
// in leaf order. visit may lower bound.
template <bool nearest_first, class Visit>
void walk(const KdTree& tree, Vec3f p, float& bound, Visit visit) {
    struct Entry {
        std::uint32_t node;
        float distance2;
    };
    Entry stack[64];
    int size = 0;
    const std::size_t leaves = std::size_t{1} << tree.levels;
    Entry at{1, squared_distance_to_box(tree, 1, p)};
    while (true) {
        if (at.distance2 <= bound) {
            if (at.node >= leaves) {
                const std::size_t leaf = at.node - leaves;
                visit((leaf * tree.count) >> tree.levels, ((leaf + 1) * tree.count) >> tree.levels);
            } else {
                Entry left{2 * at.node, squared_distance_to_box(tree, 2 * at.node, p)};
                Entry right{2 * at.node + 1, squared_distance_to_box(tree, 2 * at.node + 1, p)};
                if (nearest_first && right.distance2 < left.distance2) std::swap(left, right);
                stack[size++] = right;
                at = left;
                continue;
            }
        }
        if (size == 0) return;
        at = stack[--size];
    }
}

} // namespace

namespace {

// An empty tree of the right size.
KdTree shape_tree(std::size_t count) {
    KdTree tree;
    tree.count = count;
    if (count == 0) return tree;
    while ((leaf_points << tree.levels) < count) ++tree.levels;
    const std::size_t nodes = std::size_t{2} << tree.levels;
    tree.low.resize(nodes);
    tree.high.resize(nodes);
    for (std::vector<float>* axis : {&tree.x, &tree.y, &tree.z}) axis->assign(count + padding, 0.f);
    return tree;
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
    Builder{tree, items}.build(1, 0, std::size_t{1} << tree.levels);
    tree.bounds = {Vec3(tree.low[1]), Vec3(tree.high[1])};
    tree.order.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        tree.order[i] = items[i].index;
        set_point(tree, i, items[i].p);
    }
    return tree;
}

KdTree kdtree_of_leaf_order(std::span<const Vec3f> points) {
    KdTree tree = shape_tree(points.size());
    if (points.empty()) return tree;
    const std::size_t leaves = std::size_t{1} << tree.levels;
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
        const std::size_t begin = (leaf * tree.count) >> tree.levels;
        const std::size_t end = ((leaf + 1) * tree.count) >> tree.levels;
        Vec3f low = points[begin], high = low;
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, points[i]);
            high = glm::max(high, points[i]);
            set_point(tree, i, points[i]);
        }
        tree.low[leaves + leaf] = low;
        tree.high[leaves + leaf] = high;
    }
    for (std::size_t node = leaves - 1; node >= 1; --node) {
        tree.low[node] = glm::min(tree.low[2 * node], tree.low[2 * node + 1]);
        tree.high[node] = glm::max(tree.high[2 * node], tree.high[2 * node + 1]);
    }
    tree.bounds = {Vec3(tree.low[1]), Vec3(tree.high[1])};
    return tree;
}

void find_nearest(const KdTree& tree, Vec3f point, int k, float radius, std::vector<Neighbour>& found) {
    found.clear();
    if (tree.count == 0 || k <= 0) return;
    float bound = square_of(radius);
    const std::size_t wanted = std::min(static_cast<std::size_t>(k), tree.count);
    // Candidates pile up to a few times k before the k nearest of them are kept: cheaper than a heap.
    const std::size_t full = 3 * wanted + leaf_points;
    const auto keep_nearest = [&] {
        const auto kth = found.begin() + static_cast<std::ptrdiff_t>(wanted - 1);
        std::nth_element(found.begin(), kth, found.end(), nearer);
        bound = kth->distance2;
        found.resize(wanted);
    };
    bool first = true;
    walk<true>(tree, point, bound, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float d2 = squared_distance(tree, i, point);
            if (d2 <= bound) found.push_back({d2, original(tree, i)});
        }
        // The first k found give a radius at once, later ones only lower it.
        if (found.size() > full || (first && found.size() >= wanted)) {
            first = false;
            keep_nearest();
        }
    });
    if (found.size() > wanted) keep_nearest();
    std::sort(found.begin(), found.end(), nearer);
}

void find_within(const KdTree& tree, Vec3f point, float radius, std::vector<Neighbour>& found) {
    found.clear();
    if (tree.count == 0) return;
    float bound = square_of(radius);
    walk<false>(tree, point, bound, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float d2 = squared_distance(tree, i, point);
            if (d2 <= bound) found.push_back({d2, original(tree, i)});
        }
    });
}

} // namespace pnr
