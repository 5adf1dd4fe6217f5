// SPDX-License-Identifier: GPL-3.0-or-later
// What a coat of paint costs: one layer of strokes over a whole square picture, along a known field of
// swirls.
//
// bench_ilic [--sizes N,N,...] [--lengths L,L,...]
//   --sizes: pixels a side; --lengths: of the strokes, in pixels of a picture 512 high, as in scenes
// Prints a row a size and length: seconds on the wall, of processor time, and processor time in nanoseconds
// for each pixel and each pixel of the strokes' length in this picture. The least of three runs (one from
// 2048 pixels on).

#include "npr/paint.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <sstream>

namespace {

using namespace pnr;

struct Cost {
    double wall = infinity, processor = infinity;
};

std::vector<int> read_list(const std::string& text) {
    std::vector<int> list;
    std::stringstream stream(text);
    for (std::string item; std::getline(stream, item, ',');) list.push_back(std::atoi(item.c_str()));
    return list;
}

GBuffer flat_gbuffer(int side) {
    GBuffer g;
    g.view.width = g.view.height = side;
    g.window = {0, 0, side, side};
    g.seen = Image<Seen>(side, side);
    g.coverage = Image<float>(side, side, 1.0f);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            Seen& seen = g.seen.at(x, y);
            seen.object = 1, seen.npr = true, seen.z = 1;
            seen.position = Vec3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0);
            seen.normal = {0, 0, -1};
            seen.dpdx = {1, 0, 0}, seen.dpdy = {0, 1, 0};
        }
    return g;
}

// Soft colours, and axes that turn four times across the picture and down it.
InformativeMap swirls(int side) {
    InformativeMap map(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double u = 2 * pi * x / side, v = 2 * pi * y / side;
            const double angle = 3 * std::sin(2 * u + std::cos(v)) + 2 * std::cos(3 * v);
            Informed& pixel = map.at(x, y);
            pixel.kind = PixelKind::interpolated;
            pixel.object = 1;
            pixel.radiance = Color(0.4f) + 0.2f * Color(std::sin(u), std::sin(v), std::cos(u + v));
            pixel.axis = Vec2f(std::cos(angle), std::sin(angle));
        }
    return map;
}

Cost measure(const GBuffer& gbuffer, const InformativeMap& map, double length, int runs) {
    World world;
    world.objects.resize(2);
    world.objects[1].npr = true;
    world.objects[1].paint.length = length;
    Cost cost;
    for (int run = 0; run < runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t before = std::clock();
        const Layer layer = convolve(map, Seats{}, world, gbuffer, 1);
        cost.processor =
            std::min(cost.processor, static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
        cost.wall = std::min(cost.wall,
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return cost;
}

} // namespace

int main(int count, char** values) {
    std::vector<int> sizes{512, 1024, 2048, 4096}, lengths{10, 20, 40};
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string word = values[i];
        if (word == "--sizes") sizes = read_list(values[i + 1]);
        if (word == "--lengths") lengths = read_list(values[i + 1]);
    }
    fmt::print("side,length,wall_s,processor_s,ns_a_pixel_and_length\n");
    for (const int side : sizes) {
        if (side < 1) continue;
        const GBuffer gbuffer = flat_gbuffer(side);
        const InformativeMap map = swirls(side);
        for (const int length : lengths) {
            const Cost cost = measure(gbuffer, map, length, side < 2048 ? 3 : 1);
            fmt::print("{},{},{:.3f},{:.3f},{:.2f}\n", side, length, cost.wall, cost.processor,
                       cost.processor * 1e9 / (static_cast<double>(side) * side * scaled(length, side)));
            std::fflush(stdout);
        }
    }
    return 0;
}
