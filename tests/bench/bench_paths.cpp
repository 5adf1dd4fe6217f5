// SPDX-License-Identifier: GPL-3.0-or-later
// How far paths stray by the way they are integrated: on smoothed fields given on a grid of pixels, against a
// path of Runge and Kutta's fourth order in steps of 1/64 pixel over the bilinear field.
//
// bench_paths
// Prints a row a field, way and step: reads of the field over a path of 13 pixels (half a stroke of the
// default length), and how far its end lies from the true one, in pixels: median, mean below the 90th
// percentile, 90th percentile. `canvas` reads the nearest of directions kept twice a pixel each way, as the
// painter does; `bilinear` blends axes at every read.

#include "core/rng.h"
#include "npr/direction_field.h"
#include "npr/masked_blur.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace {

using namespace pnr;

constexpr int side = 256;
constexpr double length = 13;

struct Field {
    std::string name;
    Image<Vec2f> axes;
    Image<std::uint8_t> mask{side, side, 1};
    Image<Vec2f> canvas{2 * side, 2 * side};
    mutable int reads = 0;

    Vec2 bilinear(Vec2 p, Vec2 heading) const { return turned(direction_at(axes, mask, Vec2f(p)), heading); }
    Vec2 nearest(Vec2 p, Vec2 heading) const {
        return turned(canvas.at(static_cast<int>(2 * p.x), static_cast<int>(2 * p.y)), heading);
    }
    Vec2 turned(Vec2f found, Vec2 heading) const {
        ++reads;
        const Vec2 d(found);
        return glm::dot(d, heading) < 0 ? -d : d;
    }
};

using Read = Vec2 (Field::*)(Vec2, Vec2) const;

Vec2 rk4_step(const Field& f, Read read, Vec2 p, Vec2 heading, double h, Vec2& next_heading) {
    const Vec2 a = (f.*read)(p, heading), b = (f.*read)(p + a * (h / 2), a),
               c = (f.*read)(p + b * (h / 2), b), d = (f.*read)(p + c * h, c);
    next_heading = d;
    return p + (a + 2.0 * b + 2.0 * c + d) * (h / 6);
}

// Each takes the field, a read, a start, a heading, a step and gives the path's end.
using Way = std::function<Vec2(const Field&, Read, Vec2, Vec2, double)>;

Vec2 euler(const Field& f, Read read, Vec2 p, Vec2 heading, double h) {
    for (double way = 0; way < length - 1e-9; way += h) p += (heading = (f.*read)(p, heading)) * h;
    return p;
}
Vec2 midpoint(const Field& f, Read read, Vec2 p, Vec2 heading, double h) {
    for (double way = 0; way < length - 1e-9; way += h) {
        const Vec2 first = (f.*read)(p, heading);
        heading = (f.*read)(p + first * (h / 2), first);
        p += heading * h;
    }
    return p;
}
// The midpoint, found with the last step's direction: one read a step.
Vec2 carried_midpoint(const Field& f, Read read, Vec2 p, Vec2 heading, double h) {
    for (double way = 0; way < length - 1e-9; way += h) {
        heading = (f.*read)(p + heading * (h / 2), heading);
        p += heading * h;
    }
    return p;
}
// The same read at the step's stratified sample, whose mean over the steps is the midpoint.
Vec2 sampled_midpoint(const Field& f, Read read, Vec2 p, Vec2 heading, double h) {
    auto turn = static_cast<std::uint32_t>(
        mix_bits(static_cast<std::uint64_t>(p.x * 4096) * 65536 + static_cast<std::uint64_t>(p.y * 4096)));
    for (double way = 0; way < length - 1e-9; way += h, turn += 2654435769u) {
        heading = (f.*read)(p + heading * (h * turn * 0x1p-32), heading);
        p += heading * h;
    }
    return p;
}
Vec2 rk4(const Field& f, Read read, Vec2 p, Vec2 heading, double h) {
    for (double way = 0; way < length - 1e-9; way += h) p = rk4_step(f, read, p, heading, h, heading);
    return p;
}
// Bogacki and Shampine's pair of orders 3 and 2 [1989]; `tolerance`: of a step, pixels.
Vec2 adaptive(const Field& f, Read read, Vec2 p, Vec2 heading, double tolerance) {
    double h = 1, way = 0;
    Vec2 a = (f.*read)(p, heading);
    while (way < length - 1e-9) {
        h = std::min(h, length - way);
        const Vec2 b = (f.*read)(p + a * (h / 2), a), c = (f.*read)(p + b * (h * 3 / 4), b);
        const Vec2 next = p + (a * 2.0 + b * 3.0 + c * 4.0) * (h / 9), d = (f.*read)(next, c);
        const double error = h * glm::length(a * (-5.0 / 72) + b / 12.0 + c / 9.0 - d / 8.0);
        if (error <= tolerance || h < 0.05) {
            p = next, way += h, a = d;
        }
        h = std::clamp(0.9 * h * std::cbrt(tolerance / std::max(error, 1e-12)), 0.2 * h, 3 * h);
        h = std::max(h, 0.04);
    }
    return p;
}

