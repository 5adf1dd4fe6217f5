// SPDX-License-Identifier: GPL-3.0-or-later
#include "library_file.h"

#include "core/bvh.h"

#include "bvh_oracle.h"
#include "core/mesh_io.h"
#include "core/parallel.h"
#include "core/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace pnr {
namespace {

using Triangles = std::vector<float>; // nine a triangle

void add_triangle(Triangles& out, Vec3f a, Vec3f b, Vec3f c) {
    for (const Vec3f& p : {a, b, c})
        for (int k = 0; k < 3; ++k) out.push_back(p[k]);
}

Vec3f random_point(Rng& rng, double size) {
    return Vec3f(size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1));
}

// A closed sphere whose triangles become slivers at the poles.
Triangles sphere(int rows, int columns) {
    const auto at = [&](int row, int column) {
        const double a = pi * row / rows, b = 2 * pi * (column % columns) / columns;
        if (row == 0) return Vec3f(0, 0.75f, 0);
        if (row == rows) return Vec3f(0, -0.75f, 0);
        return Vec3f(0.75 * Vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
    };
    Triangles out;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            if (row > 0) add_triangle(out, at(row, column), at(row, column + 1), at(row + 1, column + 1));
            if (row + 1 < rows)
                add_triangle(out, at(row, column), at(row + 1, column + 1), at(row + 1, column));
        }
    return out;
}

// Everything that breaks trees and tests: huge beside tiny, slivers, repeated and flipped faces, no area at
// all.
Triangles rubble() {
    Triangles out;
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < 400; ++i) {
        const Vec3f p = random_point(rng, 0.8);
        const double size = std::pow(10.0, -5 * rng.uniform());
        const Vec3f a = p + random_point(rng, 0.2 * size), b = p + random_point(rng, 0.2 * size);
        add_triangle(out, p, a, b);
        if (i % 4 == 0) add_triangle(out, a, b, p); // the same face again, begun elsewhere
        if (i % 5 == 0) add_triangle(out, p, b, a);
        if (i % 3 == 0) add_triangle(out, p, a, a + random_point(rng, 1e-6)); // sliver
        if (i % 7 == 0) add_triangle(out, p, p, a);
        if (i % 11 == 0) add_triangle(out, p, 0.5f * (p + a), a); // collinear, or nearly
    }
    add_triangle(out, {-1, -1, 0.5f}, {1, -1, 0.5f}, {1, 1, 0.5f}); // a wall, and one in the same plane
    add_triangle(out, {-1, -1, 0.5f}, {1, 1, 0.5f}, {-1, 1, 0.5f});
    add_triangle(out, {-1, -1, 0.5f}, {1, -1, 0.5f}, {1, 1, 0.5f});
    for (int i = 0; i < 40; ++i) add_triangle(out, {0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}); // all at one place
    return out;
}

// A grid of squares in three planes: rays along the axes meet it in edges and corners.
Triangles lattice() {
    Triangles out;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = -4; i < 4; ++i)
            for (int j = -4; j < 4; ++j) {
                const auto at = [&](int a, int b) {
                    Vec3f p(0);
                    p[(axis + 1) % 3] = static_cast<float>(a) / 8;
                    p[(axis + 2) % 3] = static_cast<float>(b) / 8;
                    return p;
                };
                add_triangle(out, at(i, j), at(i + 1, j), at(i + 1, j + 1));
                add_triangle(out, at(i, j), at(i + 1, j + 1), at(i, j + 1));
            }
    return out;
}

Vec3f corner(const Triangles& t, std::size_t triangle, std::size_t v) {
    return {t[9 * triangle + 3 * v], t[9 * triangle + 3 * v + 1], t[9 * triangle + 3 * v + 2]};
}

KernelRay kernel_ray(Vec3f origin, Vec3f direction, double t_min = 0, double t_max = infinity) {
    KernelRay ray{};
    const float largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    const float scale = std::ldexp(1.0f, -std::ilogb(largest));
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = static_cast<double>(origin[k]);
        ray.direction[k] = static_cast<double>(direction[k] * scale);
    }
    ray.t_min = t_min, ray.t_max = t_max;
    return ray;
}

