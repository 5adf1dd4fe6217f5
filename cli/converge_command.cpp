// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr converge`: error against time, as a table and as a page.
#include "cli/commands.h"
#include "cli/converge.h"
#include "cli/html_page.h"
#include "cli/load.h"
#include "cli/report.h"
#include "core/atomic_file.h"
#include "core/image_io.h"
#include "core/parallel.h"
#include "parser/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace pnr {

namespace {

// ---- settings that may be swept
// ---------------------------------------------------------------------------------------

struct SweepWord {
    const char* name;
    void (*set)(Settings&, double);
};
constexpr std::array<SweepWord, 6> sweep_words{{
    {"photons",
     [](Settings& s, double v) {
         s.photons.count = static_cast<std::int64_t>(v), s.photons.count_given = true;
     }},
    {"gather", [](Settings& s, double v) { s.photons.gather_max = std::max(1, static_cast<int>(v)); }},
    {"radius", [](Settings& s, double v) { s.photons.radius = v; }},
    {"shadow", [](Settings& s, double v) { s.render.shadow_samples = std::max(1, static_cast<int>(v)); }},
    {"sharp", [](Settings& s, double v) { s.render.sharp = v != 0; }},
    {"seed", [](Settings& s, double v) { s.render.seed = static_cast<std::uint64_t>(v); }},
}};

const SweepWord& sweep_word(const std::string& word) {
    std::vector<std::string_view> names;
    std::string list;
    for (const SweepWord& known : sweep_words) {
        if (word == known.name) return known;
        names.emplace_back(known.name);
        list += (list.empty() ? "" : ", ") + std::string(known.name);
    }
    const std::string_view near = nearest_word(word, names);
    throw UsageError(fmt::format("--sweep: `{}` is no setting{}; there are {}", word,
                                 near.empty() ? "" : fmt::format(" (did you mean `{}`?)", near), list));
}

// ---- what a run is compared with
// --------------------------------------------------------------------------------------

Image<Color> read_reference(const std::filesystem::path& file) {
    const Image<glm::vec4> pixels = read_image(file);
    Image<Color> picture(pixels.width, pixels.height);
    for (std::size_t i = 0; i < pixels.pixels.size(); ++i) picture.pixels[i] = Color(pixels.pixels[i]);
    return picture;
}

// Two path-traced pictures with different random numbers, half of the time each.
Reference trace_reference(const Scene& scene, Settings settings, const Options& options) {
    Reference reference;
    settings.render.integrator = Integrator::path;
    for (Image<Color>* picture : {&reference.a, &reference.b}) {
        settings.render.seed = hash_words(settings.render.seed, 0x7ef);
        std::vector<Snapshot> run =
            run_budgets(scene, settings, options.budgets, {0.5 * options.reference_s}, options.progress);
        *picture = std::move(run.back().photoreal);
    }
    return reference;
}

// ---- the report
// -------------------------------------------------------------------------------------------------------

struct Row {
    std::string setting; // "" without --sweep
    Snapshot snapshot;
    std::optional<PictureError> error; // without a reference: none
};

std::string number(double value) { return fmt::format("{:.4g}", value); }
std::string number(const std::optional<double>& value) { return value ? number(*value) : ""; }

double estimate(const Snapshot& s) { return std::sqrt(*s.noise * *s.noise + *s.bias * *s.bias); }

// What the true error holds beyond noise; nothing where it is hidden by that, or a reference or the causes lack.
std::optional<double> kernel_bias(const Row& row) {
    const Snapshot& s = row.snapshot;
    if (!row.error || !s.photon_noise || !s.sample_noise) return {};
    const double noise2 = *s.photon_noise * *s.photon_noise + *s.sample_noise * *s.sample_noise;
    const double left2 = row.error->relative_rmse * row.error->relative_rmse - noise2;
    return left2 > 0 ? std::optional(std::sqrt(left2)) : std::nullopt;
}

HtmlTable paint_table(const std::vector<PaintCauses>& causes) {
    HtmlTable table{{"photons", "cpu_s", "field_degrees", "map_relative", "ilic"}, {}, {}};
    for (const PaintCauses& c : causes)
        table.rows.push_back({fmt::format("x {:g}", c.photons), number(c.cpu_s), number(c.field), number(c.map), number(c.ilic)});
    return table;
}

HtmlTable as_table(const std::vector<Row>& rows) {
    HtmlTable table{{"setting", "budget_s", "wall_s", "cpu_s", "passes", "rmse", "relative_rmse",
                     "mean_ratio", "relative_99", "flip", "estimated_noise", "estimated_bias", "estimated/true",
                     "photon_noise", "sample_noise", "kernel_bias"},
                    {},
                    {}};
    for (const Row& row : rows) {
        const Snapshot& s = row.snapshot;
        std::vector<std::string> cells{row.setting, number(s.budget_s), number(s.wall_s), number(s.cpu_s),
                                       fmt::format("{}", s.passes)};
        if (row.error)
            for (const double value : {row.error->rmse, row.error->relative_rmse, row.error->mean_ratio,
                                       row.error->relative_99, row.error->flip})
                cells.push_back(number(value));
        else
            cells.resize(cells.size() + 5);
        cells.push_back(number(s.noise));
        cells.push_back(number(s.bias));
        const bool both = row.error && s.noise && row.error->relative_rmse > 0;
        cells.push_back(both ? number(estimate(s) / row.error->relative_rmse) : "");
        cells.push_back(number(s.photon_noise));
        cells.push_back(number(s.sample_noise));
        cells.push_back(number(kernel_bias(row)));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::string as_csv(const HtmlTable& table) {
    std::string text;
    const auto line = [&](const std::vector<std::string>& cells) {
        for (std::size_t i = 0; i < cells.size(); ++i) text += (i > 0 ? "," : "") + cells[i];
        text += '\n';
    };
    line(table.head);
    for (const auto& row : table.rows) line(row);
    return text;
}

std::vector<std::string> settings_in(const std::vector<Row>& rows) {
    std::vector<std::string> settings;
    for (const Row& row : rows)
        if (std::find(settings.begin(), settings.end(), row.setting) == settings.end())
            settings.push_back(row.setting);
    return settings;
}

using Reading = std::function<std::optional<double>(const Row&)>;
std::vector<std::pair<double, double>> points_of(const std::vector<Row>& rows, const std::string& setting,
                                                 const Reading& read, bool over_passes = false) {
    std::vector<std::pair<double, double>> points;
    for (const Row& row : rows)
        if (const auto value = read(row); row.setting == setting && value)
            points.emplace_back(over_passes ? row.snapshot.passes : row.snapshot.cpu_s, *value);
    return points;
}

const Reading true_error = [](const Row& r) {
    return r.error ? std::optional(r.error->relative_rmse) : std::nullopt;
};
const Reading noise_of = [](const Row& r) { return r.snapshot.noise; };
const Reading photon_noise_of = [](const Row& r) { return r.snapshot.photon_noise; };
const Reading sample_noise_of = [](const Row& r) { return r.snapshot.sample_noise; };
const Reading bias_of = [](const Row& r) { return r.snapshot.bias; };

// Theory: independent samples' mean, and photons' whose width shrinks so that noise and bias fall alike [Knaus and Zwicker
// 2011]; where light comes by final gathering, whose rays do not shrink, photon noise lies between the two.
struct Cause {
    const char* name;
    Reading read;
    const char* theory;
};
const std::vector<Cause> causes{{"sample noise", sample_noise_of, "-1/2"},
                                {"photon noise", photon_noise_of, "-1/3 (photons alone) to -1/2 (final gathering)"},
                                {"kernel bias", kernel_bias, "-1/3"}};

// What the numbers say, in lines.
std::string conclusions(const std::vector<Row>& rows, const Options& options) {
    std::string text;
    std::optional<std::pair<double, std::string>> cheapest;
    for (const std::string& setting : settings_in(rows)) {
        const std::string name = setting.empty() ? "" : setting + ": ";
        for (const auto& [what, read] :
             {std::pair{"relative error", true_error}, {"estimated noise", noise_of}})
            if (const auto slope = log_slope(points_of(rows, setting, read)))
                text += fmt::format("{}{} falls with the {:.2f}th power of CPU time\n", name, what, *slope);
        for (const Cause& cause : causes)
            if (const auto slope = log_slope(points_of(rows, setting, cause.read, true)))
                text += fmt::format("{}{} falls with the {:.2f}th power of passes; theory says {}\n", name, cause.name, *slope,
                                    cause.theory);
        for (const Row& row : rows) {
            const auto error = true_error(row) ? true_error(row) : noise_of(row);
            if (row.setting != setting || !options.error || !error || *error > *options.error) continue;
            if (!cheapest || row.snapshot.cpu_s < cheapest->first) cheapest = {row.snapshot.cpu_s, setting};
            break;
        }
    }
    if (options.error)
        text += cheapest
                    ? fmt::format("error {:.3g} is met in {:.3g} CPU s{}\n", *options.error, cheapest->first,
                                  cheapest->second.empty() ? "" : " by " + cheapest->second)
                    : fmt::format("error {:.3g} is not met\n", *options.error);
    return text;
}

// Where the picture is off, five times as strong: brighter than the reference red, darker blue.
Image<Color> difference_picture(const Image<Color>& x, const Reference& reference, const Image<float>& mask) {
    Image<Color> picture(x.width, x.height, Color(0.02f));
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        if (mask.pixels[i] <= 0) continue;
        const float r = 0.5f * luminance(reference.a.pixels[i] + reference.b.pixels[i]);
        const float off = 5 * (luminance(x.pixels[i]) - r) / (r + 0.05f);
        picture.pixels[i] =
            off > 0 ? Color(off, 0.2f * off, 0.1f * off) : Color(-0.1f * off, -0.3f * off, -off);
    }
    return picture;
}

// The causes against passes, dashed lines with the slopes that theory gives.
std::string causes_part(const std::vector<Row>& rows, const std::vector<PaintCauses>& paint) {
    std::vector<PlotLine> lines;
    for (const std::string& setting : settings_in(rows)) {
        const std::string name = setting.empty() ? "" : setting + " ";
        for (const Cause& cause : causes) {
            const auto points = points_of(rows, setting, cause.read, true);
            if (!points.empty()) lines.push_back({name + cause.name, points, false});
        }
        const auto samples = points_of(rows, setting, sample_noise_of, true);
        for (const auto& [slope, label] : {std::pair{-0.5, "slope -1/2"}, {-1.0 / 3, "slope -1/3"}})
            if (samples.size() > 1) {
                const auto& [x, y] = samples.front();
                const double end = samples.back().first;
                lines.push_back({name + label, {samples.front(), {end, y * std::pow(end / x, slope)}}, true});
            }
    }
    std::string html = html_log_plot("Error by cause", "passes", "relative RMSE", lines);
    if (!html.empty())
        html += "<p>Photon noise: half the mean square difference from a run with other photons and the same samples; sample "
                "noise (edges, shadow rays): from one with the same photons and other samples; kernel bias: what the true error "
                "holds beyond both.</p>";
    if (paint.empty()) return html;
    return html + "<h2>Paint by cause</h2>" + html_table(paint_table(paint)) +
           "<p>For a quarter, one and four times the photons. Field: angle between strokes' axes as interpolated in the picture "
           "and the field itself at the seen points; map: colours from other photons; ILIC: paths with steps half as long.</p>";
}

std::string page(const std::string& scene, const std::vector<Row>& rows, const std::vector<PaintCauses>& paint,
                 const std::optional<Reference>& reference, const std::string& conclusion) {
    std::vector<PlotLine> errors, parts;
    for (const std::string& setting : settings_in(rows)) {
        const std::string name = setting.empty() ? "" : setting + " ";
        const auto points = points_of(rows, setting, true_error);
        errors.push_back({name + (points.empty() ? "no reference" : "relative RMSE"), points, false});
        if (const auto slope = log_slope(points); slope && points.size() > 2) {
            const auto& [x0, y0] = points.front();
            errors.push_back(
                {fmt::format("{}slope {:.2f}", name, *slope),
                 {points.front(), {points.back().first, y0 * std::pow(points.back().first / x0, *slope)}},
                 true});
        }
        parts.push_back({name + "estimated noise", points_of(rows, setting, noise_of), false});
        parts.push_back({name + "estimated bias", points_of(rows, setting, bias_of), false});
    }
    std::string body = "<p>" + html_text(conclusion) + "</p>";
    body += html_log_plot("Error against time", "CPU seconds", "relative RMSE", errors);
    body += html_log_plot("What the run itself says of its error", "CPU seconds", "relative", parts);
    body += causes_part(rows, paint);
    body += "<h2>Numbers</h2>" + html_table(as_table(rows)) + "<h2>Pictures</h2>";
    for (const Row& row : rows)
        body += html_picture(row.snapshot.picture,
                             fmt::format("{} {:.3g} s", row.setting, row.snapshot.wall_s), 220);
    if (reference) {
        body += "<h2>Differences from the reference, five times as strong</h2><p>Brighter is red, darker is "
                "blue; what is "
                "painted is left out.</p>";
        for (const Row& row : rows)
            body += html_picture(difference_picture(row.snapshot.photoreal, *reference, row.snapshot.mask),
                                 fmt::format("{} {:.3g} s", row.setting, row.snapshot.wall_s), 220);
        body += html_picture(reference->a, "reference", 220);
    }
    body += "<h2>Time</h2>";
    std::vector<std::pair<std::string, double>> times;
    for (const PassTime& time : rows.back().snapshot.times) times.emplace_back(time.name, time.cpu_s);
    return html_page("pnr converge: " + scene, body + html_bar(times, "CPU s"));
}

std::vector<Row> run_settings(const Scene& scene, const Settings& settings, const Options& options,
                              const std::optional<Reference>& reference) {
    std::vector<Row> rows;
    const auto run = [&](const std::string& name, const Settings& changed) {
        std::vector<Snapshot> snapshots =
            run_budgets(scene, changed, options.budgets, options.run_budgets, options.progress);
        if (options.causes) add_causes(scene, changed, options.budgets, snapshots, options.progress);
        for (Snapshot& s : snapshots) {
            Row row{name, std::move(s), {}};
            if (reference) row.error = picture_error(row.snapshot.photoreal, *reference, row.snapshot.mask);
            rows.push_back(std::move(row));
        }
    };
    if (options.sweep.empty()) run("", settings);
    for (const double value : options.sweep_values) {
        Settings changed = settings;
        sweep_word(options.sweep).set(changed, value);
        run(fmt::format("{}={:g}", options.sweep, value), changed);
    }
    return rows;
}

} // namespace

int run_converge(const Options& options) {
    if (!options.sweep.empty()) sweep_word(options.sweep);
    const ThreadLimit limit(options.threads);
    LoadResult loaded;
    if (!load_and_report(options, {}, loaded)) return exit_scene;
    return with_scene_errors(loaded.sources, [&] {
        const Settings settings = merge_settings(loaded.settings, options);
        std::optional<Reference> reference;
        if (!options.reference.empty()) {
            const Image<Color> picture = read_reference(options.reference);
            reference = Reference{picture, picture};
        } else if (options.reference_s > 0) {
            reference = trace_reference(*loaded.scene, settings, options);
        }
        const std::vector<Row> rows = run_settings(*loaded.scene, settings, options, reference);
        std::vector<PaintCauses> paint;
        if (options.causes) paint = paint_causes(*loaded.scene, settings);
        const HtmlTable table = as_table(rows);
        const std::string conclusion = conclusions(rows, options);
        print_answer(table_text(table) + conclusion);
        if (!paint.empty()) print_answer(table_text(paint_table(paint)));
        if (!options.csv.empty()) {
            if (options.csv == "-")
                print_answer(as_csv(table));
            else
                write_file_atomically(options.csv, as_csv(table));
        }
        if (!options.html.empty())
            write_file_atomically(options.html, page(loaded.scene->file, rows, paint, reference, conclusion));
        return exit_done;
    });
}

} // namespace pnr
