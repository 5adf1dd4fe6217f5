// SPDX-License-Identifier: GPL-3.0-or-later
// What the language server changes: names, layout, colours.
#include "cli/lsp.h"
#include "parser/format_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

using Json = nlohmann::json;

constexpr int request_failed = -32803; // the protocol's number

bool is_word(const EditorText& text, std::uint32_t token) {
    return static_cast<TokenKind>(text.tokens[token].kind) == TokenKind::word;
}

bool is_name(const std::string& name) {
    const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const auto inside = [&](char c) { return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; };
    return !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), inside);
}

bool uses(const EditorText& text, std::string_view name) {
    for (std::uint32_t i = 0; i < text.tokens.size(); ++i)
        if (is_word(text, i) && token_text(text, i) == name) return true;
    return false;
}

Json renamed(const LspServer& server, const EditorText& text, std::string_view name,
             const std::string& fresh) {
    Json edits = Json::array();
    for (std::uint32_t i = 0; i < text.tokens.size(); ++i) {
        if (!is_word(text, i) || token_text(text, i) != name) continue;
        const std::uint32_t begin = text.tokens[i].begin;
        edits.push_back(
            {{"range", lsp_range(server, text, begin, begin + text.tokens[i].length)}, {"newText", fresh}});
    }
    return edits;
}

// The name at this byte; throws unless the document itself declares it.
std::uint32_t declared_name_at(const LspDocument& document, std::uint32_t offset) {
    const std::uint32_t token = token_at(document.text, offset);
    if (token == no_token || !is_word(document.text, token))
        throw LspError(request_failed, "there is no name here");
    const std::string_view name = token_text(document.text, token);
    if (find_declaration(document.text, name, offset) != nullptr) return token;
    for (const auto& text : document.included)
        if (find_declaration(*text, name, no_token) != nullptr)
            throw LspError(request_failed,
                           fmt::format("`{}` is declared in {}: rename it there", name, text->source.path));
    throw LspError(request_failed, fmt::format("`{}` is not declared in this scene", name));
}

// ---- colours ----

double displayed(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; // IEC 61966-2-1
}
double linear(double displayed_value) {
    const double v = std::clamp(displayed_value, 0.0, 1.0);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Red, green, blue as the screen shows them, and how much is not let through.
Json swatch(const WrittenColor& color) {
    const auto channel = [&](std::size_t i) {
        return color.numbers.size() == 1 ? color.numbers[0] : i < color.numbers.size() ? color.numbers[i] : 0;
    };
    const bool is_srgb = color.word[0] == 's';
    const auto shown = [&](std::size_t i) {
        return is_srgb ? std::clamp(channel(i), 0.0, 1.0) : displayed(channel(i));
    };
    const bool clear = color.word.ends_with('f') || color.word.ends_with('t');
    double through = 0;
    for (std::size_t i = 3; clear && i < (color.word.ends_with("ft") ? 5u : 4u); ++i) through += channel(i);
    return {{"red", shown(0)},
            {"green", shown(1)},
            {"blue", shown(2)},
            {"alpha", 1 - std::clamp(through, 0.0, 1.0)}};
}

std::string number(double value) { return fmt::format("{:.4g}", value < 5e-5 ? 0.0 : value); }

} // namespace

Json lsp_prepare_rename(const LspServer& server, const LspDocument& document, std::uint32_t offset) {
    const std::uint32_t token = declared_name_at(document, offset);
    const std::uint32_t begin = document.text.tokens[token].begin;
    return {{"range", lsp_range(server, document.text, begin, begin + document.text.tokens[token].length)},
            {"placeholder", token_text(document.text, token)}};
}

Json lsp_rename(const LspServer& server, const LspDocument& document, std::uint32_t offset,
                const std::string& name) {
    const std::string old(token_text(document.text, declared_name_at(document, offset)));
    if (!is_name(name))
        throw LspError(request_failed, fmt::format("`{}` is no name: letters, digits and _ are", name));
    Words words;
    if (is_keyword(words.intern(name)))
        throw LspError(request_failed, fmt::format("`{}` is a word of the language", name));
    bool taken = uses(document.text, name);
    for (const auto& text : document.included) taken = taken || uses(*text, name);
    if (taken && name != old)
        throw LspError(request_failed, fmt::format("`{}` is a name in this scene already", name));
    Json changes = {{document.uri, renamed(server, document.text, old, name)}};
    for (const auto& text : document.included)
        if (uses(*text, old))
            throw LspError(request_failed, fmt::format("{} uses `{}` too: rename it in both by hand",
                                                       text->source.path, old));
    return {{"changes", changes}};
}

Json lsp_formatting(const LspServer& server, const LspDocument& document) {
    const FormattedText formatted = format_text(document.text.source.text);
    if (!formatted.problem.empty()) throw LspError(request_failed, formatted.problem);
    if (formatted.text == document.text.source.text) return Json::array();
    const auto end = static_cast<std::uint32_t>(document.text.source.text.size());
    return Json::array({{{"range", lsp_range(server, document.text, 0, end)}, {"newText", formatted.text}}});
}

Json lsp_colors(const LspServer& server, const LspDocument& document) {
    Json list = Json::array();
    for (const WrittenColor& color : written_colors(document.text))
        list.push_back(
            {{"range", lsp_range(server, document.text, color.begin, color.end)}, {"color", swatch(color)}});
    return list;
}

Json lsp_color_presentations(const LspServer& server, const LspDocument& document, const Json& color,
                             std::uint32_t begin, std::uint32_t end) {
    std::string word = "rgb";
    for (const WrittenColor& written : written_colors(document.text))
        if (written.begin == begin) word = written.word;
    const bool is_srgb = word[0] == 's';
    std::string numbers;
    for (const char* channel : {"red", "green", "blue"}) {
        const double shown = color.at(channel).get<double>();
        numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number(is_srgb ? shown : linear(shown)));
    }
    const double through = 1 - std::clamp(color.value("alpha", 1.0), 0.0, 1.0);
    const bool filters = word.ends_with("f");
    word = is_srgb ? "srgb" : "rgb";
    if (through > 0) {
        word += filters ? "f" : "t";
        numbers += ", " + number(through);
    }
    const std::string label = fmt::format("{} <{}>", word, numbers);
    return Json::array(
        {{{"label", label},
          {"textEdit", {{"range", lsp_range(server, document.text, begin, end)}, {"newText", label}}}}});
}

} // namespace pnr
