// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gbuffer.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <atomic>

namespace pnr {
namespace {

float mean(Color c) { return (c.x + c.y + c.z) / 3; }

struct ChainStep {
    std::uint32_t surface = 0;
    ChainBranch branch = ChainBranch::none;
};

// A camera ray followed to the first surface that is seen for itself.
struct Chain {
    std::optional<Hit> hit; // none: the background
    Bsdf bsdf;              // there
    Ray last;               // the segment that found it
    double length = 0, specular_length = 0;
    Vec3 specular_position{0};
    std::uint32_t via = 0;
    Color weight{1};
    std::vector<ChainStep> steps;
};

Chain follow_chain(const World& world, const Ray& camera_ray, const RenderSettings& settings) {
    Chain chain;
    chain.last = camera_ray;
    if (sees_nothing(camera_ray)) return chain;
    RayKind kind = RayKind::camera;
    for (int level = 0;; ++level) {
        chain.hit = closest_hit(world, chain.last, kind);
        if (!chain.hit) return chain;
        const Hit& hit = *chain.hit;
        const Vec3 outgoing = -chain.last.direction;
        chain.bsdf = make_bsdf(world, hit, outgoing);
        chain.length += hit.t;
        if (level > 0) chain.weight *= segment_transmittance(world, hit, chain.bsdf, hit.t);
        const ChainBranch branch =
            level < settings.max_trace_level ? chain_branch(world, hit, chain.bsdf) : ChainBranch::none;
        if (branch == ChainBranch::none) return chain;
        chain.weight *= branch_weight(chain.bsdf, branch);
        if (max_component(chain.weight) < settings.adc_bailout) return chain;
        if (chain.steps.empty()) chain.via = static_cast<std::uint32_t>(world.surfaces[hit.surface].object);
        chain.steps.push_back({hit.surface, branch});
        chain.specular_length = chain.length;
        chain.specular_position = hit.position;
        chain.last = leave(hit, branch_direction(chain.bsdf, outgoing, branch));
        kind = RayKind::specular;
    }
}

// The last segment of a neighbouring camera ray forced through the same surfaces by the same branches;
// nothing if it meets another surface on the way or the branch does not exist there.
std::optional<Ray> follow_steps(const World& world, Ray ray, const std::vector<ChainStep>& steps) {
    RayKind kind = RayKind::camera;
    for (const ChainStep& step : steps) {
        const std::optional<Hit> hit = closest_hit(world, ray, kind);
        if (!hit || hit->surface != step.surface) return std::nullopt;
        const Bsdf bsdf = make_bsdf(world, *hit, -ray.direction);
        if (is_black(step.branch == ChainBranch::mirror ? bsdf.mirror : bsdf.transmit)) return std::nullopt;
        ray = leave(*hit, branch_direction(bsdf, -ray.direction, step.branch));
        kind = RayKind::specular;
    }
    return ray;
}

// Cosine that a division by may be trusted with: a grazing plane is taken as one seen at about 0.1 degrees.
double away_from_zero(double cosine) {
    constexpr double least = 1.0 / 512;
    return std::abs(cosine) >= least ? cosine : (cosine < 0 ? -least : least);
}

Vec3 meet_plane(const Ray& ray, Vec3 point, Vec3 normal) {
    const double cosine = away_from_zero(glm::dot(normal, ray.direction));
    return ray.origin + ray.direction * (glm::dot(normal, point - ray.origin) / cosine);
}

// Of a camera without a picture plane: by rays a tenth of a pixel to both sides.
Vec3 curved_derivative(const PictureView& view, Vec2 pixel, Vec2 axis, Vec3 point, Vec3 normal) {
    constexpr double step = 0.1;
    const Ray a = pixel_ray(view, pixel - step * axis), b = pixel_ray(view, pixel + step * axis);
    if (sees_nothing(a) || sees_nothing(b)) return Vec3(0);
    return (meet_plane(b, point, normal) - meet_plane(a, point, normal)) / (2 * step);
}

// How the point where the camera ray through `pixel` meets the plane (point, normal) moves when the pixel
// does.
void direct_footprint(const PictureView& view, Vec2 pixel, Vec3 point, Vec3 normal, Seen& seen) {
    const Camera& camera = view.camera;
    const Vec3 step_x = camera.right / static_cast<double>(view.width);
    const Vec3 step_y = -camera.up / static_cast<double>(view.height);
    const double x = pixel.x / view.width - 0.5, y = 0.5 - pixel.y / view.height;
    const bool perspective = camera.projection == Projection::perspective;
    if (!perspective && camera.projection != Projection::orthographic) {
        seen.dpdx = Vec3f(curved_derivative(view, pixel, {1, 0}, point, normal));
        seen.dpdy = Vec3f(curved_derivative(view, pixel, {0, 1}, point, normal));
        return;
    }
    const Vec3 along = perspective ? camera.direction + x * camera.right + y * camera.up : camera.direction;
    // point = location + scale * along; an orthographic step moves the ray's origin instead.
    const double scale = perspective ? glm::length(point - camera.location) / glm::length(along) : 1.0;
    const Vec3 unit = glm::normalize(along);
    const double cosine = away_from_zero(glm::dot(normal, unit));
    seen.dpdx = Vec3f(scale * (step_x - unit * (glm::dot(normal, step_x) / cosine)));
    seen.dpdy = Vec3f(scale * (step_y - unit * (glm::dot(normal, step_y) / cosine)));
}

// Seen through a chain: by rays a tenth of a pixel away to both sides, one side if the other parts from the
// chain, else as if the plane stood at the same distance unfolded (mirrors keep lengths; a lens does not, so
// this is the last resort).
Vec3 chain_derivative(const World& world, const PictureView& view, Vec2 pixel, const Chain& chain, Vec2 axis,
                      Vec3 point, Vec3 normal) {
    constexpr double step = 0.1;
    Vec3 there[2]{point, point};
    double span = 0;
    for (int side = 0; side < 2; ++side) {
        const Vec2 moved = pixel + axis * (side == 0 ? -step : step);
        const Ray start = pixel_ray(view, moved);
        if (sees_nothing(start)) continue;
        const std::optional<Ray> last = follow_steps(world, start, chain.steps);
        if (!last) continue;
        there[side] = meet_plane(*last, point, normal);
        span += step;
    }
    if (span > 0) return (there[1] - there[0]) / span;
    const Ray a = pixel_ray(view, pixel), b = pixel_ray(view, pixel + axis);
    Vec3 moved = (b.origin - a.origin) + (b.direction - a.direction) * chain.length;
    const Vec3 unit = chain.last.direction;
    moved -= unit * glm::dot(moved, unit);
    return moved - unit * (glm::dot(normal, moved) / away_from_zero(glm::dot(normal, unit)));
}

Seen see(const World& world, const PictureView& view, Vec2 pixel, const RenderSettings& settings) {
    const Chain chain = follow_chain(world, pixel_ray(view, pixel), settings);
    Seen seen;
    seen.weight = chain.weight;
    seen.via = chain.via;
    if (!chain.steps.empty()) {
        seen.z_specular = static_cast<float>(chain.specular_length);
        seen.last_specular = Vec3f(chain.specular_position);
    }
    seen.toward_viewer = Vec3f(-chain.last.direction);
    if (!chain.hit) return seen;
    const Surface& surface = world.surfaces[chain.hit->surface];
    seen.position = Vec3f(chain.hit->position);
    seen.normal = Vec3f(chain.bsdf.normal);
    seen.z = static_cast<float>(chain.length);
    seen.object = surface.light >= 0 ? 0u : static_cast<std::uint32_t>(surface.object);
    seen.surface = chain.hit->surface;
    seen.npr = paint_mix(world, *chain.hit) > 0;
    const Vec3 plane = chain.bsdf.geometric;
    if (chain.steps.empty()) {
        direct_footprint(view, pixel, chain.hit->position, plane, seen);
    } else {
        seen.dpdx = Vec3f(chain_derivative(world, view, pixel, chain, {1, 0}, chain.hit->position, plane));
        seen.dpdy = Vec3f(chain_derivative(world, view, pixel, chain, {0, 1}, chain.hit->position, plane));
    }
    return seen;
}

// Whether the border of something painted may run through the pixel: paint in the 3 x 3 pixels about it that
// is not one smooth surface.
bool may_be_border(const Image<Seen>& seen, int x, int y) {
    const Seen& here = seen.at(x, y);
    bool any_paint = here.npr, differ = false;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (!seen.contains(x + dx, y + dy)) continue;
            const Seen& other = seen.at(x + dx, y + dy);
            any_paint = any_paint || other.npr;
            differ = differ || other.npr != here.npr || other.object != here.object || other.via != here.via;
            // A jump in depth beyond what the pixel's own plane explains.
            const float slope = glm::length(here.dpdx) * static_cast<float>(std::abs(dx)) +
                                glm::length(here.dpdy) * static_cast<float>(std::abs(dy));
            differ = differ || std::abs(other.z - here.z) > 2 * slope + 0.01f * here.z;
        }
    return any_paint && differ;
}

float supersample_coverage(const World& world, const PictureView& view, int x, int y,
                           const RenderSettings& settings) {
    const int samples = std::max(settings.samples_min, settings.samples_max);
    int painted = 0;
    for (int i = 0; i < samples; ++i) {
        const Chain chain =
            follow_chain(world, pixel_ray(view, pixel_sample(settings.seed, x, y, i)), settings);
        if (chain.hit && paint_mix(world, *chain.hit) > 0) ++painted;
    }
    return static_cast<float>(painted) / static_cast<float>(samples);
}

// Calls body(y) for the rows of a rectangle on all cores, and tells the progress.
template <class Body>
void for_rows(PixelRect r, const Progress& progress, std::int64_t done_before, std::int64_t total,
              const Body& body) {
    std::atomic<std::int64_t> done{done_before};
    std::atomic<bool> stop{false};
    parallel_for(r.y1 - r.y0, 1, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        if (stop) return;
        for (std::int64_t row = begin; row < end; ++row) body(r.y0 + static_cast<int>(row));
        if (progress && !progress(done += end - begin, total)) stop = true;
    });
    if (stop) throw Interrupted{};
}

} // namespace

