// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of strokes. Truth is the flow of the unit field, by Boost.Odeint's Rosenbrock method (which stiffness
// does not trouble) or, where it is not stiff, by Dormand and Prince's.
#include "cli/stability.h"

#include "cli/linear_flow.h"
#include "core/types.h"
#include "npr/maps.h"
#include "npr/streamline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace pnr {

namespace {

constexpr int side = 512;
constexpr double half = side / 2.0;
constexpr double step = 0.5;
constexpr int steps = 80;
constexpr float end_of_step = 0.999f; // its very end may lie in the next pixel

// Every pixel is a cell of its own, so that a path tells where it is.
Canvas canvas_of(const std::function<Vec2(Vec2)>& direction) {
    Canvas canvas;
    canvas.width = canvas.height = side;
    canvas.rim = 2;
    canvas.points.resize(std::size_t{side} * side);
    for (int y = canvas.rim; y < side - canvas.rim; ++y)
        for (int x = canvas.rim; x < side - canvas.rim; ++x)
            canvas.at(x, y) = {Vec2f(direction({x + 0.5 - half, y + 0.5 - half})),
                               static_cast<std::uint32_t>(y * side + x)};
    return canvas;
}

// The middles of the pixels in which our path ends its steps.
std::vector<Vec2> our_path(const Canvas& canvas, Vec2 start, Vec2 heading) {
    std::vector<Vec2> met;
    Path path{Vec2f(start + Vec2(half)), Vec2f(heading)};
    for (int k = 0; k < steps && path.going; ++k)
        step_path(canvas, path, static_cast<float>(step), end_of_step, static_cast<float>(steps),
                  [&](float, float, std::uint32_t cell) {
                      met.emplace_back(cell % side + 0.5 - half, cell / side + 0.5 - half);
                  });
    return met;
}

// The largest change of the unit field with place, met on the way or a pixel beside it.
double steepness(const LinearFlow& flow, const std::vector<Point2>& path) {
    double worst = 0;
    for (const Point2& p : path)
        for (const Point2& beside :
             {Point2{0, 0}, Point2{0.7, 0}, Point2{-0.7, 0}, Point2{0, 0.7}, Point2{0, -0.7}}) {
            double squares = 0;
            for (const double s : unit_direction_slope(flow, {p[0] + beside[0], p[1] + beside[1]}))
                squares += s * s;
            worst = std::max(worst, std::sqrt(squares));
        }
    return worst;
}

// Distance from the true path at the same length. A direction that is read from the pixel around a place is
// off by at most G sqrt(1/2), G the field's steepness; by Gronwall's lemma the path is then off by sqrt(1/2)
// (exp(G L) - 1) after the length L, and by the midpoint rule's G^2 h^2 L exp(G L) / 8. We see its place,
// just before the end of a step, to sqrt(1/2) of a pixel.
StabilityCase against_truth(std::string name, const LinearFlow& flow, Point2 start) {
    const std::vector<Point2> truth = follow_flow(flow, start, steps, step);
    const auto direction = [&](Vec2 p) {
        const Point2 n = unit_direction(flow, {p.x, p.y});
        return Vec2(n[0], n[1]);
    };
    const Vec2 from(start[0], start[1]);
    const std::vector<Vec2> ours = our_path(canvas_of(direction), from, direction(from));
    double worst = ours.size() == truth.size() ? 0 : infinity;
    for (std::size_t k = 0; k < std::min(ours.size(), truth.size()); ++k)
        worst = std::max(worst, glm::length(ours[k] - Vec2(truth[k][0], truth[k][1])));
    const double g = steepness(flow, truth), length = steps * step, growth = std::exp(g * length);
    const double bound = std::sqrt(0.5) * growth + g * g * step * step * length * growth / 8 +
                         step * (1.0 - static_cast<double>(end_of_step));
    return {"paths", std::move(name), "pixels from the true path", std::min(bound, length), worst};
}

// Fields that no path can follow exactly: what counts is that it walks on, in steps as long as they should
// be.
StabilityCase keeps_walking(std::string name, const std::function<Vec2(Vec2)>& direction, Vec2 start,
                            Vec2 heading) {
    const std::vector<Vec2> path = our_path(canvas_of(direction), start, heading);
    double longest = path.size() == steps ? 0 : infinity;
    for (std::size_t k = 1; k < path.size(); ++k)
        longest = std::max(longest, glm::length(path[k] - path[k - 1]));
    // The step, and what the two pixels' middles may add.
    return {"paths", std::move(name), "longest step, pixels", step + 2 * std::sqrt(0.5), longest};
}

Vec2 unit_or_zero(Vec2 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : Vec2(0);
}

void add_linear_fields(StabilityCases& cases) {
    for (const double radius : {200.0, 50.0, 12.0})
        cases.push_back(against_truth(fmt::format("round a circle of radius {}", radius),
                                      {{0, -1, 1, 0}, {0}}, {radius, 0}));
    for (const double spiral : {0.1, 1.0, 10.0})
        cases.push_back(against_truth(fmt::format("spiral outwards, {} to 1", spiral),
                                      {{spiral, -1, 1, spiral}, {0}}, {40, 0}));
    for (double ratio = 1; ratio <= 1e8; ratio *= 100) {
        // Towards the x axis and along it; the flow's two rates differ by the ratio. It starts far enough to
        // stay off it.
        cases.push_back(against_truth(fmt::format("saddle, stiffness {:.0e}", ratio),
                                      {{1, 0, 0, -ratio}, {0}}, {30, 90}));
        cases.push_back(
            against_truth(fmt::format("shear, {:.0e} to 1", ratio), {{0, ratio, 0, 0}, {1, 0}}, {-60, 20}));
        cases.push_back(
            against_truth(fmt::format("sink, stiffness {:.0e}", ratio), {{-1, 0, 0, -ratio}, {0}}, {60, 90}));
    }
    cases.push_back(against_truth("source, started beside it", {{1, 0, 0, 1}, {0}}, {8, 6}));
}

void add_broken_fields(StabilityCases& cases) {
    for (double ratio = 1e2; ratio <= 1e8; ratio *= 1e3)
        cases.push_back(keeps_walking(fmt::format("through a sink line of stiffness {:.0e}", ratio),
                                      [=](Vec2 p) {
                                          return unit_or_zero({1, -ratio * p.y});
                                      },
                                      {0, 15}, {0, -1}));
    cases.push_back(keeps_walking("through a centre",
                                  [](Vec2 p) {
                                      return unit_or_zero({-p.y, p.x});
                                  },
                                  {-20, 0.3}, {1, 0}));
    cases.push_back(keeps_walking("through a source", unit_or_zero, {-20, 0}, {1, 0}));
    cases.push_back(keeps_walking("no field at all", [](Vec2) { return Vec2(0); }, {-20, 0}, {1, 0}));
    cases.push_back(keeps_walking("signs that flip from pixel to pixel",
                                  [](Vec2 p) { return Vec2((std::lround(p.x + p.y) % 2) != 0 ? -1 : 1, 0); },
                                  {-20, 0}, {1, 0}));
    cases.push_back(keeps_walking("a right angle", [](Vec2 p) { return p.x < 0 ? Vec2(1, 0) : Vec2(0, 1); },
                                  {-20, 0}, {1, 0}));
}

} // namespace

StabilityCases path_cases() {
    StabilityCases cases;
    add_linear_fields(cases);
    add_broken_fields(cases);
    return cases;
}

} // namespace pnr
