// SPDX-License-Identifier: GPL-3.0-or-later
// Rays and roots where rounding bites. Truth: the same hit with 50 digits, polynomials built from their
// roots, counts that geometry fixes (a closed surface lets no ray through).
#include "cli/stability.h"

#include "core/geometry.h"
#include "core/material.h"
#include "core/polynomial.h"
#include "core/rng.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;
constexpr double eps = 2.220446049250313e-16;

std::shared_ptr<const Geometry> geometry_of(std::vector<Shape> shapes) {
    std::vector<GeometryItem> items;
    for (Shape& shape : shapes) {
        GeometryItem item;
        item.form = std::move(shape);
        items.push_back(std::move(item));
    }
    return make_geometry(std::move(items));
}

Vec3 random_direction(Rng& rng) {
    const double z = 2 * rng.uniform() - 1, angle = 2 * pi * rng.uniform(), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

// |p - c| - r with 50 digits.
double exact_sphere_distance(Vec3 p, const Sphere& sphere) {
    Exact sum = 0;
    for (int k = 0; k < 3; ++k) {
        const Exact d = Exact(p[k]) - Exact(sphere.center[k]);
        sum += d * d;
    }
    return static_cast<double>(Exact(sqrt(sum)) - Exact(sphere.radius));
}

// How far hits lie off the sphere, in units of the error that they state for themselves; and rays that miss
// it.
void add_spheres(StabilityCases& cases) {
    for (const auto& [radius, center] :
         {std::pair{1.0, 0.0}, {1e-6, 0.0}, {1e6, 0.0}, {1.0, 1e7}, {1e-3, 1e4}}) {
        const Sphere sphere{Vec3(center, -center, center), radius};
        const auto geometry = geometry_of({sphere});
        Rng rng = make_rng(1, Pass::test, 0);
        double worst = 0;
        int missed = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 from = sphere.center + 5.0 * radius * random_direction(rng);
            const Vec3 target = sphere.center + 0.9 * radius * random_direction(rng);
            const auto hit =
                closest_hit(*geometry, {from, glm::normalize(target - from), 0, infinity}, RayKind::camera);
            if (!hit) {
                ++missed;
                continue;
            }
            worst = std::max(worst, std::abs(exact_sphere_distance(hit->position, sphere)) / hit->error);
        }
        const std::string name = fmt::format("sphere of radius {:.0e}, {:.0e} away", radius, center);
        cases.push_back({"rays", name, "distance of hits / stated bound", 1, worst});
        cases.push_back({"rays", name, "rays through it that miss", 0, static_cast<double>(missed)});
    }
}

// A ball of triangles that are `aspect` times as long as wide: rings of few, long faces.
Mesh sliver_ball(int around, int along) {
    auto data = std::make_shared<MeshData>();
    const auto ring = [&](int i, int j) -> std::uint32_t {
        if (j == 0) return 0;
        if (j == along) return 1;
        return static_cast<std::uint32_t>(2 + (j - 1) * around + i % around);
    };
    data->positions = {Vec3f(0, -1, 0), Vec3f(0, 1, 0)};
    for (int j = 1; j < along; ++j) {
        for (int i = 0; i < around; ++i) {
            const double a = 2 * pi * i / around, b = pi * j / along;
            data->positions.emplace_back(std::sin(b) * std::cos(a), -std::cos(b), std::sin(b) * std::sin(a));
        }
    }
    for (int j = 0; j < along; ++j) {
        for (int i = 0; i < around; ++i) {
            if (j > 0) data->triangles.push_back({ring(i, j), ring(i, j + 1), ring(i + 1, j)});
            if (j < along - 1)
                data->triangles.push_back({ring(i + 1, j), ring(i, j + 1), ring(i + 1, j + 1)});
        }
    }
    Mesh mesh;
    mesh.data = std::move(data);
    return mesh;
}

// From the inside of a closed mesh, towards its vertices and edges, where float tests leak: every ray must
// hit.
void add_leaks(StabilityCases& cases) {
    for (const auto& [around, along] : {std::pair{16, 8}, {2000, 3}, {100000, 3}}) {
        const Mesh mesh = sliver_ball(around, along);
        const auto geometry = geometry_of({Shape(mesh)});
        Rng rng = make_rng(2, Pass::test, 0);
        int leaks = 0;
        constexpr int rays = 50000;
        for (int i = 0; i < rays; ++i) {
            const auto& triangle = mesh.data->triangles[rng.bits() % mesh.data->triangles.size()];
            const auto corner = [&](std::uint32_t k) { return Vec3(mesh.data->positions[k]); };
            const Vec3 from = 0.05 * random_direction(rng);
            const Vec3 target =
                i % 2 == 0 ? corner(static_cast<std::uint32_t>(rng.bits() % mesh.data->positions.size()))
                           : 0.5 * (corner(triangle[0]) + corner(triangle[1]));
            if (!closest_hit(*geometry, {from, target - from, 0, infinity}, RayKind::camera)) ++leaks;
        }
        cases.push_back({"rays", fmt::format("closed mesh, {} faces round an axis", around),
                         fmt::format("leaks of {} rays at vertices and edges", rays), 0,
                         static_cast<double>(leaks)});
    }
}

