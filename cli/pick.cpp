// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr pick`: the paper's mouse, in text. An author points at two pixels and gets the line of a seed.
#include "cli/commands.h"

#include "cli/load.h"
#include "cli/pipeline.h"
#include "cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

// Short decimals that still tell points of this scene apart.
std::string format_vector(Vec3 v, double unit) {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(unit))), 0, 12);
    const auto number = [&](double x) {
        std::string text = fmt::format("{:.{}f}", x, digits);
        if (digits > 0) {
            text.erase(text.find_last_not_of('0') + 1);
            if (text.back() == '.') text.pop_back();
        }
        return text == "-0" ? std::string("0") : text;
    };
    return fmt::format("<{}, {}, {}>", number(v.x), number(v.y), number(v.z));
}

Seen look(const World& world, const PictureView& view, const RenderSettings& settings,
          std::array<int, 2> pixel) {
    const auto [x, y] = pixel;
    if (x >= view.width || y >= view.height)
        throw UsageError(
            fmt::format("{},{} lies outside the picture of {} x {} pixels", x, y, view.width, view.height));
    return make_gbuffer(world, view, {x, y, x + 1, y + 1}, settings).seen.at(x, y);
}

// Part of v perpendicular to the unit normal, unit; zero if there is none.
Vec3 tangent_part(Vec3 v, Vec3 normal) {
    const Vec3 tangent = v - glm::dot(v, normal) * normal;
    const double length = glm::length(tangent);
    return length > 1e-12 * glm::length(v) ? tangent / length : Vec3(0);
}

std::string describe_object(const World& world, std::uint32_t number) {
    const WorldObject& object = world.objects[number];
    std::string text = fmt::format("object {} {}", number, object.name);
    if (object.said_at.line > 0)
        text += fmt::format(" ({}:{}:{})", object.said_at.file, object.said_at.line, object.said_at.column);
    return text + (object.npr ? ", painted" : "");
}

std::string answer(const World& world, const PictureView& view, const Settings& settings,
                   const Options& options) {
    const Seen seen = look(world, view, settings.render, options.at);
    if (seen.z == 0) return fmt::format("nothing is seen at {},{}\n", options.at[0], options.at[1]);
    const Vec3 point = Vec3(seen.position) + world.offset;
    const Vec3 normal = glm::normalize(Vec3(seen.normal));
    std::string text = describe_object(world, seen.object) + "\n";
    if (seen.via != 0) text += "seen by way of " + describe_object(world, seen.via) + "\n";
    const double unit = 1e-5 * world.radius;
    text += fmt::format("point  {}\nnormal {}\n", format_vector(point, unit), format_vector(normal, 1e-5));

    // Without a second point the stroke runs to the right in the picture.
    Vec3 direction(seen.dpdx);
    if (options.to) {
        const Seen end = look(world, view, settings.render, *options.to);
        if (end.z == 0)
            return text + fmt::format("nothing is seen at {},{}\n", (*options.to)[0], (*options.to)[1]);
        direction = Vec3(end.position) - Vec3(seen.position);
        if (end.object != seen.object)
            text += "the second pixel shows " + describe_object(world, end.object) + "\n";
    }
    const Vec3 axis = tangent_part(direction, normal);
    if (axis == Vec3(0)) return text + "the two points give no direction along the surface\n";
    return text + fmt::format("seed {{ {}, {} }}\n", format_vector(point, unit), format_vector(axis, 1e-5));
}

} // namespace

int run_pick(const Options& options) {
    LoadResult loaded;
    if (!load_and_report(options, {}, loaded)) return exit_scene;
    return with_scene_errors(loaded.sources, [&] {
        const Settings settings = merge_settings(loaded.settings, options);
        const PictureSize size = picture_size(loaded.scene->camera, settings.render);
        const World world = build_world(*loaded.scene, settings);
        print_answer(answer(world, {world.camera, size.width, size.height}, settings, options));
        return exit_done;
    });
}

} // namespace pnr