// Rays at random, at corners and at the middles of edges, along axes; with both zeros. Origins and directions
// are float, so that origin + 8 direction is exact and the oracle's line is the kernel's.
std::vector<KernelRay> rays_at(const Triangles& triangles, int count) {
    std::vector<KernelRay> rays;
    Rng rng = make_rng(2, Pass::test, 0);
    const std::size_t n = triangles.size() / 9;
    for (int i = 0; i < count; ++i) {
        const std::size_t t = rng.bits() % n, v = rng.bits() % 3;
        const Vec3f a = corner(triangles, t, v), b = corner(triangles, t, (v + 1) % 3);
        const Vec3f target = i % 4 == 0   ? a
                             : i % 4 == 1 ? 0.5f * (a + b)
                             : i % 4 == 2 ? 0.3f * a + 0.7f * b
                                          : random_point(rng, 1);
        Vec3f origin = random_point(rng, i % 3 ? 2 : 0.5), direction = target - origin;
        if (i % 5 == 0) {
            const int axis = static_cast<int>(rng.bits() % 3);
            origin = target;
            origin[axis] -= 2;
            direction = i % 2 ? Vec3f(0) : -Vec3f(0);
            direction[axis] = 1;
        }
        if (i % 13 == 0) direction[static_cast<int>(rng.bits() % 3)] = i % 2 ? 0.0f : -0.0f;
        if (i % 17 == 0) origin = a; // starts on a surface
        if (direction == Vec3f(0)) continue;
        const double t_max = i % 6 == 0 ? 0.5 + rng.uniform() : infinity;
        rays.push_back(kernel_ray(origin, direction, i % 10 == 0 ? 0.25 * rng.uniform() : 0, t_max));
    }
    return rays;
}

KernelHit trace(const Bvh& bvh, const KernelRay& ray) {
    KernelHit hit;
    hit.t = ray.t_max;
    closest(bvh, ray, {}, hit);
    return hit;
}

long double plane_distance(const Triangles& triangles, std::uint32_t number, const KernelRay& ray) {
    using V = glm::vec<3, long double>;
    const auto p = [&](std::size_t v) { return V(corner(triangles, number, v)); };
    const V n = glm::cross(p(1) - p(0), p(2) - p(0));
    const V o(ray.origin[0], ray.origin[1], ray.origin[2]),
        d(ray.direction[0], ray.direction[1], ray.direction[2]);
    return glm::dot(n, p(0) - o) / glm::dot(n, d);
}

// The closest of a set of triangles that a ray's line meets, by t in long double; a tie within its rounding
// is any of them.
void expect_closest(const Triangles& triangles, const std::vector<std::uint32_t>& met, const KernelRay& ray,
                    const KernelHit& hit) {
    long double best = infinity;
    bool at_border = false; // a triangle whose t cannot be told from t_min or t_max
    for (const std::uint32_t number : met) {
        const long double t = plane_distance(triangles, number, ray);
        at_border |= !(std::abs(t - static_cast<long double>(ray.t_min)) > 1e-9L) ||
                     !(std::abs(t - static_cast<long double>(ray.t_max)) > 1e-9L);
        if (t > static_cast<long double>(ray.t_min) && t < static_cast<long double>(ray.t_max))
            best = std::min(best, t);
    }
    if (at_border) return;
    ASSERT_EQ(hit.primitive != no_primitive, std::isfinite(best));
    if (hit.primitive == no_primitive) return;
    EXPECT_NEAR(hit.t, static_cast<double>(best), 1e-9);
    EXPECT_TRUE(std::find(met.begin(), met.end(), hit.primitive) != met.end());
}

struct Case {
    const char* name;
    Triangles triangles;
};
std::vector<Case> cases() {
    return {{"sphere", sphere(24, 48)}, {"rubble", rubble()}, {"lattice", lattice()}};
}

