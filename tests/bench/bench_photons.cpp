// SPDX-License-Identifier: GPL-3.0-or-later
// Photon look-ups against nanoflann and CGAL's Kd_tree in one run: a million photons, k nearest, all
// structures asked the same questions in the same order (along a Hilbert curve, as tiles are). Every query's
// k-th distance is compared.
//
// bench_photons [--photons N] [--queries N] [--rounds N]
// Prints rows of
// photons,structure,k,queries,kq_s,ratio_nanoflann,build_s,build_ratio_nanoflann,bytes_per_photon. Times are
// CPU time of one thread for queries and for builds, medians of interleaved rounds.

#include "core/kdtree.h"
#include "core/light.h"
#include "core/material.h"
#include "core/parallel.h"
#include "core/rng.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace pnr;

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

// ---- photons and queries
// ------------------------------------------------------------------------------------------

struct Questions {
    std::string name;
    std::vector<Vec3f> photons;
    std::vector<Vec3f> queries;
};

// The room of the paper, 10 x 10 x 20 without its front wall: a wall and a place on it by area.
Vec3 on_walls(Rng& rng) {
    const double u = rng.uniform(), x = rng.uniform(), y = rng.uniform();
    if (u < 0.1) return {10 * x - 5, 10 * y, 10};
    const Vec3 along{0, 0, 20 * y - 10};
    if (u < 0.325) return along + Vec3(10 * x - 5, 0, 0);
    if (u < 0.55) return along + Vec3(10 * x - 5, 10, 0);
    if (u < 0.775) return along + Vec3(-5, 10 * x, 0);
    return along + Vec3(5, 10 * x, 0);
}

// What a camera in front of the room sees.
Vec3 seen_wall(double x, double y) {
    const Vec3 from{0, 5, -13.5}, direction{x - 0.5, 0.5 - y, 1.2};
    double t = (10 - from.z) / direction.z;
    if (direction.x != 0) t = std::min(t, 5 / std::abs(direction.x));
    if (direction.y != 0) t = std::min(t, 5 / std::abs(direction.y));
    return from + t * direction;
}

// Where light from a small lamp above a glass ball of radius 1 meets the floor: the caustic, thousands of
// times denser in its middle than at its rim.
bool through_ball(Rng& rng, Vec3& floor) {
    const Vec2 lamp = square_to_disc(rng.uniform2()) * 0.3, aim = square_to_disc(rng.uniform2());
    const Vec3 center{0, 1.2, 0}, from{lamp.x, 8, lamp.y};
    Vec3 d = glm::normalize(Vec3(aim.x, 1.2, aim.y) - from);
    const auto cross = [&](Vec3 p, bool far, Vec3& hit) {
        const double b = glm::dot(p - center, d), c = glm::dot(p - center, p - center) - 1;
        if (b * b < c) return false;
        hit = p + (-b + (far ? 1 : -1) * std::sqrt(b * b - c)) * d;
        return true;
    };
    Vec3 in, out, inside;
    if (!cross(from, false, in) || !refract_direction(-d, glm::normalize(in - center), 1 / 1.5, inside))
        return false;
    d = inside;
    if (!cross(in, true, out) || !refract_direction(-d, -glm::normalize(out - center), 1.5, inside))
        return false;
    if (inside.y > -1e-3) return false;
    floor = out - (out.y / inside.y) * inside;
    return true;
}

std::uint64_t hilbert(std::uint32_t x, std::uint32_t y, int order) {
    std::uint64_t d = 0;
    for (std::uint32_t s = 1u << (order - 1); s > 0; s >>= 1) {
        const std::uint32_t rx = (x & s) ? 1 : 0, ry = (y & s) ? 1 : 0;
        d += static_cast<std::uint64_t>(s) * s * ((3 * rx) ^ ry);
        if (ry == 0) {
            if (rx == 1) {
                x = s - 1 - (x & (s - 1));
                y = s - 1 - (y & (s - 1));
            }
            std::swap(x, y);
        }
    }
    return d;
}