Vec2 pixel_sample(std::uint64_t seed, int x, int y, int i) {
    const std::uint64_t place =
        static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32 | static_cast<std::uint32_t>(x);
    const Rng rng = make_rng(seed, Pass::gbuffer, place);
    return Vec2(x, y) + sobol_point(static_cast<std::uint32_t>(i), rng.key);
}

double paint_mix(const World& world, const Hit& hit) {
    const Surface& surface = world.surfaces[hit.surface];
    if (surface.light >= 0) return 0;
    const WorldObject& object = world.objects[static_cast<std::size_t>(surface.object)];
    return object.npr ? object.paint.mix : 0;
}

ChainBranch chain_branch(const World& world, const Hit& hit, const Bsdf& bsdf) {
    if (!has_specular(bsdf) || paint_mix(world, hit) > 0) return ChainBranch::none;
    const float mirror = mean(bsdf.mirror), transmit = mean(bsdf.transmit);
    if (std::max(mirror, transmit) < 0.5f) return ChainBranch::none;
    return mirror >= transmit ? ChainBranch::mirror : ChainBranch::transmit;
}

Vec3 branch_direction(const Bsdf& bsdf, Vec3 outgoing, ChainBranch branch) {
    Vec3 direction = mirror_direction(outgoing, bsdf.normal);
    if (branch == ChainBranch::transmit) refract_direction(outgoing, bsdf.normal, bsdf.eta, direction);
    return direction;
}

