// SPDX-License-Identifier: GPL-3.0-or-later
// The traversal kernel, one source for all widths. Each kernel file includes it with its own instruction set;
// all of them give the same answers bit for bit, because the answer does not depend on the order in which
// boxes are met:
//
// - Whether a line meets a triangle is decided exactly. The edge functions of Woop, Benthin and Wald 2013, in
// float,
//   are a filter. Let u = 2^-24, S the largest |x| and |y| of the sheared corners, |o| of the origin, and Z
//   <= |o| + the largest coordinate of all triangles, so that |z| <= Z. Each sheared coordinate is off by
//   less than d = 4u(S + Z + |o|/2): the origin was rounded (u|o|), the corners were moved (u), the shear was
//   rounded, multiplied and subtracted (4u Z + 2u S). So an edge function, a difference of two products, is
//   off by less than 4 S d + 2 d^2 + 4u S^2 <= 5 d (S + d); 6 allows for the rounding of the bound itself.
//   Signs beyond it are certain. The others are computed once more in double, with the same bound for u =
//   2^-53 (times 4, for the second point that CGAL is given is rounded too); those still open are decided by
//   CGAL's exact predicate.
// - t comes from the triangle's plane in double. Of all hits in (t_min, t_max) the smallest t wins, of equal
// t the
//   smallest primitive.
// - A box is passed over only if it can hold no such hit. A slab's t is off by at most 4 roundings
// (subtraction,
//   direction, reciprocal, product), after the origin has been moved by the bound of its own rounding to
//   either side; so comparing with the far side times 1 + 10u is safe [Ize 2013, "Robust BVH ray traversal",
//   with 3 roundings]. t in double is clamped to the triangle's own box where its rounding could count.
// No fused multiply-add (-ffp-contract=off): it would round differently from path to path.
#pragma once

#include "core/bvh_kernel.h"
#include "core/bvh_lanes.h"
#include "core/exact.h"

namespace pnr {
namespace {

constexpr float unit = 0x1p-24f;
constexpr float widen = 1 + 12 * unit;

struct Query {
    const BvhView& bvh;
    const KernelRay& ray;
    const KernelCalls& calls;
    KernelHit& hit;
    // The ray in float.
    float near_origin[3], far_origin[3]; // moved against and along the ray's sense by the origin's rounding
    float inverse[3], far_inverse[3];    // the latter times `widen`
    int near_row[3], far_row[3];
    float t_min;
    float t_best; // at least hit.t, times `widen`
    // The shear that makes the ray the z axis [Woop et al. 2013].
    int x, y, z;
    float origin[3], shear_x, shear_y, scale;
    double precise_shear_x, precise_shear_y;
    float reach, slack; // Z + |o|/2 of the filter; the origin's rounding in units of t

