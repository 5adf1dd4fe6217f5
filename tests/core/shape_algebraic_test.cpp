// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_algebraic.h"

#include "core/closest_point.h"
#include "surface_checks.h"

namespace pnr {
namespace {

Shape polynomial(int order,
                 std::initializer_list<std::array<double, 4>> terms) { // powers of x, y, z, coefficient
    std::vector<double> c(static_cast<std::size_t>(surface_terms(order)));
    for (const auto& [i, j, k, value] : terms)
        c[static_cast<std::size_t>(
            surface_term(order, static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)))] += value;
    return make_polynomial_surface(order, c);
}

// The order of the manual's tables: x^2 xy xz x y^2 yz y z^2 z 1.
TEST(PolynomialSurface, TermsStandAsInPovrayManual) {
    const int expected[][3] = {{2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 0, 0}, {0, 2, 0},
                               {0, 1, 1}, {0, 1, 0}, {0, 0, 2}, {0, 0, 1}, {0, 0, 0}};
    for (int n = 0; n < 10; ++n)
        EXPECT_EQ(surface_term(2, expected[n][0], expected[n][1], expected[n][2]), n);
    EXPECT_EQ(surface_terms(3), 20);
    EXPECT_EQ(surface_terms(4), 35);
    EXPECT_EQ(surface_terms(15), 816);
    EXPECT_EQ(surface_term(4, 2, 2, 0),
              10 - 6); // A4 of the manual's quartic is x^2 y^2's neighbour x^3, A5 is x^2 y^2
}

TEST(Quadric, IsWhereItsFunctionIsNegative) {
    const Quadric egg{{1, 2, 3, 0.4, -0.3, 0.2, 0.1, -0.2, 0.3, -1}};
    const auto f = [](const Quadric& s, Vec3 p) {
        const auto& q = s.q;
        return q[0] * p.x * p.x + q[1] * p.y * p.y + q[2] * p.z * p.z + q[3] * p.x * p.y + q[4] * p.x * p.z +
               q[5] * p.y * p.z + q[6] * p.x + q[7] * p.y + q[8] * p.z + q[9];
    };
    for (const Quadric& s :
         {egg, Quadric{{1, 1, -1, 0, 0, 0, 0, 0, 0, -0.3}}, Quadric{{1, 0, 1, 0, 0, 0, 0, -1, 0, 0}},
          Quadric{{1, 0, 1, 0, 0, 0, 0, 0, 0, -0.7}}, Quadric{{0, 0, 0, 0, 0, 1, 1, 0, 0, 0.1}},
          Quadric{{-1, -1, -2, 0, 0, 0, 0, 0, 0, 1}}})
        expect_solid({s, [&](Vec3 p) { return f(s, p) < 0; }});
}

TEST(Quadric, BoundsAreThoseOfTheEllipsoid) {
    const Bounds b =
        bounds_of(Quadric{{0.25, 1, 4, 0, 0, 0, -0.5, 0, 0, 0}}); // (x - 1)^2 / 4 + y^2 + 4 z^2 = 1/4
    const double expected[] = {0, -0.5, -0.25, 2, 0.5, 0.25};
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(b.low[k], expected[k], 1e-11);
        EXPECT_NEAR(b.high[k], expected[k + 3], 1e-11);
    }
    const Bounds pipe = bounds_of(Quadric{{1, 0, 1, 0, 0, 0, 0, 0, 0, -4}});
    EXPECT_NEAR(pipe.high.x, 2, 1e-11);
    EXPECT_EQ(pipe.high.y, infinity);
    EXPECT_EQ(pipe.low.y, -infinity);
    EXPECT_TRUE(is_empty(bounds_of(Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}})));
    EXPECT_EQ(bounds_of(Quadric{{1, 0, 1, 0, 0, 0, 0, -1, 0, 0}}).low.x, -infinity) << "a paraboloid";
    EXPECT_FALSE(has_endless_inside(Quadric{{1, 0, 1, 0, 0, 0, 0, 0, 0, -4}}));
    EXPECT_TRUE(has_endless_inside(Quadric{{-1, -1, -1, 0, 0, 0, 0, 0, 0, 1}}));
}

