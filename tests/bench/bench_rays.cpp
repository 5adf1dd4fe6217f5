// SPDX-License-Identifier: GPL-3.0-or-later
// bench_rays --mesh FILE [--csv FILE|-] [--rounds N] [--threads N]... [--kernel NAME]...
//
// The mesh, seven units large in a box of 10 x 10 x 20, met by camera rays, two bounces and two sets of
// shadow rays, by our kernels, Embree and CGAL's AABB tree in turn, so that whatever else the machine does
// meets all alike. Times are CPU time of the process over the number of threads; ratios are medians over the
// rounds.
#include "core/mesh_io.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "ray_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <thread>

namespace pnr::bench {
namespace {

struct RaySet {
    const char* name;
    bool shadow;
    std::vector<FloatRay> rays;
};

struct SceneSoup {
    std::vector<float> corners; // mesh first, then the box
    std::size_t mesh_triangles = 0;
    bool closed = false; // the mesh
};

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
}

constexpr double shrink = 1.0 / 16; // of the whole scene, so that its numbers are about one

Vec3 corner(const std::vector<float>& corners, std::size_t triangle, std::size_t v) {
    const float* p = &corners[9 * triangle + 3 * v];
    return {p[0], p[1], p[2]};
}

bool is_closed(const MeshData& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
}

void add_box(std::vector<float>& corners) {
    const auto at = [](int i) { return shrink * Vec3(i & 1 ? 5 : -5, i & 2 ? 10 : 0, i & 4 ? 10 : -10); };
    constexpr int walls[6][4] = {{0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1},
                                 {4, 5, 7, 6}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& wall : walls)
        for (const int i : {0, 1, 2, 0, 2, 3})
            for (int k = 0; k < 3; ++k) corners.push_back(static_cast<float>(at(wall[i])[k]));
}

SceneSoup make_scene(const MeshData& mesh) {
    SceneSoup scene;
    Bounds b;
    for (const auto& t : mesh.triangles)
        for (const auto v : t) b = merge(b, Vec3(mesh.positions[v]));
    const Vec3 size = b.high - b.low;
    const double scale = 7 / std::max({size.x, size.y, size.z});
    for (const auto& t : mesh.triangles)
        for (const auto v : t) {
            const Vec3 p = scale * (Vec3(mesh.positions[v]) -
                                    Vec3(0.5 * (b.low.x + b.high.x), b.low.y, 0.5 * (b.low.z + b.high.z)));
            for (int k = 0; k < 3; ++k)
                scene.corners.push_back(static_cast<float>(shrink * (p[k] + (k == 1 ? 0.01 : 0))));
        }
    scene.mesh_triangles = mesh.triangles.size();
    scene.closed = is_closed(mesh);
    add_box(scene.corners);
    return scene;
}

FloatRay float_ray(Vec3 origin, Vec3 direction, double t_max = infinity) {
    FloatRay r{};
    for (int k = 0; k < 3; ++k) {
        r.origin[k] = static_cast<float>(origin[k]);
        r.direction[k] = static_cast<float>(direction[k]);
    }
    r.t_max = static_cast<float>(t_max);
    return r;
}

// From each hit a cosine-distributed bounce and a shadow ray to a square light under the ceiling.
void follow(const SceneSoup& scene, const RayKernel& kernel, const std::vector<FloatRay>& rays,
            std::uint64_t seed, std::vector<FloatRay>& bounces, std::vector<FloatRay>& shadows) {
    std::vector<std::uint32_t> met(rays.size());
    kernel.closest(rays, met.data());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (met[i] == nothing) continue;
        Rng rng = make_rng(seed, Pass::test, i);
        const Vec3 o(rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]),
            d(rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]);
        const Vec3 a = corner(scene.corners, met[i], 0);
        Vec3 n = glm::normalize(
            glm::cross(corner(scene.corners, met[i], 1) - a, corner(scene.corners, met[i], 2) - a));
        const double t = glm::dot(n, a - o) / glm::dot(n, d);
        if (glm::dot(n, d) > 0) n = -n;
        const Vec3 p = o + t * d + shrink * 1e-3 * n;
        if (!std::isfinite(p.x + p.y + p.z)) continue;
        const Vec2 u = rng.uniform2(), w = rng.uniform2();
        const Frame frame = make_frame(n);
        const double r = std::sqrt(u.x), angle = 2 * pi * u.y;
        bounces.push_back(float_ray(p, r * std::cos(angle) * frame.x + r * std::sin(angle) * frame.y +
                                           std::sqrt(1 - u.x) * n));
        const Vec3 light = shrink * Vec3(3 * w.x - 1.5, 9.99, 3 * w.y - 1.5);
        shadows.push_back(float_ray(p, glm::normalize(light - p), glm::length(light - p)));
    }
}