    Query(const BvhView& b, const KernelRay& r, const KernelCalls& c, KernelHit& h);
    void found_t() { t_best = round_up(hit.t) * widen; } // t >= 0
    static float round_up(double t) {
        const float f = static_cast<float>(t);
        return static_cast<double>(f) < t ? f * (1 + 2 * unit) + 0x1p-126f : f;
    }
};

Query::Query(const BvhView& b, const KernelRay& r, const KernelCalls& c, KernelHit& h)
    : bvh(b), ray(r), calls(c), hit(h) {
    float largest = 0;
    for (int k = 0; k < 3; ++k) {
        const float o = static_cast<float>(r.origin[k]), d = static_cast<float>(r.direction[k]);
        const float size = __builtin_fabsf(o);
        largest = size > largest ? size : largest;
        // The floor keeps slabs right for directions that are almost, or quite, along them: over any t that
        // matters such a ray moves less than that across.
        const float moved = 2 * unit * size + 0x1p-50f;
        const bool backwards = d < 0;
        origin[k] = o;
        near_origin[k] = backwards ? o - moved : o + moved;
        far_origin[k] = backwards ? o + moved : o - moved;
        const float least = 0x1p-64f;
        inverse[k] = 1 / (__builtin_fabsf(d) < least ? (backwards ? -least : least) : d);
        far_inverse[k] = inverse[k] * widen;
        near_row[k] = backwards ? 3 + k : k;
        far_row[k] = backwards ? k : 3 + k;
    }
    const double ax = __builtin_fabs(r.direction[0]), ay = __builtin_fabs(r.direction[1]),
                 az = __builtin_fabs(r.direction[2]);
    z = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
    x = z == 2 ? 0 : z + 1;
    y = x == 2 ? 0 : x + 1;
    const double along = 1 / r.direction[z];
    precise_shear_x = r.direction[x] * along;
    precise_shear_y = r.direction[y] * along;
    shear_x = static_cast<float>(precise_shear_x);
    shear_y = static_cast<float>(precise_shear_y);
    scale = static_cast<float>(along);
    reach =
        (b.extent + 1.5f * largest) * (1 + 4 * unit) + 0x1p-26f; // the floor keeps the bound above underflow
    slack = (4 * unit * largest + 0x1p-50f) * __builtin_fabsf(scale);
    t_min = static_cast<float>(r.t_min);
    t_min = (t_min > 0 ? t_min * (1 - 2 * unit) : t_min * (1 + 2 * unit)) - 0x1p-126f;
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
    q.found_t();
    return true;
}

enum class Side { out, in, open };

// The filter once more, in double.
template <int B>
Side decide_in_double(const Query& q, const TriangleBlock<B>& block, int lane) {
    double v[3][2];
    double s = 0;
    for (int i = 0; i < 3; ++i) {
        const auto from_origin = [&](int axis) {
            return static_cast<double>(block.corner[i][axis][lane]) - q.ray.origin[axis];
        };
        const double z = from_origin(q.z);
        v[i][0] = from_origin(q.x) - q.precise_shear_x * z;
        v[i][1] = from_origin(q.y) - q.precise_shear_y * z;
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

// B triangles. True if a hit was taken.
template <int B>
bool meet_block(Query& q, const TriangleBlock<B>& block) {
    using Some = Lanes<B>;
    const Some ox = Some::all(q.origin[q.x]), oy = Some::all(q.origin[q.y]), oz = Some::all(q.origin[q.z]);
    const Some sx = Some::all(q.shear_x), sy = Some::all(q.shear_y);
    const auto corner = [&](int v, int axis) { return Some::load(block.corner[v][axis]); };
    const Some az = corner(0, q.z) - oz, bz = corner(1, q.z) - oz, cz = corner(2, q.z) - oz;
    const Some ax = corner(0, q.x) - ox - sx * az, ay = corner(0, q.y) - oy - sy * az;
    const Some bx = corner(1, q.x) - ox - sx * bz, by = corner(1, q.y) - oy - sy * bz;
    const Some cx = corner(2, q.x) - ox - sx * cz, cy = corner(2, q.y) - oy - sy * cz;
    const Some u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    const Some least = min(u, min(v, w)), most = max(u, max(v, w));
    const Some s = max(max(max(abs(ax), abs(ay)), max(abs(bx), abs(by))), max(abs(cx), abs(cy)));
    const Some d = Some::all(4 * unit) * (s + Some::all(q.reach));
    const Some bound = Some::all(6) * d * (s + d);
    const Some minus = Some::all(0) - bound;
    // Surely outside: an edge function surely below zero and another surely above.
    unsigned open = ~(less_equal(least, minus) & less_equal(bound, most)) & ((1u << B) - 1u);
    if (!open) return false;
    // Surely before or behind: t lies between those of the corners.
    const Some scale = Some::all(q.scale), ta = az * scale, tb = bz * scale, tc = cz * scale;
    open &= less_equal(min(ta, min(tb, tc)), Some::all(q.t_best + q.slack));
    open &= less_equal(Some::all(q.t_min), max(ta, max(tb, tc)) * Some::all(widen) + Some::all(q.slack));
    if (!open) return false;
    const unsigned sure = less_equal(bound, least) | less_equal(most, minus);
    bool taken = false;
    for (; open; open &= open - 1) {
        const int lane = __builtin_ctz(open);
        if ((sure >> lane & 1u) || decide(q, block, lane)) taken |= take(q, block, lane);
    }
    return taken;
}

struct Waiting {
    std::uint32_t node;
    float t;
};

// The nearest child first; the others wait on the stack, farthest deepest.
template <int W>
std::uint32_t enter_children(const WideNode<W>& node, unsigned met, const float* t, Waiting*& top) {
    int first = __builtin_ctz(met);
    met &= met - 1;
    if (!met) return node.child[first];
    int second = __builtin_ctz(met);
    met &= met - 1;
    if (!met) {
        if (t[second] < t[first]) {
            const int swap = first;
            first = second;
            second = swap;
        }
        *top++ = {node.child[second], t[second]};
        return node.child[first];
    }
    Waiting* const bottom = top;
    const auto insert = [&](int child) {
        const Waiting waiting{node.child[child], t[child]};
        Waiting* at = top++;
        for (; at > bottom && at[-1].t < waiting.t; --at) *at = at[-1];
        *at = waiting;
    };
    insert(first);
    insert(second);
    for (; met; met &= met - 1) insert(__builtin_ctz(met));
    return (--top)->node;
}

void fetch(const char* place) {
    for (std::size_t line = 0; line < 4; ++line) __builtin_prefetch(place + line * line_size);
}

template <int W, int B, bool any>
void traverse(Query& q) {
    using Wide = Lanes<W>;
    const char* const tree = q.bvh.tree;
    const Wide nx = Wide::all(q.near_origin[0]), ny = Wide::all(q.near_origin[1]),
               nz = Wide::all(q.near_origin[2]);
    const Wide fx = Wide::all(q.far_origin[0]), fy = Wide::all(q.far_origin[1]),
               fz = Wide::all(q.far_origin[2]);
    const Wide ix = Wide::all(q.inverse[0]), iy = Wide::all(q.inverse[1]), iz = Wide::all(q.inverse[2]);
    const Wide jx = Wide::all(q.far_inverse[0]), jy = Wide::all(q.far_inverse[1]),
               jz = Wide::all(q.far_inverse[2]);
    const Wide from = Wide::all(q.t_min);
    Waiting stack[bvh_max_depth * (W - 1) + W];
    Waiting* top = stack;
    std::uint32_t at = q.bvh.root;
    for (;;) {
        if (!(at & leaf_bit)) {
            const auto& node = *reinterpret_cast<const WideNode<W>*>(tree + at * line_size);
            const Wide x0 = (Wide::load(node.bound[q.near_row[0]]) - nx) * ix,
                       y0 = (Wide::load(node.bound[q.near_row[1]]) - ny) * iy,
                       z0 = (Wide::load(node.bound[q.near_row[2]]) - nz) * iz;
            const Wide x1 = (Wide::load(node.bound[q.far_row[0]]) - fx) * jx,
                       y1 = (Wide::load(node.bound[q.far_row[1]]) - fy) * jy,
                       z1 = (Wide::load(node.bound[q.far_row[2]]) - fz) * jz;
            const Wide enter = max(max(x0, y0), max(z0, from));
            const Wide leave = min(min(x1, y1), min(z1, Wide::all(q.t_best)));
            unsigned met = less_equal(enter, leave);
            if (met) {
                // What is met next is seldom at hand already.
                for (unsigned others = met & (met - 1); others; others &= others - 1)
                    fetch(tree + (node.child[__builtin_ctz(others)] & index_mask) * line_size);
                if (any) { // in no order: whatever blocks the ray will do
                    at = node.child[__builtin_ctz(met)];
                    for (met &= met - 1; met; met &= met - 1)
                        *top++ = {node.child[__builtin_ctz(met)], q.t_min};
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
        } else if (meet_block(
                       q, *reinterpret_cast<const TriangleBlock<B>*>(tree + (at & index_mask) * line_size)) &&
                   any) {
            return;
        }
        do {
            if (top == stack) return;
            --top;
        } while (top->t > q.t_best);
        at = top->node;
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