TEST(Bvh, FindsWhatBruteForceFinds) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const Bvh bvh = build_bvh(c.triangles, {}, best_kernel());
        for (const KernelRay& ray : rays_at(c.triangles, 3000)) {
            const double second[3] = {ray.origin[0] + 8 * ray.direction[0],
                                      ray.origin[1] + 8 * ray.direction[1],
                                      ray.origin[2] + 8 * ray.direction[2]};
            std::vector<std::uint32_t> met;
            for (std::uint32_t i = 0; i < c.triangles.size() / 9; ++i) {
                const Vec3 e(corner(c.triangles, i, 1) - corner(c.triangles, i, 0));
                const Vec3 f(corner(c.triangles, i, 2) - corner(c.triangles, i, 0));
                if (glm::cross(e, f) == Vec3(0)) continue;
                if (bvh.triangles->meets_line(i, ray.origin, second)) met.push_back(i);
            }
            expect_closest(c.triangles, met, ray, trace(bvh, ray));
            const KernelHit hit = trace(bvh, ray);
            EXPECT_EQ(occluded(bvh, ray, {}), hit.primitive != no_primitive);
            // Of equal t the lower number wins: a repeated face is never met under its second number.
            if (hit.primitive == no_primitive) continue;
            for (std::uint32_t i = 0; i < hit.primitive; ++i)
                EXPECT_FALSE(std::equal(&c.triangles[9 * i], &c.triangles[9 * i] + 9,
                                        &c.triangles[9 * hit.primitive]));
        }
    }
}

TEST(Bvh, AgreesWithCgalsTree) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const Bvh bvh = build_bvh(c.triangles, {}, best_kernel());
        const test::TreeOracle oracle(c.triangles);
        int compared = 0;
        for (const KernelRay& ray : rays_at(c.triangles, 3000)) {
            const double second[3] = {ray.origin[0] + 8 * ray.direction[0],
                                      ray.origin[1] + 8 * ray.direction[1],
                                      ray.origin[2] + 8 * ray.direction[2]};
            std::vector<std::uint32_t> met = oracle.met_by(ray.origin, second);
            // The kernel does not meet triangles in whose plane the ray lies; CGAL does.
            std::erase_if(met,
                          [&](std::uint32_t i) { return !bvh.triangles->meets_line(i, ray.origin, second); });
            expect_closest(c.triangles, met, ray, trace(bvh, ray));
            ++compared;
        }
        EXPECT_GT(compared, 2500);
    }
}

TEST(Bvh, AllWidthsGiveTheSameBits) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        std::vector<Bvh> trees;
        for (const BvhKernel* kernel : available_kernels())
            trees.push_back(build_bvh(c.triangles, {}, *kernel));
        for (const KernelRay& ray : rays_at(c.triangles, 20000)) {
            const KernelHit first = trace(trees[0], ray);
            for (const Bvh& tree : trees) {
                const KernelHit hit = trace(tree, ray);
                EXPECT_EQ(hit.primitive, first.primitive) << tree.kernel->name;
                EXPECT_EQ(hit.t, first.t) << tree.kernel->name;
                EXPECT_EQ(occluded(tree, ray, {}), first.primitive != no_primitive) << tree.kernel->name;
            }
        }
    }
}

// From inside a closed mesh every ray meets it, also those aimed at its corners and edges.
int count_leaks(const Triangles& triangles, Vec3f inside, int count) {
    const Bvh bvh = build_bvh(triangles, {}, best_kernel());
    Rng rng = make_rng(3, Pass::test, 0);
    int leaks = 0;
    for (int i = 0; i < count; ++i) {
        const std::size_t t = rng.bits() % (triangles.size() / 9), v = rng.bits() % 3;
        const Vec3f a = corner(triangles, t, v), b = corner(triangles, t, (v + 1) % 3);
        leaks +=
            trace(bvh, kernel_ray(inside, (i % 2 ? a : 0.5f * (a + b)) - inside)).primitive == no_primitive;
    }
    return leaks;
}

