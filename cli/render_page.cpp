// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/render_page.h"

#include "cli/html_page.h"
#include "cli/map_files.h"
#include "cli/picture_files.h"
#include "cli/structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace pnr {

namespace {

constexpr int map_width = 260; // as shown

// ---- maps as pictures
// ------------------------------------------------------------------------------------------------

// The window's pixels by a function of their place.
Image<Color> drawn(const Rendering& r, const std::function<Color(int x, int y)>& color) {
    Image<Color> picture(r.window.x1 - r.window.x0, r.window.y1 - r.window.y0);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) picture.at(x, y) = color(r.window.x0 + x, r.window.y0 + y);
    return picture;
}

// A colour for each number, unlike that of the next ones: hues a golden angle apart, by a simple colour
// wheel.
Color color_of_number(std::uint32_t number) {
    if (number == 0) return Color(0);
    const double hue = 2 * pi * std::fmod(0.61803398875 * number, 1.0);
    const auto part = [&](double shift) { return static_cast<float>(0.35 + 0.3 * std::cos(hue + shift)); };
    return {part(0), part(2 * pi / 3), part(4 * pi / 3)};
}

// Near is light; the seen depths' whole range is used.
std::string depth_map(const Rendering& r) {
    float near = std::numeric_limits<float>::infinity(), far = 0;
    for (int y = r.window.y0; y < r.window.y1; ++y)
        for (int x = r.window.x0; x < r.window.x1; ++x)
            if (const float z = r.gbuffer.seen.at(x, y).z; z > 0)
                near = std::min(near, z), far = std::max(far, z);
    const auto picture = drawn(r, [&](int x, int y) {
        const float z = r.gbuffer.seen.at(x, y).z;
        return z > 0 ? Color(0.03f + 0.9f * (1 / z - 1 / far) / std::max(1e-30f, 1 / near - 1 / far))
                     : Color(0);
    });
    return html_picture(picture, fmt::format("depth, {:.3g} to {:.3g}", far > 0 ? near : 0, far), map_width);
}

std::string gbuffer_maps(const Rendering& r) {
    if (r.gbuffer.seen.empty()) return "";
    const auto normals = drawn(r, [&](int x, int y) {
        const Seen& seen = r.gbuffer.seen.at(x, y);
        return seen.z > 0 ? Color(0.5f) + 0.5f * seen.normal : Color(0);
    });
    const auto objects =
        drawn(r, [&](int x, int y) { return color_of_number(r.gbuffer.seen.at(x, y).object); });
    return html_picture(normals, "normals", map_width) + html_picture(objects, "objects", map_width) +
           depth_map(r);
}

std::string paint_maps(const Rendering& r) {
    if (r.paint.informative.empty()) return "";
    const auto sparse = drawn(r, [&](int x, int y) {
        const SourcePixel& p = r.paint.sparse.at(x, y);
        return p.photon >= 0 ? p.radiance : Color(0.8f);
    });
    const auto informative = drawn(r, [&](int x, int y) {
        const Informed& p = r.paint.informative.at(x, y);
        return p.kind != PixelKind::outside ? p.radiance : Color(0.8f);
    });
    const Image<Color> strokes = draw_orientation(r);
    return html_picture(sparse, "sparse map: photons that are seen", map_width) +
           html_picture(drawn(r, [&](int x, int y) { return strokes.at(x, y); }), "orientation", map_width) +
           html_picture(informative, "informative map", map_width);
}

std::string layer_maps(const Rendering& r) {
    std::string html;
    const auto add = [&](const Layer& layer, const char* name) {
        if (!layer.color.empty())
            html +=
                html_picture(drawn(r, [&](int x, int y) { return layer.color.at(x, y); }), name, map_width);
    };
    if (r.plan.paint) add(r.paint.layer, "painted layer");
    add(r.rendered.layer, "photoreal layer");
    return html;
}

std::string error_maps(const Rendering& r) {
    if (r.error.empty()) return "";
    // Of the light there, ten times as strong; bias in red where the picture is too bright, in blue where too
    // dark.
    const auto relative = [&](const Image<float>& error, int x, int y) {
        return 10 * error.at(x, y) / (0.01f + luminance(r.rendered.layer.color.at(x, y)));
    };
    const auto noise = drawn(r, [&](int x, int y) { return Color(relative(r.error.noise, x, y)); });
    const auto bias = drawn(r, [&](int x, int y) {
        const float off = relative(r.error.bias, x, y);
        return off > 0 ? Color(off, 0.2f * off, 0.1f * off) : Color(-0.1f * off, -0.3f * off, -off);
    });
    return html_picture(noise, "estimated noise over light, ten times", map_width) +
           html_picture(bias, "estimated bias over light, ten times", map_width);
}

