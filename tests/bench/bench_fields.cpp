// SPDX-License-Identifier: GPL-3.0-or-later
// bench_fields: what each kernel and each distance makes of seeds taken from known fields on a sphere, a torus, a
// cylinder and a saddle (meshes of some ten thousand triangles), and what it costs. A row: shape, kernel, distance,
// seeds, mean and 95th percentile of the angle to the truth at 2,000 points, in degrees; largest angle at a seed,
// in degrees; CPU milliseconds to make the field, and microseconds a point to ask it.
#include "core/closest_point.h"
#include "core/rng.h"
#include "core/scene.h"
#include "npr/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

namespace {

using namespace pnr;

struct Known {
    const char* name;
    std::function<Vec3(double, double)> place; // of [0, 1]^2
    std::function<Vec3(Vec3)> axis;            // of a place of the shape, any length; zero: not measured
};

// Circles of latitude, winding lines, helices, straight lines.
std::vector<Known> known_fields() {
    return {{"sphere",
             [](double u, double v) {
                 const double a = 2 * pi * u, b = pi * v;
                 return Vec3(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
             },
             [](Vec3 p) { return std::abs(p.y) < 0.9 ? glm::cross(Vec3(0, 1, 0), p) : Vec3(0); }},
            {"torus",
             [](double u, double v) {
                 const double a = 2 * pi * u, b = 2 * pi * v, r = 1.5 + 0.5 * std::cos(b);
                 return Vec3(r * std::cos(a), 0.5 * std::sin(b), r * std::sin(a));
             },
             [](Vec3 p) {
                 const Vec3 round = glm::normalize(Vec3(-p.z, 0, p.x)), out = glm::normalize(Vec3(p.x, 0, p.z));
                 const double across = (glm::length(Vec2(p.x, p.z)) - 1.5) / 0.5, up = p.y / 0.5;
                 return round + up * out - across * Vec3(0, 1, 0);
             }},
            {"cylinder",
             [](double u, double v) {
                 return Vec3(0.7 * std::cos(2 * pi * u), 2 * v - 1, 0.7 * std::sin(2 * pi * u));
             },
             [](Vec3 p) { return Vec3(0, 1, 0) + Vec3(-p.z, 0, p.x) / 0.7; }},
            {"saddle",
             [](double u, double v) {
                 const double x = 2 * u - 1, y = 2 * v - 1;
                 return Vec3(x, y, 0.7 * x * y);
             },
             [](Vec3 p) { return Vec3(1, 0, 0.7 * p.y); }}};
}

World world_of(const Known& known, const PaintStyle& style) {
    constexpr int n = 72;
    auto data = std::make_shared<MeshData>();
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            data->positions.emplace_back(known.place(static_cast<double>(i) / n, static_cast<double>(j) / n));
    const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            data->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            data->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    Mesh mesh;
    mesh.data = std::move(data);
    Object object;
    object.shape = mesh;
    object.npr.emplace();
    object.npr->on = true;
    object.npr->style = style;
    Scene scene;
    scene.objects.push_back(std::move(object));
    return build_world(scene, {});
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(const Known& known, RbfKernel kernel, SeedDistance distance, int count) {
    const auto place = [&](std::uint64_t number) {
        Rng rng = make_rng(77, Pass::test, number);
        const double u = rng.uniform();
        return known.place(u, rng.uniform());
    };
    PaintStyle style;
    style.kernel = kernel;
    style.distance = distance;
    for (std::uint64_t i = 0; static_cast<int>(style.seeds.size()) < count; ++i)
        if (const Vec3 p = place(i); glm::length(known.axis(p)) > 0) style.seeds.push_back({p, known.axis(p), 1, {}});
    const World world = world_of(known, style);
    double start = cpu_seconds();
    const OrientationFields fields = make_orientation_fields(world);
    const double made = cpu_seconds() - start;
    const auto index = index_surface(world, 1);
    std::vector<ClosestPoint> places;
    for (std::uint64_t i = 1'000'000; places.size() < 2000; ++i)
        if (const Vec3 p = place(i); glm::length(known.axis(p)) > 0)
            places.push_back(closest_point(*index, p - world.offset));
    std::vector<Vec3> found;
    start = cpu_seconds();
    for (const ClosestPoint& on : places) found.push_back(eval_orientation(*fields.fields[1], on.position, on.normal));
    const double asked = cpu_seconds() - start;
    std::vector<double> errors;
    double mean = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3 axis = known.axis(places[i].position + world.offset), n = places[i].normal;
        const Vec3 right = glm::normalize(axis - n * glm::dot(axis, n));
        errors.push_back(std::asin(std::min(1.0, glm::length(glm::cross(found[i], right)))) * 180 / pi);
        mean += errors.back() / static_cast<double>(places.size());
    }
    std::sort(errors.begin(), errors.end());
    fmt::print("{},{},{},{},{:.3f},{:.3f},{:.1e},{:.2f},{:.2f}\n", known.name,
               distance == SeedDistance::geodesic     ? "thin plate"
               : kernel == RbfKernel::biharmonic ? "biharmonic"
                                                 : "triharmonic",
               distance == SeedDistance::straight ? "straight" : "geodesic", count, mean,
               errors[errors.size() * 95 / 100], fields.reports[0].residual * 180 / pi, made * 1e3,
               asked * 1e6 / static_cast<double>(places.size()));
    std::fflush(stdout);
}

} // namespace

int main() {
    fmt::print("shape,kernel,distance,seeds,mean_deg,p95_deg,residual_deg,make_ms,ask_us\n");
    for (const Known& known : known_fields())
        for (const int count : {8, 32, 128, 512}) {
            measure(known, RbfKernel::biharmonic, SeedDistance::straight, count);
            measure(known, RbfKernel::triharmonic, SeedDistance::straight, count);
            measure(known, RbfKernel::biharmonic, SeedDistance::geodesic, count);
        }
    return 0;
}
