// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/radiosity.h"

#include "core/camera.h"
#include "core/light.h"
#include "core/povray_finish.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace pnr {

namespace {

// A record serves points within this share of the mean distance to what it sees, and within so many pixels at least and most.
constexpr double served_share = 0.3, least_pixels = 1.5, most_pixels = 24;
// Cosine of the largest angle between the normals of a record and a point.
constexpr double least_aligned = 0.9;
// Pixels between the places of the first grid that is looked at, and of the last.
constexpr int first_step = 16, last_step = 2;
// Sum of weights from which on a place is known.
constexpr float known_weight = 0.15f;
// The least and the most rays of a record.
constexpr int least_rays = 150, most_rays = 600;
// Most that a gathered ray's light counts in the picture: what carries less is given up sooner.
constexpr float gather_weight = 0.2f;

struct GatherRecord {
    Vec3 position, normal;
    Color radiance{0};
    std::array<Vec3f, 3> moved{}, turned{}; // derivatives of each channel
    double reach = 0;
};

struct CellHash {
    std::size_t operator()(std::uint64_t key) const { return static_cast<std::size_t>(mix_bits(key)); }
};

} // namespace

// Records lie in cells at least twice as wide as they reach, of a level for each power of two; in all that they touch.
struct GatheredLight {
    std::vector<GatherRecord> records;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>, CellHash> cells;
    std::vector<int> levels; // that hold any
};

namespace {

std::uint64_t cell_key(int level, std::int64_t x, std::int64_t y, std::int64_t z) {
    return hash_words(hash_words(static_cast<std::uint64_t>(level), static_cast<std::uint64_t>(x)),
                      hash_words(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(z)));
}

std::int64_t cell_of(double coordinate, int level) {
    return static_cast<std::int64_t>(std::floor(std::ldexp(coordinate, -level)));
}

void keep(GatheredLight& gathered, const GatherRecord& record) {
    const int level = std::ilogb(2 * record.reach) + 1;
    const auto index = static_cast<std::uint32_t>(gathered.records.size());
    gathered.records.push_back(record);
    const Vec3 low = record.position - record.reach, high = record.position + record.reach;
    for (auto x = cell_of(low.x, level); x <= cell_of(high.x, level); ++x)
        for (auto y = cell_of(low.y, level); y <= cell_of(high.y, level); ++y)
            for (auto z = cell_of(low.z, level); z <= cell_of(high.z, level); ++z)
                gathered.cells[cell_key(level, x, y, z)].push_back(index);
    if (std::find(gathered.levels.begin(), gathered.levels.end(), level) == gathered.levels.end())
        gathered.levels.push_back(level);
}

// ---- asking
// -----------------------------------------------------------------------------------------------------

struct Answer {
    Color radiance{0};
    float weight = 0;
};

// 1 at the record, 0 where it is no longer to be trusted.
float weight_at(const GatherRecord& record, Vec3 position, Vec3 normal) {
    const Vec3 apart = position - record.position;
    const double distance = glm::length(apart);
    const double aligned = glm::dot(normal, record.normal);
    if (distance >= record.reach || aligned < least_aligned) return 0;
    if (std::abs(glm::dot(apart, record.normal)) > 0.3 * record.reach) return 0;
    const double bent = std::sqrt(std::max(0.0, 1 - aligned) / (1 - least_aligned));
    return static_cast<float>(1 - std::max(distance / record.reach, bent));
}

Answer ask(const GatheredLight& gathered, Vec3 position, Vec3 normal) {
    Answer answer;
    for (const int level : gathered.levels) {
        const auto found = gathered.cells.find(cell_key(level, cell_of(position.x, level), cell_of(position.y, level),
                                                        cell_of(position.z, level)));
        if (found == gathered.cells.end()) continue;
        for (const std::uint32_t i : found->second) {
            const GatherRecord& record = gathered.records[i];
            const float weight = weight_at(record, position, normal);
            if (!(weight > 0)) continue;
            const Vec3f apart(position - record.position), turn(glm::cross(record.normal, normal));
            for (int c = 0; c < 3; ++c) {
                const float there = record.radiance[c] + glm::dot(apart, record.moved[static_cast<std::size_t>(c)]) +
                                    glm::dot(turn, record.turned[static_cast<std::size_t>(c)]);
                answer.radiance[c] += weight * std::max(0.0f, there);
            }
            answer.weight += weight;
        }
    }
    if (answer.weight > 0) answer.radiance /= answer.weight;
    return answer;
}

// ---- gathering
// --------------------------------------------------------------------------------------------------

// What the rays of one hemisphere found, by ring and sector.
struct Hemisphere {
    int rings, sectors;
    Frame frame;
    std::vector<Color> found;
    std::vector<double> distance;

