// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/show.h"

#include "cli/drawing.h"
#include "cli/refine.h"
#include "cli/show_wire.h"
#include "core/image_io.h"
#include "npr/footprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

const Color no_ink = displayed(0.08f, 0.08f, 0.1f);

// ---- what pictures have in common

// Shapes in grey, lit from the eye: the ground that dots and strokes are drawn on.
Image<Color> ground(const Rendering& r) {
    Image<Color> picture(r.gbuffer.seen.width, r.gbuffer.seen.height, no_ink);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Seen& seen = r.gbuffer.seen.pixels[i];
        if (seen.object == 0) continue;
        const float light = std::abs(glm::dot(seen.normal, seen.toward_viewer));
        const float grey = seen.npr ? 0.25f + 0.3f * light : 0.15f + 0.2f * light;
        picture.pixels[i] = displayed(grey, grey, grey);
    }
    return picture;
}

int digit_size(const Rendering& r) { return std::max(1, r.gbuffer.view.height / 300); }

// The scene's own look: exposure and shoulder are for light alone.
Color as_viewed(Color light, const RenderSettings& settings) {
    const Color c = light * static_cast<float>(std::exp2(settings.exposure));
    return settings.view == View::shoulder ? shoulder(c) : c;
}

// Whether a place is what the picture shows there, seen directly.
bool is_seen(const Rendering& r, const Projected& at, double tolerance) {
    const int x = static_cast<int>(std::floor(at.pixel.x)), y = static_cast<int>(std::floor(at.pixel.y));
    if (!r.gbuffer.seen.contains(x, y)) return false;
    const Seen& seen = r.gbuffer.seen.at(x, y);
    return seen.object != 0 && seen.via == 0 &&
           std::abs(at.distance - static_cast<double>(seen.z)) <= tolerance * static_cast<double>(seen.z);
}

// ---- ids, normals

Shown show_ids(const Rendering& r) {
    Shown shown{Image<Color>(r.gbuffer.seen.width, r.gbuffer.seen.height), {}};
    std::vector<std::int64_t> pixels(r.world.objects.size(), 0);
    for (std::size_t i = 0; i < shown.picture.pixels.size(); ++i) {
        const Seen& seen = r.gbuffer.seen.pixels[i];
        // In mirrors and through glass darker, and every fourth diagonal tells in what.
        const bool diagonal = seen.via != 0 && (i % static_cast<std::size_t>(shown.picture.width) +
                                                i / static_cast<std::size_t>(shown.picture.width)) %
                                                       4 ==
                                                   0;
        shown.picture.pixels[i] =
            diagonal ? number_color(seen.via) : number_color(seen.object) * (seen.via == 0 ? 1.0f : 0.3f);
        ++pixels[seen.object];
        if (seen.via != 0) ++pixels[seen.via];
    }
    for (std::uint32_t id = 1; id < r.world.objects.size(); ++id) {
        const WorldObject& object = r.world.objects[id];
        const Color c = number_color(id);
        const auto byte = [](float v) { return std::lround(255 * srgb_encode(v)); };
        shown.legend.push_back(
            fmt::format("object {} #{:02x}{:02x}{:02x} {} {}:{}:{}{}{}", id, byte(c.x), byte(c.y), byte(c.z),
                        object.name, object.said_at.file, object.said_at.line, object.said_at.column,
                        object.npr ? ", painted" : "", pixels[id] == 0 ? ", not seen" : ""));
    }
    return shown;
}

Shown show_normals(const Rendering& r) {
    Shown shown{Image<Color>(r.gbuffer.seen.width, r.gbuffer.seen.height),
                {"red, green, blue: x, y, z of the normal that faces the viewer, -1 black, 1 full"}};
    for (std::size_t i = 0; i < shown.picture.pixels.size(); ++i) {
        const Seen& seen = r.gbuffer.seen.pixels[i];
        if (seen.object == 0) continue;
        const Vec3f n = seen.normal * 0.5f + 0.5f;
        shown.picture.pixels[i] = displayed(n.x, n.y, n.z);
    }
    return shown;
}

