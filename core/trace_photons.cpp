// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/trace_photons.h"

#include "core/emission.h"
#include "core/material.h"
#include "core/sobol.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace pnr {

namespace {

constexpr std::int64_t photons_per_chunk = 2048;
// From this many bounces on a roulette ends paths that no surface would end (albedo 1 in a closed box); survivors make up
// for it. Of n bounces it ends one in 2 / n: the share that lives on falls by the square of n and power grows by the square,
// which any albedo below 1 outruns, so that the variance is finite. (An even roulette's is not where it kills faster than
// the surfaces do.)
constexpr int free_bounces = 64;
double late_survival(int bounces) { return 1 - 2.0 / bounces; }

struct Chunk {
    std::vector<Photon> photons;
    std::vector<Vec3f> normals;
    PowerBalance balance;
};

// Where a photon stands between two hits.
struct Flight {
    Ray ray;
    glm::dvec3 flux{0};
    int bounces = 0;
    bool scattered = false; // by a diffuse or glossy surface, at least once
    bool specular = false;  // by a mirror or glass just now
    // Whether every diffuse or glossy surface on the way was met through a mirror or glass: such light is a
    // caustic, also the second time. Final gathering would find it with much noise, photons find it by themselves.
    bool focused = true;
    bool aimed = false;     // a photon of a share of caustics
    bool at_target = false; // the first surface met is one of EmissionPlan::targets
    double length = 0;      // of the path so far
    bool booked = true;     // counts in the power balance (an emitter's, of all light)
    bool settled = true;    // a POV-Ray light's photon: whether distance and fading are in its flux
};

// The first random numbers of a path continue its low-discrepancy point, later ones are hashed.
struct PathNumbers {
    std::uint64_t index, sobol_seed;
    Rng rng;