std::vector<RaySet> make_rays(const SceneSoup& scene, const RayKernel& kernel) {
    std::vector<RaySet> sets{{"camera", false, {}},
                             {"bounce1", false, {}},
                             {"bounce2", false, {}},
                             {"shadow1", true, {}},
                             {"shadow2", true, {}}};
    constexpr int size = 512;
    const double half = std::tan(25 * pi / 180);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Vec3 d((2 * (x + 0.5) / size - 1) * half, (1 - 2 * (y + 0.5) / size) * half - 0.1, -1);
            sets[0].rays.push_back(float_ray(shrink * Vec3(0, 5, 9.9), glm::normalize(d)));
        }
    follow(scene, kernel, sets[0].rays, 1, sets[1].rays, sets[3].rays);
    follow(scene, kernel, sets[1].rays, 2, sets[2].rays, sets[4].rays);
    Rng rng = make_rng(3, Pass::test, 0); // the second bounce in no order at all
    for (std::size_t i = sets[2].rays.size(); i > 1; --i)
        std::swap(sets[2].rays[i - 1], sets[2].rays[rng.bits() % i]);
    return sets;
}

// ---- leaks
// ----------------------------------------------------------------------------------------------------

struct LeakRays {
    std::vector<FloatRay> rays;
    std::vector<bool> must_hit;
};

// Rays from a point at corners and middles of edges. From inside a closed mesh each of them must meet it;
// else those that exact arithmetic says meet the very triangle that was aimed at.
LeakRays make_leak_rays(const SceneSoup& scene, std::span<const float> corners, std::size_t count) {
    const ExactTriangles exact(corners);
    const std::size_t triangles = corners.size() / 9;
    const auto second_point = [](const FloatRay& r, double(&p)[3], double(&q)[3]) {
        for (int k = 0; k < 3; ++k) {
            p[k] = static_cast<double>(r.origin[k]);
            q[k] = p[k] + 8 * static_cast<double>(r.direction[k]);
        }
    };
    const auto crossings = [&](const FloatRay& r) {
        double p[3], q[3];
        second_point(r, p, q);
        const Vec3 o(p[0], p[1], p[2]), d(r.direction[0], r.direction[1], r.direction[2]);
        int n = 0;
        for (std::uint32_t i = 0; i < triangles; ++i) {
            if (!exact.meets_line(i, p, q)) continue;
            const Vec3 a = corner(scene.corners, i, 0);
            const Vec3 normal = glm::cross(corner(scene.corners, i, 1) - a, corner(scene.corners, i, 2) - a);
            n += glm::dot(normal, a - o) / glm::dot(normal, d) > 0;
        }
        return n;
    };
    Bounds box;
    for (std::size_t i = 0; i < triangles; ++i) box = merge(box, corner(scene.corners, i, 0));
    Rng rng = make_rng(4, Pass::test, 0);
    Vec3 from = 0.5 * (box.low + box.high);
    for (int attempt = 0; scene.closed && attempt < 1000; ++attempt) {
        const Vec3 p = box.low + (box.high - box.low) * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
        if (crossings(float_ray(p, glm::normalize(Vec3(0.31, 0.81, 0.46)))) % 2 == 0) continue;
        if (crossings(float_ray(p, glm::normalize(Vec3(-0.71, 0.11, -0.36)))) % 2 == 0) continue;
        from = p;
        break;
    }
    LeakRays leaks;
    for (std::size_t i = 0; i < count; ++i) {
        const auto t = static_cast<std::uint32_t>(rng.bits() % triangles);
        const std::size_t v = rng.bits() % 3;
        const Vec3 a = corner(scene.corners, t, v), b = corner(scene.corners, t, (v + 1) % 3);
        const Vec3 origin = Vec3(Vec3f(from)), target = i % 2 ? a : Vec3(0.5f * (Vec3f(a) + Vec3f(b)));
        Vec3f d = Vec3f(target) - Vec3f(origin);
        const float largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        if (!(largest > 0)) continue;
        d *= std::ldexp(1.0f, -std::ilogb(largest)); // keeps the aim; a unit vector would not
        const FloatRay ray = float_ray(origin, Vec3(d));
        double p[3], q[3];
        second_point(ray, p, q);
        leaks.rays.push_back(ray);
        leaks.must_hit.push_back(scene.closed || exact.meets_line(t, p, q));
    }
    return leaks;
}