// ---- photons

Shown show_photons(const Rendering& r) {
    const std::array<Color, 3> colors{displayed(1, 0.85f, 0.25f), displayed(0.35f, 0.65f, 1),
                                      displayed(1, 0.25f, 0.3f)};
    Shown shown{ground(r), {}};
    std::array<std::int64_t, 3> seen{}, all{};
    for (const PhotonPath path :
         {PhotonPath::indirect, PhotonPath::direct, PhotonPath::caustic}) { // the few over the many
        const auto kind = static_cast<std::size_t>(path);
        for (const Photon& photon : r.photons.photons) {
            if (photon.path() != path) continue;
            ++all[kind];
            const auto at = project(r.gbuffer.view, Vec3(photon.position));
            if (!at || !is_seen(r, *at, 0.02)) continue;
            ++seen[kind];
            shown.picture.at(static_cast<int>(at->pixel.x), static_cast<int>(at->pixel.y)) = colors[kind];
        }
    }
    constexpr const char* names[] = {"yellow: direct", "blue: indirect", "red: caustic"};
    for (std::size_t i = 0; i < 3; ++i)
        shown.legend.push_back(fmt::format("{}, {} of {} seen", names[i], seen[i], all[i]));
    if (r.photons.photons.empty()) shown.legend = {"the scene's light needs no photons"};
    return shown;
}

// ---- field

// How a direction on the surface lies in the picture, at a seen point.
Vec2 direction_in_picture(const Rendering& r, const Seen& seen, Vec3 direction) {
    if (seen.via == 0) return project_direction(r.gbuffer.view, Vec3(seen.position), direction);
    return footprint_offset(seen, direction).value_or(Vec2(0));
}

void draw_seeds(const Rendering& r, const OrientationFields& fields, Shown& shown) {
    const int size = digit_size(r);
    int number = 0;
    for (std::size_t id = 1; id < r.world.objects.size(); ++id) {
        if (!fields.fields[id]) continue;
        const std::vector<Seed>& said = r.world.objects[id].paint.seeds;
        const std::vector<SnappedSeed>& seeds = snapped_seeds(*fields.fields[id]);
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            const SnappedSeed& seed = seeds[i];
            const auto at = project(r.gbuffer.view, seed.position);
            const bool seen = at && is_seen(r, *at, 0.02);
            const Vec3 p = seed.position + r.world.offset;
            const SourceRef where = i < said.size() ? said[i].said_at : SourceRef{};
            shown.legend.push_back(fmt::format("seed {} {}:{}:{} of object {} at <{:.4g}, {:.4g}, {:.4g}>{}",
                                               ++number, where.file, where.line, where.column, id, p.x, p.y,
                                               p.z, seen ? "" : ", not seen"));
            if (!seen) continue;
            const Vec2 way = project_direction(r.gbuffer.view, seed.position, seed.axis);
            const double length = glm::length(way);
            const Vec2 arm = length > 0 ? way * (5.0 * size / length) : Vec2(0);
            draw_line(shown.picture, at->pixel - arm, at->pixel + arm, displayed(1, 0.2f, 0.15f));
            draw_dot(shown.picture, at->pixel, 1.2 * size, displayed(1, 0.9f, 0.2f));
            draw_number(shown.picture, static_cast<int>(at->pixel.x) + 2 * size,
                        static_cast<int>(at->pixel.y) + 2 * size, std::to_string(number), size,
                        displayed(1, 1, 0.6f));
        }
    }
}