// Two squares in one place: whichever is met, the place is the same, and the first one said wins for every
// ray.
void add_coincident_faces(StabilityCases& cases) {
    const Box one{Vec3(-1, -1, 0), Vec3(1, 1, 1)}, two{Vec3(-1, -1, 0), Vec3(1, 1, 2)};
    const auto geometry = geometry_of({one, two});
    Rng rng = make_rng(3, Pass::test, 0);
    std::array<int, 2> met{};
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 from(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, -3 - rng.uniform());
        const Vec3 target(1.8 * rng.uniform() - 0.9, 1.8 * rng.uniform() - 0.9, 0);
        const auto hit = closest_hit(*geometry, {from, target - from, 0, infinity}, RayKind::camera);
        if (!hit) {
            worst = infinity;
            break;
        }
        ++met[hit->surface];
        worst = std::max(worst, std::abs(hit->position.z));
    }
    cases.push_back({"rays", "coincident faces", "distance from the face", 1e-15, worst});
    cases.push_back({"rays", "coincident faces", "rays that meet the less frequent one", 0,
                     static_cast<double>(std::min(met[0], met[1]))});
}

void add_grazing_rays(StabilityCases& cases) {
    for (double angle = 1e-2; angle > 1e-13; angle *= 1e-2) {
        const auto geometry = geometry_of({Plane{Vec3(0, 1, 0), 0}});
        const auto hit = closest_hit(*geometry, {{0, 1, 0}, {1, -angle, 0}, 0, infinity}, RayKind::camera);
        const double far = hit ? std::abs(hit->t * angle - 1) : infinity;
        cases.push_back({"rays", fmt::format("plane met at an angle of {:.0e}", angle),
                         "relative error of the distance", 4 * eps, far});
    }
    // Along the face itself, with components that are zeros of both signs: no ray between two boxes' facing
    // sides may meet either.
    const auto walls =
        geometry_of({Box{Vec3(-2, -1, -1), Vec3(-1, 1, 1)}, Box{Vec3(1, -1, -1), Vec3(2, 1, 1)}});
    int wrong = 0;
    for (const double x : {-0.999, 0.0, 0.999})
        for (const double zero : {0.0, -0.0})
            for (const double z : {1.0, -1.0})
                wrong +=
                    closest_hit(*walls, {{x, 0.3, -5 * z}, {zero, zero, z}, 0, infinity}, RayKind::camera)
                        .has_value();
    cases.push_back({"rays", "between two boxes, zero components of both signs", "wrong hits", 0,
                     static_cast<double>(wrong)});
}

// Sine of the refracted angle with 50 digits.
void add_refraction(StabilityCases& cases) {
    for (const double ior : {1 + 1e-9, 1 + 1e-12, 1.0, 1.5, 10.0}) {
        double worst = 0;
        for (int i = 1; i < 1000; ++i) {
            const double sine = i / 1000.0;
            const Vec3 out(sine, std::sqrt(1 - sine * sine), 0);
            Vec3 refracted(0);
            if (!refract_direction(out, Vec3(0, 1, 0), 1 / ior, refracted)) worst = infinity;
            const double truth = static_cast<double>(-Exact(out.x) / Exact(ior));
            worst = std::max({worst, std::abs(refracted.x - truth), std::abs(glm::length(refracted) - 1)});
        }
        cases.push_back({"rays", fmt::format("refraction, index 1 + {:.0e}", ior - 1),
                         "error of the direction", 8 * eps, worst});
    }
    // At the edge of total reflection everything is reflected, and just inside it nothing is lost or made.
    double worst = 0;
    for (double below = 1e-1; below > 1e-17; below *= 0.1) {
        const double critical = std::asin(1 / 1.5), cosine = std::cos(critical - below);
        const double share = fresnel_dielectric(cosine, 1.5);
        worst = std::max(worst, share >= 0 && share <= 1 ? 0 : infinity);
    }
    cases.push_back({"rays", "up to the edge of total reflection", "shares outside of 0 to 1", 0, worst});
    cases.push_back({"rays", "beyond total reflection", "share that is not reflected", 0,
                     1 - fresnel_dielectric(std::cos(std::asin(1 / 1.5) + 1e-6), 1.5)});
}