TEST(PolynomialSurface, QuarticTorusIsTheTorus) {
    const double r1 = 1, r2 = 0.3, k = r1 * r1 - r2 * r2;
    const Shape quartic = polynomial(4, {{4, 0, 0, 1},
                                         {0, 4, 0, 1},
                                         {0, 0, 4, 1},
                                         {2, 2, 0, 2},
                                         {2, 0, 2, 2},
                                         {0, 2, 2, 2},
                                         {2, 0, 0, 2 * k - 4 * r1 * r1},
                                         {0, 2, 0, 2 * k},
                                         {0, 0, 2, 2 * k - 4 * r1 * r1},
                                         {0, 0, 0, k * k}});
    expect_solid({quartic, [&](Vec3 p) { return std::hypot(std::hypot(p.x, p.z) - r1, p.y) < r2; }});
    Rng rng = make_rng(5, Pass::test, 0);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from = point_in_cube(rng, 3);
        const Ray ray{from, point_in_cube(rng, 1) - from, 0, infinity};
        HitList a, b;
        ASSERT_EQ(intersect_shape(quartic, ray, a), intersect_shape(Torus{r1, r2}, ray, b));
        for (std::size_t n = 0; n < a.size(); ++n) {
            EXPECT_NEAR(a[n].t, b[n].t, 1e-7);
            EXPECT_GT(glm::dot(glm::normalize(a[n].normal), glm::normalize(b[n].normal)), 1 - 1e-6);
        }
    }
}

TEST(PolynomialSurface, HigherOrdersAreWhereTheirFunctionIsNegative) {
    // Barth's sextic, a cubic, and |p|^14 = 1.
    const double g = (1 + std::sqrt(5.0)) / 2, g2 = g * g;
    const auto sextic = [&](Vec3 p) {
        const double x = p.x * p.x, y = p.y * p.y, z = p.z * p.z, s = x + y + z - 1;
        return 4 * (g2 * x - y) * (g2 * y - z) * (g2 * z - x) - (1 + 2 * g) * s * s;
    };
    std::vector<std::array<double, 4>> terms;
    const double m = 1 + 2 * g;
    const double l[3][3] = {{g2, -1, 0}, {0, g2, -1}, {-1, 0, g2}}; // in x^2, y^2, z^2
    std::vector<double> c(static_cast<std::size_t>(surface_terms(6)));
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            for (int d = 0; d < 3; ++d) {
                int powers[3] = {0, 0, 0};
                powers[a] += 2, powers[b] += 2, powers[d] += 2;
                c[static_cast<std::size_t>(surface_term(6, powers[0], powers[1], powers[2]))] +=
                    4 * l[0][a] * l[1][b] * l[2][d];
            }
    const double one[4] = {1, 1, 1, -1}; // s in x^2, y^2, z^2, 1
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            int powers[4] = {0, 0, 0, 0};
            powers[a] += 2, powers[b] += 2;
            c[static_cast<std::size_t>(surface_term(6, powers[0], powers[1], powers[2]))] -=
                m * one[a] * one[b];
        }
    expect_solid({make_polynomial_surface(6, c), [&](Vec3 p) { return sextic(p) < 0; }});
    const Shape cubic = polynomial(
        3, {{3, 0, 0, 1}, {0, 3, 0, -2}, {1, 1, 1, 3}, {0, 0, 2, 1}, {1, 0, 0, -0.5}, {0, 0, 0, -0.2}});
    expect_solid({cubic, [](Vec3 p) {
                      return p.x * p.x * p.x - 2 * p.y * p.y * p.y + 3 * p.x * p.y * p.z + p.z * p.z -
                                 0.5 * p.x - 0.2 <
                             0;
                  }});
    const Shape pillow = polynomial(14, {{14, 0, 0, 1}, {0, 14, 0, 1}, {0, 0, 14, 1}, {0, 0, 0, -1}});
    expect_solid(
        {pillow, [](Vec3 p) { return std::pow(p.x, 14) + std::pow(p.y, 14) + std::pow(p.z, 14) < 1; }});
}

TEST(PolynomialSurface, KeepsItsPrecisionFromAfar) {
    const Shape ball = polynomial(4, {{4, 0, 0, 1}, {0, 4, 0, 1}, {0, 0, 4, 1}, {0, 0, 0, -1}});
    Rng rng = make_rng(6, Pass::test, 0);
    for (int i = 0; i < 500; ++i) {
        const Vec3 away = 1e6 * glm::normalize(point_in_cube(rng, 1));
        const Vec3 direction = glm::normalize(point_in_cube(rng, 0.5) - away);
        HitList hits;
        ASSERT_EQ(intersect_shape(ball, {away, direction, 0, infinity}, hits), 2);
        for (const ShapeHit& hit : hits) {
            const Vec3 p = away + hit.t * direction;
            EXPECT_NEAR(std::pow(p.x, 4) + std::pow(p.y, 4) + std::pow(p.z, 4), 1, 1e-8);
        }
    }
}

