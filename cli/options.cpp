// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/options.h"

#include "cli/editor_files.h"
#include "cli/help_command.h"
#include "cli/options_more.h"
#include "cli/povray_options.h"
#include "parser/diagnostic.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <map>

namespace pnr {

namespace {

// ---- values
// -----------------------------------------------------------------------------------------------------

// Numbers separated by commas, or by 'x' in WxH. Nothing if the text is anything else.
template <std::size_t n>
std::optional<std::array<double, n>> split_numbers(const std::string& text, char separator) {
    std::array<double, n> numbers{};
    const char* at = text.c_str();
    for (std::size_t i = 0; i < n; ++i) {
        char* end = nullptr;
        numbers[i] = std::strtod(at, &end);
        if (end == at || !std::isfinite(numbers[i])) return {};
        if (*end != (i + 1 < n ? separator : '\0')) return {};
        at = end + 1;
    }
    return numbers;
}

constexpr int largest_side = 65536;

int to_side(double value, const std::string& option) {
    if (!(value >= 1 && value <= largest_side && value == std::floor(value)))
        throw UsageError(
            fmt::format("{}: a size is a whole number of pixels from 1 to {}", option, largest_side));
    return static_cast<int>(value);
}

std::array<int, 2> to_pixel(const std::string& text, const std::string& option) {
    const auto numbers = split_numbers<2>(text, ',');
    if (!numbers || (*numbers)[0] < 0 || (*numbers)[1] < 0 || (*numbers)[0] > largest_side ||
        (*numbers)[1] > largest_side)
        throw UsageError(
            fmt::format("{} {}: a pixel is said as X,Y, counted from the top left", option, text));
    return {static_cast<int>((*numbers)[0]), static_cast<int>((*numbers)[1])};
}

FrameRange to_frames(const std::string& text) {
    FrameRange range;
    int used = 0, used_more = 0;
    const char* words = text.c_str();
    const bool two = std::sscanf(words, "%d-%d%n", &range.first, &range.last, &used) == 2;
    const bool step =
        two && words[used] == 'x' && std::sscanf(words + used, "x%d%n", &range.step, &used_more) == 1;
    if (!two || words[used + (step ? used_more : 0)] != '\0' || range.first < 0 || range.last < range.first ||
        range.last > 1'000'000 || range.step < 1)
        throw UsageError(fmt::format("--frames {}: frames are said as FIRST-LAST or FIRST-LASTxSTEP", text));
    return range;
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        if (end > begin) parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

// ---- the options of each command
// ----------------------------------------------------------------------------------

// What CLI11 fills and still needs a look.
struct Words {
    std::optional<std::string> tev;
    std::string show, scene, size, crop, frames, subset, aov, at, to, help, groups, sweep, shell, editor;
    std::string budgets = "1,2,4,8,16,32";
    std::vector<std::string> declares, outputs, library, limits;
    bool no_prune = false, manual = false;
};

void add_scene_options(CLI::App& app, Options& options, Words& words) {
    app.add_option("-D", words.declares, "Declare an identifier before the scene's first line")
        ->type_name("NAME=EXPR")
        ->allow_extra_args(false);
    app.add_option("-L", words.library, "Search this folder for included files, meshes and pictures")
        ->type_name("DIR")
        ->allow_extra_args(false);
    app.add_flag("--werror", options.werror, "Take warnings for errors");
    app.add_option("--limit", words.limits,
                   "Let a scene use more, or less, than it may by default; `--limit help` lists the limits")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    app.add_option("--allow-write", options.allow_write,
                   "Let the scene's #fopen write files below this folder; else they stay in memory")
        ->type_name("DIR");
}

void add_threads(CLI::App& app, Options& options) {
    app.add_option("--threads", options.threads, "Threads to use (default: all)")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
}

void add_size_options(CLI::App& app, Options& options, Words& words) {
    app.add_option("-W", options.width, "Width in pixels (default: 512, or from -H and the camera)")
        ->type_name("N");
    app.add_option("-H", options.height, "Height in pixels (default: from the width and the camera)")
        ->type_name("N");
    app.add_option("--size", words.size, "Width and height at once")->type_name("WxH");
}

template <class T>
void add_choice(CLI::App& app, const char* name, std::optional<T>& target, std::map<std::string, T> choices,
                const char* text) {
    std::string names;
    for (const auto& choice : choices) names += (names.empty() ? "" : "|") + choice.first;
    app.add_option_function<std::string>(
           name,
           [&target, choices, names, name](const std::string& word) {
               const auto found = choices.find(word);
               if (found == choices.end())
                   throw UsageError(fmt::format("{} {}: {} is expected", name, word, names));
               target = found->second;
           },
           text)
        ->type_name(names);
}

void add_progress(CLI::App& app, std::optional<ProgressMode>& progress) {
    add_choice<ProgressMode>(
        app, "--progress", progress,
        {{"auto", ProgressMode::automatic}, {"off", ProgressMode::off}, {"json", ProgressMode::json}},
        "Progress on standard error");
}

// What a picture is made of and with, of all commands that write one.
void add_picture_options(CLI::App& app, Options& options, Words& words, std::optional<ProgressMode>& progress) {
    app.add_option("-o", words.outputs,
                   "Write this picture, .png or .exr; may be repeated; - is PNG on standard output")
        ->type_name("IMAGE")
        ->allow_extra_args(false);
    add_size_options(app, options, words);
    add_threads(app, options);
    app.add_option("--seed", options.seed, "Random seed; the same seed gives the same picture, bit for bit")
        ->type_name("N");
    add_scene_options(app, options, words);
    app.add_option("--crop", words.crop,
                   "Render this part alone, in pixels from the top left or in fractions")
        ->type_name("X0,Y0,X1,Y1");
    app.add_option("--exposure", options.exposure, "Brighten or darken PNG pictures by stops")
        ->type_name("STOPS");
    add_choice<View>(app, "--view", options.view, {{"clip", View::clip}, {"shoulder", View::shoulder}},
                     "How PNG pictures treat light above 1");
    add_choice<Quality>(app, "--quality", options.quality,
                        {{"draft", Quality::draft}, {"normal", Quality::normal}, {"high", Quality::high}},
                        "Rays a pixel and shadow rays a light: draft 1 to 4 and 4, normal the scene's own (4 "
                        "to 16 and 32), high 16 to 64 and 64; half or twice the photons if the scene does not "
                        "say how many");
    add_choice<Integrator>(app, "--integrator", options.integrator,
                           {{"photons", Integrator::photons}, {"path", Integrator::path}},
                           "How photoreal light is found: the photon map, or the slow path-traced reference");
    app.add_option("--maps", options.maps,
                   "Write photons, G-buffer, sparse and informative maps and both layers there")
        ->type_name("DIR");
    app.add_option("--aov", words.aov, "Add these parts to EXR pictures (see below)")->type_name("NAME,...");
    add_cache(app, options);
    add_tev(app, words.tev);
    add_progress(app, progress);
}

void add_render(CLI::App& parent, Options& options, Words& words, std::optional<ProgressMode>& progress) {
    CLI::App& app = *parent.add_subcommand("render", "Render a scene to a picture");
    app.add_option("SCENE", words.scene,
                   "A .pnr or .pov file; - reads standard input; none: the built-in scene");
    add_picture_options(app, options, words, progress);
    app.add_option("--show", words.show,
                   "In place of the picture show what cannot be seen: field, photons, sparse, informative, partial, ids,\n"
                   "normals, error, wire; several kinds to NAME_KIND.png, or one -o for each")
        ->type_name("KIND,...");
    app.add_option("--frames", words.frames,
                   "Render these frames; the scene's `clock` goes from 0 to 1 over them")
        ->type_name("A-B[xSTEP]");
    app.add_option("--clock-first", options.clock_first, "The clock of the first frame (default: 0)");
    app.add_option("--clock-last", options.clock_last, "The clock of the last frame (default: 1)");
    app.add_flag("--cyclic", options.cyclic, "The clock's end is the frame behind the last: the animation runs round");
    app.add_option("--subset", words.subset, "Of the frames, render these alone; the clock stays as it is")
        ->type_name("A-B[xSTEP]");
    app.add_option("--clock", options.clock)->group(""); // POV-Ray's +K
    app.add_option("--time", options.time_s,
                   "Refine the picture in passes until so many seconds have gone by, from start to written file")
        ->type_name("SECONDS");
    app.add_option("--error", options.error,
                   "Refine until 90 % of the pixels have an estimated error below this share of their light; exit "
                   "code 5 if --time or --passes ends it before")
        ->type_name("FRACTION");
    app.add_option("--passes", options.passes, "Refine in so many passes; repeats a --time run bit for bit")
        ->type_name("N")
        ->check(CLI::Range(1, 100'000));
    app.add_option("--stats", options.stats, "Write times and counts as JSON")->type_name("FILE");
    add_render_page(app, options);
    app.add_option("--save-photons", options.save_photons, "Keep the photon map")->type_name("FILE");
    app.add_option("--load-photons", options.load_photons, "Use a kept photon map of the same scene")
        ->type_name("FILE");
    app.add_flag("--no-prune", words.no_prune, "Run every pass and structure, needed or not");
    auto* skip = app.add_flag("--skip-existing", options.skip_existing,
                              "Do nothing if the pictures are there already");
    app.add_flag("--no-overwrite", options.no_overwrite, "Refuse to replace a picture")->excludes(skip);
    app.add_option("--antialias", options.antialias)->group(""); // POV-Ray's +A, +R, +J
    app.add_option("--antialias-depth", options.antialias_depth)->group("")->check(CLI::Range(1, 9));
    app.add_option("--antialias-jitter", options.antialias_jitter)->group("")->check(CLI::Range(0.0, 1.0));
    app.footer("Parts for --aov: N P Z id npr.mask direct indirect caustic specular photon.density error.noise\n"
               "error.bias numbers sparse informative partial. SIGUSR1 has a run with --time, --error or --passes write the\n"
               "picture so far. POV-Ray's options (+W640 +H480 +I +O +L +Q +A0.3 +WT2 ...) are understood too.\n\n"
               "Examples:\n"
               "  pnr render                                   the built-in scene, to default.png\n"
               "  pnr render pot.pnr -o pot.png -o pot.exr     two pictures of one rendering\n"
               "  pnr render pot.pnr -H 1024 --maps pot.maps   a larger picture, and what lies behind it\n"
               "  pnr render pot.pnr -D Turn=30 --stats -      with a declared number, statistics on "
               "standard output\n"
               "  pnr render pot.pnr --time 20 --error 0.03    at most 20 s, less if the light is known before\n"
               "  pnr render pot.pnr --show field,ids          pot_field.png with numbered seeds, pot_ids.png\n"
               "  pnr render turn.pnr --frames 1-48 -o turn.png   turn0001.png to turn0048.png, `clock` from "
               "0 to 1");
}

void add_watch(CLI::App& parent, Options& options, Words& words, std::optional<ProgressMode>& progress) {
    CLI::App& app = *parent.add_subcommand("watch", "Render a scene again whenever it is saved");
    app.add_option("SCENE", words.scene, "A .pnr or .pov file")->required();
    add_picture_options(app, options, words, progress);
    app.footer("Runs just the passes that a change needs and says which: where only paint has changed, those of paint; where\n"
               "the camera has moved, all but the photons. Included files, meshes and pictures are watched too. An error in\n"
               "the scene is shown, and the picture stays until it is mended. Ctrl-C ends with exit code 130.\n\n"
               "Example:\n  pnr watch pot.pnr -o pot.png");
}

void add_others(CLI::App& parent, Options& options, Words& words, std::optional<TextFormat>& format) {
    const std::map<std::string, TextFormat> formats{{"text", TextFormat::text}, {"json", TextFormat::json}};
    CLI::App& check = *parent.add_subcommand("check", "Read and evaluate scenes, render nothing");
    check.add_option("SCENE", options.scenes, "Scene files; - reads standard input")->required();
    add_scene_options(check, options, words);
    add_choice(check, "--format", format, formats, "How to print what was found");
    check.footer("--format json prints one array for all scenes. An entry has severity (error, warning, note), file, line,\n"
                 "column, end_line, end_column (from 1, in bytes; the end is behind the last), message, help (may be \"\")\n"
                 "and notes, an array of the same places with a message each.\n\n"
                 "Example:\n  pnr check *.pnr");

    CLI::App& plan =
        *parent.add_subcommand("plan", "Say which passes and structures a scene needs, and what is left out");
    plan.add_option("SCENE", words.scene, "A scene file; none: the built-in scene");
    add_size_options(plan, options, words);
    add_threads(plan, options);
    add_scene_options(plan, options, words);
    add_choice(plan, "--format", format, formats, "How to print the plan");
    plan.add_option("--graph", options.graph, "Draw it as an SVG picture too")->type_name("FILE.svg");
    plan.add_flag("--no-prune", words.no_prune, "The plan when nothing is left out");
    add_cache(plan, options);
    plan.footer("Examples:\n  pnr plan pot.pnr\n  pnr plan pot.pnr --format json\n  pnr plan pot.pnr --graph pot.svg");

    CLI::App& pick = *parent.add_subcommand("pick", "Say what is seen at a pixel, and a seed line for it");
    pick.add_option("SCENE", words.scene, "A scene file; none: the built-in scene");
    pick.add_option("--at", words.at, "The pixel, from the top left")->type_name("X,Y")->required();
    pick.add_option("--to", words.to, "A second pixel: the seed's direction points there")
        ->type_name("X2,Y2");
    add_size_options(pick, options, words);
    add_scene_options(pick, options, words);
    pick.footer("Example:\n  pnr pick pot.pnr --at 250,300 --to 290,300\n"
                "Pixels are those of the picture that `pnr render` makes with the same -W and -H.");

    CLI::App& help = *parent.add_subcommand("help", "Explain a command or a word of the language");
    help.add_option("WORD", words.help, "A command, or a keyword, directive, function or block such as `sphere`");
    help.add_flag("--manual", words.manual, "All words of the language, as Markdown");
    help.add_option("--editor", words.editor, "The words for an editor's colours, as in grammar/editors")
        ->type_name("vim|textmate")
        ->check(CLI::IsMember({"vim", "textmate"}));
    help.footer("Examples:\n  pnr help render\n  pnr help isosurface\n  pnr help '#for'");
}

void add_ilic(CLI::App& parent, Options& options, Words& words, std::optional<ProgressMode>& progress) {
    CLI::App& app = *parent.add_subcommand("ilic", "Paint a flat picture along its own edges");
    IlicOptions& ilic = options.ilic;
    app.add_option("PICTURE", ilic.picture, "PNG, JPEG, EXR or what else the image library reads")->required();
    app.add_option("-o", words.outputs, "Write this picture, .png or .exr (default: PICTURE_painted.png)")
        ->type_name("IMAGE")
        ->allow_extra_args(false);
    app.add_option("--style", ilic.style, "How paint is laid: ilic, oil, impasto, pastel, fur, wash (default: ilic)")
        ->type_name("WORD");
    const auto pixels = CLI::Range(0.0, 1000.0);
    app.add_option("--length", ilic.length, "Length of a stroke, in pixels of a picture 512 high")
        ->type_name("N")
        ->check(pixels);
    app.add_option("--cell", ilic.cell, "Width of a stroke, likewise; one coat")->type_name("N")->check(pixels);
    app.add_option("--size", ilic.size, "All strokes so many times as large")
        ->type_name("FACTOR")
        ->check(CLI::Range(0.05, 20.0));
    app.add_option("--seed", options.seed, "Random seed")->type_name("N");
    add_threads(app, options);
    add_progress(app, progress);
    app.footer("Example:\n  pnr ilic photo.jpg -o painting.png --style oil --length 20\n"
               "Strokes follow the picture's edges [Wang and Lee 2003]; paint in space is `pnr render`'s.");
}

void add_stability(CLI::App& parent, Options& options, Words& words) {
    CLI::App& app = *parent.add_subcommand("stability", "Measure stiff and extreme cases against what theory allows");
    app.add_option("--group", words.groups, "These groups alone: paths, fields, roots, rays, photons, sums, pictures")
        ->type_name("NAME,...");
    app.add_option("--html", options.html, "Write the table as a page too")->type_name("FILE");
    add_threads(app, options);
    app.footer("Each line is a case that could break: what is measured, the bound that theory or a computation with 50\n"
               "digits gives, and what came out. Exit code 5 if one does not hold. All groups take about a minute.\n\n"
               "Example:\n  pnr stability --group rays,roots --html stability.html");
}

void add_converge(CLI::App& parent, Options& options, Words& words, std::optional<ProgressMode>& progress) {
    CLI::App& app = *parent.add_subcommand("converge", "Measure a scene's error against run time");
    app.add_option("SCENE", words.scene, "A scene file; none: the built-in scene");
    add_size_options(app, options, words);
    add_scene_options(app, options, words);
    app.add_option("--budgets", words.budgets, "Seconds after which to look (default: 1,2,4,8,16,32)")->type_name("S,...");
    app.add_option("--reference", options.reference, "Compare with this picture of linear light (.exr)")->type_name("IMAGE");
    app.add_option("--reference-time", options.reference_s,
                   "Trace two references by paths, this long together; 0: the error is estimated alone (default: 0)")
        ->type_name("S")
        ->check(CLI::Range(0.0, 1e6));
    app.add_flag("--causes", options.causes, "Split the error by cause, by more runs with one cause's random numbers changed");
    app.add_option("--sweep", words.sweep,
                   "Compare values of a setting: photons, gather, radius, shadow, sharp or seed")
        ->type_name("NAME=A,B,...");
    app.add_option("--error", options.error, "Say which budget and setting meets this relative error first")
        ->type_name("FRACTION");
    app.add_option("--csv", options.csv, "Write the table, - prints it")->type_name("FILE");
    app.add_option("--html", options.html, "Write a page with plots and pictures")->type_name("FILE");
    app.add_option("--seed", options.seed, "Random seed")->type_name("N");
    add_threads(app, options);
    add_progress(app, progress);
    app.footer("One progressive run is looked at whenever a budget is used up. Error is measured over the photoreal pixels,\n"
               "against two independent references whose own noise drops out: root mean squares, absolute and relative to\n"
               "light + a tenth of the mean; the ratio of means; the 99th percentile; FLIP, how different they look, 0 to 1;\n"
               "and beside them what the run itself estimates as its noise and bias. --causes adds photon noise (a second\n"
               "run with other photons), sample noise (edges and shadow rays: a third with other samples), kernel bias (what\n"
               "the true error holds beyond both), and of a painting the errors of field, informative map and ILIC.\n\n"
               "Examples:\n  pnr converge box.pnr -W 256 --reference-time 60 --html box.html\n"
               "  pnr converge box.pnr --budgets 2,4,8 --sweep photons=50000,200000,800000 --error 0.03");
}

void finish_converge(Options& options, const Words& words) {
    for (const std::string& word : split(words.budgets, ',')) {
        const auto seconds = split_numbers<1>(word, ',');
        if (!seconds || !((*seconds)[0] > 0) || (!options.run_budgets.empty() && (*seconds)[0] <= options.run_budgets.back()))
            throw UsageError(fmt::format("--budgets {}: rising numbers of seconds are expected, such as 1,2,4", words.budgets));
        options.run_budgets.push_back((*seconds)[0]);
    }
    if (words.sweep.empty()) return;
    const std::size_t equals = words.sweep.find('=');
    options.sweep = words.sweep.substr(0, equals);
    if (equals != std::string::npos)
        for (const std::string& word : split(words.sweep.substr(equals + 1), ','))
            if (const auto value = split_numbers<1>(word, ',')) options.sweep_values.push_back((*value)[0]);
    if (options.sweep_values.empty())
        throw UsageError(fmt::format("--sweep {}: a setting and its values are said as NAME=A,B,...", words.sweep));
}

void finish_options(Options& options, Words& words) {
    finish_tev(options, words.tev, words.scene);
    if (!words.scene.empty()) options.scenes = {words.scene};
    for (const std::string& output : words.outputs) options.outputs.emplace_back(output);
    for (const std::string& folder : words.library) options.library.emplace_back(folder);
    for (const std::string& declare : words.declares) {
        const std::size_t equals = declare.find('=');
        if (equals == 0 || equals == std::string::npos || equals + 1 == declare.size())
            throw UsageError(fmt::format("-D {}: a declaration is said as NAME=EXPR", declare));
        options.declares.emplace_back(declare.substr(0, equals), declare.substr(equals + 1));
    }
    for (const std::string& said : words.limits)
        if (const std::string wrong = set_limit(options.budgets, said); !wrong.empty())
            throw UsageError(fmt::format("--limit {}: {}", said, wrong));
    if (options.width) options.width = to_side(*options.width, "-W");
    if (options.height) options.height = to_side(*options.height, "-H");
    if (!words.size.empty()) {
        const auto size = split_numbers<2>(words.size, 'x');
        if (!size)
            throw UsageError(fmt::format("--size {}: a size is said as WxH, e.g. 640x480", words.size));
        options.width = to_side((*size)[0], "--size");
        options.height = to_side((*size)[1], "--size");
    }
    if (!words.crop.empty()) {
        options.crop = split_numbers<4>(words.crop, ',');
        if (!options.crop)
            throw UsageError(fmt::format("--crop {}: a crop is said as X0,Y0,X1,Y1", words.crop));
    }
    if (!words.frames.empty()) options.frames = to_frames(words.frames);
    if (!words.subset.empty()) options.subset = to_frames(words.subset);
    if (options.subset && !options.frames) throw UsageError("--subset: which frames are there? --frames says it");
    if (options.exposure && !(std::abs(*options.exposure) <= 100))
        throw UsageError("--exposure: a number of stops from -100 to 100 is expected");
    if (options.time_s && !(*options.time_s > 0 && *options.time_s <= 1e7))
        throw UsageError("--time: a number of seconds above 0 is expected");
    if (options.error && !(*options.error > 0 && *options.error < 1e3))
        throw UsageError("--error: a fraction above 0 is expected, such as 0.03");
    options.aovs = split(words.aov, ',');
    options.shows = split(words.show, ',');
    options.groups = split(words.groups, ',');
    finish_converge(options, words);
    options.prune = !words.no_prune;
    if (!words.at.empty()) options.at = to_pixel(words.at, "--at");
    if (!words.to.empty()) options.to = to_pixel(words.to, "--to");
}

// ---- help and errors
// ------------------------------------------------------------------------------------------------

std::string did_you_mean(const CLI::App& app, const std::vector<std::string>& arguments) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    for (const std::string& argument : arguments) {
        if (std::find(names.begin(), names.end(), argument) != names.end()) continue;
        const std::string_view near = nearest_word(argument, candidates);
        if (!near.empty()) return fmt::format("; did you mean `{}`?", near);
    }
    return "";
}

// The program's whole command line; what it parses goes into the members.
struct Parsing {
    CLI::App app{
        "pnr renders scenes of POV-Ray's language, as a photograph and as a painting, by photon mapping.",
        "pnr"};
    Options options;
    Words words;
    std::optional<ProgressMode> progress;
    std::optional<TextFormat> format;

    Parsing() {
        app.set_help_flag("-h,--help", "Print this help");
        app.set_version_flag("--version", fmt::format("pnr {}", version()));
        app.require_subcommand(1);
        add_render(app, options, words, progress);
        add_watch(app, options, words, progress);
        add_others(app, options, words, format);
        add_ilic(app, options, words, progress);
        add_stability(app, options, words);
        add_converge(app, options, words, progress);
        add_fmt(app, options);
        add_init(app, options);
        add_lsp(app, options);
        add_shell_files(app, words.shell);
        app.footer("Exit codes: 0 done, 1 render failed, 2 usage, 3 error in the scene, 4 file not read or "
                   "written,\n"
                   "5 done, but --error was missed, a stability case fails or fmt --check would\n"
                   "change a file, 130 or 143 stopped by a signal.");
    }
    Parsing(const Parsing&) = delete; // the app points into it
    Parsing& operator=(const Parsing&) = delete;
};

bool is_command(CLI::App& app, const std::string& word) {
    const auto commands = app.get_subcommands([](CLI::App*) { return true; });
    return std::any_of(commands.begin(), commands.end(),
                       [&](const CLI::App* command) { return command->get_name() == word; });
}

[[noreturn]] void refuse_command(const CLI::App& app, const std::string& word) {
    throw UsageError(fmt::format("there is no command `{}`{}", word, did_you_mean(app, {word})));
}

// From an app that has parsed nothing: after parsing, CLI11 tells of the command that was given.
std::string help_text(const std::string& command) {
    Parsing fresh;
    std::string text;
    if (command.empty())
        text = fresh.app.help();
    else if (is_command(fresh.app, command))
        text = fresh.app.get_subcommand(command)->help("pnr");
    else
        text = help_for_word(command, did_you_mean(fresh.app, {command}));
    return text.ends_with('\n') ? text : text + "\n";
}

std::string help_answer(const Words& words) {
    if (!words.editor.empty()) return editor_file(words.editor);
    return words.manual ? whole_manual() : help_text(words.help);
}

} // namespace

CommandLine parse_command_line(std::vector<std::string> arguments) {
    arguments = from_povray_options(std::move(arguments));
    if (arguments.empty()) throw UsageError("a command is expected; `pnr help` lists them");
    for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
        if (arguments[i] == "--limit" && arguments[i + 1] == "help") return {{}, limits_help({})};
    Parsing parsing;
    CLI::App& app = parsing.app;
    if (arguments[0][0] != '-' && !is_command(app, arguments[0])) refuse_command(app, arguments[0]);
    CommandLine line;
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        parsing.options.command = app.get_subcommands().front()->get_name();
        line.answer = shell_file(Parsing().app, parsing.options.command, parsing.words.shell);
        if (parsing.options.command == "help") line.answer = help_answer(parsing.words);
    } catch (const CLI::CallForHelp&) {
        const auto chosen = app.get_subcommands();
        line.answer = help_text(chosen.empty() ? "" : chosen.front()->get_name());
    } catch (const CLI::CallForVersion& version_text) {
        line.answer = std::string(version_text.what()) + "\n";
    } catch (const CLI::ParseError& error) {
        const auto chosen = app.get_subcommands();
        const CLI::App& at = chosen.empty() ? app : *chosen.front();
        const bool unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
        throw UsageError(error.what() + (unknown ? did_you_mean(at, arguments) : ""));
    }
    if (!line.answer.empty()) return line;
    parsing.options.progress = parsing.progress.value_or(ProgressMode::automatic);
    parsing.options.format = parsing.format.value_or(TextFormat::text);
    finish_options(parsing.options, parsing.words);
    line.options = std::move(parsing.options);
    return line;
}

PixelRect crop_window(const std::optional<CropWord>& crop, int width, int height) {
    if (!crop) return {0, 0, width, height};
    CropWord c = *crop;
    const bool fractions = *std::max_element(c.begin(), c.end()) <= 1;
    if (fractions) c = {c[0] * width, c[1] * height, c[2] * width, c[3] * height};
    const PixelRect window{static_cast<int>(std::lround(c[0])), static_cast<int>(std::lround(c[1])),
                           static_cast<int>(std::lround(c[2])), static_cast<int>(std::lround(c[3]))};
    if (window.x0 < 0 || window.y0 < 0 || window.x1 > width || window.y1 > height || window.x0 >= window.x1 ||
        window.y0 >= window.y1)
        throw UsageError(fmt::format("--crop: {},{},{},{} is not a part of the picture of {} x {} pixels",
                                     window.x0, window.y0, window.x1, window.y1, width, height));
    return window;
}

} // namespace pnr