std::size_t count_leaks(const RayKernel& kernel, const LeakRays& leaks) {
    std::vector<std::uint32_t> met(leaks.rays.size());
    kernel.closest(leaks.rays, met.data());
    std::size_t n = 0;
    for (std::size_t i = 0; i < met.size(); ++i) n += leaks.must_hit[i] && met[i] == nothing;
    return n;
}

// ---- timing
// ---------------------------------------------------------------------------------------------------

double time_rays(const RayKernel& kernel, const RaySet& set, int threads) {
    // Whole scan lines in the middle, for those that would take all day.
    const std::size_t part = kernel.slow ? set.rays.size() / 16 : set.rays.size();
    const std::span<const FloatRay> rays(set.rays.data() + (set.rays.size() - part) / 2, part);
    std::vector<std::uint32_t> met(part);
    std::vector<std::uint8_t> blocked(part);
    const auto run = [&](std::size_t begin, std::size_t end) {
        const auto share = rays.subspan(begin, end - begin);
        if (set.shadow)
            kernel.occluded(share, blocked.data() + begin);
        else
            kernel.closest(share, met.data() + begin);
    };
    const double start = cpu_seconds();
    if (threads == 1) {
        run(0, part);
    } else {
        std::vector<std::thread> workers;
        for (std::size_t i = 0; i < static_cast<std::size_t>(threads); ++i)
            workers.emplace_back(run, part * i / static_cast<std::size_t>(threads),
                                 part * (i + 1) / static_cast<std::size_t>(threads));
        for (std::thread& worker : workers) worker.join();
    }
    return (cpu_seconds() - start) / threads / static_cast<double>(part);
}

struct Options {
    std::string mesh, csv = "-";
    int rounds = 15;
    std::vector<int> threads;
    std::vector<std::string> kernels; // beside Embree's; empty: all
};