TEST(Superellipsoid, IsWhereItsFunctionSays) {
    for (const auto& [e, n] :
         {std::pair{1.0, 1.0}, {0.25, 0.3}, {0.05, 0.05}, {2.0, 2.0}, {1.0, 0.1}, {3.0, 1.5}, {0.5, 4.0}}) {
        const double east = e, north = n;
        expect_solid({Superellipsoid{e, n}, [=](Vec3 p) {
                          p = glm::abs(p);
                          return std::pow(std::pow(p.x, 2 / east) + std::pow(p.y, 2 / east), east / north) +
                                     std::pow(p.z, 2 / north) <
                                 1;
                      }});
        if (testing::Test::HasFailure()) FAIL() << e << " " << n;
    }
}

TEST(Superellipsoid, OfOneIsTheUnitSphere) {
    Rng rng = make_rng(7, Pass::test, 0);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from = point_in_cube(rng, 3);
        const Ray ray{from, point_in_cube(rng, 1.2) - from, 0, infinity};
        HitList a, b;
        ASSERT_EQ(intersect_shape(Superellipsoid{1, 1}, ray, a), intersect_shape(Sphere{}, ray, b));
        for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n].t, b[n].t, 1e-12);
    }
}

// Hits of POV-Ray 3.7's trace() from <-10, y, 0> along x, and their normals' heights.
TEST(Ovus, IsPovrays) {
    const double egg[][3] = {{-0.5, 0.866025403784, -0.5},  {0, 1, 0},
                             {0.3, 0.962165391471, 0.2125}, {0.6, 0.871810800987, 0.3625},
                             {1.2, 0.505967085008, 0.6625}, {1.4, 0.3, 0.8}};
    const double top[][3] = {
        {-0.3, 0.409416437371, -0.7}, {0, 0.640687448455, -0.5125}, {0.9, 0.692820323028, 0.5}};
    const auto check = [](const Ovus& ovus, auto& rows) {
        for (const auto& [y, x, up] : rows) {
            HitList hits;
            ASSERT_EQ(intersect_shape(ovus, {{-10, y, 0}, {1, 0, 0}, 0, infinity}, hits), 2);
            EXPECT_NEAR(hits[0].t - 10, -x, 1e-11);
            EXPECT_NEAR(glm::normalize(hits[0].normal).y, up, 1e-11);
        }
    };
    check(Ovus{1, 0.5}, egg);
    check(Ovus{0.5, 0.8}, top);
    // What a pigment with uv_mapping shows at x = -0.1.
    for (const auto& [y, u, v] :
         {std::array{0.9, 0.728, 0.733}, {0.5, 0.732, 0.586}, {-0.1, 0.734, 0.392}, {-0.9, 0.713, 0.115}}) {
        HitList hits;
        ASSERT_EQ(intersect_shape(Ovus{1, 0.5}, {{-0.1, y, -10}, {0, 0, 1}, 0, infinity}, hits), 2);
        EXPECT_NEAR(hits[0].uv.x, u, 2e-3);
        EXPECT_NEAR(hits[0].uv.y, v, 2e-3);
    }
    for (const Ovus& ovus : {Ovus{1, 0.5}, Ovus{0.5, 0.8}, Ovus{0.5, 1.2}, Ovus{1, 1}}) {
        expect_solid({ovus, [&](Vec3 p) { return inside_shape(ovus, p); }});
    }
}

TEST(ClosestPointByRays, AgreesWithTheFormulas) {
    Rng rng = make_rng(8, Pass::test, 0);
    for (const Shape& shape : {Shape(Sphere{{0.1, 0.2, -0.3}, 0.8}), Shape(Torus{1, 0.3}),
                               Shape(Cylinder{{0, -1, 0}, {0, 1, 0}, 0.5})})
        for (int i = 0; i < 60; ++i) {
            const Vec3 p = point_in_cube(rng, 2.5);
            const ClosestPoint a = closest_point_on_shape(shape, p), b = closest_point_by_rays(shape, p);
            const bool edges = std::holds_alternative<Cylinder>(shape);
            EXPECT_NEAR(a.distance, b.distance, (edges ? 1e-3 : 1e-7) * (1 + a.distance))
                << shape_name(shape);
            EXPECT_NEAR(glm::distance(p, b.position), b.distance, 1e-9);
            const ClosestPoint on = closest_point_by_rays(shape, a.position);
            EXPECT_LT(on.distance, 1e-9);
        }
    const ClosestPoint tip = closest_point_on_shape(Superellipsoid{1, 1}, {0, 0, 5});
    EXPECT_NEAR(tip.distance, 4, 1e-9);
    EXPECT_NEAR(tip.normal.z, 1, 1e-6);
}

} // namespace
} // namespace pnr
