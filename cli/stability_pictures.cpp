// SPDX-License-Identifier: GPL-3.0-or-later
// Whole pictures of one small scene, in ways that must not change them: in other units, far from the origin,
// lit by next to nothing, with things in it that are not there. The same seed has the same photons
// everywhere, so pictures may be compared pixel by pixel; 1 % of the mean is what rounding may do by sending
// some of them another way.
#include "cli/stability.h"

#include "cli/pipeline.h"
#include "parser/load_scene.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

// A painted ball and a glass one in a box, in units of `Unit` about the place `At`.
constexpr const char* scene = R"(
global_settings { photons { count 30000 } }
camera { location <0, 1, -3.4> * Unit + At look_at <0, 0.9, 0> * Unit + At right x angle 42 }
light_source { <0, 1.95, 0.2> * Unit + At, rgb 1 emitter { rectangle 0.8 * x * Unit, 0.8 * z * Unit } power Power * Unit * Unit }
union {
    box { <-1, -0.1, -1>, <1, 0, 1> }
    box { <-1, 2, -1>, <1, 2.1, 1> }
    box { <-1, 0, 1>, <1, 2, 1.1> }
    box { <-1.1, 0, -1>, <-1, 2, 1> pigment { rgb <0.8, 0.2, 0.1> } }
    box { <1, 0, -1>, <1.1, 2, 1> pigment { rgb <0.2, 0.5, 0.2> } }
    pigment { rgb 0.75 } finish { diffuse 1 }
    scale Unit translate At
}
sphere {
    <-0.4, 0.45, 0.3>, 0.45 pigment { rgb <0.4, 0.6, 0.8> } finish { diffuse 0.9 }
    #if (Painted) npr { style oil seeds { seed { <-0.4, 0.45, -0.15>, x } seed { <-0.4, 0.9, 0.3>, z } } } #end
    scale Unit translate At
}
sphere {
    <0.4, 0.35, -0.2>, 0.35 pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel on } }
    interior { ior Ior }
    scale Unit translate At
}
)";

using Words = std::vector<std::pair<std::string, std::string>>;

Rendering rendered(const Words& changed, const std::string& more = "", int width = 64, int height = 64) {
    LoadOptions options;
    Words words{{"Unit", "1"}, {"At", "<0, 0, 0>"}, {"Power", "40"}, {"Ior", "1.5"}, {"Painted", "1"}};
    for (const auto& [name, value] : changed)
        for (auto& word : words)
            if (word.first == name) word.second = value;
    options.declares = words;
    const LoadResult loaded = load_scene_text(scene + more, "stability.pnr", options);
    if (!loaded.scene) throw SceneError({}, "the scene of the stability suite does not load");
    Settings settings = loaded.settings;
    settings.render.width = width;
    settings.render.height = height;
    // More rays where neighbours differ as they are shown would come with more light.
    settings.render.samples_max = settings.render.samples_min;
    Passes passes(ProgressMode::off, false);
    Reuse none;
    return render_scene(*loaded.scene, settings, {}, none, passes);
}

double faults_of(const Rendering& r) {
    std::int64_t bad = r.faults.nan + r.faults.inf + r.faults.negative;
    for (const Color& c : r.picture.color.pixels)
        if (!std::isfinite(c.x + c.y + c.z)) ++bad;
    return static_cast<double>(bad);
}

// Mean absolute difference over the mean, once `a` is divided by `factor`.
double difference(const Rendering& a, const Rendering& b, double factor) {
    double sum = 0, mean = 0;
    for (std::size_t i = 0; i < a.picture.color.pixels.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const double truth = static_cast<double>(b.picture.color.pixels[i][k]);
            sum += std::abs(static_cast<double>(a.picture.color.pixels[i][k]) / factor - truth);
            mean += truth;
        }
    }
    return sum / mean;
}

void add_same_picture(StabilityCases& cases, const std::string& name, const Rendering& changed,
                      const Rendering& plain, double factor = 1) {
    cases.push_back({"pictures", name, "mean difference / mean", 0.01, difference(changed, plain, factor)});
    cases.push_back({"pictures", name, "samples that are no light", 0, faults_of(changed)});
}

} // namespace

StabilityCases picture_cases() {
    StabilityCases cases;
    const Rendering plain = rendered({});
    cases.push_back({"pictures", "as it stands", "samples that are no light", 0, faults_of(plain)});
    for (const char* unit : {"1e-6", "1e-3", "1e3", "1e6"})
        add_same_picture(cases, fmt::format("in units of {}", unit), rendered({{"Unit", unit}}), plain);
    add_same_picture(cases, "1e6 from the origin", rendered({{"At", "<1e6, -1e6, 1e6>"}}), plain);
    // Strokes vary by what an eye sees of them, so not in proportion to the light.
    const Rendering photoreal = rendered({{"Painted", "0"}});
    for (const char* power : {"40e-30", "40e-10", "40e10", "40e30"}) {
        add_same_picture(cases, fmt::format("a lamp of {} W", power),
                         rendered({{"Power", power}, {"Painted", "0"}}), photoreal, std::stod(power) / 40);
        cases.push_back({"pictures", fmt::format("paint under a lamp of {} W", power),
                         "samples that are no light", 0, faults_of(rendered({{"Power", power}}))});
    }
    const Rendering clear = rendered({{"Ior", "1"}});
    for (const char* ior : {"1 + 1e-9", "1 + 1e-12", "1 - 1e-9"})
        add_same_picture(cases, fmt::format("glass of index {}", ior), rendered({{"Ior", ior}}), clear);
    add_same_picture(
        cases, "with triangles that are points and lines",
        rendered({}, "mesh { triangle { 0, 0, 0 } triangle { 0, x, 2 * x } triangle { y, y, z } "
                     "triangle { <0.3, 0.3, 0>, <0.3, 0.3, 0> + 1e-300, <0.3, 0.3, 0> } pigment { rgb 1 } }"),
        plain);
    add_same_picture(cases, "with a ball that no float can see",
                     rendered({}, "sphere { <0, 1, 0>, 1e-30 pigment { rgb 1 } }"), plain);
    cases.push_back({"pictures", "glass of index 10", "samples that are no light", 0,
                     faults_of(rendered({{"Ior", "10"}}))});
    cases.push_back(
        {"pictures", "one pixel", "samples that are no light", 0, faults_of(rendered({}, "", 1, 1))});
    cases.push_back(
        {"pictures", "one row", "samples that are no light", 0, faults_of(rendered({}, "", 64, 1))});
    cases.push_back(
        {"pictures", "one column", "samples that are no light", 0, faults_of(rendered({}, "", 1, 64))});
    for (const char* eye :
         {"<0.4, 0.35, -0.2>", "<0.4, 0.35, -0.55>", "<-0.4, 0.45, 0.3>", "<-0.4, 0.45, -0.15>", "<0, 0, 0>"})
        cases.push_back(
            {"pictures", fmt::format("the camera in or on a surface, at {}", eye),
             "samples that are no light", 0,
             faults_of(rendered({}, fmt::format("camera {{ location {} look_at <0.1, 0.9, 0.9> }}", eye)))});
    cases.push_back(
        {"pictures", "an albedo of 1e30", "samples that are no light", 0,
         faults_of(rendered({}, "sphere { <0, 1.5, 0>, 0.2 pigment { rgb 1e30 } finish { diffuse 1 } }"))});
    cases.push_back({"pictures", "a painted ball out of sight", "samples that are no light", 0,
                     faults_of(rendered({}, "camera { location <0, 1, -0.9> look_at <0, 2, -0.9> }"))});
    return cases;
}

} // namespace pnr
