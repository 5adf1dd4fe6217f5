// SPDX-License-Identifier: GPL-3.0-or-later
// Isosurfaces against the signs of their function, and enclosures against sampled values.
#include "core/shape_field.h"

#include "core/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pnr {
namespace {

using Op = FieldOp;

struct Program {
    FieldProgram field;

    std::uint32_t add(Op op, std::uint32_t a = 0, std::uint32_t b = 0, std::uint32_t c = 0,
                      std::uint32_t d = 0) {
        field.steps.push_back({op, a, b, c, d, 0});
        return static_cast<std::uint32_t>(field.steps.size() - 1);
    }
    std::uint32_t constant(double value) {
        field.steps.push_back({Op::constant, 0, 0, 0, 0, value});
        return static_cast<std::uint32_t>(field.steps.size() - 1);
    }
};

// x^2 + y^2 + z^2 - r^2
FieldProgram ball(double radius) {
    Program p;
    const auto x = p.add(Op::x), y = p.add(Op::y), z = p.add(Op::z);
    const auto xx = p.add(Op::sqr, x), yy = p.add(Op::multiply, y, y),
               zz = p.add(Op::power, z, p.constant(2));
    const auto sum = p.add(Op::add, p.add(Op::add, xx, yy), zz);
    p.add(Op::subtract, sum, p.constant(radius * radius));
    return p.field;
}

// sin(5x) cos(4y) + 0.7 sin(6z + x y): many sheets
FieldProgram waves() {
    Program p;
    const auto x = p.add(Op::x), y = p.add(Op::y), z = p.add(Op::z);
    const auto a = p.add(Op::sin, p.add(Op::multiply, x, p.constant(5)));
    const auto b = p.add(Op::cos, p.add(Op::multiply, y, p.constant(4)));
    const auto c =
        p.add(Op::sin, p.add(Op::add, p.add(Op::multiply, z, p.constant(6)), p.add(Op::multiply, x, y)));
    p.add(Op::add, p.add(Op::multiply, a, b), p.add(Op::multiply, c, p.constant(0.7)));
    return p.field;
}

// max(|x|, |y|) - 0.6 where z < 0.1, else sqrt(x^2 + z^2) - 0.5: edges and a jump
FieldProgram corners() {
    Program p;
    const auto x = p.add(Op::x), y = p.add(Op::y), z = p.add(Op::z);
    const auto square =
        p.add(Op::subtract, p.add(Op::maximum, p.add(Op::abs, x), p.add(Op::abs, y)), p.constant(0.6));
    const auto round = p.add(
        Op::subtract, p.add(Op::sqrt, p.add(Op::add, p.add(Op::sqr, x), p.add(Op::sqr, z))), p.constant(0.5));
    p.add(Op::select, p.add(Op::subtract, z, p.constant(0.1)), square, round, round);
    return p.field;
}

Isosurface surface_of(FieldProgram field, bool open, bool in_sphere, bool prepared) {
    auto data = std::make_shared<IsosurfaceData>();
    data->field = std::move(field);
    data->open = open;
    data->in_sphere = in_sphere;
    data->sphere.radius = 1.2;
    const Isosurface plain{data, nullptr};
    return prepared ? prepare_isosurface(plain) : plain;
}

Vec3 random_point(Rng& rng, double size) {
    return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

// Hits are where the sign of the function, in the container, changes: compared with small steps along the
// ray.
void expect_sign_changes(const Isosurface& shape, int rays, double step, int seed) {
    Rng rng = make_rng(static_cast<std::uint64_t>(seed), Pass::test, 0);
    int met = 0, missed = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec3 origin = random_point(rng, 2);
        const Vec3 direction = glm::normalize(random_point(rng, 0.8) - origin);
        HitList hits;
        intersect(shape, {origin, direction, 0, infinity}, hits, all_hits);
        met += !hits.empty();
        for (std::size_t k = 0; k < hits.size(); ++k) {
            const Vec3 p = origin + hits[k].t * direction;
            const bool before = is_inside(shape, p - 1e-7 * direction),
                       behind = is_inside(shape, p + 1e-7 * direction);
            EXPECT_NE(before, behind) << "ray " << i;
            EXPECT_EQ(glm::dot(hits[k].normal, direction) < 0, behind) << "ray " << i;
            if (k > 0) {
                EXPECT_LT(hits[k - 1].t, hits[k].t);
            }
        }
        bool inside = is_inside(shape, origin);
        std::size_t next = 0;
        for (double t = step; t < 5; t += step) {
            const bool now = is_inside(shape, origin + t * direction);
            bool expected = inside;
            while (next < hits.size() && hits[next].t < t) expected = !expected, ++next;
            missed += now != expected;
            inside = now;
        }
    }
    EXPECT_GT(met, rays / 10);
    EXPECT_EQ(missed, 0);
}

TEST(Isosurface, HitsAreTheSignChangesOfItsFunction) {
    for (const bool prepared : {false, true})
        for (const bool in_sphere : {false, true}) {
            expect_sign_changes(surface_of(ball(1.1), false, in_sphere, prepared), 300, 0.003, 1);
            expect_sign_changes(surface_of(waves(), false, in_sphere, prepared), 300, 0.003, 2);
            expect_sign_changes(surface_of(corners(), false, in_sphere, prepared), 300, 0.003, 3);
        }
}

TEST(Isosurface, OpenOnesHaveNoLids) {
    const Isosurface open = surface_of(ball(1.1), true, false, true),
                     closed = surface_of(ball(1.1), false, false, true);
    HitList hits;
    const Ray along{{0.1, 0.2, -5}, {0, 0, 1}, 0, infinity};
    intersect(open, along, hits, all_hits);
    EXPECT_TRUE(hits.empty()); // the ball's radius is more than the box reaches here
    intersect(closed, along, hits, all_hits);
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_NEAR(hits[0].t, 4, 1e-12);
    EXPECT_NEAR(hits[1].t, 6, 1e-12);
}

TEST(Isosurface, AGradientSaidTooSmallLosesNothingThatCanBeEnclosed) {
    auto data = std::make_shared<IsosurfaceData>();
    data->field = waves();
    data->max_gradient = 0.01;
    expect_sign_changes(prepare_isosurface({data, nullptr}), 200, 0.003, 5);
}

TEST(Isosurface, OpaqueFunctionsAreMetByTheirGradient) {
    auto data = std::make_shared<IsosurfaceData>();
    Program p;
    p.add(Op::x), p.add(Op::y), p.add(Op::z);
    p.field.opaque.push_back(
        {[](const double* v) { return std::sin(5 * v[0]) * std::cos(4 * v[1]) + v[2]; }});
    p.field.arguments = {0, 1, 2};
    p.add(Op::call, 0, 0);
    data->field = p.field;
    data->max_gradient = 5.2; // the true one is sqrt(26)
    expect_sign_changes(prepare_isosurface({data, nullptr}), 200, 0.003, 6);
}

TEST(Isosurface, NormalsAreTheGradient) {
    const Isosurface shape = surface_of(waves(), true, false, true);
    Rng rng = make_rng(7, Pass::test, 0);
    for (int i = 0; i < 300; ++i) {
        const Vec3 origin = random_point(rng, 2), direction = glm::normalize(random_point(rng, 0.8) - origin);
        HitList hits;
        intersect(shape, {origin, direction, 0, infinity}, hits, 1);
        if (hits.empty()) continue;
        const Vec3 p = origin + hits[0].t * direction;
        const Vec3 gradient(
            5 * std::cos(5 * p.x) * std::cos(4 * p.y) + 4.2 / 6 * p.y * std::cos(6 * p.z + p.x * p.y),
            -4 * std::sin(5 * p.x) * std::sin(4 * p.y) + 0.7 * p.x * std::cos(6 * p.z + p.x * p.y),
            4.2 * std::cos(6 * p.z + p.x * p.y));
        if (glm::length(gradient) < 0.3) continue;
        EXPECT_GT(glm::dot(glm::normalize(gradient), glm::normalize(hits[0].normal)), 0.9999);
    }
}

// Every operation: sampled values and slopes lie in what was told of the box.
TEST(FieldEnclosure, HoldsAllValuesAndSlopes) {
    const Op unary[] = {Op::negate, Op::invert, Op::abs,  Op::sqr,   Op::sqrt, Op::exp,  Op::ln,
                        Op::log,    Op::sin,    Op::cos,  Op::tan,   Op::asin, Op::acos, Op::atan,
                        Op::sinh,   Op::cosh,   Op::tanh, Op::floor, Op::ceil};
    const Op binary[] = {Op::add,           Op::subtract, Op::multiply, Op::divide, Op::power,
                         Op::modulo,        Op::less,     Op::greater,  Op::equal,  Op::less_equal,
                         Op::greater_equal, Op::unequal,  Op::both,     Op::either, Op::minimum,
                         Op::maximum,       Op::arc};
    std::vector<FieldProgram> programs;
    for (const Op op : unary) {
        Program p;
        const auto x = p.add(Op::x), y = p.add(Op::y);
        p.add(op, p.add(Op::add, x, p.add(Op::multiply, y, x)));
        programs.push_back(p.field);
    }
    for (const Op op : binary) {
        Program p;
        const auto x = p.add(Op::x), y = p.add(Op::y), z = p.add(Op::z);
        p.add(op, p.add(Op::multiply, x, z), p.add(Op::subtract, y, z));
        programs.push_back(p.field);
    }
    for (const double exponent : {-2.0, 0.0, 0.5, 2.0, 3.0, -1.5}) {
        Program p;
        p.add(Op::power, p.add(Op::x), p.constant(exponent));
        programs.push_back(p.field);
    }
    programs.push_back(corners());
    Rng rng = make_rng(8, Pass::test, 0);
    FieldScratch scratch;
    for (std::size_t n = 0; n < programs.size(); ++n)
        for (int i = 0; i < 300; ++i) {
            const Vec3 a = random_point(rng, 2), way = random_point(rng, i % 3 == 0 ? 2 : 0.1);
            FieldBoxes boxes;
            for (int l = 0; l < field_lanes; ++l) { // the same in every lane but the last, which is a point
                const Vec3 b = l + 1 < field_lanes ? a + way : a;
                const Vec3 low = glm::min(a, b), high = glm::max(a, b);
                boxes.low.x[l] = low.x, boxes.low.y[l] = low.y, boxes.low.z[l] = low.z;
                boxes.high.x[l] = high.x, boxes.high.y[l] = high.y, boxes.high.z[l] = high.z;
                boxes.along.x[l] = way.x, boxes.along.y[l] = way.y, boxes.along.z[l] = way.z;
            }
            FieldEnclosure e;
            field_enclosure(programs[n], boxes, e, scratch);
            double before = 0;
            for (int k = 0; k <= 32; ++k) {
                const double f = field_value(programs[n], a + (k / 32.0) * way, scratch);
                if (std::isnan(f)) {
                    EXPECT_GE(e.high[0], field_huge) << n << " has no value somewhere";
                    before = f;
                    continue;
                }
                const double slack = 1e-9 * (1 + std::abs(f));
                if (std::abs(f) < field_huge) {
                    EXPECT_GE(f, e.low[0] - slack) << "program " << n;
                    EXPECT_LE(f, e.high[0] + slack) << "program " << n;
                }
                if (k == 0) {
                    EXPECT_GE(f, e.low[field_lanes - 1] - slack) << "program " << n;
                    EXPECT_LE(f, e.high[field_lanes - 1] + slack) << "program " << n;
                } else if (!std::isnan(before) && e.slope_high[0] < field_huge &&
                           e.slope_low[0] > -field_huge) {
                    const double slope = (f - before) * 32; // the mean slope is one of them
                    EXPECT_GE(slope, e.slope_low[0] - 1e-6 * (1 + std::abs(slope))) << "program " << n;
                    EXPECT_LE(slope, e.slope_high[0] + 1e-6 * (1 + std::abs(slope))) << "program " << n;
                }
                before = f;
            }
        }
}

} // namespace
} // namespace pnr