Color branch_weight(const Bsdf& bsdf, ChainBranch branch) {
    if (branch == ChainBranch::mirror) return bsdf.mirror;
    return bsdf.transmit * static_cast<float>(bsdf.eta * bsdf.eta);
}

Color segment_transmittance(const World& world, const Hit& hit, const Bsdf& bsdf, double distance) {
    if (!bsdf.inside) return Color{1};
    const Material& material =
        world.materials[static_cast<std::size_t>(world.surfaces[hit.surface].material)];
    return interior_transmittance(material.interior, distance);
}

GBuffer make_gbuffer(const World& world, const PictureView& view, PixelRect window,
                     const RenderSettings& settings, const Progress& progress) {
    GBuffer result;
    result.view = view;
    result.window = grow(window, 0, view.width, view.height);
    result.seen = Image<Seen>(view.width, view.height);
    result.coverage = Image<float>(view.width, view.height);
    // Coverage looks at the neighbours, so one more pixel is traced all round and cleared again.
    const PixelRect w = result.window;
    if (w.empty()) return result;
    const PixelRect padded = grow(w, 1, view.width, view.height);
    const std::int64_t total = padded.y1 - padded.y0 + w.y1 - w.y0;
    for_rows(padded, progress, 0, total, [&](int y) {
        for (int x = padded.x0; x < padded.x1; ++x)
            result.seen.at(x, y) = see(world, view, {x + 0.5, y + 0.5}, settings);
    });
    if (world.has_paint)
        for_rows(w, progress, padded.y1 - padded.y0, total, [&](int y) {
            for (int x = w.x0; x < w.x1; ++x)
                result.coverage.at(x, y) = may_be_border(result.seen, x, y)
                                               ? supersample_coverage(world, view, x, y, settings)
                                               : (result.seen.at(x, y).npr ? 1.0f : 0.0f);
        });
    for (int y = padded.y0; y < padded.y1; ++y)
        for (int x = padded.x0; x < padded.x1; ++x)
            if (!w.contains(x, y)) result.seen.at(x, y) = Seen{};
    return result;
}

} // namespace pnr