    Vec3 direction(int bounce) {
        if (bounce == 0) {
            const Vec2 u = sobol2(index, 4, sobol_seed);
            return {u.x, u.y, sobol(index, 6, sobol_seed)};
        }
        const Vec2 u = rng.uniform2();
        return {u.x, u.y, rng.uniform()};
    }
    double event(int bounce) { return bounce == 0 ? sobol(index, 7, sobol_seed) : rng.uniform(); }
};

double largest(glm::dvec3 c) { return std::max({c.x, c.y, c.z}); }

// ---- what happens at a hit
// ------------------------------------------------------------------------------------

enum class Event { absorbed, scattered, reflected, refracted };

struct Outcome {
    Event event = Event::absorbed;
    Vec3 direction{0};
    glm::dvec3 flux{0};     // of the survivor
    glm::dvec3 absorbed{0}; // expected: flux (1 - albedo); not what the roulette kills
};

// Mirror and refraction about the shading normal, or about the true one where that would pass through the
// surface.
Vec3 reflected_direction(const Bsdf& bsdf, Vec3 outgoing) {
    const Vec3 d = mirror_direction(outgoing, bsdf.normal);
    return glm::dot(d, bsdf.geometric) > 0 ? d : mirror_direction(outgoing, bsdf.geometric);
}

bool refracted_direction(const Bsdf& bsdf, Vec3 outgoing, Vec3& d) {
    if (refract_direction(outgoing, bsdf.normal, bsdf.eta, d) && glm::dot(d, bsdf.geometric) < 0) return true;
    return refract_direction(outgoing, bsdf.geometric, bsdf.eta, d);
}

// By the finish. Each event happens with the share that its albedo has of the flux' largest channel, so that
// photons keep about the power they had [Jensen 2001 5.2].
Outcome scatter_by_finish(const Bsdf& bsdf, Vec3 outgoing, glm::dvec3 flux, Vec3 u, double xi) {
    Outcome out;
    const BsdfSample sample = sample_bsdf(bsdf, outgoing, u);
    const glm::dvec3 scattered = flux * glm::dvec3(sample.weight);
    const glm::dvec3 mirrored = flux * glm::dvec3(bsdf.mirror);
    glm::dvec3 passed = flux * glm::dvec3(bsdf.transmit);
    Vec3 refracted(0);
    if (largest(passed) > 0 && !refracted_direction(bsdf, outgoing, refracted)) passed = glm::dvec3(0);
    out.absorbed = flux - scattered - mirrored - passed;
    const double whole = largest(flux);
    double p[3] = {largest(scattered) / whole, largest(mirrored) / whole, largest(passed) / whole};
    const double sum = p[0] + p[1] + p[2];
    if (sum > 1)
        for (double& x : p) x /= sum;
    if (xi < p[0]) {
        out = {Event::scattered, sample.incoming, scattered / p[0], out.absorbed};
    } else if (xi < p[0] + p[1]) {
        out = {Event::reflected, reflected_direction(bsdf, outgoing), mirrored / p[1], out.absorbed};
    } else if (xi < p[0] + p[1] + p[2]) {
        out = {Event::refracted, refracted, passed / p[2], out.absorbed};
    }
    return out;
}

// By the object's own probabilities [LW10 Table 1]: specular with PSR, else absorbed with PA, else diffuse.
// Survivors keep their flux, tinted by the pigment over its largest component (a specular one only by a
// metal).
Outcome scatter_by_roles(const Material& material, const Bsdf& bsdf, Vec3 outgoing,
                         glm::dvec3 flux, Vec3 u, double xi) {
    const double psr = std::clamp(material.photons.specular_probability.value_or(0), 0.0, 1.0);
    const double pa = std::clamp(material.photons.absorption_probability.value_or(0), 0.0, 1.0);
    const glm::dvec3 rgb(bsdf.tint);
    const double most = largest(rgb);
    const glm::dvec3 tint = most > 0 ? rgb / most : glm::dvec3(1);
    const glm::dvec3 metal_tint = glm::dvec3(1) + bsdf.metal * (tint - glm::dvec3(1));
    Outcome out;
    out.absorbed = flux * (glm::dvec3(1) - psr * metal_tint - (1 - psr) * (1 - pa) * tint);
    if (xi < psr) {
        out.event = Event::reflected;
        out.direction = reflected_direction(bsdf, outgoing);
        out.flux = flux * metal_tint;
        // Glass shares its specular photons between both sides as its finish does.
        const double through = max_component(bsdf.transmit);
        Vec3 refracted;
        if (through > 0 && xi / psr < through / (through + max_component(bsdf.mirror)) &&
            refracted_direction(bsdf, outgoing, refracted)) {
            out.event = Event::refracted;
            out.direction = refracted;
        }
    } else if (xi >= psr + (1 - psr) * pa) {
        out.event = Event::scattered;
        out.direction = square_to_cosine({u.x, u.y}, make_frame(bsdf.normal));
        out.flux = flux * tint;
        if (!(glm::dot(out.direction, bsdf.geometric) > 0)) { // a shading normal's direction into the surface
            out.event = Event::absorbed;
            out.absorbed += out.flux;
        }
    }
    return out;
}

// ---- one photon
// ---------------------------------------------------------------------------------------------------

struct Tracer {
    const World& world;
    const EmissionPlan& plan;
    bool keep_normals;
    Chunk& chunk;

    // Distance, fall-off and fading of a POV-Ray light's photon; false if nothing is left of it.
    bool settle(const Light& light, const Hit& hit, bool diffuse, Flight& flight) const {
        if (flight.bounces == 0) flight.flux *= light_falloff(light, hit.position);
        if (diffuse && !flight.settled) {
            const double d2 = is_parallel(light) ? 1 : flight.length * flight.length;
            flight.flux *= d2 * light_fading(light, flight.length);
            flight.settled = true;
        }
        return largest(flight.flux) > 0;
    }

