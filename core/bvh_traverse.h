// SPDX-License-Identifier: GPL-3.0-or-later
// The traversal kernel, one source for all widths. Each kernel file includes it with its own instruction set;
// all of them give the same answers bit for bit, because the answer does not depend on the order in which
// boxes are met:
//
// - Whether a line meets a triangle is decided exactly. The edge functions of Woop, Benthin and Wald 2013, in
//   float, are a filter. Let u = 2^-24, S the largest |x| and |y| of the sheared corners, |o| of the origin,
//   and Z <= |o| + the largest coordinate of all boxes, so that |z| <= Z. Each sheared coordinate is off by
//   less than d = 7u(S + Z + |o|/2): the origin was rounded (2u|o|, once for z), the corner moved (u(S + Z)
//   and uZ), the shear made of a rounded direction and its rounded reciprocal (4uZ), multiplied (uZ) and
//   subtracted (uS). So an edge function, a difference of two products, is off by less than 4 S d + 2 d^2 +
//   4u S^2 <= 5 d (S + d); 6 allows for the rounding of the bound itself. Signs beyond it are certain. The
//   others are computed once more in double, with the same bound for u = 2^-53 (times 4, for the second point
//   that CGAL is given is rounded too); those still open are decided by CGAL's exact predicate.
// - t comes from the triangle's plane in double. Of all hits in (t_min, t_max) the smallest t wins, of equal
//   t the smallest primitive.
// - A box is passed over only if it can hold no such hit. A slab at b has t = (b - o) / d; computed is b i -
// c
//   with i = 1/d and c = o' i, o' being the origin moved by m to one side. Whether or not the product is
//   fused with the difference, and c being rounded, that equals (b - o'') i with |o'' - o'| <= u|b| + u|o'|.
//   The origin itself was rounded (u|o|) and so was o' (u|o'|): m = 4u|o| + 2u max|b| keeps o'' on its side
//   of o, so that what is left are relative errors, of the direction, the reciprocal and the last operation
//   (3u). They are allowed for at the far side, as there is no saying which way the near one goes: t_far (1 +
//   12u)
//   >= t_near for every box that is met [Ize 2013, "Robust BVH ray traversal"]. The same factor on t_best
//   covers its rounding. m has a floor, and directions another, so that a ray along a slab, of either zero,
//   neither overflows nor misses: over any t that matters it moves less than m across. t in double is clamped
//   to the triangle's own box where its rounding could count.
// No product of an edge test is fused with a sum (-ffp-contract=off): the filter's bound does not count with
// it. In the box tests it may be: they only pass over what holds no hit.
#pragma once

#include "core/bvh_kernel.h"
#include "core/bvh_lanes.h"
#include "core/exact.h"

#include <cstddef>

namespace pnr {
namespace {

constexpr float unit = 0x1p-24f;
constexpr float widen = 1 + 12 * unit;

struct Query {
    const BvhView& bvh;
    const KernelRay& ray;
    const KernelCalls& calls;
    KernelHit& hit;
    // The ray in float, axis by axis: a slab at b is entered at b times `inverse` minus `near`, and left at b
    // times `far_inverse` minus `far`.
    alignas(16) float origin[4], direction[4], inverse[4], near[4], far_inverse[4], far[4];
    int near_row[3], far_row[3];
    float t_min, t_after, t_before; // less than t_min; more than that, and less than t_max
    float t_best;                   // at least hit.t, times `widen`
    // The shear that makes the ray the z axis [Woop et al. 2013].
    int x, y, z;
    float shear_x, shear_y, scale;
    float reach, slack; // Z + |o|/2 of the filter; the origin's rounding in units of t