    std::size_t at(int ring, int sector) const {
        return static_cast<std::size_t>(ring) * static_cast<std::size_t>(sectors) + static_cast<std::size_t>(sector);
    }
};

Color one_ray(const Shading& shading, const GatherPlace& place, Vec3 direction, double& distance, SampleState& state) {
    Hit from;
    from.position = place.position;
    from.normal = from.shading_normal = place.normal;
    from.error = place.error;
    return povray_gather_ray(shading, leave(from, direction), Color{gather_weight}, distance, state);
}

// POV-Ray's gray_threshold takes colour out of what is gathered.
Color greyed(Color c, double threshold) {
    return glm::mix(c, Color((c.x + c.y + c.z) / 3), static_cast<float>(threshold));
}

Hemisphere look_around(const Shading& shading, const GatherPlace& place, int rays, SampleState& state) {
    Hemisphere h;
    h.rings = std::max(2, static_cast<int>(std::lround(std::sqrt(rays / pi))));
    h.sectors = std::max(4, static_cast<int>(std::lround(pi * h.rings)));
    h.frame = make_frame(place.normal);
    for (int j = 0; j < h.rings; ++j)
        for (int k = 0; k < h.sectors; ++k) {
            const double sine2 = (j + state.rng.uniform()) / h.rings;
            const double turn = 2 * pi * (k + state.rng.uniform()) / h.sectors;
            const double sine = std::sqrt(sine2), cosine = std::sqrt(std::max(0.0, 1 - sine2));
            const Vec3 d = sine * (std::cos(turn) * h.frame.x + std::sin(turn) * h.frame.y) + cosine * h.frame.z;
            double distance = infinity;
            h.found.push_back(greyed(one_ray(shading, place, glm::normalize(d), distance, state),
                                     shading.radiosity->gray_threshold));
            h.distance.push_back(std::max(distance, place.width));
        }
    return h;
}

// Derivatives of the mean radiance [Ward and Heckbert 1992, eqs. 3 and 4]; divided by pi.
void differentiate(const Hemisphere& h, GatherRecord& record) {
    for (int k = 0; k < h.sectors; ++k) {
        const double middle = 2 * pi * (k + 0.5) / h.sectors, border = 2 * pi * k / h.sectors;
        const Vec3 u = std::cos(middle) * h.frame.x + std::sin(middle) * h.frame.y;
        const Vec3 v = -std::sin(middle) * h.frame.x + std::cos(middle) * h.frame.y;
        const Vec3 across = -std::sin(border) * h.frame.x + std::cos(border) * h.frame.y;
        const int before = (k + h.sectors - 1) % h.sectors;
        Vec3 turned(0), along(0), sideways(0); // by channel
        for (int j = 0; j < h.rings; ++j) {
            const Vec3 here(h.found[h.at(j, k)]);
            const double low2 = static_cast<double>(j) / h.rings, high2 = (j + 1.0) / h.rings;
            const double middle2 = 0.5 * (low2 + high2);
            turned -= here * std::sqrt(middle2 / (1 - middle2));
            if (j > 0) {
                const double near = std::min(h.distance[h.at(j, k)], h.distance[h.at(j - 1, k)]);
                along += (here - Vec3(h.found[h.at(j - 1, k)])) * (std::sqrt(low2) * (1 - low2) / near);
            }
            const double near = std::min(h.distance[h.at(j, k)], h.distance[h.at(j, before)]);
            sideways += (here - Vec3(h.found[h.at(j, before)])) * ((std::sqrt(high2) - std::sqrt(low2)) / near);
        }
        for (int c = 0; c < 3; ++c) {
            const auto i = static_cast<std::size_t>(c);
            record.turned[i] += Vec3f(v * (turned[c] / (h.rings * h.sectors)));
            record.moved[i] += Vec3f((u * (2 * pi / h.sectors * along[c]) + across * sideways[c]) / pi);
        }
    }
}

SampleState gather_state(const Shading& shading, const GatherPlace& place, std::uint64_t key,
                         std::vector<Neighbour>& scratch) {
    SampleState state;
    // By the place alone, so that all who gather there find the same.
    std::uint64_t bits = hash_words(shading.settings.seed, key);
    for (int i = 0; i < 3; ++i) bits = hash_words(bits, std::bit_cast<std::uint64_t>(place.position[i]));
    state.rng = {bits, 0};
    state.scratch = &scratch;
    state.bounces = 1;
    return state;
}

Color mean_of(const Hemisphere& h) {
    glm::dvec3 sum(0);
    for (const Color c : h.found) sum += glm::dvec3(c);
    return Color(sum / static_cast<double>(h.found.size()));
}

GatherRecord make_record(const Shading& shading, const GatherPlace& place) {
    std::vector<Neighbour> scratch;
    SampleState state = gather_state(shading, place, 1, scratch);
    const int rays = std::clamp(shading.radiosity->count, least_rays, most_rays);
    const Hemisphere h = look_around(shading, place, rays, state);
    GatherRecord record{place.position, place.normal, mean_of(h), {}, {}, 0};
    double inverse = 0;
    for (const double d : h.distance) inverse += 1 / d;
    const double mean_distance = static_cast<double>(h.distance.size()) / std::max(inverse, 1e-300);
    record.reach = std::clamp(served_share * mean_distance, least_pixels * place.width, most_pixels * place.width);
    differentiate(h, record);
    for (int c = 0; c < 3; ++c) { // a steep one is mostly noise: it must not double the light where the record ends
        Vec3f& slope = record.moved[static_cast<std::size_t>(c)];
        const auto change = static_cast<float>(glm::length(Vec3(slope)) * record.reach);
        if (change > record.radiance[c]) slope *= record.radiance[c] / change;
    }
    return record;
}

Color gather_alone(const Shading& shading, const GatherPlace& place, SampleState& state) {
    SampleState own = gather_state(shading, place, 2, *state.scratch);
    const Color found = mean_of(look_around(shading, place, least_rays / 2, own));
    state.rays += own.rays;
    return found;
}

// ---- finding the places
// ---------------------------------------------------------------------------------------------

// The places in every `step`-th pixel that the records do not know yet, in the order of the pixels.
std::vector<GatherPlace> unknown_places(const Shading& shading, const PictureView& view, int step) {
    const int across = (view.width + step - 1) / step, down = (view.height + step - 1) / step;
    std::vector<std::vector<GatherPlace>> rows(static_cast<std::size_t>(down));
    parallel_for(down, 1, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<Neighbour> scratch;
        for (std::int64_t row = begin; row < end; ++row)
            for (int column = 0; column < across; ++column) {
                const Vec2 pixel(std::min(view.width - 0.5, (column + 0.5) * step),
                                 std::min(view.height - 0.5, (static_cast<double>(row) + 0.5) * step));
                const Ray ray = pixel_ray(view, pixel);
                if (sees_nothing(ray)) continue;
                std::vector<GatherPlace> places;
                SampleState state;
                state.rng = make_rng(shading.settings.seed, Pass::render, hash_words(static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(column)));
                state.scratch = &scratch;
                state.pixel_width = pixel_width(view, pixel);
                state.unknown = &places;
                povray_radiance(shading, ray, state);
                auto& all = rows[static_cast<std::size_t>(row)];
                all.insert(all.end(), places.begin(), places.end());
            }
    });
    std::vector<GatherPlace> all;
    for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
}

} // namespace