    void store(const Hit& hit, const Bsdf& bsdf, const Surface& surface, const Flight& flight) const {
        const PhotonPath path = flight.bounces == 0                 ? PhotonPath::direct
                                : flight.focused && flight.specular ? PhotonPath::caustic
                                                                    : PhotonPath::indirect;
        if ((world.caustics_apart || flight.aimed) && path != PhotonPath::caustic) return;
        if (path == PhotonPath::caustic && !flight.aimed && flight.at_target) return; // left to those that aim
        Photon photon;
        photon.position = Vec3f(hit.position);
        photon.direction = Vec3f(flight.ray.direction);
        photon.flux = Color(flight.flux);
        photon.tag =
            photon_tag(surface.object, world.objects[static_cast<std::size_t>(surface.object)].npr, path);
        chunk.photons.push_back(photon);
        if (keep_normals) chunk.normals.push_back(Vec3f(bsdf.geometric));
    }

    // Light lost on the way through a coloured interior.
    void fade_inside(const Material& material, const Bsdf& bsdf, double distance, Flight& flight) const {
        if (!bsdf.inside || !(material.interior.fade_power > 0)) return;
        const glm::dvec3 left = flight.flux * glm::dvec3(interior_transmittance(material.interior, distance));
        if (flight.booked) chunk.balance.absorbed += flight.flux - left;
        flight.flux = left;
    }

    // POV-Ray's `reflection on` and `refraction on`, where caustics alone are wanted: an object that says one
    // of them throws caustics by that one only.
    bool caustic_allowed(const PhotonRoles& roles, Event event) const {
        if (!world.caustics_apart || (!roles.reflection && !roles.refraction))
            return true;
        return (event == Event::reflected && roles.reflection) ||
               (event == Event::refracted && roles.refraction);
    }

    // One hit; false when the path ends.
    bool step(const Light& light, Flight& flight, PathNumbers& numbers) const {
        const std::optional<Hit> hit = closest_hit(world, flight.ray, RayKind::photon);
        if (!hit) {
            if (flight.booked) chunk.balance.escaped += flight.flux;
            return false;
        }
        const Surface& surface = world.surfaces[hit->surface];
        if (surface.light >= 0) {
            if (flight.booked) chunk.balance.absorbed += flight.flux;
            return false;
        }
        const Vec3 outgoing = -flight.ray.direction;
        const Bsdf bsdf = make_bsdf(world, *hit, outgoing);
        const Material& material = world.materials[static_cast<std::size_t>(surface.material)];
        const double distance = glm::distance(flight.ray.origin, hit->position);
        flight.length += distance;
        fade_inside(material, bsdf, distance, flight);
        const bool diffuse = has_diffuse(bsdf);
        if (flight.bounces == 0)
            flight.at_target = !plan.aimed_at.empty() && plan.aimed_at[static_cast<std::size_t>(surface.object)] != 0;
        if (flight.aimed && !flight.at_target) return false;
        if (!light.is_emitter()) {
            if (!settle(light, *hit, diffuse, flight)) return false;
            if (glm::distance(hit->position, plan.focus.center) > emission_reach * plan.focus.radius)
                return false;
        }
        if (!(largest(flight.flux) > 0)) return false;
        if (flight.bounces == 0 && !shines_on(light, surface)) return false;
        if (plan.targeted && flight.bounces == 0 && !material.photons.target) return false;
        if (diffuse && material.photons.collect) store(*hit, bsdf, surface, flight);
        return scatter(*hit, bsdf, material, outgoing, flight, numbers);
    }

