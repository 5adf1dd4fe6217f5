// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"

#include "cli/report.h"
#include "core/atomic_file.h"
#include "parser/format_text.h"
#include "parser/source.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>

namespace pnr {

namespace {

std::string read_whole(const std::string& name) {
    if (name == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
    std::error_code error;
    std::ifstream file(name, std::ios::binary);
    if (!file || std::filesystem::is_directory(name, error)) throw FileError(fmt::format("cannot read {}", name));
    return {std::istreambuf_iterator<char>(file), {}};
}

int format_file(const std::string& name, bool check_only) {
    const std::string text = read_whole(name);
    const FormattedText formatted = format_text(text);
    if (!formatted.problem.empty()) {
        Sources sources;
        const std::uint32_t source = sources.add(name == "-" ? "<stdin>" : name, text);
        Diagnostic problem;
        problem.severity = Severity::error;
        problem.message = formatted.problem;
        problem.span = {source, formatted.at, formatted.at + 1};
        print_diagnostics({problem}, sources);
        return exit_scene;
    }
    const bool same = formatted.text == text;
    if (check_only) {
        if (!same) print_note(fmt::format("{}: `pnr fmt` would change it", name == "-" ? "<stdin>" : name));
        return same ? exit_done : exit_missed;
    }
    if (name == "-")
        print_answer(formatted.text);
    else if (!same)
        write_file_atomically(name, std::string_view(formatted.text));
    return exit_done;
}

} // namespace

int run_fmt(const Options& options) {
    int code = exit_done;
    const std::vector<std::string> standard_input{"-"};
    for (const std::string& name : options.scenes.empty() ? standard_input : options.scenes) {
        try {
            const int result = format_file(name, options.check_only);
            if (result != exit_done && (code == exit_done || code == exit_missed)) code = result;
        } catch (const FileError& error) {
            print_error(error.what());
            code = exit_file;
        }
    }
    return code;
}

} // namespace pnr
