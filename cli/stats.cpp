// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stats.h"

#include "cli/faults.h"
#include "cli/html_page.h"
#include "cli/structures.h"
#include "core/geometry.h"
#include "core/irradiance_field.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

using Json = nlohmann::ordered_json;

Json rgb(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

Json photon_counts(const PhotonMap& map) {
    const auto count = [&](auto of_kind) {
        return std::count_if(map.photons.begin(), map.photons.end(), of_kind);
    };
    return {{"emitted", map.emitted},
            {"stored", map.photons.size()},
            {"npr", count([](const Photon& p) { return p.npr(); })},
            {"caustic", count([](const Photon& p) { return p.path() == PhotonPath::caustic; })},
            {"emitted_power", rgb(map.balance.emitted)},
            {"absorbed_power", rgb(map.balance.absorbed)},
            {"escaped_power", rgb(map.balance.escaped)}};
}

Json paint_counts(const Rendering& r) {
    const auto count = [&](PixelKind kind) {
        return std::count_if(r.paint.informative.pixels.begin(), r.paint.informative.pixels.end(),
                             [kind](const Informed& p) { return p.kind == kind; });
    };
    const auto painted = std::count_if(r.gbuffer.seen.pixels.begin(), r.gbuffer.seen.pixels.end(),
                                       [](const Seen& seen) { return seen.npr; });
    return {{"source_pixels", count(PixelKind::source)},
            {"painted_pixels", painted},
            {"filled_pixels", count(PixelKind::filled)}};
}

// Bytes a triangle are those of the whole BVH: 0 where the scene has no triangles.
Json ray_counts(const Rendering& r) {
    Json rays{{"camera", r.rendered.camera_rays}, {"gathers", r.rendered.gathers},
              {"records", r.photons.field ? record_count(*r.photons.field) : 0}};
    if (!r.world.geometry) return rays;
    const GeometryStats stats = geometry_stats(*r.world.geometry);
    rays["triangles"] = stats.triangles;
    rays["shapes"] = stats.shapes;
    rays["instances"] = stats.instances;
    rays["unbounded"] = stats.unbounded;
    rays["bvh_bytes"] = stats.bytes;
    rays["bytes_per_triangle"] =
        stats.triangles > 0 ? static_cast<double>(stats.bytes) / static_cast<double>(stats.triangles) : 0.0;
    rays["build_s"] = stats.build_s;
    return rays;
}

// Beside the counts where they are: the objects, the worst first, with a pixel each.
Json numbers_object(const Rendering& r) {
    Json objects = Json::array();
    for (const ObjectFaults& o : faults_by_object(r))
        objects.push_back({{"object", o.object}, {"samples", o.faults.sum()}, {"pixel", {o.x, o.y}}});
    return {{"nan", r.faults.nan}, {"inf", r.faults.inf}, {"negative", r.faults.negative}, {"objects", objects}};
}

Json memory_object(const Rendering& r) {
    Json memory = Json::object();
    for (const StructureSize& size : structure_sizes(r)) memory[size.name] = static_cast<std::int64_t>(size.bytes);
    return memory;
}

Json plan_object(const Plan& plan) {
    Json left_out = Json::array();
    for (const LeftOut& left : plan.left_out) left_out.push_back({{"what", left.what}, {"why", left.why}});
    return {{"used", plan.used}, {"left_out", left_out}};
}

// Root of the mean square over the window.
double rms(const Image<float>& image, const PixelRect& window) {
    if (image.empty()) return 0;
    double sum = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            sum += static_cast<double>(image.at(x, y)) * static_cast<double>(image.at(x, y));
    return std::sqrt(sum / (static_cast<double>(window.x1 - window.x0) * (window.y1 - window.y0)));
}

// `reached`: 90 % of the pixels have an estimated error below this times (L + 0.01 mean L); noise and bias: of the
// luminance, root mean square. 0 while nothing is known: fewer than two whole batches of passes.
Json error_object(const Rendering& r) {
    const bool known = !r.error.empty();
    return {{"asked", r.asked_error},
            {"reached", known ? r.reached_error : 0.0},
            {"known", known},
            {"passes", r.passes_done},
            {"batches", r.progressive.batches},
            {"noise_rms", rms(r.error.noise, r.window)},
            {"bias_rms", rms(r.error.bias, r.window)}};
}

} // namespace

std::string stats_json(const Scene& scene, const Rendering& r, const std::vector<PassTime>& times,
                       const std::vector<std::string>& warnings) {
    Json passes = Json::array();
    for (const PassTime& time : times)
        passes.push_back({{"name", time.name},
                          {"wall_s", time.wall_s},
                          {"cpu_s", time.cpu_s},
                          {"peak_rss_mb", time.peak_rss_mb}});
    const Json stats{
        {"schema", 1},
        {"program", "pnr"},
        {"version", version()},
        {"scene", scene.file},
        {"scene_hash", fmt::format("{:016x}", scene.hash)},
        {"threads", thread_count()},
        {"seed", r.settings.render.seed},
        {"image", {{"width", r.settings.render.width}, {"height", r.settings.render.height}}},
        {"passes", passes},
        {"photons", photon_counts(r.photons)},
        {"npr", paint_counts(r)},
        {"rays", ray_counts(r)},
        {"memory", memory_object(r)},
        {"numbers", numbers_object(r)},
        {"plan", plan_object(r.plan)},
        {"error", error_object(r)},
        {"warnings", warnings},
    };
    return stats.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

std::string megabytes(double bytes) { return fmt::format("{:.1f}", bytes / (1024 * 1024)); }

HtmlTable pass_table(const Forecast& f) {
    HtmlTable table{{"pass", "CPU s", "share %", "memory so far MB"}, {}, {}};
    for (const PassForecast& pass : f.passes)
        table.rows.push_back({pass.name, fmt::format("{:.2f}", pass.cpu_s), fmt::format("{:.0f}", 100 * pass.share),
                              fmt::format("{:.0f}", pass.peak_rss_mb)});
    return table;
}

HtmlTable structure_table(const Forecast& f) {
    HtmlTable table{{"structure", "MB"}, {}, {}};
    for (const StructureSize& structure : f.structures) table.rows.push_back({structure.name, megabytes(structure.bytes)});
    return table;
}

} // namespace

std::string plan_text(const Plan& plan, const Forecast& f) {
    std::string text;
    for (const std::string& what : plan.used) text += fmt::format("uses       {}\n", what);
    for (const LeftOut& left : plan.left_out) text += fmt::format("leaves out {}: {}\n", left.what, left.why);
    text += fmt::format("\nforetold for {} x {} pixels and {} photons, from {} pixels' width and {} photons:\n\n", f.width,
                        f.height, f.photons, f.small_width, f.small_photons);
    return text + table_text(pass_table(f)) + "\n" + table_text(structure_table(f));
}

std::string plan_json(const Plan& plan, const Forecast& f) {
    Json json = plan_object(plan);
    Json passes = Json::array(), structures = Json::array();
    for (const PassForecast& pass : f.passes)
        passes.push_back({{"name", pass.name}, {"cpu_s", pass.cpu_s}, {"share", pass.share}, {"peak_rss_mb", pass.peak_rss_mb}});
    for (const StructureSize& structure : f.structures)
        structures.push_back({{"name", structure.name}, {"bytes", static_cast<std::int64_t>(structure.bytes)}});
    json["forecast"] = {{"image", {{"width", f.width}, {"height", f.height}}},
                        {"photons", f.photons},
                        {"passes", passes},
                        {"structures", structures}};
    return json.dump(2) + "\n";
}

} // namespace pnr
