// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/irradiance_field.h"

#include "core/gbuffer.h"
#include "core/lit_places.h"
#include "core/radiance.h"

#include <atomic>
#include <bit>
#include <mutex>
#include <unordered_map>

namespace pnr {
namespace {

// Strata of a final gather: rings in elevation, sectors in azimuth; sectors near pi times the rings make them
// even.
struct Strata {
    int rings, sectors;
    constexpr int count() const { return rings * sectors; }
};
// By level, from the one that FieldSettings::effort names: where records lie close, more of them are blended at a point,
// and each may know less.
constexpr std::array<Strata, 7> level_strata{{{13, 41}, {11, 34}, {9, 28}, {7, 22}, {6, 19}, {5, 16}, {4, 13}}};
constexpr std::size_t most_levels = 4;
// How much more than the mean a single ray of a record may bring before more are shot.
constexpr float spotty = 8;
// Strata where a point gathers for itself alone, without gradients.
constexpr Strata own_strata{5, 16};
// Share of the mean distance to what a record sees within which it is trusted.
constexpr double trusted_share = 0.35;
// A level's records reach so many of its spacings.
constexpr double reach_in_spacings = 1.75;
// Share of the map's gather radius within which surfaces that gather rays meet are sampled anew.
constexpr double near_share = 0.4;
// Sum of weights that is enough.
constexpr float enough = 0.7f;
// Cosine of the largest angle between a record's normal and the point's.
constexpr float least_aligned = 0.9f;
// Sum of trusted weights from which on a point need not gather for itself.
constexpr float sure_weight = 0.05f;
// Weight of a record where it is not to be trusted, if no other is.
constexpr float last_resort = 1e-5f;
// Photons that tell the light where gather rays end.
constexpr int lit_neighbours = 64;

// Irradiance and its derivatives when the point moves or the normal turns, a vector for each channel.
struct Record {
    Color irradiance{0};
    std::array<Vec3f, 3> moved{}, turned{};
    float reach = 0; // world units, before the level's own limit
};

struct Site {
    Vec3f position, normal;
    std::uint32_t photon = 0; // that marks it
};

struct Level {
    float spacing = 0;
    std::vector<Site> sites;
    KdTree tree;
    std::unique_ptr<std::once_flag[]> asked;
    std::vector<Record> records; // of the sites, filled when first asked for
};

} // namespace

struct IrradianceField {
    mutable std::vector<Level> levels;
    LitPlaces lit;
    mutable std::atomic<std::int64_t> records{0};
    std::uint64_t seed = 0;
    FieldSettings settings;
};

namespace {

// ---- sites
// --------------------------------------------------------------------------------------------------------

// Cells of the width of a spacing, so that only the 27 about a point can hold a site too near to it.
struct Cells {
    float width;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> sites;