    Query(const BvhView& b, const KernelRay& r, const KernelCalls& c, KernelHit& h);
    void found_t() { t_best = static_cast<float>(hit.t) * widen + 0x1p-126f; } // t >= 0
};

// No branches: the signs of rays are as good as random.
inline Query::Query(const BvhView& b, const KernelRay& r, const KernelCalls& c, KernelHit& h)
    : bvh(b), ray(r), calls(c), hit(h) {
    static_assert(offsetof(KernelRay, t_min) == 3 * sizeof(double));
    using Four = Lanes<4>;
    const Four o = Four::rounded(r.origin), d = Four::rounded(r.direction);
    const Four size = abs(o), along = abs(d);
    const Four moved = copy_sign(size * Four::all(4 * unit) + Four::all(2 * unit * b.extent + 0x1p-50f), d);
    const Four inv = Four::all(1) / copy_sign(max(min(along, Four::all(2)), Four::all(0x1p-64f)), d);
    const Four far_inv = inv * Four::all(widen);
    o.store(origin);
    d.store(direction);
    inv.store(inverse);
    far_inv.store(far_inverse);
    ((o + moved) * inv).store(near);
    ((o - moved) * far_inv).store(far);
    const int signs = static_cast<int>(negative(d));
    for (int k = 0; k < 3; ++k) {
        near_row[k] = k + 3 * (signs >> k & 1);
        far_row[k] = 3 + 2 * k - near_row[k];
    }
    static constexpr std::uint8_t longest[8] = {0, 0, 1, 0, 2, 2, 1, 0}; // by y <= x, z <= y, x <= z
    z = longest[less_equal(turned(along), along) & 7u];
    x = (1 << z) & 3; // z + 1
    y = (1 << x) & 3;
    scale = inverse[z];
    shear_x = direction[x] * scale;
    shear_y = direction[y] * scale;
    alignas(16) float most[4];
    max(max(size, turned(size)), turned(turned(size))).store(most);
    const float largest = most[0];
    reach =
        (b.extent + 1.5f * largest) * (1 + 4 * unit) + 0x1p-26f; // the floor keeps the bound above underflow
    slack = (4 * unit * largest + 0x1p-50f) * __builtin_fabsf(scale);
    const float rounding = __builtin_fabsf(origin[3]) * 2 * unit + 0x1p-126f;
    t_min = origin[3] - rounding;
    t_after = origin[3] + rounding;
    t_before = direction[3] * (1 - 2 * unit);
    found_t();
}

// t of the hit with the triangle's plane, given that the line meets the triangle; its true value lies in the
// triangle's box, so that is where rounding may not carry it out of.
double plane_t(const KernelRay& ray, const double (&a)[3], const double (&b)[3], const double (&c)[3]) {
    const double e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]},
                 f[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const double n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    const double* d = ray.direction;
    const double* o = ray.origin;
    const double slope = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
    const double height = n[0] * (a[0] - o[0]) + n[1] * (a[1] - o[1]) + n[2] * (a[2] - o[2]);
    const double t = height / slope;
    const auto size = [](const double(&v)[3]) {
        return __builtin_fabs(v[0]) + __builtin_fabs(v[1]) + __builtin_fabs(v[2]);
    };
    if (__builtin_fabs(slope) > 0x1p-20 * size(e) * size(f)) return t; // then t is right to some 2^-30
    double low = -__builtin_inf(), high = __builtin_inf();
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0) continue;
        const double ta = (a[k] - o[k]) / d[k], tb = (b[k] - o[k]) / d[k], tc = (c[k] - o[k]) / d[k];
        const double least = ta < tb ? (ta < tc ? ta : tc) : (tb < tc ? tb : tc);
        const double most = ta > tb ? (ta > tc ? ta : tc) : (tb > tc ? tb : tc);
        low = least > low ? least : low;
        high = most < high ? most : high;
    }
    if (!(t >= low)) return low;
    return t <= high || high < low ? t : high;
}

// Takes the lane's triangle, which the line meets, if its t is the best so far.
template <int B>
bool take(Query& q, const TriangleBlock<B>& block, int lane) {
    const std::uint32_t number = block.triangle[lane];
    double corner[3][3];
    for (int v = 0; v < 3; ++v)
        for (int k = 0; k < 3; ++k) corner[v][k] = static_cast<double>(block.corner[v][k][lane]);
    const double t = plane_t(q.ray, corner[0], corner[1], corner[2]);
    if (!(t > q.ray.t_min && t < q.ray.t_max)) return false;
    if (!(t < q.hit.t || (t == q.hit.t && number < q.hit.primitive))) return false;
    if (q.calls.sees && !q.calls.sees(q.calls.context, number, t)) return false;
    q.hit.t = t;
    q.hit.primitive = q.hit.triangle = number;
    q.hit.corners = &block.corner[0][0][lane];
    q.found_t();
    return true;
}

