// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_swept.h"

#include "surface_checks.h"

#include <stdexcept>

namespace pnr {
namespace {

// A curve as a fine polygon, and its inside by crossings to the right.
struct Outline {
    std::vector<Vec2> a, b;

    void add(const std::function<Vec2(double)>& curve, int parts = 3000) {
        for (int i = 0; i < parts; ++i) {
            a.push_back(curve(static_cast<double>(i) / parts));
            b.push_back(curve(static_cast<double>(i + 1) / parts));
        }
    }
    bool contains(Vec2 p) const {
        bool inside = false;
        for (std::size_t i = 0; i < a.size(); ++i)
            if ((a[i].y > p.y) != (b[i].y > p.y))
                inside ^= a[i].x + (p.y - a[i].y) / (b[i].y - a[i].y) * (b[i].x - a[i].x) > p.x;
        return inside;
    }
};

Vec2 quadratic(Vec2 before, Vec2 from, Vec2 to, double s) { // through the three at -1, 0, 1
    return from + s * 0.5 * (to - before) + s * s * 0.5 * (before - 2.0 * from + to);
}
Vec2 catmull_rom(Vec2 p0, Vec2 p1, Vec2 p2, Vec2 p3, double s) {
    return 0.5 * (2.0 * p1 + s * (p2 - p0) + s * s * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                  s * s * s * (3.0 * p1 - p0 - 3.0 * p2 + p3));
}
Vec2 bezier(Vec2 p0, Vec2 p1, Vec2 p2, Vec2 p3, double s) {
    const double r = 1 - s;
    return r * r * r * p0 + 3 * r * r * s * p1 + 3 * r * s * s * p2 + s * s * s * p3;
}

Outline outline_of(SplineKind kind, const std::vector<Vec2>& p) {
    Outline outline;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (kind == SplineKind::linear && i + 1 < p.size())
            outline.add([&](double s) { return (1 - s) * p[i] + s * p[i + 1]; }, 1);
        if (kind == SplineKind::quadratic && i > 0 && i + 1 < p.size())
            outline.add([&](double s) { return quadratic(p[i - 1], p[i], p[i + 1], s); });
        if (kind == SplineKind::cubic && i > 0 && i + 2 < p.size())
            outline.add([&](double s) { return catmull_rom(p[i - 1], p[i], p[i + 1], p[i + 2], s); });
        if (kind == SplineKind::bezier && i % 4 == 0)
            outline.add([&](double s) { return bezier(p[i], p[i + 1], p[i + 2], p[i + 3], s); });
    }
    return outline;
}

struct Curve {
    SplineKind kind;
    std::vector<Vec2> points;
};

const std::vector<Curve>& lathe_curves() {
    static const std::vector<Curve> curves = {
        {SplineKind::linear, {{0, -1}, {0.8, -0.6}, {0.3, 0}, {0.9, 0.4}, {0.5, 0.9}, {0, 0.9}}},
        {SplineKind::quadratic, {{-0.5, -1.2}, {0, -1}, {0.8, -0.5}, {0.4, 0.1}, {0.6, 0.5}, {0, 1}}},
        {SplineKind::cubic, {{0, -1.2}, {0, -1}, {0.8, -0.5}, {0.4, 0}, {0.6, 0.5}, {0, 1}, {-1, 1}}},
        {SplineKind::bezier,
         {{0, -1}, {1.4, -1}, {0.2, 0}, {0.6, 0.2}, {0.6, 0.2}, {1, 0.4}, {0.7, 0.9}, {0, 0.8}}},
        // A ring: closed, away from the axis.
        {SplineKind::linear, {{0.5, -0.4}, {1, -0.3}, {0.9, 0.5}, {0.5, -0.4}}}};
    return curves;
}

TEST(Lathe, HoldsWhatItsCurveHolds) {
    for (const Curve& curve : lathe_curves()) {
        const Outline outline = outline_of(curve.kind, curve.points);
        expect_solid({make_lathe(curve.kind, curve.points),
                      [&](Vec3 p) {
                          return outline.contains({std::hypot(p.x, p.z), p.y});
                      },
                      1.5, 1e-5, 400});
        if (testing::Test::HasFailure()) FAIL() << static_cast<int>(curve.kind);
    }
}

TEST(Lathe, FlatAndNearlyFlatRaysMeetIt) {
    const Curve& curve = lathe_curves()[2];
    const Shape lathe = make_lathe(curve.kind, curve.points);
    for (const double slope : {0.0, 1e-300, 1e-16, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 2e-6, 1e-5, 1e-4, 1e-2})
        for (const double sign : {-1.0, 1.0}) {
            HitList hits;
            ASSERT_EQ(intersect_shape(lathe,
                                      {{-5, 0.3 - 5 * sign * slope, 0.1}, {1, sign * slope, 0}, 0, infinity},
                                      hits),
                      2)
                << slope;
            EXPECT_NEAR(hits[0].t + hits[1].t, 10, 20 * slope + 1e-9);
            HitList up;
            ASSERT_EQ(intersect_shape(
                          lathe, {{0.1 - 5 * sign * slope, -5, 0.2}, {sign * slope, 1, 0}, 0, infinity}, up),
                      2)
                << slope;
        }
}

// What POV-Ray 3.7 shows of a pigment with uv_mapping on these, at x = -0.1.
TEST(Lathe, HasPovraysTextureCoordinates) {
    const Shape lathe =
        make_lathe(SplineKind::linear, std::vector<Vec2>{{0.2, -1.5}, {1, -1}, {0.6, 0.5}, {1, 1.5}});
    const Shape sor = make_sor(std::vector<Vec2>{{0.2, -1.6}, {1, -1}, {0.6, 0.5}, {1, 1.2}, {1, 1.6}});
    const double rows[][5] = {{0.9, 0.729, 0.8, 0.731, 0.786},
                              {-0.1, 0.729, 0.533, 0.730, 0.3},
                              {-0.9, 0.734, 0.356, 0.734, 0.033}};
    for (const auto& [y, lathe_u, lathe_v, sor_u, sor_v] : rows) {
        HitList hits;
        ASSERT_EQ(intersect_shape(lathe, {{-0.1, y, -10}, {0, 0, 1}, 0, infinity}, hits), 2);
        EXPECT_NEAR(hits[0].uv.x, lathe_u, 1e-3);
        EXPECT_NEAR(hits[0].uv.y, lathe_v, 1e-3);
        ASSERT_EQ(intersect_shape(sor, {{-0.1, y, -10}, {0, 0, 1}, 0, infinity}, hits), 2);
        EXPECT_NEAR(hits[0].uv.x, sor_u, 1e-3);
        EXPECT_NEAR(hits[0].uv.y, sor_v, 1e-3);
    }
}

TEST(Sor, HasTheManualsCubics) {
    const std::vector<Vec2> p = {{0, -1.5}, {0.5, -1}, {0.8, -0.4}, {0.3, 0.3}, {0.5, 0.9}, {0.7, 1.3}};
    // r^2 = A h^3 + B h^2 + C h + D between two points, from the values and slopes at both.
    const auto square = [&](double y) {
        for (std::size_t i = 1; i + 2 < p.size(); ++i) {
            if (y < p[i].y || y > p[i + 1].y) continue;
            const double length = p[i + 1].y - p[i].y, s = (y - p[i].y) / length;
            const auto slope = [&](std::size_t k) {
                return 2 * p[k].x * (p[k + 1].x - p[k - 1].x) / (p[k + 1].y - p[k - 1].y);
            };
            const double a = p[i].x * p[i].x, b = p[i + 1].x * p[i + 1].x, da = length * slope(i),
                         db = length * slope(i + 1);
            return a + s * (da + s * (3 * (b - a) - 2 * da - db + s * (2 * (a - b) + da + db)));
        }
        return -1.0;
    };
    Shape sor = make_sor(p);
    expect_solid({sor, [&](Vec3 q) { return q.x * q.x + q.z * q.z < square(q.y); }, 1.6, 1e-7, 2000});
    HitList hits;
    const Ray along{{0.2, 5, 0}, {0, -1, 0}, 0, infinity};
    ASSERT_EQ(intersect_shape(sor, along, hits), 2);
    EXPECT_NEAR(hits[0].t, 4.1, 1e-12); // the lid at 0.9
    std::get<Sor>(sor).open = true;
    EXPECT_EQ(intersect_shape(sor, along, hits), 0);
    EXPECT_THROW(make_sor(std::vector<Vec2>{{0, 0}, {1, 1}, {1, 0.5}, {1, 2}}), std::invalid_argument);
    EXPECT_THROW(make_sor(std::vector<Vec2>{{0, 0}, {1, 1}, {1, 2}}), std::invalid_argument);
}

const std::vector<Curve>& prism_curves() {
    static const std::vector<Curve> curves = {
        {SplineKind::linear,
         {{-1, -1},
          {1, -0.9},
          {0.8, 0.2},
          {0.1, -0.2},
          {-0.9, 0.9},
          {-1, -1},
          {-0.7, -0.6},
          {-0.2, -0.7},
          {-0.6, 0},
          {-0.7, -0.6}}},
        {SplineKind::quadratic, {{1, -1}, {-0.8, -0.7}, {0.7, -0.7}, {0.6, 0.6}, {-0.7, 0.5}, {-0.8, -0.7}}},
        {SplineKind::cubic,
         {{1, -1},
          {-0.8, -0.7},
          {0, -0.3},
          {0.8, -0.7},
          {0.7, 0.6},
          {0, 0.8},
          {-0.7, 0.5},
          {-0.8, -0.7},
          {0, -1}}},
        {SplineKind::bezier,
         {{-0.8, -0.8}, {0, -0.2}, {0.5, -1}, {0.9, -0.6}, {0.9, -0.6}, {1, 0.5}, {-1, 1}, {-0.8, -0.8}}}};
    return curves;
}

TEST(Prism, HoldsWhatItsCurvesHold) {
    for (const Curve& curve : prism_curves()) {
        Outline outline = outline_of(curve.kind, curve.points);
        if (curve.kind == SplineKind::linear) { // the step from one curve to the next is no side
            outline = outline_of(curve.kind, {curve.points.begin(), curve.points.begin() + 6});
            const Outline hole = outline_of(curve.kind, {curve.points.begin() + 6, curve.points.end()});
            outline.a.insert(outline.a.end(), hole.a.begin(), hole.a.end());
            outline.b.insert(outline.b.end(), hole.b.begin(), hole.b.end());
        }
        for (const bool conic : {false, true})
            for (const auto& [low, high] : {std::pair{-0.7, 0.9}, {0.2, 1.1}, {-1.0, -0.3}}) {
                bool is_closed = false;
                const Shape prism = make_prism({curve.kind, conic, low, high}, curve.points, is_closed);
                EXPECT_TRUE(is_closed);
                const double from = low, to = high;
                expect_solid({prism,
                              [&](Vec3 p) {
                                  return p.y > from && p.y < to &&
                                         outline.contains(conic ? Vec2(p.x, p.z) / p.y : Vec2(p.x, p.z));
                              },
                              1.6, 1e-5, curve.kind == SplineKind::linear ? 2000 : 150});
                if (testing::Test::HasFailure()) FAIL() << static_cast<int>(curve.kind) << conic << low;
            }
    }
}

TEST(Prism, OpenHasNoLidsAndUnclosedIsClosed) {
    bool is_closed = true;
    const std::vector<Vec2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    Shape prism = make_prism({}, square, is_closed);
    EXPECT_FALSE(is_closed);
    HitList hits;
    const Ray through{{0, 5, 0}, {0.01, -1, 0}, 0, infinity}, across{{-5, 0.5, 0}, {1, 0, 0}, 0, infinity};
    EXPECT_EQ(intersect_shape(prism, through, hits), 2);
    EXPECT_EQ(intersect_shape(prism, across, hits), 2);
    std::get<Prism>(prism).open = true;
    EXPECT_EQ(intersect_shape(prism, through, hits), 0);
    EXPECT_EQ(intersect_shape(prism, across, hits), 2);
    EXPECT_TRUE(inside_shape(prism, {0, 0.5, 0}));
}

// Rays aimed at the rims, where a side ends and a lid begins, into the body.
TEST(Prism, RimsDoNotLeak) {
    bool is_closed = false;
    const std::vector<Vec2> corners = {{-1, -0.8}, {0.9, -1}, {1.1, 0.7}, {-0.7, 1}, {-1, -0.8}};
    const Shape prism = make_prism({}, corners, is_closed);
    Rng rng = make_rng(3, Pass::test, 0);
    for (int i = 0; i < 5000; ++i) {
        const std::size_t side = static_cast<std::size_t>(i) % 4;
        const Vec2 rim = glm::mix(corners[side], corners[side + 1], rng.uniform());
        const Vec3 at(rim.x, 1, rim.y), inside = Vec3(0, 0.5, 0) + point_in_cube(rng, 0.2);
        HitList hits;
        EXPECT_EQ(intersect_shape(prism, {inside + 4.0 * (at - inside), inside - at, 0, infinity}, hits), 2);
    }
}

TEST(SphereSweep, HoldsTheBallsOfItsCurve) {
    const std::vector<SweepPoint> p = {{{-1, -0.5, 0}, 0.1},   {{-0.8, 0, 0}, 0.3},
                                       {{0, 0.9, -0.5}, 0.2},  {{0.7, -0.9, 0}, 0.4},
                                       {{0.9, 0.9, 0.5}, 0.3}, {{0.2, 0.4, 0.9}, 0.05}};
    for (const SweepKind kind : {SweepKind::linear, SweepKind::b_spline, SweepKind::cubic}) {
        std::vector<SweepPoint> balls;
        constexpr int parts = 400;
        const std::size_t first = kind == SweepKind::linear ? 0 : 1, last = kind == SweepKind::linear ? 5 : 4;
        for (std::size_t i = first; i < last; ++i)
            for (int k = 0; k <= parts; ++k) {
                const double s = static_cast<double>(k) / parts, r = 1 - s;
                double w[4] = {0, r, s, 0};
                if (kind == SweepKind::b_spline) {
                    w[0] = r * r * r / 6, w[1] = (3 * s * s * s - 6 * s * s + 4) / 6;
                    w[2] = (3 * r * r * r - 6 * r * r + 4) / 6, w[3] = s * s * s / 6;
                } else if (kind == SweepKind::cubic) {
                    w[0] = 0.5 * (-s + 2 * s * s - s * s * s), w[1] = 0.5 * (2 - 5 * s * s + 3 * s * s * s);
                    w[2] = 0.5 * (s + 4 * s * s - 3 * s * s * s), w[3] = 0.5 * (-s * s + s * s * s);
                }
                SweepPoint ball{Vec3(0), 0};
                for (std::size_t m = 0; m < 4; ++m) {
                    if (w[m] == 0) continue;
                    ball.center += w[m] * p[i + m - 1].center, ball.radius += w[m] * p[i + m - 1].radius;
                }
                balls.push_back(ball);
            }
        expect_solid({make_sphere_sweep(kind, p),
                      [&](Vec3 q) {
                          return std::any_of(balls.begin(), balls.end(), [&](const SweepPoint& ball) {
                              return glm::distance(q, ball.center) < ball.radius;
                          });
                      },
                      1.8, 1e-4, 600});
        if (testing::Test::HasFailure()) FAIL() << static_cast<int>(kind);
    }
    EXPECT_THROW(make_sphere_sweep(SweepKind::cubic, std::span(p).subspan(0, 3)), std::invalid_argument);
}

TEST(SphereSweep, OneBallThatStandsStillIsASphere) {
    const SweepPoint still[] = {{{0, 0, 0}, 1}, {{0, 0, 0}, 1}};
    HitList hits;
    ASSERT_EQ(intersect_shape(make_sphere_sweep(SweepKind::linear, still),
                              {{-5, 0, 0}, {2, 0, 0}, 0, infinity}, hits),
              2);
    EXPECT_NEAR(hits[0].t, 2, 1e-12);
    EXPECT_NEAR(hits[1].t, 3, 1e-12);
}

TEST(Polygon, HasHoles) {
    const std::vector<Vec3> p = {{-1, -1, 0},     {1, -1, 0},     {1, 1, 0},     {-1, 1, 0},     {-1, -1, 0},
                                 {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, -0.5, 0}};
    const Shape polygon = make_polygon(p);
    Rng rng = make_rng(9, Pass::test, 0);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 at(2.4 * rng.uniform() - 1.2, 2.4 * rng.uniform() - 1.2, 0),
            from = at + Vec3(rng.uniform(), 1, -3);
        const bool in_hole = at.x < 0.5 && at.y > -0.5 && at.y < at.x;
        const bool there = std::abs(at.x) < 1 && std::abs(at.y) < 1 && !in_hole;
        HitList hits;
        ASSERT_EQ(intersect_shape(polygon, {from, at - from, 0, infinity}, hits), there ? 1 : 0)
            << at.x << " " << at.y;
        if (!there) continue;
        EXPECT_NEAR(hits[0].t, 1, 1e-12);
        EXPECT_NEAR(std::abs(hits[0].normal.z), 1, 1e-12);
    }
    EXPECT_THROW(make_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), std::invalid_argument);
}

} // namespace
} // namespace pnr