double pixel_width(const PictureView& view, Vec2 pixel) {
    const Ray here = pixel_ray(view, pixel), beside = pixel_ray(view, pixel + Vec2(1, 0));
    if (sees_nothing(here) || sees_nothing(beside)) return 1.0 / view.width;
    const double parted = glm::length(here.direction - beside.direction);
    // Rays side by side: as if the picture stood one scene away.
    return parted > 1e-9 ? parted : glm::length(here.origin - beside.origin);
}

std::shared_ptr<const GatheredLight> make_gathered_light(const Shading& shading, const PictureView& view,
                                                         const Progress& progress) {
    auto gathered = std::make_shared<GatheredLight>();
    Shading own = shading;
    own.gathered = gathered.get();
    constexpr std::int64_t total = 4;
    std::int64_t done = 0;
    for (int step = first_step; step >= last_step; step /= 2) {
        const std::vector<GatherPlace> places = unknown_places(own, view, step);
        std::vector<GatherRecord> records(places.size());
        parallel_for(static_cast<std::int64_t>(places.size()), 4, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
            for (std::int64_t i = begin; i < end; ++i)
                records[static_cast<std::size_t>(i)] = make_record(shading, places[static_cast<std::size_t>(i)]);
        });
        for (const GatherRecord& record : records) keep(*gathered, record);
        if (progress && !progress(++done, total)) throw Interrupted{};
    }
    return gathered;
}

std::int64_t record_count(const GatheredLight& gathered) { return static_cast<std::int64_t>(gathered.records.size()); }

Color gathered_light(const Shading& shading, const Hit& hit, Vec3 normal, SampleState& state) {
    const RadiositySettings& said = *shading.radiosity;
    const auto brightness = static_cast<float>(said.brightness);
    const bool inside = glm::dot(normal, hit.normal) < 0;
    GatherPlace place{hit.position, said.normal ? normal : inside ? -hit.shading_normal : hit.shading_normal, hit.surface,
                      hit.error, 0};
    if (state.bounces > 0) { // a surface that a gather ray met: one ray goes on
        if (state.bounces >= said.recursion_limit) return Color{0};
        ++state.bounces;
        const Vec3 direction = square_to_cosine(state.rng.uniform2(), make_frame(place.normal));
        double distance = 0;
        const Color found = one_ray(shading, place, direction, distance, state);
        --state.bounces;
        return brightness * greyed(found, said.gray_threshold);
    }
    if (!shading.gathered) return Color{0};
    place.width = std::max(1e-9 * shading.world.radius,
                           state.pixel_width * glm::distance(hit.position, shading.world.camera.location));
    const Answer answer = ask(*shading.gathered, place.position, place.normal);
    if (answer.weight >= known_weight) return brightness * answer.radiance;
    if (state.unknown) {
        state.unknown->push_back(place);
        return Color{0};
    }
    if (answer.weight > 0) return brightness * answer.radiance;
    ++state.gathers;
    return brightness * gather_alone(shading, place, state);
}

} // namespace pnr