std::string fault_map(const Rendering& r) {
    if (r.fault_places.empty()) return "";
    Image<Color> marks(r.settings.render.width, r.settings.render.height, Color(0));
    for (const FaultPlace& place : r.fault_places) marks.at(place.x, place.y) = Color(1, 0.05f, 0.05f);
    return html_picture(drawn(r, [&](int x, int y) { return marks.at(x, y); }), "samples that are no light",
                        map_width);
}

// ---- tables
// ----------------------------------------------------------------------------------------------------------

std::string pass_part(const std::vector<PassTime>& times) {
    HtmlTable table{{"pass", "wall s", "CPU s", "share %", "memory so far MB"}, {}, {}};
    std::vector<std::pair<std::string, double>> bar;
    double whole = 0;
    for (const PassTime& time : times) whole += time.cpu_s;
    for (const PassTime& time : times) {
        bar.emplace_back(time.name, time.cpu_s);
        if (time.peak_rss_mb > 0)
            table.rows.push_back({time.name, fmt::format("{:.2f}", time.wall_s),
                                  fmt::format("{:.2f}", time.cpu_s),
                                  fmt::format("{:.0f}", whole > 0 ? 100 * time.cpu_s / whole : 0),
                                  fmt::format("{:.0f}", time.peak_rss_mb)});
    }
    return "<h2>Time</h2>" + html_bar(bar, "CPU s") + html_table(table);
}

std::string memory_part(const Rendering& r) {
    std::vector<std::pair<std::string, double>> bar;
    for (const StructureSize& size : structure_sizes(r))
        bar.emplace_back(size.name, size.bytes / (1024 * 1024));
    return "<h2>Memory of structures</h2>" + html_bar(bar, "MB");
}

std::string error_part(const Rendering& r) {
    if (r.progressive.passes == 0) return "";
    std::string text = fmt::format("<h2>Error</h2><p>{} passes", r.passes_done);
    if (r.error.empty()) return text + ": too few to know the error.</p>";
    text +=
        fmt::format(": 90 % of the pixels are known within {:.2g} % of their light", 100 * r.reached_error);
    if (r.asked_error > 0) text += fmt::format("; {:.2g} % were asked for", 100 * r.asked_error);
    return text + ".</p>" + error_maps(r);
}

std::string plan_part(const Plan& plan) {
    HtmlTable left{{"left out", "why"}, {}, {}};
    for (const LeftOut& out : plan.left_out) left.rows.push_back({out.what, out.why});
    std::string used;
    for (const std::string& what : plan.used) used += (used.empty() ? "" : ", ") + what;
    return "<h2>Plan</h2><p>Used: " + html_text(used) + ".</p>" +
           (left.rows.empty() ? std::string() : html_table(left));
}

std::string facts(const Rendering& r) {
    const RenderSettings& s = r.settings.render;
    return fmt::format("<p>{} x {} pixels, seed {}, {} photons emitted, {} stored, {} camera rays.</p>",
                       s.width, s.height, s.seed, r.photons.emitted, r.photons.photons.size(),
                       r.rendered.camera_rays);
}

} // namespace

std::string render_page(const Scene& scene, const Rendering& r, const std::vector<PassTime>& times,
                        const std::vector<std::string>& warnings) {
    std::string body;
    if (!r.picture.color.empty())
        body += html_picture(shown_picture(scene, r), scene.file, std::min(900, r.window.x1 - r.window.x0));
    body += facts(r) + pass_part(times) + memory_part(r);
    const std::string maps = gbuffer_maps(r) + paint_maps(r) + layer_maps(r) + fault_map(r);
    if (!maps.empty()) body += "<h2>What lies behind it</h2>" + maps;
    body += error_part(r) + plan_part(r.plan);
    if (!warnings.empty()) {
        body += "<h2>Warnings</h2><ul>";
        for (const std::string& warning : warnings) body += "<li>" + html_text(warning) + "</li>";
        body += "</ul>";
    }
    return html_page("pnr render: " + scene.file, body);
}

} // namespace pnr