Shown show_field(const Rendering& r) {
    const OrientationFields fields = make_orientation_fields(r.world);
    Shown shown{ground(r), {}};
    const int spacing = std::max(4, static_cast<int>(std::lround(scaled(10, r.gbuffer.view.height))));
    for (int y = spacing / 2; y < shown.picture.height; y += spacing)
        for (int x = spacing / 2; x < shown.picture.width; x += spacing) {
            const Seen& seen = r.gbuffer.seen.at(x, y);
            if (!is_painted(seen) || !fields.fields[seen.object]) continue;
            const Vec3 axis =
                eval_orientation(*fields.fields[seen.object], Vec3(seen.position), Vec3(seen.normal));
            const Vec2 way = direction_in_picture(r, seen, axis);
            if (!(glm::length(way) > 0)) continue;
            const Vec2 arm = glm::normalize(way) * (0.42 * spacing), middle(x + 0.5, y + 0.5);
            draw_line(shown.picture, middle - arm, middle + arm, displayed(0.75f, 0.9f, 1));
        }
    draw_seeds(r, fields, shown);
    if (!r.world.has_paint) shown.legend = {"nothing is painted: there is no field"};
    return shown;
}

// ---- maps of the painting

Shown show_sparse(const Rendering& r) {
    Shown shown{ground(r), {}};
    for (Color& color : shown.picture.pixels) color *= 0.2f; // the dots are what is shown
    std::int64_t sources = 0;
    for (std::size_t i = 0; i < shown.picture.pixels.size() && i < r.paint.sparse.pixels.size(); ++i) {
        const SourcePixel& source = r.paint.sparse.pixels[i];
        if (source.photon < 0) continue;
        ++sources;
        shown.picture.pixels[i] = as_viewed(source.radiance, r.settings.render);
    }
    shown.legend = {fmt::format("{} source photons, in their own colours", sources)};
    return shown;
}

Shown show_informative(const Rendering& r) {
    Shown shown{Image<Color>(r.gbuffer.seen.width, r.gbuffer.seen.height, no_ink),
                {"colours before the strokes; dark: not painted"}};
    for (std::size_t i = 0; i < r.paint.informative.pixels.size(); ++i)
        if (r.paint.informative.pixels[i].kind != PixelKind::outside)
            shown.picture.pixels[i] = as_viewed(r.paint.informative.pixels[i].radiance, r.settings.render);
    return shown;
}

Shown show_partial(const Rendering& r) {
    Shown shown{Image<Color>(r.gbuffer.seen.width, r.gbuffer.seen.height, no_ink),
                {"the painted layer alone, on dark"}};
    for (std::size_t i = 0; i < r.paint.layer.color.pixels.size(); ++i)
        shown.picture.pixels[i] = as_viewed(r.paint.layer.color.pixels[i], r.settings.render) +
                                  (1 - r.paint.layer.alpha.pixels[i]) * no_ink;
    return shown;
}

// ---- error

constexpr double hottest = 0.3;

// From 0 to the hottest along the lower edge, with numbers in percent.
void draw_heat_legend(Image<Color>& picture, int size) {
    const int height = 5 * size, width = picture.width;
    for (int y = picture.height - height; y < picture.height; ++y)
        for (int x = 0; x < width; ++x)
            if (picture.contains(x, y)) picture.at(x, y) = heat((x + 0.5) / width);
    for (int percent = 0; percent <= 30; percent += 10) {
        const std::string text = std::to_string(percent) + "%";
        const int middle = static_cast<int>(width * percent / 100.0 / hottest);
        draw_number(picture,
                    std::clamp(middle - number_width(text, size) / 2, 0, width - number_width(text, size)),
                    picture.height - height - 7 * size, text, size, Color(1));
    }
}

Shown show_error(const Rendering& r) {
    Shown shown{Image<Color>(r.gbuffer.seen.width, r.gbuffer.seen.height), {}};
    if (r.error.empty()) {
        shown.legend = {"too few passes were done to know the error"};
        return shown;
    }
    double mean = 0;
    for (const Color& c : r.rendered.layer.color.pixels) mean += static_cast<double>(luminance(c));
    mean /= static_cast<double>(std::max<std::size_t>(1, r.rendered.layer.color.pixels.size()));
    for (std::size_t i = 0; i < shown.picture.pixels.size(); ++i) {
        const double error = std::hypot(static_cast<double>(r.error.noise.pixels[i]),
                                        static_cast<double>(r.error.bias.pixels[i]));
        const double light = static_cast<double>(luminance(r.rendered.layer.color.pixels[i]));
        shown.picture.pixels[i] = heat(light + 0.01 * mean > 0 ? error / (light + 0.01 * mean) / hottest : 0);
    }
    draw_heat_legend(shown.picture, digit_size(r));
    shown.legend = {fmt::format("estimated error of the light after {} passes, relative: black 0, blue 7.5 "
                                "%, red 15 %, yellow 22.5 %, "
                                "white 30 % and more; 90 % of the pixels are below {:.2g} %",
                                r.passes_done, 100 * r.reached_error)};
    return shown;
}

} // namespace