int run(const Options& options) {
    const std::filesystem::path file(options.mesh);
    const SceneSoup scene = make_scene(read_mesh(file, {}));
    const std::span<const float> mesh_only(scene.corners.data(), 9 * scene.mesh_triangles);
    std::vector<std::unique_ptr<RayKernel>> kernels;
    kernels.push_back(make_embree(true));
    kernels.push_back(make_embree(false));
    for (const BvhKernel* kernel : available_kernels()) {
        const bool chosen = kernel == &best_kernel();
        kernels.push_back(make_pnr(*kernel, chosen ? "pnr" : std::string("pnr-") + kernel->name));
    }
    kernels.push_back(make_cgal_tree());
    kernels.push_back(make_pnr_scene());
    std::erase_if(kernels, [&](const auto& kernel) {
        const auto& wanted = options.kernels;
        const bool asked = std::find(wanted.begin(), wanted.end(), kernel->name) != wanted.end();
        if (kernel->name == "pnr-scene") return !asked; // no kernel: only if it is asked for
        return !wanted.empty() && !kernel->name.starts_with("embree") && !asked;
    });

    const LeakRays leak_rays = make_leak_rays(scene, mesh_only, 1000000);
    std::vector<std::size_t> leaks;
    for (auto& kernel : kernels) {
        kernel->build(mesh_only);
        leaks.push_back(kernel->slow ? 0 : count_leaks(*kernel, leak_rays));
        if (!kernel->slow) continue;
        LeakRays few{{leak_rays.rays.begin(), leak_rays.rays.begin() + 20000},
                     {leak_rays.must_hit.begin(), leak_rays.must_hit.begin() + 20000}};
        leaks.back() = 50 * count_leaks(*kernel, few);
    }
    {
        const ThreadLimit one(1);
        std::vector<std::vector<double>> seconds(kernels.size());
        for (int round = 0; round < 5; ++round)
            for (std::size_t i = 0; i < kernels.size(); ++i) {
                const double start = cpu_seconds();
                kernels[i]->build(scene.corners);
                seconds[i].push_back(cpu_seconds() - start);
            }
        for (std::size_t i = 0; i < kernels.size(); ++i) {
            kernels[i]->build_seconds = median(seconds[i]);
            kernels[i]->bytes_per_triangle =
                static_cast<double>(kernels[i]->bytes()) / (static_cast<double>(scene.corners.size()) / 9);
        }
    }
    const std::vector<RaySet> sets = make_rays(scene, *kernels[0]);
    std::FILE* out = options.csv == "-" ? stdout : std::fopen(options.csv.c_str(), "w");
    if (!out) return 4;
    std::fprintf(out, "mesh,kernel,rays,threads,mrays_s,ratio_embree_robust,ratio_embree_default,build_s,"
                      "bytes_per_triangle,leaks\n");
    for (const int threads : options.threads)
        for (const RaySet& set : sets) {
            std::vector<std::vector<double>> seconds(kernels.size()), robust(kernels.size()),
                plain(kernels.size());
            for (int round = 0; round < options.rounds; ++round) {
                for (std::size_t i = 0; i < kernels.size(); ++i)
                    if (!kernels[i]->slow || round < 3)
                        seconds[i].push_back(time_rays(*kernels[i], set, threads));
                for (std::size_t i = 0; i < kernels.size(); ++i) {
                    if (kernels[i]->slow && round >= 3) continue;
                    robust[i].push_back(seconds[0].back() / seconds[i].back());
                    plain[i].push_back(seconds[1].back() / seconds[i].back());
                }
            }
            for (std::size_t i = 0; i < kernels.size(); ++i)
                std::fprintf(out, "%s,%s,%s,%d,%.3f,%.3f,%.3f,%.4f,%.1f,%zu\n", file.stem().c_str(),
                             kernels[i]->name.c_str(), set.name, threads, 1e-6 / median(seconds[i]),
                             median(robust[i]), median(plain[i]), kernels[i]->build_seconds,
                             kernels[i]->bytes_per_triangle, leaks[i]);
            std::fflush(out);
        }
    return 0;
}

} // namespace
} // namespace pnr::bench

int main(int argc, char** argv) {
    pnr::bench::Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const char* value = i + 1 < argc ? argv[i + 1] : nullptr;
        if (word == "--mesh" && value)
            options.mesh = argv[++i];
        else if (word == "--csv" && value)
            options.csv = argv[++i];
        else if (word == "--rounds" && value)
            options.rounds = std::max(1, std::atoi(argv[++i]));
        else if (word == "--threads" && value)
            options.threads.push_back(std::max(1, std::atoi(argv[++i])));
        else if (word == "--kernel" && value)
            options.kernels.push_back(argv[++i]);
        else
            options.mesh.clear(), i = argc;
    }
    if (options.threads.empty()) options.threads = {1, 2};
    if (options.mesh.empty()) {
        std::fprintf(stderr, "usage: bench_rays --mesh FILE [--csv FILE|-] [--rounds N] [--threads N]... "
                             "[--kernel NAME]...\n");
        return 2;
    }
    try {
        return pnr::bench::run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 4;
    }
}