// Rays that start on a surface, or at it from inside, find its other side and not itself.
void add_starts_on_surfaces(StabilityCases& cases) {
    const auto geometry = geometry_of({Sphere{Vec3(1e3, 0, 0), 1}});
    Rng rng = make_rng(4, Pass::test, 0);
    int wrong = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 from = Vec3(1e3, 0, 0) + 3.0 * random_direction(rng);
        const Vec3 to = Vec3(1e3, 0, 0) + 0.9 * random_direction(rng);
        const auto hit =
            closest_hit(*geometry, {from, glm::normalize(to - from), 0, infinity}, RayKind::camera);
        if (!hit) continue;
        const Vec3 outwards = hit->normal;
        Vec3 away = random_direction(rng);
        if (glm::dot(away, outwards) < 0) away = -away;
        if (closest_hit(*geometry, leave(*hit, away), RayKind::camera)) ++wrong;
        if (glm::dot(away, outwards) > 1e-3 && !closest_hit(*geometry, leave(*hit, -away), RayKind::camera))
            ++wrong;
    }
    cases.push_back(
        {"rays", "leaving a sphere outwards and inwards", "wrong answers", 0, static_cast<double>(wrong)});
}

// Coefficients of (t - r0)(t - r1)..., constant first.
std::vector<double> polynomial_of(const std::vector<Exact>& roots) {
    std::vector<Exact> c{1};
    for (const Exact& r : roots) {
        c.insert(c.begin(), Exact(0));
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= r * c[i + 1];
    }
    std::vector<double> rounded;
    for (const Exact& x : c) rounded.push_back(static_cast<double>(x));
    return rounded;
}

// A pair `gap` apart beside two others. Rounded coefficients are off by eps, by which a root moves eps / |p'|
// and a near double one sqrt(eps) at most; and the number of roots must be even or odd as the signs at the
// ends say.
void add_close_roots(StabilityCases& cases) {
    for (double gap = 1e-1; gap > 1e-13; gap *= 0.1) {
        const std::vector<Exact> roots{Exact(-0.5), Exact(0.75), Exact(0.75) + Exact(gap), Exact(1.5)};
        const std::vector<double> c = polynomial_of(roots);
        std::array<double, 4> found{};
        const int count = real_roots(c, -2, 2, found.data());
        const double moved = std::min(32 * eps / gap, std::sqrt(32 * eps));
        double worst = 0;
        for (const Exact& root : roots) {
            const bool of_pair = root > Exact(0.7) && root < Exact(1);
            if (of_pair && gap < std::sqrt(32 * eps) && count == 2) continue; // taken for no root: allowed
            double nearest = infinity;
            for (int i = 0; i < count; ++i)
                nearest = std::min(nearest,
                                   std::abs(found[static_cast<std::size_t>(i)] - static_cast<double>(root)));
            worst = std::max(worst, nearest / (of_pair ? moved : 32 * eps));
        }
        cases.push_back({"roots", fmt::format("two roots {:.0e} apart", gap),
                         "error / what rounding moves them", 1, worst});
        cases.push_back({"roots", fmt::format("two roots {:.0e} apart", gap), "roots, odd", 0,
                         static_cast<double>(count % 2)});
    }
}

// Tori met within `gap` of touching: a ray above the tube meets nothing, one below it an even number of
// times.
void add_tangent_tori(StabilityCases& cases) {
    for (double gap = 1e-3; gap > 1e-12; gap *= 0.1) {
        const Torus torus{1, 0.25};
        const auto geometry = geometry_of({torus});
        int wrong = 0;
        for (const double z : {-0.999, -0.3, 0.0, 0.2, 0.8}) {
            const auto ray = [&](double y) { return Ray{{-3, y, z}, {1, 0, 0}, 0, infinity}; };
            if (closest_hit(*geometry, ray(0.25 + gap), RayKind::camera)) ++wrong;
            if (std::abs(z) < 1 && !closest_hit(*geometry, ray(0.25 - gap), RayKind::camera)) ++wrong;
        }
        cases.push_back({"roots", fmt::format("torus passed at {:.0e} from its crest", gap),
                         "wrong answers of 10", 0, static_cast<double>(wrong)});
    }
}

} // namespace

StabilityCases root_cases() {
    StabilityCases cases;
    add_close_roots(cases);
    add_tangent_tori(cases);
    return cases;
}

StabilityCases ray_cases() {
    StabilityCases cases;
    add_spheres(cases);
    add_leaks(cases);
    add_coincident_faces(cases);
    add_grazing_rays(cases);
    add_starts_on_surfaces(cases);
    add_refraction(cases);
    return cases;
}

} // namespace pnr