enum class Side { out, in, open };

// The filter once more, in double.
template <int B>
Side decide_in_double(const Query& q, const TriangleBlock<B>& block, int lane) {
    double v[3][2];
    const double* d3 = q.ray.direction;
    const double shear_x = d3[q.x] / d3[q.z], shear_y = d3[q.y] / d3[q.z];
    double s = 0;
    for (int i = 0; i < 3; ++i) {
        const auto from_origin = [&](int axis) {
            return static_cast<double>(block.corner[i][axis][lane]) - q.ray.origin[axis];
        };
        const double z = from_origin(q.z);
        v[i][0] = from_origin(q.x) - shear_x * z;
        v[i][1] = from_origin(q.y) - shear_y * z;
        for (const double c : v[i]) s = __builtin_fabs(c) > s ? __builtin_fabs(c) : s;
    }
    const double d = 16 * 0x1p-53 * (s + static_cast<double>(q.reach)), bound = 6 * d * (s + d);
    const auto edge = [&](int i, int k) { return v[i][0] * v[k][1] - v[i][1] * v[k][0]; };
    const double e[3] = {edge(2, 1), edge(0, 2), edge(1, 0)};
    int above = 0, below = 0;
    for (const double x : e) {
        above += x > bound;
        below += x < -bound;
    }
    if (above > 0 && below > 0) return Side::out;
    return above == 3 || below == 3 ? Side::in : Side::open;
}

template <int B>
bool decide(const Query& q, const TriangleBlock<B>& block, int lane) {
    const Side side = decide_in_double(q, block, lane);
    if (side != Side::open) return side == Side::in;
    // Any second point of the line will do; one about as far off as the origin keeps the direction's digits.
    const double second[3] = {q.ray.origin[0] + 8 * q.ray.direction[0],
                              q.ray.origin[1] + 8 * q.ray.direction[1],
                              q.ray.origin[2] + 8 * q.ray.direction[2]};
    return q.bvh.triangles->meets_line(block.triangle[lane], q.ray.origin, second);
}

// Which of a block's triangles the line may meet at a t that is wanted; of those, which it surely meets, and
// at which of them t surely lies within the query's limits.
struct Met {
    unsigned open, sure, between;
};

// What is constant for a ray's way through all blocks.
template <int B>
struct Sheared {
    using Some = Lanes<B>;
    int x, y, z; // rows
    Some ox, oy, oz, sx, sy;
    explicit Sheared(const Query& q)
        : x(q.x), y(q.y), z(q.z), ox(Some::all(q.origin[q.x])), oy(Some::all(q.origin[q.y])),
          oz(Some::all(q.origin[q.z])), sx(Some::all(q.shear_x)), sy(Some::all(q.shear_y)) {}
};

template <int B>
[[gnu::always_inline]] inline Met meet_block(const Query& q, const Sheared<B>& r,
                                             const TriangleBlock<B>& block) {
    using Some = Lanes<B>;
    const auto corner = [&](int v, int axis) { return Some::load(block.corner[v][axis]); };
    const Some az = corner(0, r.z) - r.oz, bz = corner(1, r.z) - r.oz, cz = corner(2, r.z) - r.oz;
    const Some ax = corner(0, r.x) - r.ox - r.sx * az, ay = corner(0, r.y) - r.oy - r.sy * az;
    const Some bx = corner(1, r.x) - r.ox - r.sx * bz, by = corner(1, r.y) - r.oy - r.sy * bz;
    const Some cx = corner(2, r.x) - r.ox - r.sx * cz, cy = corner(2, r.y) - r.oy - r.sy * cz;
    const Some u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    const Some least = min(u, min(v, w)), most = max(u, max(v, w));
    const Some s = max(max(max(abs(ax), abs(ay)), max(abs(bx), abs(by))), max(abs(cx), abs(cy)));
    const Some d = Some::all(7 * unit) * (s + Some::all(q.reach));
    const Some bound = Some::all(6) * d * (s + d);
    const Some minus = Some::all(0) - bound;
    // Surely outside: an edge function surely below zero and another surely above.
    unsigned open = ~(less_equal(least, minus) & less_equal(bound, most)) & ((1u << B) - 1u);
    if (!open) return {0, 0, 0};
    // Surely before or behind: t lies between those of the corners, which are off by 4u and the slack.
    const Some scale = Some::all(q.scale), ta = az * scale, tb = bz * scale, tc = cz * scale;
    const Some slack = Some::all(q.slack), first = min(ta, min(tb, tc)), last = max(ta, max(tb, tc));
    const Some latest = last * Some::all(widen) + slack;
    open &= less_equal(first, Some::all(q.t_best) + slack);
    open &= less_equal(Some::all(q.t_min), latest);
    if (!open) return {0, 0, 0};
    const Some earliest = first * Some::all(1 - 12 * unit) - slack;
    return {open, less_equal(bound, least) | less_equal(most, minus),
            less_equal(Some::all(q.t_after), earliest) & less_equal(latest, Some::all(q.t_before))};
}

