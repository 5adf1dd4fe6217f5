// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"

#include "cli/interrupt.h"
#include "cli/load.h"
#include "cli/map_files.h"
#include "cli/parts.h"
#include "cli/picture_files.h"
#include "cli/pipeline.h"
#include "cli/report.h"
#include "cli/stats.h"
#include "core/atomic_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace pnr {

namespace {

namespace fs = std::filesystem;

std::string scene_of(const Options& options) { return options.scenes.empty() ? "" : options.scenes.front(); }

void print_answer(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw FileError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

// Loads the one scene of a command and prints what was found. False: the scene cannot be rendered.
bool load_and_report(const Options& options, LoadResult& loaded) {
    loaded = load_named_scene(scene_of(options), options);
    if (!loaded.debug_output.empty()) std::fputs(loaded.debug_output.c_str(), stderr);
    print_diagnostics(loaded.diagnostics, loaded.sources);
    if (may_render(loaded, options)) return true;
    if (loaded.scene) print_error("warnings count as errors (--werror)");
    return false;
}

// Runs work that may find an error in the scene after reading it.
template <class Work>
int with_scene_errors(LoadResult& loaded, Work work) {
    try {
        return work();
    } catch (const SceneError& error) {
        print_diagnostics({as_diagnostic(error, loaded.sources)}, loaded.sources);
        return exit_scene;
    }
}

void check_aovs(const std::vector<std::string>& asked) {
    const std::vector<std::string>& known = aov_names();
    for (const std::string& name : asked) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        const std::string_view near = nearest_word(name, {known.begin(), known.end()});
        throw UsageError(fmt::format("--aov: there is no part `{}`{}", name,
                                     near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
    }
}

// ---- render
// -----------------------------------------------------------------------------------------------------

std::vector<fs::path> output_files(const Options& options) {
    if (!options.outputs.empty()) return options.outputs;
    return {scene_stem(scene_of(options)) + ".png"};
}

bool any_exists(const std::vector<fs::path>& files) {
    return std::any_of(files.begin(), files.end(),
                       [](const fs::path& f) { return f != "-" && fs::exists(f); });
}

std::vector<std::string> all_warnings(const LoadResult& loaded, const Rendering& r) {
    std::vector<std::string> warnings = warning_texts(loaded.diagnostics, loaded.sources);
    warnings.insert(warnings.end(), r.world.notes.begin(), r.world.notes.end());
    for (const FieldReport& report : r.paint.fields.reports)
        for (const std::string& note : report.notes)
            warnings.push_back(fmt::format("object {}: {}", report.object, note));
    return warnings;
}

void write_results(const LoadResult& loaded, const Rendering& r, const Options& options,
                   const std::vector<fs::path>& outputs, Passes& passes) {
    passes.run("write", [&](const Progress&) {
        for (const fs::path& output : outputs)
            write_picture(*loaded.scene, r, options.aovs, passes.times(), output);
        if (!options.maps.empty()) write_maps(r, options.maps);
    });
    if (options.stats.empty()) return;
    const std::string text = stats_json(*loaded.scene, r, passes.times(), all_warnings(loaded, r));
    if (options.stats == "-")
        print_answer(text);
    else
        write_file_atomically(options.stats, text);
}

void report_faults(const SampleFaults& faults) {
    if (faults.nan + faults.inf + faults.negative == 0) return;
    print_warning(fmt::format(
        "samples that no picture can show were left out: {} not a number, {} infinite, {} negative",
        faults.nan, faults.inf, faults.negative));
}

} // namespace

int run_render(const Options& options) {
    const std::vector<fs::path> outputs = output_files(options);
    check_aovs(options.aovs);
    for (const fs::path& output : outputs) check_output(output);
    if (options.skip_existing &&
        std::all_of(outputs.begin(), outputs.end(), [](const fs::path& f) { return fs::exists(f); }))
        return exit_done;
    if (options.no_overwrite && any_exists(outputs))
        throw FileError("a picture of that name exists already (--no-overwrite)");

    const ThreadLimit limit(options.threads);
    Passes passes(options.progress);
    LoadResult loaded;
    const bool ready = passes.run("parse", [&](const Progress&) { return load_and_report(options, loaded); });
    if (!ready) return exit_scene;
    return with_scene_errors(loaded, [&] {
        const bool parts = std::any_of(options.aovs.begin(), options.aovs.end(), [](const std::string& name) {
            return name == "direct" || name == "indirect" || name == "caustic" || name == "specular" ||
                   name == "photon.density";
        });
        const Wishes wishes{options.crop, !options.maps.empty(), parts, options.save_photons,
                            options.load_photons};
        const Rendering r =
            render_scene(*loaded.scene, merge_settings(loaded.settings, options), wishes, passes);
        report_faults(r.faults);
        write_results(loaded, r, options, outputs, passes);
        return r.stopped ? exit_signal + stop_signal() : exit_done;
    });
}

// ---- check
// ------------------------------------------------------------------------------------------------------

int run_check(const Options& options) {
    int code = exit_done;
    std::string json;
    for (const std::string& name : options.scenes) {
        try {
            const LoadResult loaded = load_named_scene(name, options);
            if (options.format == TextFormat::json)
                json += format_json(loaded.diagnostics, loaded.sources);
            else
                print_diagnostics(loaded.diagnostics, loaded.sources);
            if (!may_render(loaded, options)) code = exit_scene;
        } catch (const FileError& error) {
            print_error(error.what());
            if (code == exit_done) code = exit_file;
        }
    }
    print_answer(json);
    return code;
}

// ---- plan
// -------------------------------------------------------------------------------------------------------

int run_plan(const Options& options) {
    LoadResult loaded;
    if (!load_and_report(options, loaded)) return exit_scene;
    return with_scene_errors(loaded, [&] {
        const Settings settings = merge_settings(loaded.settings, options);
        const Plan plan = make_plan(build_world(*loaded.scene, settings), settings, false);
        print_answer(options.format == TextFormat::json ? plan_json(plan) : plan_text(plan));
        return exit_done;
    });
}

// ---- the program
// ------------------------------------------------------------------------------------------------

int run_program(const std::vector<std::string>& arguments) {
    install_signal_handlers();
    try {
        const CommandLine line = parse_command_line(arguments);
        if (!line.answer.empty()) {
            print_answer(line.answer);
            return exit_done;
        }
        const Options& options = line.options;
        if (options.command == "check") return run_check(options);
        if (options.command == "plan") return run_plan(options);
        if (options.command == "pick") return run_pick(options);
        return run_render(options);
    } catch (const UsageError& error) {
        print_error(error.what());
        std::fputs("`pnr help` and `pnr help COMMAND` explain the command line\n", stderr);
        return exit_usage;
    } catch (const FileError& error) {
        print_error(error.what());
        return exit_file;
    } catch (const std::exception& error) {
        print_error(fmt::format("render failed: {}", error.what()));
        return exit_render;
    }
}

} // namespace pnr