TEST(Bvh, ClosedSphereDoesNotLeak) {
    EXPECT_EQ(count_leaks(sphere(64, 300), {0.1f, 0.2f, -0.15f}, 200000), 0);
    EXPECT_EQ(count_leaks(sphere(4, 1000), {0.01f, 0.02f, -0.03f}, 100000), 0) << "long slivers";
}

class LibraryMesh : public testing::TestWithParam<const char*> {};

TEST_P(LibraryMesh, DoesNotLeak) {
    const std::string name = std::string(GetParam()) + ".ply";
    const auto file = library_file(name);
    if (file.empty()) GTEST_SKIP() << "skipped: no " << name;
    const MeshData mesh = read_mesh(file, {});
    Bounds box;
    for (const Vec3f& p : mesh.positions) box = merge(box, Vec3(p));
    const Vec3 center = 0.5 * (box.low + box.high);
    const double size = glm::length(box.high - box.low);
    Triangles triangles;
    for (const auto& t : mesh.triangles)
        add_triangle(triangles, Vec3f((Vec3(mesh.positions[t[0]]) - center) / size),
                     Vec3f((Vec3(mesh.positions[t[1]]) - center) / size),
                     Vec3f((Vec3(mesh.positions[t[2]]) - center) / size));
    // A place inside: there every ray leaves through the surface an odd number of times, as CGAL's tree
    // counts it.
    const test::TreeOracle oracle(triangles);
    Rng rng = make_rng(4, Pass::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f p = random_point(rng, 0.3);
        const double from[3] = {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
        const double to[3] = {from[0] + 0.4, from[1] + 0.7, from[2] - 0.3};
        if (oracle.met_by(from, to).size() % 2 == 0) continue;
        EXPECT_EQ(count_leaks(triangles, p, 50000), 0);
        return;
    }
    FAIL() << "no place inside was found";
}
INSTANTIATE_TEST_SUITE_P(Closed, LibraryMesh, testing::Values("bunny_closed_59664", "slivers_21004"),
                         [](const auto& param) { return std::string(param.param); });

struct Asked {
    std::vector<int> times; // by triangle
};
bool refuse(const void* context, std::uint32_t triangle, double) {
    ++static_cast<Asked*>(const_cast<void*>(context))->times[triangle];
    return false; // and go on
}

// The callback sees every triangle on the line, each once: also those of blocks that are not full. That is
// how insides are counted.
TEST(Bvh, EachTriangleOnTheWayIsAskedAboutOnce) {
    for (const BvhKernel* kernel : available_kernels())
        for (std::size_t n = 1; n <= 20; ++n) {
            Triangles stack;
            for (std::size_t i = 0; i < n; ++i) {
                const float z = static_cast<float>(i) / 32;
                add_triangle(stack, {-1, -1, z}, {1, -1, z}, {0, 1, z});
            }
            const Bvh bvh = build_bvh(stack, {}, *kernel);
            const KernelRay ray = kernel_ray({0, -0.25f, -1}, {0.01f, 0, 1});
            for (const bool any : {false, true}) {
                Asked asked{std::vector<int>(n)};
                const KernelCalls calls{&asked, nullptr, &refuse};
                KernelHit hit;
                hit.t = infinity;
                if (any)
                    EXPECT_FALSE(occluded(bvh, ray, calls));
                else
                    closest(bvh, ray, calls, hit);
                EXPECT_EQ(hit.primitive, no_primitive);
                EXPECT_EQ(asked.times, std::vector<int>(n, 1)) << kernel->name << ' ' << n;
            }
        }
}

// A hit lies in (t_min, t_max) or it does not, to the last bit: any hit agrees with the closest one.
TEST(Bvh, LimitsAreExact) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        for (const BvhKernel* kernel : available_kernels()) {
            const Bvh bvh = build_bvh(c.triangles, {}, *kernel);
            int hits = 0;
            for (KernelRay ray : rays_at(c.triangles, 2000)) {
                const KernelHit hit = trace(bvh, ray);
                if (hit.primitive == no_primitive) continue;
                ++hits;
                ray.t_max = hit.t;
                EXPECT_FALSE(occluded(bvh, ray, {}));
                EXPECT_EQ(trace(bvh, ray).primitive, no_primitive);
                ray.t_max = std::nextafter(hit.t, infinity);
                EXPECT_TRUE(occluded(bvh, ray, {}));
                EXPECT_EQ(trace(bvh, ray).t, hit.t);
                ray.t_min = hit.t;
                EXPECT_FALSE(occluded(bvh, ray, {}));
            }
            EXPECT_GT(hits, 200);
        }
    }
}