const std::vector<std::string>& show_names() {
    static const std::vector<std::string> names{"field", "photons", "sparse", "informative", "partial",
                                                "ids",   "normals", "error",  "wire"};
    return names;
}

Show show_kind(const std::string& name) {
    const std::vector<std::string>& names = show_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<Show>(found - names.begin());
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    throw UsageError(fmt::format("--show {}: kinds are {}", name, all));
}

ShowNeeds needs_of(const std::vector<Show>& kinds) {
    ShowNeeds needs;
    for (const Show kind : kinds) {
        needs.error |= kind == Show::error;
        needs.strokes |= kind == Show::partial;
        needs.sources |= kind == Show::sparse || kind == Show::informative || kind == Show::partial;
        needs.photons |= kind == Show::photons || needs.sources;
    }
    return needs;
}

void plan_for(const ShowNeeds& needs, Plan& plan) {
    if (needs.error) return;
    const auto leave_out = [&](bool& chosen, const char* what, bool needed) {
        if (!chosen || needed) return;
        chosen = false;
        std::erase(plan.used, what);
        plan.left_out.push_back({what, "what is shown does not need it"});
    };
    leave_out(plan.photons, "photon pass", needs.photons);
    leave_out(plan.kdtree, "kd-tree", needs.sources);
    leave_out(plan.normals, "photon normals", needs.photons);
    leave_out(plan.caustic_map, "caustic map", needs.photons);
    leave_out(plan.paint, "npr pass", needs.sources);
    leave_out(plan.ilic, "ilic", needs.strokes);
    leave_out(plan.render_rays, "rendering pass", false);
}

void look_behind(const Scene& scene, Rendering& r, const ShowNeeds& needs, const Wishes& wishes, Reuse& reuse,
                 Passes& passes) {
    plan_for(needs, r.plan);
    if (r.plan.photons && !take_photons(reuse, r)) {
        check_photons(scene, r.world, r.settings, wishes.budgets);
        r.photons = make_photons(r, r.settings, 0, 1, false, passes);
    }
    const bool known = r.plan.paint && take_sources(reuse, r);
    if (r.plan.paint && !known) add_field(r, r.settings, 1, r.photons, passes);
    if (!take_seen(reuse, r)) {
        const PictureView view{r.world.camera, r.settings.render.width, r.settings.render.height};
        r.gbuffer = passes.run("gbuffer", [&](const Progress& progress) {
            return make_gbuffer(r.world, view, {0, 0, view.width, view.height}, r.settings.render, progress);
        });
    }
    if (!r.plan.paint) return;
    r.paint =
        paint(r, passes, known ? std::optional(std::move(r.paint.sparse)) : std::nullopt, needs.strokes);
}

Shown show(Show kind, const Rendering& r) {
    switch (kind) {
    case Show::field:
        return show_field(r);
    case Show::photons:
        return show_photons(r);
    case Show::sparse:
        return show_sparse(r);
    case Show::informative:
        return show_informative(r);
    case Show::partial:
        return show_partial(r);
    case Show::ids:
        return show_ids(r);
    case Show::normals:
        return show_normals(r);
    case Show::error:
        return show_error(r);
    case Show::wire:
        break;
    }
    return {draw_wire(ground(r), r), {"white: silhouettes; grey: creases; blue: edges of meshes"}};
}

} // namespace pnr
