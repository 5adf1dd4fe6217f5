// SPDX-License-Identifier: GPL-3.0-or-later
// bench_ilic [--largest N] [--steps]: seconds for one layer of strokes over a whole square picture, of 512 to N
// (4096) pixels a side and paths 10, 20, 40 pixels long, wall and CPU; and nanoseconds a pixel and step. The
// field turns slowly; cells are 4.5 pixels wide; all pixels are one object's. `whole` is all that `convolve`
// does: smoothing the field, cells, paths, colours; `paths` what lengths cost: whole less the same with
// length 0.
// --steps instead: how far the ends of paths are from the truth, for rules and lengths of steps, on fields that
// are known; and how many places of the field a path reads. The field is stood for by its values at pixels,
// read from the nearest one or blended between four, as a path on a canvas must; truth is the smooth field.
#include "npr/paint.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>

namespace {

using namespace pnr;

// ---- seconds
// ---------------------------------------------------------------------------------------------------

struct Scenery {
    World world;
    GBuffer gbuffer;
    InformativeMap informative;
};

Scenery make_scenery(int side) {
    Scenery s;
    s.world.objects.resize(2);
    s.world.objects[1].npr = true;
    s.gbuffer.view.width = s.gbuffer.view.height = side;
    s.gbuffer.window = {0, 0, side, side};
    s.gbuffer.seen = Image<Seen>(side, side);
    s.gbuffer.coverage = Image<float>(side, side, 1.0f);
    s.informative = InformativeMap(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            Seen& seen = s.gbuffer.seen.at(x, y);
            seen.object = 1, seen.npr = true, seen.z = 1;
            seen.position = Vec3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0);
            seen.normal = {0, 0, -1};
            seen.dpdx = {1, 0, 0}, seen.dpdy = {0, 1, 0};
            Informed& pixel = s.informative.at(x, y);
            pixel.kind = PixelKind::interpolated;
            pixel.object = 1;
            pixel.radiance = Color(0.4f, 0.3f, 0.2f) * (1 + 0.3f * std::sin(static_cast<float>(x + y) / 90));
            const float angle =
                2 * std::sin(static_cast<float>(x) / 150) + 2 * std::cos(static_cast<float>(y) / 110);
            pixel.axis = {std::cos(angle), std::sin(angle)};
        }
    return s;
}

struct Seconds {
    double wall = 0, cpu = 0;
};

// The best of `rounds`. `length` and the cells are in pixels of this picture, whatever its size.
Seconds time_layer(Scenery& s, double length, int rounds) {
    const double pixel = 1 / scaled(1, s.gbuffer.view.height);
    PaintStyle style = default_style();
    style.layers.clear();
    style.length = length * pixel;
    style.cell = 4.5 * pixel;
    style.step = 0.5 * pixel;
    style.gaussian_first = (15 - 1) * pixel + 1;
    style.gaussian_second = (7 - 1) * pixel + 1;
    s.world.objects[1].paint = style;
    Seconds best{1e9, 1e9};
    for (int i = 0; i < rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpu = std::clock();
        const Layer layer = convolve(s.informative, Seats{}, s.world, s.gbuffer, 1);
        best.cpu = std::min(best.cpu, static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
        best.wall = std::min(
            best.wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        if (!std::isfinite(layer.color.pixels.front().x)) std::exit(1);
    }
    return best;
}

void print_seconds(int largest) {
    fmt::print("side,length,whole_wall_s,whole_cpu_s,paths_cpu_s,paths_ns_a_pixel_and_unit_of_length\n");
    for (int side = 512; side <= largest; side *= 2) {
        Scenery s = make_scenery(side);
        const int rounds = side <= 1024 ? 3 : 1;
        const Seconds none = time_layer(s, 0, rounds);
        for (const int length : {10, 20, 40}) {
            const Seconds all = time_layer(s, length, rounds);
            const double paths = all.cpu - none.cpu;
            fmt::print("{},{},{:.3f},{:.3f},{:.3f},{:.2f}\n", side, length, all.wall, all.cpu, paths,
                       paths * 1e9 / (static_cast<double>(side) * side * length));
            std::fflush(stdout);
        }
    }
}

// ---- steps
// -----------------------------------------------------------------------------------------------------

using Field = std::function<Vec2(Vec2)>;
constexpr int side = 256;

struct Reads {
    Field field;
    std::int64_t count = 0;
    Vec2 along(Vec2 p, Vec2 heading) {
        ++count;
        const Vec2 d = field(p);
        return glm::dot(d, heading) < 0 ? -d : d;
    }
};

Vec2 unit(Vec2 v) { return v / std::max(1e-300, glm::length(v)); }

// Values at pixels' middles, read as a canvas is: of the pixel around a place, or blended as axes between four.
Field read_pixels(const Field& field, bool blended) {
    auto pixels = std::make_shared<Image<Vec2>>(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) pixels->at(x, y) = field({x + 0.5, y + 0.5});
    const auto at = [pixels](int x, int y) {
        return pixels->at(std::clamp(x, 0, side - 1), std::clamp(y, 0, side - 1));
    };
    if (!blended)
        return [at](Vec2 p) { return at(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y))); };
    return [at](Vec2 p) {
        const double fx = std::floor(p.x - 0.5), fy = std::floor(p.y - 0.5);
        Vec2 sum(0);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const Vec2 d = at(static_cast<int>(fx) + i, static_cast<int>(fy) + j);
                sum += std::abs(1 - i - (p.x - 0.5 - fx)) * std::abs(1 - j - (p.y - 0.5 - fy)) *
                       Vec2(d.x * d.x - d.y * d.y, 2 * d.x * d.y);
            }
        const double angle = 0.5 * std::atan2(sum.y, sum.x);
        return Vec2(std::cos(angle), std::sin(angle));
    };
}

