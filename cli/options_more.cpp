// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/options_more.h"

#include <CLI/CLI.hpp>

namespace pnr {

void add_fmt(CLI::App& parent, Options& options) {
    CLI::App& app = *parent.add_subcommand("fmt", "Lay scene texts out: indentation, spaces, empty lines");
    app.add_option("FILE", options.scenes, "Scenes and includes, replaced by what comes out; - or none: standard input to output");
    app.add_flag("--check", options.check_only, "Write nothing; exit code 5 if a file would change");
    app.footer("Line breaks, comments and the meaning stay. A file that cannot be read as a scene is left alone: exit code 3.\n\n"
               "Examples:\n  pnr fmt pot.pnr\n  pnr fmt --check *.pnr *.inc\n  pnr fmt < pot.pnr");
}

void add_lsp(CLI::App& parent, Options& options) {
    CLI::App& app = *parent.add_subcommand("lsp", "Serve an editor: problems while typing, completion, help, names");
    app.add_option("-L", options.library, "Search this folder for included files")->type_name("DIR")->allow_extra_args(false);
    app.footer("The Language Server Protocol over standard input and output; the editor starts it for .pnr, .pov and .inc.\n\n"
               "Examples:\n  pnr lsp\n  pnr lsp -L scenes/include");
}

} // namespace pnr