// `count` points of a picture in Hilbert order.
std::vector<Vec3f> picture_queries(std::size_t count, const std::function<Vec3(double, double)>& see) {
    int order = 1;
    while ((std::size_t{1} << (2 * order)) < count) ++order;
    const std::uint32_t side = 1u << order;
    std::vector<Vec3f> points(static_cast<std::size_t>(side) * side);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x)
            points[hilbert(x, y, order)] = Vec3f(see((x + 0.5) / side, (y + 0.5) / side));
    points.resize(count);
    return points;
}

Questions uniform_questions(std::size_t photons, std::size_t queries) {
    Questions q{"uniform", {}, picture_queries(queries, seen_wall)};
    Rng rng = make_rng(1, Pass::test, 0);
    while (q.photons.size() < photons) q.photons.push_back(Vec3f(on_walls(rng)));
    return q;
}

Questions caustic_questions(std::size_t photons, std::size_t queries) {
    const auto floor = [](double x, double y) { return Vec3(3 * x - 1.5, 0, 3 * y - 1.5); };
    Questions q{"caustic", {}, picture_queries(queries, floor)};
    Rng rng = make_rng(2, Pass::test, 0);
    Vec3 p;
    while (q.photons.size() < photons)
        if (through_ball(rng, p)) q.photons.push_back(Vec3f(p));
    return q;
}

// ---- structures
// -----------------------------------------------------------------------------------------------------

// Each asks all queries and leaves the k-th squared distances.
using Ask = std::function<void(const std::vector<Vec3f>&, int, std::vector<float>&)>;
struct Structure {
    std::string name;
    std::function<void(const std::vector<Vec3f>&)> build;
    Ask ask;
    std::function<double()> bytes; // per photon, without the photons themselves
    std::vector<double> build_seconds;
    std::vector<double> seconds; // of a round, for the k at hand
};

