// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"

#include "cli/forecast.h"
#include "cli/identity.h"
#include "cli/interrupt.h"
#include "cli/load.h"
#include "cli/pipeline.h"
#include "cli/report.h"
#include "cli/stats.h"

#include <fmt/format.h>

#include <cstdio>
#include <new>

namespace pnr {

// ---- check ----

int run_check(const Options& options) {
    int code = exit_done;
    std::vector<std::string> found;
    for (const std::string& name : options.scenes) {
        try {
            const LoadResult loaded = load_named_scene(name, options, {});
            if (options.format == TextFormat::json)
                found.push_back(format_json(loaded.diagnostics, loaded.sources));
            else
                print_diagnostics(loaded.diagnostics, loaded.sources);
            if (!may_render(loaded, options)) code = exit_scene;
        } catch (const FileError& error) {
            print_error(error.what());
            if (code == exit_done) code = exit_file;
        }
    }
    if (options.format == TextFormat::json) print_answer(join_json_arrays(found));
    return code;
}

// ---- plan ----

int run_plan(const Options& options) {
    const ThreadLimit limit(options.threads);
    Passes passes(ProgressMode::off, true);
    LoadResult loaded;
    if (!passes.run("parse", [&](const Progress&) { return load_and_report(options, {}, loaded); })) return exit_scene;
    return with_scene_errors(loaded.sources, [&] {
        Reuse reuse;
        reuse.scene = identity_of(loaded);
        if (options.cache) reuse.disk = users_cache();
        Rendering r = plan_rendering(*loaded.scene, merge_settings(loaded.settings, options), {}, reuse, passes);
        for (const std::string& note : r.world.notes) print_note(note);
        note_stored(reuse, r);
        const Plan plan = r.plan;
        const Forecast f = forecast(std::move(r.world), r.settings, plan, passes.times());
        print_answer(options.format == TextFormat::json ? plan_json(plan, f) : plan_text(plan, f));
        return exit_done;
    });
}

// ---- the program ----

int run_program(const std::vector<std::string>& arguments) {
    install_signal_handlers();
    build_identity(); // before modules are loaded
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
        if (options.command == "ilic") return run_ilic(options);
        if (options.command == "stability") return run_stability(options);
        if (options.command == "converge") return run_converge(options);
        if (options.command == "fmt") return run_fmt(options);
        if (options.command == "init") return run_init(options);
        if (options.command == "lsp") return run_lsp(options);
        if (options.command == "watch") return run_watch(options);
        return options.shows.empty() ? run_render(options) : run_show(options);
    } catch (const UsageError& error) {
        print_error(error.what());
        std::fputs("`pnr help` and `pnr help COMMAND` explain the command line\n", stderr);
        return exit_usage;
    } catch (const FileError& error) {
        print_error(error.what());
        return exit_file;
    } catch (const std::bad_alloc&) {
        print_error("memory ran out; a smaller picture, fewer photons or a smaller scene need less");
        return exit_render;
    } catch (const std::exception& error) {
        print_error(fmt::format("render failed: {}", error.what()));
        return exit_render;
    } catch (...) {
        print_error("render failed for a reason that has no name");
        return exit_render;
    }
}

} // namespace pnr