Vec2 euler(Reads& f, Vec2 p, Vec2 d, double h) { return p + h * f.along(p, d); }
Vec2 midpoint(Reads& f, Vec2 p, Vec2 d, double h) {
    const Vec2 first = f.along(p, d);
    return p + h * f.along(p + 0.5 * h * first, first);
}
Vec2 rk4(Reads& f, Vec2 p, Vec2 d, double h) {
    const Vec2 a = f.along(p, d), b = f.along(p + 0.5 * h * a, a), c = f.along(p + 0.5 * h * b, b),
               e = f.along(p + h * c, c);
    return p + h / 6 * (a + 2.0 * b + 2.0 * c + e);
}

using Rule = Vec2 (*)(Reads&, Vec2, Vec2, double);

Vec2 walk(Reads& f, Rule rule, Vec2 p, Vec2 heading, double length, double h) {
    const int steps = static_cast<int>(std::lround(length / h));
    for (int k = 0; k < steps; ++k) {
        const Vec2 next = rule(f, p, heading, length / steps);
        heading = unit(next - p);
        p = next;
    }
    return p;
}

// Bogacki and Shampine's pair of orders 3 and 2; its last place read is the next step's first.
Vec2 walk_adaptive(Reads& f, Vec2 p, Vec2 heading, double length, double tolerance) {
    double done = 0, h = 1;
    Vec2 a = f.along(p, heading);
    while (done < length - 1e-9) {
        h = std::min(h, length - done);
        const Vec2 b = f.along(p + 0.5 * h * a, a), c = f.along(p + 0.75 * h * b, b);
        const Vec2 next = p + h / 9 * (2.0 * a + 3.0 * b + 4.0 * c);
        const Vec2 d = f.along(next, c);
        const double error = h * glm::length(-5.0 / 72 * a + b / 12.0 + c / 9.0 - d / 8.0);
        if (error <= tolerance || h <= 0.05) done += h, p = next, a = d;
        h = std::clamp(0.9 * h * std::cbrt(tolerance / std::max(error, 1e-12)), 0.05, std::min(4.0, 3 * h));
    }
    return p;
}

struct Known {
    const char* name;
    Field field;
};

void print_steps() {
    constexpr double length = 20;
    const Vec2 middle(side / 2.0);
    const std::vector<Known> fields{
        {"circles", [=](Vec2 p) { return unit({middle.y - p.y, p.x - middle.x}); }},
        {"saddle", [=](Vec2 p) { return unit({p.x - middle.x, middle.y - p.y}); }},
        {"waves", [](Vec2 p) {
             const double a = 1.2 * std::sin(p.x / 9) + 0.9 * std::cos(p.y / 7);
             return Vec2(std::cos(a), std::sin(a));
         }}};
    fmt::print("field,read,rule,step_or_tolerance,rms_pixels,reads_a_path\n");
    for (const Known& known : fields) {
        std::vector<std::pair<Vec2, Vec2>> paths; // start, true end
        Reads truth{known.field};
        for (int i = 0; i < 400; ++i) {
            const Vec2 start = Vec2(60 + 136 * std::fmod(0.5 + i * 0.7548776662466927, 1.0),
                                    60 + 136 * std::fmod(0.5 + i * 0.5698402909980532, 1.0));
            if (glm::distance(start, middle) < 26) continue; // the fields' own singular points
            paths.emplace_back(start, walk(truth, rk4, start, known.field(start), length, 0.01));
        }
        for (const char* reading : {"exact", "blended", "nearest"}) {
            const bool exact = std::strcmp(reading, "exact") == 0;
            Reads reads{exact ? known.field : read_pixels(known.field, std::strcmp(reading, "blended") == 0)};
            const auto row = [&](const char* rule, double value, auto&& end_of) {
                double sum = 0;
                reads.count = 0;
                for (const auto& [start, end] : paths) {
                    const Vec2 off = end_of(start) - end;
                    sum += glm::dot(off, off);
                }
                const auto count = static_cast<double>(paths.size());
                fmt::print("{},{},{},{},{:.5f},{:.0f}\n", known.name, reading, rule, value, std::sqrt(sum / count),
                           static_cast<double>(reads.count) / count);
            };
            for (const double h : {0.25, 0.5, 1.0, 2.0}) {
                row("euler", h, [&](Vec2 p) { return walk(reads, euler, p, known.field(p), length, h); });
                row("midpoint", h, [&](Vec2 p) { return walk(reads, midpoint, p, known.field(p), length, h); });
                row("rk4", h, [&](Vec2 p) { return walk(reads, rk4, p, known.field(p), length, h); });
            }
            for (const double tolerance : {0.1, 0.01, 0.001})
                row("adaptive", tolerance, [&](Vec2 p) { return walk_adaptive(reads, p, known.field(p), length, tolerance); });
        }
    }
}

} // namespace

int main(int count, char** values) {
    int largest = 4096;
    for (int i = 1; i < count; ++i) {
        if (std::strcmp(values[i], "--steps") == 0) {
            print_steps();
            return 0;
        }
        if (std::strcmp(values[i], "--largest") == 0 && i + 1 < count) {
            largest = std::atoi(values[++i]);
        } else {
            fmt::print(stderr, "bench_ilic [--largest N] [--steps]\n");
            return 2;
        }
    }
    print_seconds(largest);
    return 0;
}