struct Cloud {
    const std::vector<Vec3f>* points = nullptr;
    std::size_t kdtree_get_point_count() const { return points->size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return (*points)[i][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

Structure nanoflann_structure() {
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3,
                                                     std::uint32_t>;
    struct State {
        Cloud cloud;
        std::unique_ptr<Tree> tree;
    };
    auto state = std::make_shared<State>();
    return {"nanoflann",
            [state](const std::vector<Vec3f>& points) {
                state->cloud.points = &points;
                state->tree =
                    std::make_unique<Tree>(3, state->cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
            },
            [state](const std::vector<Vec3f>& queries, int k, std::vector<float>& kth) {
                std::vector<std::uint32_t> index(static_cast<std::size_t>(k));
                std::vector<float> distance(static_cast<std::size_t>(k));
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    state->tree->knnSearch(&queries[i].x, static_cast<std::size_t>(k), index.data(),
                                           distance.data());
                    kth[i] = distance.back();
                }
            },
            [state] {
                return static_cast<double>(state->tree->usedMemory(*state->tree)) /
                       static_cast<double>(state->cloud.points->size());
            },
            {},
            {}};
}

Structure cgal_structure() {
    using Traits = CGAL::Search_traits_3<CGAL::Simple_cartesian<float>>;
    using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
    using Point = Traits::Point_d;
    auto tree = std::make_shared<std::unique_ptr<Search::Tree>>();
    return {"cgal",
            [tree](const std::vector<Vec3f>& points) {
                std::vector<Point> copies;
                copies.reserve(points.size());
                for (const Vec3f& p : points) copies.emplace_back(p.x, p.y, p.z);
                *tree = std::make_unique<Search::Tree>(copies.begin(), copies.end());
                (*tree)->build();
            },
            [tree](const std::vector<Vec3f>& queries, int k, std::vector<float>& kth) {
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    const Search search(**tree, Point(queries[i].x, queries[i].y, queries[i].z),
                                        static_cast<unsigned>(k));
                    float last = 0;
                    for (const auto& found : search) last = static_cast<float>(found.second);
                    kth[i] = last;
                }
            },
            [] { return std::numeric_limits<double>::quiet_NaN(); },
            {},
            {}};
}

double tree_bytes(const KdTree& tree) {
    const std::size_t bytes = 4 * (tree.x.size() + tree.y.size() + tree.z.size() + tree.order.size()) +
                              sizeof(KdNode) * tree.nodes.size();
    return static_cast<double>(bytes) / static_cast<double>(tree.count);
}

Structure sorted_structure() {
    auto tree = std::make_shared<KdTree>();
    return {"pnr-sorted",
            [tree](const std::vector<Vec3f>& points) { *tree = build_kdtree(points); },
            [tree](const std::vector<Vec3f>& queries, int k, std::vector<float>& kth) {
                std::vector<Neighbour> found;
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    find_nearest(*tree, queries[i], k, std::numeric_limits<float>::infinity(), found);
                    kth[i] = found.back().distance2;
                }
            },
            [tree] { return tree_bytes(*tree); },
            {},
            {}};
}

// The tree as photons use it: sorted into leaf order, asked with the last query's radius as a hint.
Structure pnr_structure() {
    auto tree = std::make_shared<KdTree>();
    return {
        "pnr",
        [tree](const std::vector<Vec3f>& points) { // as build_photon_tree: the photons move to their leaves
            *tree = build_kdtree(points);
            std::vector<Vec3f> sorted;
            sorted.reserve(points.size());
            for (const std::uint32_t i : tree->order) sorted.push_back(points[i]);
            tree->order.clear();
        },
        [tree](const std::vector<Vec3f>& queries, int k, std::vector<float>& kth) {
            std::vector<Neighbour> found;
            SearchHint hint;
            for (std::size_t i = 0; i < queries.size(); ++i)
                kth[i] = find_nearest_near(*tree, queries[i], k, std::numeric_limits<float>::infinity(), hint,
                                           found);
        },
        [tree] { return tree_bytes(*tree); },
        {},
        {}};
}

// ---- running
// --------------------------------------------------------------------------------------------------------

void compare(const std::vector<float>& truth, const std::vector<float>& kth, const std::string& name) {
    for (std::size_t i = 0; i < truth.size(); ++i)
        if (std::abs(truth[i] - kth[i]) > 1e-5f * truth[i] + 1e-12f) {
            fmt::print(stderr, "{}: query {} gives {} instead of {}\n", name, i, kth[i], truth[i]);
            std::exit(1);
        }
}

void run(const Questions& questions, std::vector<Structure>& structures, int rounds) {
    for (Structure& s : structures) s.build_seconds.clear();
    for (int round = 0; round < rounds; ++round)
        for (Structure& s : structures) {
            const double start = cpu_seconds();
            s.build(questions.photons);
            s.build_seconds.push_back(cpu_seconds() - start);
        }
    for (const int k : {50, 100}) {
        std::vector<float> truth(questions.queries.size()), kth(questions.queries.size());
        for (Structure& s : structures) s.seconds.clear();
        for (int round = 0; round < rounds; ++round)
            for (Structure& s : structures) {
                const double start = cpu_seconds();
                s.ask(questions.queries, k, kth);
                s.seconds.push_back(cpu_seconds() - start);
                if (&s == &structures.front()) truth = kth;
                compare(truth, kth, s.name);
            }
        const double base = median(structures.front().seconds),
                     base_build = median(structures.front().build_seconds);
        for (const Structure& s : structures) {
            const double seconds = median(s.seconds), build = median(s.build_seconds);
            fmt::print("{},{},{},{},{:.1f},{:.2f},{:.3f},{:.2f},{:.1f}\n", questions.name, s.name, k,
                       questions.queries.size(),
                       1e-3 * static_cast<double>(questions.queries.size()) / seconds, base / seconds, build,
                       build / base_build, s.bytes());
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    std::size_t photons = 1000000, queries = 262144;
    int rounds = 3;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        if (option == "--photons")
            photons = std::stoul(argv[i + 1]);
        else if (option == "--queries")
            queries = std::stoul(argv[i + 1]);
        else if (option == "--rounds")
            rounds = std::stoi(argv[i + 1]);
        else {
            fmt::print(stderr, "usage: bench_photons [--photons N] [--queries N] [--rounds N]\n");
            return 2;
        }
    }
    const ThreadLimit one(1);
    std::vector<Structure> structures{nanoflann_structure(), cgal_structure(), pnr_structure(),
                                      sorted_structure()};
    fmt::print(
        "photons,structure,k,queries,kq_s,ratio_nanoflann,build_s,build_ratio_nanoflann,bytes_per_photon\n");
    run(uniform_questions(photons, queries), structures, rounds);
    run(caustic_questions(photons, queries), structures, rounds);
}