// What a hit says of its triangle's corners is what was given.
TEST(Bvh, HitsCarryTheirCorners) {
    for (const Case& c : cases())
        for (const BvhKernel* kernel : available_kernels()) {
            const Bvh bvh = build_bvh(c.triangles, {}, *kernel);
            for (const KernelRay& ray : rays_at(c.triangles, 500)) {
                const KernelHit hit = trace(bvh, ray);
                if (hit.primitive == no_primitive) continue;
                for (std::size_t i = 0; i < 9; ++i)
                    EXPECT_EQ(hit.corners[i * static_cast<std::size_t>(kernel->block_size)],
                              c.triangles[9 * hit.triangle + i]);
            }
        }
}

TEST(BuildBvh, DoesNotDependOnTheThreads) {
    const Triangles triangles = sphere(300, 400); // enough for parallel work
    std::vector<Bvh> trees;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        trees.push_back(build_bvh(triangles, {}, best_kernel()));
    }
    ASSERT_EQ(trees[0].tree.size(), trees[1].tree.size());
    EXPECT_EQ(std::memcmp(trees[0].view.tree, trees[1].view.tree, trees[0].tree.size() * line_size), 0);
    EXPECT_EQ(trees[0].tree.size(), trees[0].tree.capacity()) << "it was not moved while it grew";
    EXPECT_LE(static_cast<double>(trees[0].bytes) / static_cast<double>(trees[0].triangle_count), 120.0);
}

// Boxes without a surface, or all alike, in any number: whatever the costs come to, each is met.
TEST(BuildBvh, FlatBoxesOfOthersAreMet) {
    struct Count {
        std::vector<int> times;
    };
    for (const BvhKernel* kernel : available_kernels())
        for (std::size_t n = 1; n < 40; ++n) {
            std::vector<FloatBox> points(n, FloatBox{{0.25f, 0.25f, 0.5f}, {0.25f, 0.25f, 0.5f}});
            for (std::size_t i = 0; i < n; i += 2)
                points[i].low[2] = points[i].high[2] = 0.01f * static_cast<float>(i);
            Count count{std::vector<int>(n)};
            const KernelCalls calls{
                &count,
                [](const void* context, std::uint32_t index, const KernelRay&, KernelHit&) {
                    ++static_cast<Count*>(const_cast<void*>(context))->times[index];
                    return false;
                },
                nullptr};
            KernelHit hit;
            hit.t = infinity;
            closest(build_bvh({}, points, *kernel), kernel_ray({0.25f, 0.25f, -1}, {0, -0.0f, 1}), calls,
                    hit);
            EXPECT_EQ(count.times, std::vector<int>(n, 1)) << kernel->name << ' ' << n;
        }
}

TEST(BuildBvh, NothingAndOneAreTrees) {
    for (const BvhKernel* kernel : available_kernels()) {
        const KernelRay ray = kernel_ray({0, 0, -1}, {0, 0, 1});
        EXPECT_EQ(trace(build_bvh({}, {}, *kernel), ray).primitive, no_primitive);
        Triangles one;
        add_triangle(one, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
        EXPECT_EQ(trace(build_bvh(one, {}, *kernel), ray).t, 1.0);
        const Triangles none(9, 0.5f);
        EXPECT_EQ(trace(build_bvh(none, {}, *kernel), ray).primitive, no_primitive);
    }
}

} // namespace
} // namespace pnr
