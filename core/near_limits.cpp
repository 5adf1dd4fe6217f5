// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/near_limits.h"

#include "core/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pnr {
namespace {

// Of neighbouring floats about 1.
constexpr double float_spacing = 0x1p-23;
// Spacings of floats across an object below which places on it lie visibly wrong in a picture of it.
constexpr double fewest_spacings = 4096;
// Of a gather radius likewise: the density of photons is off by about 2 / this.
constexpr double fewest_in_radius = 64;
// Distance of two seeds over the object's size.
constexpr double nearest_seeds = 1e-6;
// Photons of a light, and how much stronger the others are together.
constexpr std::int64_t fewest_photons = 200;
constexpr double much_stronger = 1e4;
constexpr std::size_t most_said = 3;

std::string place(const SourceRef& at) {
    return at.line > 0 ? fmt::format("{}:{}:{}: ", at.file, at.line, at.column) : std::string();
}

// Notes of one kind with how bad they are; the worst are kept.
struct Kind {
    std::vector<std::pair<double, std::string>> notes;

    void add_to(std::vector<std::string>& all) {
        std::stable_sort(notes.begin(), notes.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        const std::size_t more = notes.size() > most_said ? notes.size() - most_said : 0;
        for (std::size_t i = 0; i < notes.size() - more; ++i) all.push_back(notes[i].second);
        if (more > 0) all.back() += fmt::format(" (and {} more like it)", more);
    }
};

bool is_bounded(const Bounds& b) { return !is_empty(b) && std::isfinite(glm::length(b.high - b.low)); }

double farthest(const Bounds& b) {
    const Vec3 far = glm::max(glm::abs(b.low), glm::abs(b.high));
    return std::max({far.x, far.y, far.z});
}

void add_radius(const World& world, const Settings& settings, Kind& kind) {
    double far = 0;
    for (const WorldObject& object : world.objects)
        if (is_bounded(object.bounds)) far = std::max(far, farthest(object.bounds));
    const double radius = settings.photons.radius, spacing = far * float_spacing;
    if (!(radius > 0) || radius >= fewest_in_radius * spacing) return;
    kind.notes.emplace_back(
        1, fmt::format(
               "photons are gathered within a radius of {:.3g}, but their places are only known to {:.3g}: "
               "a larger radius, or none, would show smoother light",
               radius, spacing));
}

void add_small(const WorldObject& object, Kind& kind) {
    if (!is_bounded(object.bounds)) return;
    const double size = glm::length(object.bounds.high - object.bounds.low);
    const double spacing = farthest(object.bounds) * float_spacing;
    if (!(size > 0) || size >= fewest_spacings * spacing) return;
    kind.notes.emplace_back(
        spacing / size,
        fmt::format(
            "{}`{}` is {:.3g} wide, but where it stands photons' places are only known to {:.3g}: their "
            "light will be blurred on it",
            place(object.said_at), object.name, size, spacing));
}

void add_seeds(const WorldObject& object, Kind& kind) {
    if (!object.npr || !is_bounded(object.bounds)) return;
    const double least = nearest_seeds * glm::length(object.bounds.high - object.bounds.low);
    const std::vector<Seed>& seeds = object.paint.seeds;
    for (std::size_t i = 0; i < seeds.size(); ++i)
        for (std::size_t k = i + 1; k < seeds.size(); ++k) {
            const double apart = glm::distance(seeds[i].position, seeds[k].position);
            if (apart >= least) continue;
            kind.notes.emplace_back(
                1 - apart / least,
                fmt::format(
                    "{}seeds {} and {} of `{}` are {:.3g} apart, next to nothing beside its size: the "
                    "field about them is ill-conditioned",
                    place(seeds[k].said_at), i + 1, k + 1, object.name, apart));
        }
}

void add_lights(const World& world, const Settings& settings, Kind& kind) {
    const EmissionPlan plan = plan_emission(world, settings.photons);
    for (const LightShare& share : plan.shares) {
        if (share.caustics || share.count >= fewest_photons) continue;
        const auto others = static_cast<double>(plan.everywhere - share.count);
        const double ratio = others / static_cast<double>(share.count);
        if (ratio < much_stronger) continue;
        const Light& light = world.lights[static_cast<std::size_t>(share.light)];
        kind.notes.emplace_back(
            ratio,
            fmt::format("{}this light gets {} of {} photons, as much weaker as it is than the others: what "
                        "only it lights indirectly will be spotty",
                        place(light.said.said_at), share.count, plan.everywhere));
    }
}

} // namespace

std::vector<std::string> near_limits(const World& world, const Settings& settings, bool photons) {
    Kind radius, small, seeds, lights;
    if (photons) add_radius(world, settings, radius);
    for (const WorldObject& object : world.objects) {
        if (photons) add_small(object, small);
        add_seeds(object, seeds);
    }
    if (photons) add_lights(world, settings, lights);
    std::vector<std::string> all;
    for (Kind* kind : {&radius, &small, &seeds, &lights}) kind->add_to(all);
    return all;
}

} // namespace pnr
