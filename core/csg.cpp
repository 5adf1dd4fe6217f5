// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/csg.h"

#include <algorithm>

namespace pnr {

namespace {

constexpr Bounds everywhere{Vec3(-infinity), Vec3(infinity)};
constexpr std::size_t few = 8; // children up to which a list is as good as a tree of boxes

Bounds common(const Bounds& a, const Bounds& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

bool holds(const Bounds& b, Vec3 p) {
    return p.x >= b.low.x && p.x <= b.high.x && p.y >= b.low.y && p.y <= b.high.y && p.z >= b.low.z &&
           p.z <= b.high.z;
}

// The box of the points for which a child matters to its parent: elsewhere it is surely outside (a union's),
// or surely inside (an intersection's).
const Bounds& matters(CsgKind parent, const Csg::Node& child) {
    return parent == CsgKind::all ? child.outside : child.inside;
}

// ---- building
// -------------------------------------------------------------------------------------------------

void find_extent(Csg& csg, Csg::Node& node) {
    const bool all = node.kind == CsgKind::all || node.kind == CsgKind::clipped;
    node.inside = all ? everywhere : Bounds{};
    node.outside = all ? Bounds{} : everywhere;
    for (const std::uint32_t c : node.children) {
        const Csg::Node& child = csg.nodes[c];
        node.inside = all ? common(node.inside, child.inside) : merge(node.inside, child.inside);
        node.outside = all ? merge(node.outside, child.outside) : common(node.outside, child.outside);
    }
}

Vec3 middle(const Bounds& b) { // of infinite boxes, anything finite
    const Vec3 far(1e30);
    return glm::clamp(b.low, -far, far) + glm::clamp(b.high, -far, far);
}

void add_picks(const Csg& csg, Csg::Node& node, std::uint32_t* first, std::uint32_t* last) {
    const std::size_t at = node.picks.size();
    node.picks.emplace_back();
    Bounds box, middles;
    for (const std::uint32_t* c = first; c != last; ++c) {
        box = merge(box, matters(node.kind, csg.nodes[*c]));
        middles = merge(middles, middle(matters(node.kind, csg.nodes[*c])));
    }
    if (last - first == 1) {
        node.picks[at] = {box, *first, 0};
    } else {
        const Vec3 size = middles.high - middles.low;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        std::uint32_t* const half = first + (last - first) / 2;
        std::nth_element(first, half, last, [&](std::uint32_t a, std::uint32_t b) {
            const double x = middle(matters(node.kind, csg.nodes[a]))[axis],
                         y = middle(matters(node.kind, csg.nodes[b]))[axis];
            return x != y ? x < y : a < b;
        });
        node.picks[at] = {box, no_csg, 0};
        add_picks(csg, node, first, half);
        add_picks(csg, node, half, last);
    }
    node.picks[at].skip = static_cast<std::uint32_t>(node.picks.size());
}

// Where a leaf is seen: on its surface, inside all that cuts it.
Bounds seen_bounds(const Csg& csg, std::uint32_t leaf, Bounds box) {
    for (std::uint32_t at = leaf, up = csg.nodes[leaf].parent; up != no_csg;
         at = up, up = csg.nodes[up].parent) {
        const Csg::Node& parent = csg.nodes[up];
        if (parent.kind != CsgKind::all && parent.kind != CsgKind::clipped) continue;
        for (const std::uint32_t c : parent.children)
            if (c != at) box = common(box, csg.nodes[c].inside);
    }
    return is_empty(box) ? Bounds{} : box;
}

// ---- points
// ---------------------------------------------------------------------------------------------------

// Calls f for the children that matter at p, until one call gives true.
template <class F>
bool any_child(const Csg& csg, const Csg::Node& node, Vec3 p, F f) {
    if (node.picks.empty()) {
        for (const std::uint32_t c : node.children)
            if (holds(matters(node.kind, csg.nodes[c]), p) && f(c)) return true;
        return false;
    }
    for (std::size_t i = 0; i < node.picks.size();) {
        const Csg::Pick& pick = node.picks[i];
        if (!holds(pick.box, p)) {
            i = pick.skip;
            continue;
        }
        if (pick.child != no_csg && f(pick.child)) return true;
        ++i;
    }
    return false;
}

enum class Side { no, yes, border };

// Whether a surface of the child `own` is seen among its siblings: none of those that matter may hide it.
Side seen_among(const Csg& csg, const Csg::Node& parent, std::uint32_t own, Vec3 before, Vec3 behind,
                const CsgInside& solids) {
    const bool wanted = parent.kind == CsgKind::all;
    bool border = false, first = true;
    const auto hides = [&](Vec3 here, Vec3 there, std::uint32_t c) {
        if (c == own || csg_contains(csg, c, here, solids) == wanted) return false;
        if (csg_contains(csg, c, there, solids) != wanted) return true;
        border = true; // its surface is here, too
        first &= csg.nodes[c].order > csg.nodes[own].order;
        return false;
    };
    if (any_child(csg, parent, before, [&](std::uint32_t c) { return hides(before, behind, c); }))
        return Side::no;
    if (any_child(csg, parent, behind, [&](std::uint32_t c) { return hides(behind, before, c); }))
        return Side::no;
    return !border ? Side::yes : first ? Side::border : Side::no;
}

bool seen_through_clips(const Csg& csg, const Csg::Node& parent, Vec3 before, Vec3 behind,
                        const CsgInside& solids) {
    return std::all_of(parent.children.begin() + 1, parent.children.end(), [&](std::uint32_t clip) {
        return csg_contains(csg, clip, before, solids) || csg_contains(csg, clip, behind, solids);
    });
}

// The first leaf with a texture of its own that holds p.
std::uint32_t textured_leaf(const Csg& csg, std::uint32_t at, Vec3 p, const CsgInside& solids) {
    const Csg::Node& node = csg.nodes[at];
    if (node.kind == CsgKind::leaf) return !node.bare && csg_contains(csg, at, p, solids) ? at : no_csg;
    for (const std::uint32_t c : node.children) {
        if (const std::uint32_t found = textured_leaf(csg, c, p, solids); found != no_csg) return found;
        if (node.first_alone || node.kind == CsgKind::clipped) break;
    }
    return no_csg;
}

} // namespace

Csg make_csg(const std::vector<CsgNode>& nodes, const std::vector<CsgLeaf>& items) {
    Csg csg;
    csg.leaf_of_item.assign(items.size(), no_csg);
    csg.seen.reserve(items.size());
    for (const CsgLeaf& item : items) csg.seen.push_back(item.surface);
    csg.nodes.reserve(nodes.size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const CsgNode& said = nodes[i];
        Csg::Node& node = csg.nodes.emplace_back();
        node.kind = said.kind;
        node.cutaway = said.cutaway;
        node.first_alone = said.first_alone;
        node.bare = said.bare;
        node.item = said.item;
        node.children = said.children;
        if (said.kind == CsgKind::leaf) {
            const CsgLeaf& leaf = items[said.item];
            node.inside = leaf.inside;
            node.outside = leaf.outside;
            node.inverse = leaf.inverse;
            csg.leaf_of_item[said.item] = i;
            continue;
        }
        find_extent(csg, node);
        for (std::uint32_t k = 0; k < said.children.size(); ++k)
            if (said.kind != CsgKind::clipped || k == 0) {
                csg.nodes[said.children[k]].parent = i;
                csg.nodes[said.children[k]].order = k;
            }
        if (said.kind != CsgKind::clipped && said.children.size() > few) {
            std::vector<std::uint32_t> order = said.children;
            add_picks(csg, node, order.data(), order.data() + order.size());
        }
    }
    for (std::uint32_t i = 0; i < items.size(); ++i)
        if (csg.leaf_of_item[i] != no_csg)
            csg.seen[i] = seen_bounds(csg, csg.leaf_of_item[i], items[i].surface);
    return csg;
}

bool csg_contains(const Csg& csg, std::uint32_t at, Vec3 p, const CsgInside& solids) {
    const Csg::Node& node = csg.nodes[at];
    switch (node.kind) {
    case CsgKind::leaf:
        return solids.inside(solids.context, node.item, p) != node.inverse;
    case CsgKind::any:
    case CsgKind::merged:
        return holds(node.inside, p) &&
               any_child(csg, node, p, [&](std::uint32_t c) { return csg_contains(csg, c, p, solids); });
    case CsgKind::all:
        return holds(node.inside, p) &&
               !any_child(csg, node, p, [&](std::uint32_t c) { return !csg_contains(csg, c, p, solids); });
    case CsgKind::clipped:
        break;
    }
    return holds(node.inside, p) &&
           std::all_of(node.children.begin(), node.children.end(),
                       [&](std::uint32_t c) { return csg_contains(csg, c, p, solids); });
}

bool csg_shows(const Csg& csg, std::uint32_t leaf, Vec3 before, Vec3 behind, const CsgInside& solids) {
    for (std::uint32_t at = leaf, up = csg.nodes[leaf].parent; up != no_csg;
         at = up, up = csg.nodes[up].parent) {
        const Csg::Node& parent = csg.nodes[up];
        if (parent.kind == CsgKind::clipped) {
            if (!seen_through_clips(csg, parent, before, behind, solids)) return false;
        } else if (parent.kind != CsgKind::any) {
            const Side side = seen_among(csg, parent, at, before, behind, solids);
            if (side == Side::no) return false;
            if (side == Side::border &&
                csg_contains(csg, up, before, solids) == csg_contains(csg, up, behind, solids))
                return false;
        }
    }
    return true;
}

std::uint32_t csg_textured_item(const Csg& csg, std::uint32_t leaf, Vec3 p, const CsgInside& solids) {
    const std::uint32_t own = csg.nodes[leaf].item;
    if (!csg.nodes[leaf].bare) return own;
    std::uint32_t top = no_csg;
    for (std::uint32_t up = csg.nodes[leaf].parent; up != no_csg; up = csg.nodes[up].parent)
        if (csg.nodes[up].cutaway) top = up;
    const std::uint32_t found = top == no_csg ? no_csg : textured_leaf(csg, top, p, solids);
    return found == no_csg ? own : csg.nodes[found].item;
}

} // namespace pnr