// Takes the triangles that are met. Seldom needed, so kept out of the way's code. True if one was taken.
template <int B>
[[gnu::noinline]] bool take_met(Query& q, const TriangleBlock<B>& block, const Met& met) {
    bool taken = false;
    for (unsigned open = met.open; open; open &= open - 1) {
        const int lane = __builtin_ctz(open);
        if (block.triangle[lane] == no_primitive) break; // and so are those behind
        if ((met.sure >> lane & 1u) || decide(q, block, lane)) taken |= take(q, block, lane);
    }
    return taken;
}

// The same where any hit will do: then t need not be known where it surely lies within the limits.
template <int B>
bool take_any(Query& q, const TriangleBlock<B>& block, const Met& met) {
    if ((met.open & met.sure & met.between) && !q.calls.sees) {
        q.hit.primitive = block.triangle[0]; // any; lanes left over repeat the first
        return true;
    }
    return take_met(q, block, met);
}

// A child to come back to, and above it in the same number where the ray enters it: such numbers sort by
// distance (t_min >= 0, give or take 2^-126).
using Waiting = std::int64_t;

inline Waiting waiting(std::uint32_t node, float t) {
    std::uint32_t bits;
    __builtin_memcpy(&bits, &t, sizeof bits);
    return static_cast<Waiting>(std::uint64_t{bits} << 32 | node);
}

// The nearest child first; the others wait on the stack, farthest deepest. Which is nearer is as good as
// random, so up to four are sorted without branches. Leaving all but the nearest unsorted is not worth its
// saving: 2 to 12 % more nodes are met on scanned meshes, 15 to 45 % on slivers.
template <int W>
[[gnu::always_inline]] inline std::uint32_t enter_children(const WideNode<W>& node, unsigned met,
                                                           const float* t, Waiting*& top) {
    const auto next = [&] {
        const int i = __builtin_ctz(met);
        met &= met - 1;
        return waiting(node.child[i], t[i]);
    };
    const auto sort = [](Waiting& x, Waiting& y) { // the nearer one to y
        const Waiting far = x > y ? x : y, near = x > y ? y : x;
        x = far, y = near;
    };
    Waiting a = next(), b = next();
    sort(a, b);
    if (!met) {
        *top++ = a;
        return static_cast<std::uint32_t>(b);
    }
    Waiting c = next();
    if (!met) {
        sort(a, c), sort(b, c);
        top[0] = a, top[1] = b;
        top += 2;
        return static_cast<std::uint32_t>(c);
    }
    Waiting d = next();
    sort(c, d), sort(a, c), sort(b, d), sort(b, c);
    Waiting* const bottom = top;
    top[0] = a, top[1] = b, top[2] = c, top[3] = d;
    for (top += 4; met; ++top) {
        const Waiting e = next();
        Waiting* at = top;
        for (; at > bottom && at[-1] < e; --at) *at = at[-1];
        *at = e;
    }
    return static_cast<std::uint32_t>(*--top);
}

void fetch(const char* place) {
    for (std::size_t line = 0; line < 4; ++line) __builtin_prefetch(place + line * line_size);
}