    std::uint64_t key(glm::ivec3 c) const {
        return (static_cast<std::uint64_t>(c.x & 0x1fffff) << 42) |
               (static_cast<std::uint64_t>(c.y & 0x1fffff) << 21) |
               static_cast<std::uint64_t>(c.z & 0x1fffff);
    }
    glm::ivec3 cell(Vec3f p) const { return glm::ivec3(glm::floor(p / width)); }
};

// Whether a site of the same sheet and side lies nearer than the spacing.
bool crowded(const Level& level, const Cells& cells, const Photon& photon) {
    const glm::ivec3 c = cells.cell(photon.position);
    for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const auto found = cells.sites.find(cells.key(c + glm::ivec3(dx, dy, dz)));
                if (found == cells.sites.end()) continue;
                for (const std::uint32_t i : found->second) {
                    const Site& site = level.sites[i];
                    const Vec3f apart = photon.position - site.position;
                    if (glm::dot(apart, apart) < level.spacing * level.spacing &&
                        glm::dot(photon.direction, site.normal) < 0 &&
                        std::abs(glm::dot(apart, site.normal)) < 0.3f * level.spacing)
                        return true;
                }
            }
    return false;
}

// Poisson-disc sites by dart throwing, the photons as darts.
Level make_level(const World& world, const PhotonMap& map, float spacing) {
    Level level;
    level.spacing = spacing;
    Cells cells{spacing, {}};
    for (std::size_t i = 0; i < map.tree.count; ++i) {
        const Photon& photon = map.photons[i];
        if (crowded(level, cells, photon)) continue;
        const std::optional<Hit> hit = hit_of_photon(world, photon);
        if (!hit) continue;
        cells.sites[cells.key(cells.cell(photon.position))].push_back(
            static_cast<std::uint32_t>(level.sites.size()));
        level.sites.push_back(
            {photon.position, Vec3f(lit_side(*hit, photon)), static_cast<std::uint32_t>(i)});
    }
    std::vector<Vec3f> positions;
    positions.reserve(level.sites.size());
    for (const Site& site : level.sites) positions.push_back(site.position);
    level.tree = build_kdtree(positions);
    level.asked = std::make_unique<std::once_flag[]>(level.sites.size());
    level.records.resize(level.sites.size());
    return level;
}

// ---- light that gather rays bring
// ----------------------------------------------------------------------------------

// What the points share that gather rays are shot from.
struct GatherScene {
    const IrradianceField& field;
    const World& world;
    const PhotonMap& map;
};

// Direct and caustic light that a matt surface reflects: all but what the next ray of a path is to bring.
Color near_light(const GatherScene& scene, const Hit& hit, const Bsdf& matt, Vec3 outgoing, bool caustics,
                 Rng& rng, std::vector<Neighbour>& scratch) {
    const Color direct = direct_light(scene.world, hit, matt, outgoing, 1, rng);
    if (!caustics || scene.map.caustic.count == 0) return direct;
    GatherSettings alone;
    alone.count = lit_neighbours;
    alone.radius = scene.map.radius;
    alone.indirect = false;
    alone.field = false;
    return direct + gather(scene.world, scene.map, alone, hit.position, matt, outgoing, scratch);
}

// Radiance that a gather ray brings: reflected by the first diffuse surface, seen straight or through
// specular ones. What emitters send is left out: it is direct or caustic light; and so are caustics seen through a
// specular surface, which are caustics again (PhotonPath). A surface met nearer than the
// width over which the photons' light is known is sampled anew, and the ray goes on from there [Christensen
// 1999]; else light from round a corner would shine into it.
Color gathered_radiance(const GatherScene& scene, Ray ray, Rng& rng, double& distance,
                        std::vector<Neighbour>& scratch) {
    constexpr int most_bounces = 8; // specular ones, and near
    constexpr int most_near = 4;
    const World& world = scene.world;
    const double near = near_share * scene.map.radius;
    Color throughput{1}, found{0};
    bool straight = true; // from the last diffuse surface
    distance = infinity;
    for (int bounce = 0, scattered = 0; bounce < most_bounces; ++bounce) {
        const std::optional<Hit> hit = closest_hit(world, ray, RayKind::specular);
        if (!hit) return found + throughput * sky_radiance(world, ray.direction);
        if (bounce == 0) distance = hit->t;
        if (world.surfaces[hit->surface].light >= 0) return found;
        const Vec3 outgoing = -ray.direction;
        const Bsdf bsdf = make_bsdf(world, *hit, outgoing);
        if (bounce > 0) throughput *= segment_transmittance(world, *hit, bsdf, hit->t);
        const double spread = has_diffuse(bsdf) ? max_component(bsdf.diffuse + bsdf.glossy) : 0.f;
        const double mirror = max_component(bsdf.mirror), transmit = max_component(bsdf.transmit);
        const double sum = spread + mirror + transmit;
        if (!(sum > 0)) return found + throughput * bsdf.emission;
        const double u = mirror + transmit > 0 ? rng.uniform() * sum : 0;
        if (u < spread || mirror + transmit == 0) {
            found += throughput * bsdf.emission;
            throughput *= static_cast<float>(sum / spread);
            Bsdf matt;
            matt.normal = matt.geometric = bsdf.geometric;
            matt.diffuse = bsdf.diffuse + bsdf.glossy;
            if (hit->t >= near || scattered == most_near) {
                const LitIrradiance lit = lit_irradiance(scene.field.lit, hit->position, matt.normal, scratch);
                return found + throughput * matt.diffuse / static_cast<float>(pi) *
                                   (straight ? lit.plain + lit.caustic : lit.plain);
            }
            found += throughput * near_light(scene, *hit, matt, outgoing, straight, rng, scratch);
            straight = true;
            throughput *= matt.diffuse;
            ray = leave(*hit, square_to_cosine(rng.uniform2(), make_frame(matt.normal)));
            ++scattered;
            continue;
        }
        const bool reflect = u < spread + mirror || transmit == 0;
        const ChainBranch branch = reflect ? ChainBranch::mirror : ChainBranch::transmit;
        throughput *= branch_weight(bsdf, branch) * static_cast<float>(sum / (reflect ? mirror : transmit));
        ray = leave(*hit, branch_direction(bsdf, outgoing, branch));
        straight = false;
    }
    return found;
}

// ---- records
// --------------------------------------------------------------------------------------------------------

// What the rays found, by ring and sector.
struct GatherRays {
    Strata strata;
    std::array<Color, level_strata[0].count()> radiances;
    std::array<double, level_strata[0].count()> distances;

