// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>

namespace pnr {

namespace {

constexpr std::size_t widest_line = 160; // longer source lines are shown in part

const char* severity_name(Severity severity) {
    switch (severity) {
    case Severity::error:
        return "error";
    case Severity::warning:
        return "warning";
    default:
        return "note";
    }
}

const char* severity_color(Severity severity) {
    switch (severity) {
    case Severity::error:
        return "\x1b[1;31m";
    case Severity::warning:
        return "\x1b[1;35m";
    default:
        return "\x1b[1;36m";
    }
}

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// The source line and below it a caret under `begin` and an underline to `end` (bytes of the line). Tabs are
// kept so that both lines shift alike; a character of several bytes takes one column; control bytes are shown
// as `?`.
std::string underline(std::string_view line, std::size_t begin, std::size_t end) {
    begin = std::min(begin, line.size());
    end = std::clamp(end, begin, line.size());
    std::size_t from = 0;
    if (line.size() > widest_line) {
        from = begin > widest_line / 2 ? begin - widest_line / 2 : 0;
        while (from > 0 && continues_character(line[from])) --from;
        line = line.substr(from, widest_line);
        begin -= from;
        end = std::min(end - from, line.size());
    }
    std::string shown, marks;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        shown += (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f ? '?' : c;
        if (continues_character(c) || i >= std::max(end, begin + 1)) continue;
        marks += i < begin ? (c == '\t' ? '\t' : ' ') : (i == begin ? '^' : '~');
    }
    if (begin >= line.size()) marks += '^';
    return fmt::format("{}\n{}\n", shown, marks);
}

std::string format_one(Severity severity, const Span& span, std::string_view message, const Sources& sources,
                       bool color) {
    if (span.source >= sources.files.size()) // nothing to point at: the command line
        return fmt::format("{}: {}\n", severity_name(severity), message);
    const LineColumn place = sources.locate(span.source, span.begin);
    const std::string_view line = sources.line_text(span.source, place.line);
    const auto begin = static_cast<std::size_t>(place.column - 1);
    const std::string marks = underline(line, begin, begin + (span.end - span.begin));
    const std::string_view path = sources.files[span.source].path;
    if (!color)
        return fmt::format("{}:{}:{}: {}: {}\n{}", path, place.line, place.column, severity_name(severity),
                           message, marks);
    return fmt::format("\x1b[1m{}:{}:{}:\x1b[0m {}{}:\x1b[0m \x1b[1m{}\x1b[0m\n{}", path, place.line,
                       place.column, severity_color(severity), severity_name(severity), message, marks);
}

void append_json_string(std::string& out, std::string_view text) {
    out += '"';
    for (const char c : text) {
        switch (c) {
        case '"':
            out += "\\\"";
            break;
        case '\\':
            out += "\\\\";
            break;
        case '\n':
            out += "\\n";
            break;
        case '\t':
            out += "\\t";
            break;
        case '\r':
            out += "\\r";
            break;
        default:
            if (static_cast<unsigned char>(c) < 0x20)
                out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
            else
                out += c;
        }
    }
    out += '"';
}

void append_json_place(std::string& out, const Span& span, const Sources& sources) {
    if (span.source >= sources.files.size()) {
        out += "\"file\":null,\"line\":0,\"column\":0,\"end_line\":0,\"end_column\":0";
        return;
    }
    const LineColumn begin = sources.locate(span.source, span.begin);
    const LineColumn end = sources.locate(span.source, std::max(span.begin, span.end));
    out += "\"file\":";
    append_json_string(out, sources.files[span.source].path);
    out += fmt::format(",\"line\":{},\"column\":{},\"end_line\":{},\"end_column\":{}", begin.line,
                       begin.column, end.line, end.column);
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

constexpr std::size_t longest_word = 64; // that neighbours are looked for

// Edit distance with swaps of neighbours [Damerau 1964]; a different case costs nothing but the tie. More
// than `limit`: limit + 1. Words of at most `longest_word` bytes.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
    const std::size_t gap = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
    if (gap > limit) return limit + 1;
    using Row = std::array<std::size_t, longest_word + 1>;
    Row rows[3];
    Row *before = &rows[0], *last = &rows[1], *row = &rows[2];
    for (std::size_t j = 0; j <= b.size(); ++j) (*before)[j] = (*last)[j] = j;
    std::size_t least_before = 0;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        (*row)[0] = i;
        std::size_t least = i;
        const char letter = lower(a[i - 1]);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const char other = lower(b[j - 1]);
            std::size_t cost = (*last)[j - 1] + (letter != other);
            if ((*last)[j] + 1 < cost) cost = (*last)[j] + 1;
            if ((*row)[j - 1] + 1 < cost) cost = (*row)[j - 1] + 1;
            if (i > 1 && j > 1 && letter == lower(b[j - 2]) && lower(a[i - 2]) == other && (*before)[j - 2] + 1 < cost)
                cost = (*before)[j - 2] + 1;
            (*row)[j] = cost;
            if (cost < least) least = cost;
        }
        if (least > limit && least_before > limit) return limit + 1; // no way on comes back below
        least_before = least;
        Row* const oldest = before;
        before = last, last = row, row = oldest;
    }
    return std::min((*last)[b.size()], limit + 1);
}

// Which letters a word has. One change of a word changes at most two bits.
std::uint32_t letters_of(std::string_view word) {
    std::uint32_t letters = 0;
    for (const char c : word) letters |= 1u << (static_cast<unsigned char>(lower(c)) & 31);
    return letters;
}

} // namespace

std::string format(const Diagnostic& diagnostic, const Sources& sources, bool color) {
    std::string text = format_one(diagnostic.severity, diagnostic.span, diagnostic.message, sources, color);
    if (!diagnostic.help.empty()) text += fmt::format("  help: {}\n", diagnostic.help);
    for (const Note& note : diagnostic.notes)
        text += format_one(Severity::note, note.span, note.text, sources, color);
    return text;
}

std::string format_json(const std::vector<Diagnostic>& diagnostics, const Sources& sources) {
    std::string out = "[";
    for (const Diagnostic& diagnostic : diagnostics) {
        if (out.size() > 1) out += ",";
        out += fmt::format("\n{{\"severity\":\"{}\",", severity_name(diagnostic.severity));
        append_json_place(out, diagnostic.span, sources);
        out += ",\"message\":";
        append_json_string(out, diagnostic.message);
        out += ",\"help\":";
        append_json_string(out, diagnostic.help);
        out += ",\"notes\":[";
        for (const Note& note : diagnostic.notes) {
            if (out.back() != '[') out += ",";
            out += "{";
            append_json_place(out, note.span, sources);
            out += ",\"message\":";
            append_json_string(out, note.text);
            out += "}";
        }
        out += "]}";
    }
    return out + "\n]\n";
}

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& candidates) {
    if (word.size() > longest_word) return {};
    std::size_t best = std::max<std::size_t>(word.size() / 3, 1);
    if (word.size() == 1) best = 0; // one letter for another says nothing; only its case
    std::string_view nearest;
    bool found = false;
    const std::uint32_t letters = letters_of(word);
    for (const std::string_view candidate : candidates) {
        if (candidate == word || candidate.size() > longest_word) continue;
        if (static_cast<std::size_t>(std::popcount(letters ^ letters_of(candidate))) > 2 * best) continue;
        const std::size_t distance = edit_distance(word, candidate, best);
        if (distance < best + !found || (found && distance == best && candidate < nearest)) {
            best = distance;
            nearest = candidate;
            found = true;
        }
    }
    return nearest;
}

} // namespace pnr