template <int W, int B, bool any>
void traverse(Query& q) {
    using Wide = Lanes<W>;
    const char* const tree = q.bvh.tree;
    const Wide nx = Wide::all(q.near[0]), ny = Wide::all(q.near[1]), nz = Wide::all(q.near[2]);
    const Wide fx = Wide::all(q.far[0]), fy = Wide::all(q.far[1]), fz = Wide::all(q.far[2]);
    const Wide ix = Wide::all(q.inverse[0]), iy = Wide::all(q.inverse[1]), iz = Wide::all(q.inverse[2]);
    const Wide jx = Wide::all(q.far_inverse[0]), jy = Wide::all(q.far_inverse[1]),
               jz = Wide::all(q.far_inverse[2]);
    const Wide from = Wide::all(q.t_min);
    const int near_x = q.near_row[0], near_y = q.near_row[1], near_z = q.near_row[2];
    const int far_x = q.far_row[0], far_y = q.far_row[1], far_z = q.far_row[2];
    const Sheared<B> sheared(q);
    Waiting stack[bvh_max_depth * (W - 1) + W];
    Waiting* top = stack;
    std::uint32_t at = q.bvh.root;
    for (;;) {
        if (!(at & leaf_bit)) {
            const auto& node = *reinterpret_cast<const WideNode<W>*>(tree + at * line_size);
            const Wide x0 = multiply_subtract(Wide::load(node.bound[near_x]), ix, nx),
                       y0 = multiply_subtract(Wide::load(node.bound[near_y]), iy, ny),
                       z0 = multiply_subtract(Wide::load(node.bound[near_z]), iz, nz);
            const Wide x1 = multiply_subtract(Wide::load(node.bound[far_x]), jx, fx),
                       y1 = multiply_subtract(Wide::load(node.bound[far_y]), jy, fy),
                       z1 = multiply_subtract(Wide::load(node.bound[far_z]), jz, fz);
            const Wide enter = max(max(x0, y0), max(z0, from));
            const Wide leave = min(min(x1, y1), min(z1, Wide::all(q.t_best)));
            unsigned met = less_equal(enter, leave);
            if (met) {
                // What is met next is seldom at hand already: without this, rays in no order take up to 15 %
                // longer.
                for (unsigned others = met & (met - 1); others; others &= others - 1)
                    fetch(tree + (node.child[__builtin_ctz(others)] & index_mask) * line_size);
                if (any) { // in no order: whatever blocks the ray will do
                    at = node.child[__builtin_ctz(met)];
                    for (met &= met - 1; met; met &= met - 1) *top++ = node.child[__builtin_ctz(met)];
                    continue;
                }
                if (!(met & (met - 1))) {
                    at = node.child[__builtin_ctz(met)];
                    continue;
                }
                alignas(64) float t[W];
                enter.store(t);
                at = enter_children<W>(node, met, t, top);
                continue;
            }
        } else if (at & other_bit) {
            if (q.calls.meets(q.calls.context, at & index_mask, q.ray, q.hit)) {
                if (any) return;
                q.found_t();
            }
        } else {
            const auto& block =
                *reinterpret_cast<const TriangleBlock<B>*>(tree + (at & index_mask) * line_size);
            const Met met = meet_block(q, sheared, block);
            if (met.open && (any ? take_any(q, block, met) : take_met(q, block, met)) && any) return;
        }
        do {
            if (top == stack) return;
            --top;
        } while (!any && *top > waiting(0xffffffffu, q.t_best));
        at = static_cast<std::uint32_t>(*top);
    }
}

template <int W, int B>
void closest(const BvhView& bvh, const KernelRay& ray, const KernelCalls& calls, KernelHit& hit) {
    Query query(bvh, ray, calls, hit);
    traverse<W, B, false>(query);
}

template <int W, int B>
bool occluded(const BvhView& bvh, const KernelRay& ray, const KernelCalls& calls) {
    KernelHit hit;
    hit.t = ray.t_max;
    Query query(bvh, ray, calls, hit);
    traverse<W, B, true>(query);
    return hit.primitive != no_primitive;
}

} // namespace
} // namespace pnr
