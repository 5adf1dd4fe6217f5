// SPDX-License-Identifier: GPL-3.0-or-later
// What went wrong, on standard error.
#pragma once

#include "core/types.h"
#include "parser/diagnostic.h"

#include <string>
#include <vector>

namespace pnr {

// The exit codes of the command line's contract.
enum ExitCode {
    exit_done = 0,
    exit_render = 1,
    exit_usage = 2,
    exit_scene = 3,
    exit_file = 4,
    exit_missed = 5, // done, but --error was asked for and missed
    exit_signal = 128
};

// Colour only on a terminal and without NO_COLOR.
bool color_on_stderr();

void print_error(const std::string& text); // `pnr: error: text`
void print_warning(const std::string& text);
void print_note(const std::string& text);
void print_diagnostics(const std::vector<Diagnostic>& diagnostics, const Sources& sources);

// An error that was found after reading, in the form of those found while reading: with its line and a caret
// if the text is still known.
Diagnostic as_diagnostic(const SceneError& error, Sources& sources);

// What a command was asked for, on standard output. Throws FileError.
void print_answer(const std::string& text);
// Several JSON arrays as one, on lines of its own.
std::string join_json_arrays(const std::vector<std::string>& arrays);

// Runs work that may find an error in the scene after reading it; then prints that and returns exit_scene.
template <class Work>
int with_scene_errors(Sources& sources, Work work) {
    try {
        return work();
    } catch (const SceneError& error) {
        print_diagnostics({as_diagnostic(error, sources)}, sources);
        return exit_scene;
    }
}

// `path:line:col: text` of the warnings, for the statistics.
std::vector<std::string> warning_texts(const std::vector<Diagnostic>& diagnostics, const Sources& sources);

} // namespace pnr
