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

// The middle of the pixel that our path reads in a step, and where in the step that is.
struct Place {
    Vec2 at;
    double share;
};

// From a pixel's centre, the way that `heading` points.
std::vector<Place> our_path(const Canvas& canvas, Vec2 start, Vec2 heading) {
    const int x = static_cast<int>(start.x + half), y = static_cast<int>(start.y + half);
    Starts starts;
    starts.x.fill(x), starts.y.fill(y);
    std::vector<MetRow> met;
    const int ahead = glm::dot(Vec2(canvas.at(x, y).direction), heading) < 0 ? 1 : 0;
    walk_paths(canvas, {steps, static_cast<float>(step)}, starts, ahead, met);
    std::vector<Place> path;
    for (std::size_t k = 0; met[k].way[0] > 0; ++k) {
        const std::uint32_t cell = met[k].cell[0];
        path.push_back({Vec2(cell % side + 0.5 - half, cell / side + 0.5 - half),
                        static_cast<double>(
                            sample_share(first_turn(0, ahead) + static_cast<std::uint32_t>(k) * next_turn))});
    }
    return path;
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
// off by at most G sqrt(1/2), G the field's steepness, and by G h / 2 since the place is not the step's
// midpoint; by Gronwall's lemma the path is then off by (sqrt(1/2) + h / 2) (exp(G L) - 1) after the length
// L. We see its place to sqrt(1/2) of a pixel, and the true one on chords, which are off by at most G h^2
// / 8.
StabilityCase against_truth(std::string name, const LinearFlow& flow, Point2 near_start) {
    const Point2 start{near_start[0] + 0.5, near_start[1] + 0.5}; // a pixel's centre
    std::vector<Point2> truth = follow_flow(flow, start, steps, step);
    truth.insert(truth.begin(), start);
    const auto direction = [&](Vec2 p) {
        const Point2 n = unit_direction(flow, {p.x, p.y});
        return Vec2(n[0], n[1]);
    };
    const Vec2 from(start[0], start[1]);
    const std::vector<Place> ours = our_path(canvas_of(direction), from, direction(from));
    double worst = ours.size() == steps ? 0 : infinity;
    for (std::size_t k = 0; k < std::min<std::size_t>(ours.size(), steps); ++k) {
        const Vec2 before(truth[k][0], truth[k][1]), after(truth[k + 1][0], truth[k + 1][1]);
        worst = std::max(worst, glm::length(ours[k].at - glm::mix(before, after, ours[k].share)));
    }
    const double g = steepness(flow, truth), length = steps * step, growth = std::exp(g * length);
    const double bound = std::sqrt(0.5) + (std::sqrt(0.5) + step / 2) * (growth - 1) + g * step * step / 8;
    return {"paths", std::move(name), "pixels from the true path", std::min(bound, length), worst};
}

// Fields that no path can follow exactly: what counts is that it walks on, in steps as long as they should
// be.
StabilityCase keeps_walking(std::string name, const std::function<Vec2(Vec2)>& direction, Vec2 start,
                            Vec2 heading) {
    const std::vector<Place> path = our_path(canvas_of(direction), start, heading);
    double longest = path.size() == steps ? 0 : infinity;
    for (std::size_t k = 1; k < path.size(); ++k)
        longest = std::max(longest, glm::length(path[k].at - path[k - 1].at));
    // Two steps, less what the samples are not at their ends, and what the two pixels' middles may add.
    return {"paths", std::move(name), "longest step, pixels", 2 * step + 2 * std::sqrt(0.5), longest};
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