    bool scatter(const Hit& hit, const Bsdf& bsdf, const Material& material, Vec3 outgoing, Flight& flight,
                 PathNumbers& numbers) const {
        const Vec3 u = numbers.direction(flight.bounces);
        const double xi = numbers.event(flight.bounces);
        const bool roles = material.photons.specular_probability || material.photons.absorption_probability;
        const Outcome out = roles ? scatter_by_roles(material, bsdf, outgoing, flight.flux, u, xi)
                                  : scatter_by_finish(bsdf, outgoing, flight.flux, u, xi);
        if (flight.booked) chunk.balance.absorbed += out.absorbed;
        if (out.event == Event::absorbed || !(largest(out.flux) > 0)) return false;
        if (!caustic_allowed(material.photons, out.event)) return false;
        flight.flux = out.flux;
        if (out.event == Event::scattered) {
            flight.scattered = true;
            flight.focused = flight.focused && flight.specular;
        }
        flight.specular = out.event != Event::scattered;
        // Caustics alone: light that a diffuse surface has scattered is not wanted.
        if (flight.scattered && world.caustics_apart) return false;
        if (flight.aimed && !flight.focused) return false;
        if (++flight.bounces > free_bounces) {
            if (numbers.rng.uniform() >= late_survival(flight.bounces)) return false;
            flight.flux /= late_survival(flight.bounces);
        }
        flight.ray = leave(hit, out.direction);
        return true;
    }
};

std::uint64_t seed_of(const LightShare& share, std::uint64_t seed) {
    const auto number = static_cast<std::uint64_t>(share.light);
    return hash_words(seed, share.caustics ? ~number : number);
}

} // namespace

PhotonMap trace_photons(const World& world, const PhotonSettings& settings, std::uint64_t seed, int pass,
                        bool keep_normals, const Progress& progress) {
    PhotonMap map;
    map.radius = static_cast<float>(settings.radius);
    EmissionPlan plan = plan_emission(world, settings);
    find_cells(world, plan, seed);
    map.emitted = plan.everywhere;
    map.pass = pass;
    std::vector<Chunk> chunks(
        static_cast<std::size_t>((plan.count + photons_per_chunk - 1) / photons_per_chunk));
    std::atomic<std::int64_t> done{0};
    std::atomic<bool> stop{false};
    parallel_for(
        plan.count, photons_per_chunk, [&](std::int64_t begin, std::int64_t end, std::int64_t number) {
            if (stop) return;
            Chunk& chunk = chunks[static_cast<std::size_t>(number)];
            const Tracer tracer{world, plan, keep_normals, chunk};
            auto share = std::upper_bound(plan.shares.begin(), plan.shares.end(), begin,
                                          [](std::int64_t i, const LightShare& s) { return i < s.first; }) -
                         1;
            for (std::int64_t i = begin; i < end; ++i) {
                while (i >= share->first + share->count) ++share;
                const Light& light = world.lights[static_cast<std::size_t>(share->light)];
                const std::uint64_t index =
                    static_cast<std::uint64_t>(i - share->first) +
                    static_cast<std::uint64_t>(pass) * static_cast<std::uint64_t>(share->count);
                const std::uint64_t light_seed = seed_of(*share, seed);
                const EmittedPhoton emitted = emit_photon(world, plan, *share, index, light_seed);
                Flight flight;
                flight.ray = emitted.ray;
                flight.flux = glm::dvec3(emitted.flux);
                if (!(largest(flight.flux) > 0)) continue;
                flight.aimed = share->caustics;
                flight.booked = light.is_emitter() && !flight.aimed;
                flight.settled = light.is_emitter();
                if (flight.booked) chunk.balance.emitted += flight.flux;
                PathNumbers numbers{index, light_seed, make_rng(light_seed, Pass::photons, index)};
                while (tracer.step(light, flight, numbers)) {}
            }
            if (progress && !progress(done += end - begin, plan.count)) stop = true;
        });
    if (stop) throw Interrupted{};
    std::size_t stored = 0;
    for (const Chunk& chunk : chunks) stored += chunk.photons.size();
    map.photons.reserve(stored);
    if (keep_normals) map.normals.reserve(stored);
    for (Chunk& chunk : chunks) { // in chunk order: the same map for any number of threads
        map.photons.insert(map.photons.end(), chunk.photons.begin(), chunk.photons.end());
        map.normals.insert(map.normals.end(), chunk.normals.begin(), chunk.normals.end());
        map.balance.emitted += chunk.balance.emitted;
        map.balance.absorbed += chunk.balance.absorbed;
        map.balance.escaped += chunk.balance.escaped;
        chunk = {};
    }
    return map;
}

} // namespace pnr