Field make_field(const std::string& name, const std::function<double(int, int)>& angle, double sigma) {
    Field field;
    field.name = name;
    field.axes = Image<Vec2f>(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            field.axes.at(x, y) = Vec2f(std::cos(2 * angle(x, y)), std::sin(2 * angle(x, y)));
    masked_blur(field.axes, field.mask, sigma);
    masked_blur(field.axes, field.mask, 7.0 / 3); // the painter's own windows of 15 and 7 pixels
    masked_blur(field.axes, field.mask, 1);
    for (int y = 0; y < 2 * side; ++y)
        for (int x = 0; x < 2 * side; ++x)
            field.canvas.at(x, y) = direction_at(field.axes, field.mask, Vec2f(Vec2(x + 0.5, y + 0.5) * 0.5));
    return field;
}

std::vector<Field> make_fields() {
    const auto rings = [](int x, int y) { return std::atan2(x - 128.0, 128.0 - y); };
    const auto swirls = [](int x, int y) {
        return std::sin(x * 0.06 + std::cos(y * 0.05)) + std::cos(y * 0.08);
    };
    const auto random = [](int x, int y) {
        return pi * make_rng(3, Pass::test, static_cast<std::uint64_t>(y * side + x)).uniform();
    };
    return {make_field("rings", rings, 0), make_field("swirls", swirls, 0), make_field("rough", random, 8)};
}

void compare(const Field& field, const std::string& name, const std::string& reading, Read read,
             const Way& way, double step) {
    std::vector<double> errors;
    double reads = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
        Rng rng = make_rng(1, Pass::test, i);
        const double x = rng.uniform(), y = rng.uniform();
        const Vec2 start(20 + x * (side - 40), 20 + y * (side - 40));
        const Vec2 heading(direction_at(field.axes, field.mask, Vec2f(start)));
        const Vec2 truth = rk4(field, &Field::bilinear, start, heading, 1.0 / 64);
        field.reads = 0;
        errors.push_back(glm::distance(way(field, read, start, heading, step), truth));
        reads += field.reads;
    }
    std::sort(errors.begin(), errors.end());
    const std::size_t most = errors.size() * 9 / 10;
    double mean = 0;
    for (std::size_t i = 0; i < most; ++i) mean += errors[i] / static_cast<double>(most);
    fmt::print("{},{},{},{:g},{:.1f},{:.5f},{:.5f},{:.5f}\n", field.name, name, reading, step,
               reads / static_cast<double>(errors.size()), errors[errors.size() / 2], mean, errors[most]);
}

} // namespace

int main() {
    fmt::print("field,way,reading,step_or_tolerance,reads,median,mean,p90\n");
    for (const Field& field : make_fields()) {
        const auto both = [&](const std::string& name, const Way& way, std::initializer_list<double> steps) {
            for (const double step : steps) {
                compare(field, name, "canvas", &Field::nearest, way, step);
                compare(field, name, "bilinear", &Field::bilinear, way, step);
            }
        };
        both("euler", euler, {0.25, 0.5, 1});
        both("sampled_midpoint", sampled_midpoint, {0.25, 0.5, 1});
        both("carried_midpoint", carried_midpoint, {0.25, 0.5, 1});
        both("midpoint", midpoint, {0.5, 1});
        both("rk4", rk4, {0.5, 1, 3.25});
        both("adaptive", adaptive, {1e-2, 1e-3, 1e-4});
    }
    return 0;
}
