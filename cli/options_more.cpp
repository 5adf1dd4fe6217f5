// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/options_more.h"

#include "cli/shell_files.h"
#include "cli/tev_view.h"

#include <CLI/CLI.hpp>

namespace pnr {

void add_tev(CLI::App& app, std::optional<std::string>& place) {
    app.add_option("--tev", place,
                   std::string("Show the picture in the making, and every map as a layer, in the viewer tev at this place (default: ") +
                       tev_usual_place + ")")
        ->type_name("HOST:PORT")
        ->expected(0, 1);
}

void finish_tev(Options& options, const std::optional<std::string>& place, std::string& scene) {
    if (!place) return;
    const std::size_t colon = place->rfind(':');
    const std::string port = colon == std::string::npos ? "" : place->substr(colon + 1);
    const bool is_place = colon != 0 && !port.empty() && port.size() <= 5 &&
                          port.find_first_not_of("0123456789") == std::string::npos && std::stoi(port) <= 65535;
    options.tev = is_place ? *place : tev_usual_place;
    if (is_place || place->empty()) return;
    if (!scene.empty()) throw UsageError(*place + " is no place of a viewer; --tev HOST:PORT is expected, such as " + tev_usual_place);
    scene = *place; // `--tev pot.pnr`
}

void add_cache(CLI::App& app, Options& options) {
    app.add_flag_callback("--no-cache", [&options] { options.cache = false; },
                          "Use no results of earlier runs and keep none; the picture is the same");
}

void add_render_page(CLI::App& app, Options& options) {
    app.add_option("--html", options.html, "Write a page: passes, memory, maps as pictures, error, plan")->type_name("FILE");
}

void add_fmt(CLI::App& parent, Options& options) {
    CLI::App& app = *parent.add_subcommand("fmt", "Lay scene texts out: indentation, spaces, empty lines");
    app.add_option("FILE", options.scenes, "Scenes and includes, replaced by what comes out; - or none: standard input to output");
    app.add_flag("--check", options.check_only, "Write nothing; exit code 5 if a file would change");
    app.footer("Line breaks, comments and the meaning stay. A file that cannot be read as a scene is left alone: exit code 3.\n\n"
               "Examples:\n  pnr fmt pot.pnr\n  pnr fmt --check *.pnr *.inc\n  pnr fmt < pot.pnr");
}

void add_init(CLI::App& parent, Options& options) {
    CLI::App& app = *parent.add_subcommand("init", "Write a small painted scene to start from");
    app.add_option("NAME", options.scenes, "The file; .pnr is added if it is not said")->required()->expected(1);
    app.footer("A file that is there already is left alone: exit code 4.\n\nExamples:\n  pnr init pot\n  pnr init scenes/pot.pnr");
}

void add_lsp(CLI::App& parent, Options& options) {
    CLI::App& app = *parent.add_subcommand("lsp", "Serve an editor: problems while typing, completion, help, names");
    app.add_option("-L", options.library, "Search this folder for included files")->type_name("DIR")->allow_extra_args(false);
    app.footer("The Language Server Protocol over standard input and output; the editor starts it for .pnr, .pov and .inc.\n\n"
               "Examples:\n  pnr lsp\n  pnr lsp -L scenes/include");
}

void add_shell_files(CLI::App& parent, std::string& shell) {
    CLI::App& completions = *parent.add_subcommand("completions", "Print a shell's completions of this command line");
    completions.add_option("SHELL", shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    completions.footer("Examples:\n  source <(pnr completions bash)\n  pnr completions zsh > ~/.zfunc/_pnr\n"
                       "  pnr completions fish > ~/.config/fish/completions/pnr.fish");
    parent.add_subcommand("man", "Print the manual page")->footer("Example:\n  pnr man | man -l -");
}

std::string shell_file(const CLI::App& app, const std::string& command, const std::string& shell) {
    if (command == "man") return man_page(app, version());
    if (command != "completions") return {};
    return shell == "bash" ? bash_completion(app) : shell == "zsh" ? zsh_completion(app) : fish_completion(app);
}

} // namespace pnr
