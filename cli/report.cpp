// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace pnr {

namespace {

void print(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void print_line(const char* kind, const char* color, const std::string& text) {
    if (color_on_stderr())
        print(fmt::format("pnr: \x1b[1;{}m{}:\x1b[0m {}\n", color, kind, text));
    else
        print(fmt::format("pnr: {}: {}\n", kind, text));
}

} // namespace

bool color_on_stderr() {
    const char* no_color = std::getenv("NO_COLOR"); // https://no-color.org: set and not empty
    return ::isatty(STDERR_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

void print_error(const std::string& text) { print_line("error", "31", text); }
void print_warning(const std::string& text) { print_line("warning", "35", text); }
void print_note(const std::string& text) { print_line("note", "36", text); }

void print_diagnostics(const std::vector<Diagnostic>& diagnostics, const Sources& sources) {
    const bool color = color_on_stderr();
    for (const Diagnostic& diagnostic : diagnostics) print(format(diagnostic, sources, color));
}

Diagnostic as_diagnostic(const SceneError& error, Sources& sources) {
    Diagnostic diagnostic{Severity::error, {}, error.what(), {}, {}};
    const SourceRef& at = error.said_at;
    std::uint32_t index = 0;
    while (index < sources.files.size() && sources.files[index].path != at.file) ++index;
    if (index == sources.files.size()) index = sources.add(at.file.empty() ? "scene" : at.file, "");
    const SourceText& source = sources.files[index];
    const std::uint32_t begin = sources.offset(index, {at.line, at.column});
    std::uint32_t end = begin;
    const auto in_word = [&](std::uint32_t i) {
        return std::isalnum(static_cast<unsigned char>(source.text[i])) != 0 || source.text[i] == '_';
    };
    while (end < source.text.size() && in_word(end)) ++end;
    if (end == begin && end < source.text.size()) ++end;
    diagnostic.span = {index, begin, end};
    return diagnostic;
}

void print_answer(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw FileError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

std::string join_json_arrays(const std::vector<std::string>& arrays) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const std::string& array : arrays)
        for (const auto& element : nlohmann::ordered_json::parse(array)) all.push_back(element);
    return all.dump(2) + "\n";
}

std::vector<std::string> warning_texts(const std::vector<Diagnostic>& diagnostics, const Sources& sources) {
    std::vector<std::string> texts;
    for (const Diagnostic& d : diagnostics) {
        if (d.severity != Severity::warning) continue;
        const LineColumn at = sources.locate(d.span.source, d.span.begin);
        texts.push_back(
            fmt::format("{}:{}:{}: {}", sources.files[d.span.source].path, at.line, at.column, d.message));
    }
    return texts;
}

} // namespace pnr