    std::size_t at(int ring, int sector) const { return static_cast<std::size_t>(ring * strata.sectors + sector); }
    Color radiance(int ring, int sector) const { return radiances[at(ring, sector)]; }
    double distance(int ring, int sector) const { return distances[at(ring, sector)]; }
};

// A direction of the stratum in ring j, sector k; u places it there.
Vec3 stratum_direction(Strata strata, int j, int k, Vec2 u, const Frame& frame) {
    const double sin2 = (j + u.x) / strata.rings, angle = 2 * pi * (k + u.y) / strata.sectors;
    const double sine = std::sqrt(sin2);
    return glm::normalize(sine * std::cos(angle) * frame.x + sine * std::sin(angle) * frame.y +
                          std::sqrt(1 - sin2) * frame.z);
}

GatherRays shoot(const GatherScene& scene, const Hit& hit, const Frame& frame, Strata strata, Rng& rng) {
    GatherRays rays;
    rays.strata = strata;
    std::vector<Neighbour> scratch;
    for (int j = 0; j < strata.rings; ++j)
        for (int k = 0; k < strata.sectors; ++k) {
            const Vec3 direction = stratum_direction(strata, j, k, rng.uniform2(), frame);
            const std::size_t i = rays.at(j, k);
            rays.radiances[i] = gathered_radiance(scene, leave(hit, direction), rng, rays.distances[i], scratch);
        }
    return rays;
}

Color irradiance_of(const GatherRays& rays) {
    Color sum{0};
    for (int i = 0; i < rays.strata.count(); ++i) sum += rays.radiances[static_cast<std::size_t>(i)];
    return sum * static_cast<float>(pi / rays.strata.count());
}

// Whether one ray brings so much that the record would show as a spot: it met something small and bright, the middle of
// a caustic most often, of which more rays know better how large it looks.
bool is_spotty(const GatherRays& rays) {
    float sum = 0, most = 0;
    for (int i = 0; i < rays.strata.count(); ++i) {
        const float light = luminance(rays.radiances[static_cast<std::size_t>(i)]);
        sum += light;
        most = std::max(most, light);
    }
    return most * static_cast<float>(rays.strata.count()) > spotty * sum;
}

// Adds the outer product of a vector and a colour to one gradient a channel.
void add(std::array<glm::dvec3, 3>& gradient, Vec3 v, Color c, double factor) {
    for (int i = 0; i < 3; ++i) gradient[static_cast<std::size_t>(i)] += v * (factor * c[i]);
}

// The gradients of Ward and Heckbert 1992, equations for cosine-distributed strata. Rays count as no shorter
// than `least`, for a few short ones in a corner would foretell more than the truth.
void find_gradients(const GatherRays& rays, const Frame& frame, double least, Record& record) {
    const auto [rings, sectors] = rays.strata;
    std::array<glm::dvec3, 3> moved{}, turned{};
    for (int k = 0; k < sectors; ++k) {
        const int before = (k + sectors - 1) % sectors;
        const double middle = 2 * pi * (k + 0.5) / sectors, low = 2 * pi * k / sectors;
        const Vec3 outward = std::cos(middle) * frame.x + std::sin(middle) * frame.y;
        const Vec3 across = -std::sin(middle) * frame.x + std::cos(middle) * frame.y;
        const Vec3 across_low = -std::sin(low) * frame.x + std::cos(low) * frame.y;
        for (int j = 0; j < rings; ++j) {
            const Color here = rays.radiance(j, k);
            const double sine = std::sqrt((j + 0.5) / rings);
            // (n x n') points across for a normal n' that turns outward in a right-handed frame.
            add(turned, across, here, sine / std::sqrt(1 - sine * sine) * pi / rays.strata.count());
            const double sine_low = std::sqrt(static_cast<double>(j) / rings);
            const double sine_high = std::sqrt((j + 1.0) / rings);
            if (j > 0) {
                const double near = std::max(least, std::min(rays.distance(j, k), rays.distance(j - 1, k)));
                const double cos2 = 1 - sine_low * sine_low;
                add(moved, outward, here - rays.radiance(j - 1, k), 2 * pi / sectors * sine_low * cos2 / near);
            }
            const double near = std::max(least, std::min(rays.distance(j, k), rays.distance(j, before)));
            add(moved, across_low, here - rays.radiance(j, before), (sine_high - sine_low) / near);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        record.moved[i] = Vec3f(moved[i]);
        record.turned[i] = Vec3f(turned[i]);
    }
}

// How far a record may be trusted: a share of the harmonic mean distance, no farther than to the nearest
// thing seen (a round thing's foot is narrow, and the mean distance knows nothing of it) and than its own
// gradient allows.
float trusted_reach(const GatherRays& rays, const Record& record, double share, double scene_radius) {
    double inverse = 0, least = infinity;
    for (int i = 0; i < rays.strata.count(); ++i) {
        const double d = rays.distances[static_cast<std::size_t>(i)];
        inverse += 1 / std::max(d, 1e-9 * scene_radius);
        least = std::min(least, d);
    }
    double reach = inverse > 0 ? share * rays.strata.count() / inverse : scene_radius;
    reach = std::min(reach, least);
    const Vec3f slope = record.moved[0] * 0.2126f + record.moved[1] * 0.7152f + record.moved[2] * 0.0722f;
    const double steep = glm::length(slope);
    if (steep > 0) reach = std::min(reach, luminance(record.irradiance) / steep);
    return static_cast<float>(reach);
}

Record make_record(const IrradianceField& field, const World& world, const PhotonMap& map, Strata strata,
                   const Site& site) {
    Record record;
    const Photon& photon = map.photons[site.photon];
    const std::optional<Hit> hit = hit_of_photon(world, photon);
    if (!hit) return record; // cannot be: the site was made from such a hit
    Rng rng = make_rng(field.seed, Pass::render, hash_words(site.photon, 0x6a09e667f3bcc908ull));
    const Frame frame = make_frame(Vec3(site.normal));
    const GatherScene scene{field, world, map};
    GatherRays rays = shoot(scene, *hit, frame, strata, rng);
    if (is_spotty(rays)) rays = shoot(scene, *hit, frame, level_strata[0], rng);
    record.irradiance = irradiance_of(rays);
    find_gradients(rays, frame, field.levels.back().spacing, record);
    record.reach = trusted_reach(rays, record, trusted_share * std::sqrt(field.settings.shrink), world.radius);
    return record;
}

const Record& record_of(const IrradianceField& field, Level& level, std::uint32_t index, const World& world,
                        const PhotonMap& map) {
    std::call_once(level.asked[index], [&] {
        const auto number = static_cast<std::size_t>(&level - field.levels.data());
        const Strata strata = level_strata[number + 2 - static_cast<std::size_t>(field.settings.effort)];
        level.records[index] = make_record(field, world, map, strata, level.sites[index]);
        ++field.records;
    });
    return level.records[index];
}

// Weighted sums over records about a point. To each record's value half of its own gradient and half of the
// mean gradient is added: the trapezoid rule along the way from the record to the point. A record's own
// gradient alone would darken points that lie low among their neighbours, on every strongly curved surface.
struct Blend {
    float weight = 0;
    Color value{0}, foretold{0};
    std::array<Vec3f, 3> moved{}, turned{};
    Vec3f apart{0}, turn{0};
    float sure = 0; // of the weight, what records are to be trusted with

    void add(const Record& record, const Site& site, Vec3f position, Vec3f normal, float w) {
        const Vec3f d = position - site.position, t = glm::cross(site.normal, normal);
        weight += w;
        value += w * record.irradiance;
        apart += w * d;
        turn += w * t;
        for (int i = 0; i < 3; ++i) {
            const auto c = static_cast<std::size_t>(i);
            foretold[i] += w * (glm::dot(record.moved[c], d) + glm::dot(record.turned[c], t));
            moved[c] += w * record.moved[c];
            turned[c] += w * record.turned[c];
        }
    }

    Color irradiance() const {
        Color result = value / weight;
        for (int i = 0; i < 3; ++i) {
            const auto c = static_cast<std::size_t>(i);
            const float mean_slope =
                (glm::dot(moved[c], apart) + glm::dot(turned[c], turn)) / (weight * weight);
            const float change = 0.5f * (foretold[i] / weight + mean_slope);
            result[i] = std::clamp(result[i] + change, 0.25f * result[i], 2.5f * result[i]);
        }
        return result;
    }
};

} // namespace

std::shared_ptr<const IrradianceField> make_irradiance_field(const World& world, const PhotonMap& map,
                                                             const FieldSettings& settings,
                                                             const Progress& progress) {
    auto field = std::make_shared<IrradianceField>();
    field->settings = settings;
    field->seed = static_cast<std::uint64_t>(map.pass);
    if (map.photons.empty() || map.tree.count == 0) return field;
    const int neighbours = std::max(8, static_cast<int>(std::lround(lit_neighbours * settings.shrink)));
    field->lit = make_lit_places(world, map, neighbours, progress);
    // From a tenth of the scene's radius down to the mean distance of photons, by halves.
    const double photon_distance = std::sqrt(pi / 100) * map.radius;
    std::vector<float> spacings;
    for (double s = world.radius / 10; spacings.size() < most_levels && s > photon_distance; s /= 2)
        spacings.push_back(static_cast<float>(s));
    field->levels.resize(spacings.size());
    parallel_for(static_cast<std::int64_t>(spacings.size()), 1,
                 [&](std::int64_t begin, std::int64_t, std::int64_t) {
                     const auto i = static_cast<std::size_t>(begin);
                     field->levels[i] = make_level(world, map, spacings[i]);
                 });
    return field;
}

FieldIrradiance field_irradiance(const IrradianceField& field, const World& world, const PhotonMap& map,
                                 Vec3 position, Vec3 normal, std::vector<Neighbour>& scratch) {
    const Vec3f p(position), n(normal);
    Blend blend;
    for (std::size_t l = 0; l < field.levels.size() && blend.weight < enough; ++l) {
        Level& level = field.levels[l];
        const bool last = l + 1 == field.levels.size();
        const auto reach = static_cast<float>(reach_in_spacings) * level.spacing;
        // What the coarser levels lack, so that a level fades in where they cease to be enough.
        const float share = 1 - blend.weight / enough;
        find_within(level.tree, p, reach, scratch);
        for (const Neighbour& near : scratch) {
            const Site& site = level.sites[near.index];
            const float aligned = glm::dot(site.normal, n);
            if (aligned < least_aligned) continue;
            const float distance = std::sqrt(near.distance2);
            if (std::abs(glm::dot(site.normal, p - site.position)) > 0.35f * distance + 0.02f * level.spacing)
                continue;
            const Record& record = record_of(field, level, near.index, world, map);
            const float own = std::min(reach, last ? std::max(record.reach, level.spacing) : record.reach);
            // Beyond its own reach a record still outweighs nothing: in the dark under a round thing no
            // photon marks a site, and the density of the few there would show their places.
            const float fall = std::max(0.0f, 1 - distance / own), far = 1 - distance / reach;
            const float turn = (aligned - least_aligned) / (1 - least_aligned);
            blend.sure += share * turn * fall * fall;
            blend.add(record, site, p, n, share * turn * (fall * fall + last_resort * far * far));
        }
    }
    if (!(blend.weight > 0)) return {};
    return {blend.irradiance(), std::min(1.0f, blend.weight / (0.01f * last_resort)),
            std::min(1.0f, blend.sure / sure_weight)};
}

Color gathered_irradiance(const IrradianceField& field, const World& world, const PhotonMap& map,
                          Vec3 position, Vec3 normal, std::vector<Neighbour>& scratch) {
    Hit hit;
    hit.position = position;
    hit.normal = hit.shading_normal = normal;
    hit.error = 0x1p-22 * world.radius;
    std::uint64_t place = 0;
    for (int i = 0; i < 3; ++i) place = hash_words(place, std::bit_cast<std::uint64_t>(position[i]));
    Rng rng = make_rng(field.seed, Pass::render, place);
    const GatherScene scene{field, world, map};
    const Frame frame = make_frame(normal);
    Color sum{0};
    double distance = 0;
    for (int j = 0; j < own_strata.rings; ++j)
        for (int k = 0; k < own_strata.sectors; ++k) {
            const Vec3 direction = stratum_direction(own_strata, j, k, rng.uniform2(), frame);
            sum += gathered_radiance(scene, leave(hit, direction), rng, distance, scratch);
        }
    return sum * static_cast<float>(pi / own_strata.count());
}

std::int64_t record_count(const IrradianceField& field) { return field.records; }

std::int64_t field_bytes(const IrradianceField& field) {
    const auto weight = [](const auto& values) { return values.size() * sizeof(values[0]); };
    const auto tree_weight = [&](const KdTree& tree) {
        return weight(tree.x) + weight(tree.y) + weight(tree.z) + weight(tree.order) + weight(tree.nodes);
    };
    std::size_t bytes = weight(field.lit.places) + tree_weight(field.lit.tree);
    if (field.lit.cells.slots) bytes += (field.lit.cells.mask + 1) * sizeof(LitCells::Slot);
    for (const Level& level : field.levels)
        bytes += weight(level.sites) + weight(level.records) + tree_weight(level.tree) +
                 level.sites.size() * sizeof(std::once_flag);
    return static_cast<std::int64_t>(bytes);
}

} // namespace pnr
