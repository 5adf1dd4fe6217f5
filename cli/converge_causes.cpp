// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a picture by cause: what changes if the random numbers, or the steps, of one cause alone
// change.
#include "cli/converge.h"

#include "core/rng.h"

#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>

namespace pnr {

namespace {

// ---- photoreal light
// -------------------------------------------------------------------------------------------------

// Half the mean square of the difference over light^2 + (mean light / 10)^2, as picture_error weighs it; its
// root.
double half_difference(const Image<Color>& x, const Image<Color>& y, const Image<float>& mask) {
    double light = 0, count = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] <= 0) continue;
        const Color& c = x.pixels[i];
        light += static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z);
        count += 3;
    }
    if (count == 0) return 0;
    const double floor = 0.1 * light / count;
    double sum = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] <= 0) continue;
        for (int k = 0; k < 3; ++k) {
            const auto a = static_cast<double>(x.pixels[i][k]), b = static_cast<double>(y.pixels[i][k]);
            const double r = 0.5 * (a + b), scale = r * r + floor * floor;
            if (scale > 0) sum += (a - b) * (a - b) / scale;
        }
    }
    return std::sqrt(0.5 * sum / count);
}

// A run of as many passes as the last snapshot, looked at where the snapshots were taken.
void run_again(const Scene& scene, const Settings& settings, Wishes wishes,
               const std::vector<Snapshot>& snapshots, ProgressMode progress,
               const std::function<void(std::size_t, const Image<Color>&)>& look) {
    Passes passes(progress, false);
    wishes.refinement = Refinement{{}, {}, snapshots.back().passes};
    std::size_t next = 0;
    wishes.after_pass = [&](Rendering& r) {
        while (next < snapshots.size() && r.passes_done >= snapshots[next].passes)
            look(next++, r.rendered.layer.color);
        return next < snapshots.size();
    };
    Reuse nothing_kept;
    render_scene(scene, settings, wishes, nothing_kept, passes);
}

// ---- paint
// -----------------------------------------------------------------------------------------------------------

// What the small steps of a painting leave behind.
struct Painting {
    Rendering r;
    double cpu_s = 0;
};

Painting paint_maps(const World& world, const Settings& settings) {
    Painting painting;
    Rendering& r = painting.r;
    r.world = world;
    r.settings = settings;
    const PictureSize size = picture_size(world.camera, settings.render);
    r.settings.render.width = size.width, r.settings.render.height = size.height;
    r.plan = make_plan(r.world, r.settings, false);
    r.window = {0, 0, size.width, size.height};
    const std::clock_t begin = std::clock();
    Passes passes(ProgressMode::off, false);
    r.photons = make_photons(r, r.settings, 0, 1, true, passes);
    r.gbuffer = make_gbuffer(r.world, {r.world.camera, size.width, size.height}, r.window, r.settings.render);
    r.paint.sparse = make_sparse_map(r.world, r.gbuffer, r.photons, r.settings);
    r.paint.fields = make_orientation_fields(r.world);
    r.paint.oriented = orient_photons(r.world, r.photons, r.paint.fields);
    orient_strokes(r.paint.sparse, r.world, r.gbuffer, r.photons, r.paint.oriented);
    r.paint.informative = make_informative_map(r.paint.sparse, r.world, r.gbuffer, r.settings.render.seed);
    painting.cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return painting;
}

// Axes as angles: twice the angle is what is compared, so that no axis has a head.
double field_error(const Rendering& r) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < r.paint.informative.pixels.size(); ++i) {
        const Informed& p = r.paint.informative.pixels[i];
        const Seen& seen = r.gbuffer.seen.pixels[i];
        if (p.kind != PixelKind::interpolated || p.via != 0 || p.object != seen.object) continue;
        const auto& field = r.paint.fields.fields[p.object];
        if (!field) continue;
        const Vec3 position(seen.position), axis = eval_orientation(*field, position, Vec3(seen.normal));
        const Vec2 direction = project_direction(r.gbuffer.view, position, axis);
        if (!(glm::length(direction) > 0)) continue;
        const Vec2f truth = direction_axis(Vec2f(glm::normalize(direction)));
        const double cosine = std::clamp(static_cast<double>(glm::dot(truth, p.axis)), -1.0, 1.0);
        const double angle = 0.5 * std::acos(cosine) * 180 / pi;
        sum += angle * angle, ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

// Colours of two maps as pictures, and the pixels that both interpolate.
double map_error(const Rendering& a, const Rendering& b) {
    Image<Color> x(a.settings.render.width, a.settings.render.height), y = x;
    Image<float> mask(x.width, x.height, 0.0f);
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        const Informed &p = a.paint.informative.pixels[i], &q = b.paint.informative.pixels[i];
        if (p.kind != PixelKind::interpolated || q.kind != PixelKind::interpolated) continue;
        x.pixels[i] = p.radiance, y.pixels[i] = q.radiance;
        mask.pixels[i] = 1;
    }
    return half_difference(x, y, mask);
}

Layer strokes(const Rendering& r, double finer) {
    World world = r.world;
    for (WorldObject& object : world.objects) object.paint.step /= finer;
    return convolve(r.paint.informative, find_seats(world, r.gbuffer, r.photons), world, r.gbuffer,
                    r.settings.render.seed);
}

double ilic_error(const Rendering& r) {
    const Layer as_said = strokes(r, 1), finer = strokes(r, 2);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < finer.color.pixels.size(); ++i) {
        if (!(finer.alpha.pixels[i] > 0)) continue;
        const Color off = as_said.color.pixels[i] - finer.color.pixels[i];
        sum += static_cast<double>(glm::dot(off, off)), count += 3;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

} // namespace

void add_causes(const Scene& scene, const Settings& settings, const Budgets& limits,
                std::vector<Snapshot>& snapshots, ProgressMode progress) {
    if (snapshots.empty()) return;
    Wishes wishes;
    wishes.budgets = limits;
    const std::uint64_t other = hash_words(settings.render.seed, 0xca05e);
    wishes.sample_seed = other;
    run_again(scene, settings, wishes, snapshots, progress, [&](std::size_t i, const Image<Color>& picture) {
        snapshots[i].sample_noise = half_difference(snapshots[i].photoreal, picture, snapshots[i].mask);
    });
    wishes.sample_seed = settings.render.seed;
    Settings changed = settings;
    changed.render.seed = other;
    run_again(scene, changed, wishes, snapshots, progress, [&](std::size_t i, const Image<Color>& picture) {
        snapshots[i].photon_noise = half_difference(snapshots[i].photoreal, picture, snapshots[i].mask);
    });
}

std::vector<PaintCauses> paint_causes(const Scene& scene, const Settings& settings) {
    const World world = build_world(scene, settings);
    std::vector<PaintCauses> all;
    if (!make_plan(world, settings, false).paint) return all;
    const double asked = static_cast<double>(plan_emission(world, settings.photons).everywhere);
    for (const double share : {0.25, 1.0, 4.0}) {
        Settings changed = settings;
        changed.photons.count = std::llround(share * asked), changed.photons.spacing = 0;
        const Painting painting = paint_maps(world, changed);
        changed.render.seed = hash_words(settings.render.seed, 0xca05e);
        all.push_back({share, painting.cpu_s, field_error(painting.r),
                       map_error(painting.r, paint_maps(world, changed).r), ilic_error(painting.r)});
    }
    return all;
}

} // namespace pnr
