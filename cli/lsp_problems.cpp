// SPDX-License-Identifier: GPL-3.0-or-later
// The problems of a scene while it is written: the parser's own diagnostics.
#include "cli/lsp.h"
#include "parser/load_scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pnr {

namespace {

using Json = nlohmann::json;

// Less than a rendering may use: an endless loop under the author's fingers must not hold the editor up.
Budgets typing_budgets() {
    Budgets budgets;
    budgets.loop_turns = 500'000;
    budgets.macro_calls = 500'000;
    budgets.tokens = 10'000'000;
    budgets.bytes = 600'000'000;
    budgets.errors = 100;
    return budgets;
}

bool is_limit(const Diagnostic& problem) { return problem.help.find("--limit ") != std::string::npos; }

// An include is no scene: that it has no camera and uses not all that it declares is no problem.
bool concerns(const LspDocument& document, const Diagnostic& problem) {
    if (!document.text.source.path.ends_with(".inc") || problem.severity != Severity::warning) return true;
    return !problem.message.starts_with("the scene has no ") &&
           !problem.message.ends_with("is declared but never used");
}

LoadResult load(const LspServer& server, const LspDocument& document) {
    LoadOptions options;
    options.library = server.library;
    options.budgets = typing_budgets();
    try {
        return load_scene_text(document.text.source.text, document.text.source.path, options);
    } catch (const std::exception& error) {
        LoadResult result;
        result.sources.add(document.text.source.path, document.text.source.text);
        result.diagnostics.push_back({Severity::error, {}, error.what(), {}, {}});
        return result;
    }
}

struct Texts {
    std::vector<std::shared_ptr<const EditorText>>
        all;                       // by the parser's number; null: not a text that was included
    std::vector<std::string> uris; // empty: cannot be shown there
};

// Included texts that have not changed are taken over from the last analysis.
Texts texts_of(const LspDocument& document, const Sources& sources) {
    Texts texts;
    texts.all.resize(sources.files.size());
    texts.uris.resize(sources.files.size());
    for (std::size_t i = 1; i < sources.files.size(); ++i) {
        const SourceText& file = sources.files[i];
        for (const auto& known : document.included)
            if (known->source.path == file.path && known->source.text == file.text) texts.all[i] = known;
        if (!texts.all[i])
            texts.all[i] = std::make_shared<EditorText>(read_editor_text(file.path, file.text));
    }
    return texts;
}

// A problem's place: in its own text if an editor can open that, else at the first letter of the document.
struct Place {
    const EditorText* text;
    std::string uri;
    std::uint32_t begin, end;
};
Place place_of(const LspDocument& document, Texts& texts, const Span& span) {
    if (span.source == 0) return {&document.text, document.uri, span.begin, span.end};
    if (span.source < texts.all.size()) {
        std::string& uri = texts.uris[span.source];
        if (uri.empty()) uri = uri_of_source(*texts.all[span.source]);
        if (!uri.empty()) return {texts.all[span.source].get(), uri, span.begin, span.end};
    }
    return {&document.text, document.uri, 0, 0};
}

Json problem_json(const LspServer& server, const LspDocument& document, Texts& texts,
                  const Diagnostic& problem, const Place& place) {
    const int severity = is_limit(problem)                       ? 3
                         : problem.severity == Severity::error   ? 1
                         : problem.severity == Severity::warning ? 2
                                                                 : 3;
    std::string message = problem.message;
    if (is_limit(problem))
        message = "more than is read while you type: `pnr check` reads further (" + message + ")";
    else if (!problem.help.empty())
        message += "\n" + problem.help;
    Json json = {{"range", lsp_range(server, *place.text, place.begin, place.end)},
                 {"severity", severity},
                 {"source", "pnr"},
                 {"message", message}};
    for (const Note& note : problem.notes) {
        const Place at = place_of(document, texts, note.span);
        json["relatedInformation"].push_back(
            {{"location", {{"uri", at.uri}, {"range", lsp_range(server, *at.text, at.begin, at.end)}}},
             {"message", note.text}});
    }
    return json;
}

} // namespace

std::vector<Json> analyse(const LspServer& server, LspDocument& document) {
    const LoadResult loaded = load(server, document);
    Texts texts = texts_of(document, loaded.sources);
    std::map<std::string, Json> problems{{document.uri, Json::array()}};
    for (const Diagnostic& problem : loaded.diagnostics) {
        if (!concerns(document, problem)) continue;
        const Place place = place_of(document, texts, problem.span);
        if (place.uri != document.uri && server.documents.contains(place.uri))
            continue; // it tells of its own
        Json& list = problems[place.uri];
        if (list.is_null()) list = Json::array();
        list.push_back(problem_json(server, document, texts, problem, place));
    }
    for (const std::string& uri : document.told)
        problems.emplace(uri, Json::array()); // nothing is wrong there any more
    document.told.clear();
    std::vector<Json> messages;
    for (auto& [uri, list] : problems) {
        if (!list.empty() && uri != document.uri) document.told.insert(uri);
        messages.push_back({{"jsonrpc", "2.0"},
                            {"method", "textDocument/publishDiagnostics"},
                            {"params", {{"uri", uri}, {"diagnostics", std::move(list)}}}});
    }
    // A line that is half typed may hide the includes behind it: what was included before is kept then.
    std::vector<std::shared_ptr<const EditorText>> included;
    for (const auto& text : texts.all)
        if (text) included.push_back(text);
    if (!loaded.scene)
        for (const auto& known : document.included)
            if (std::none_of(included.begin(), included.end(),
                             [&](const auto& text) { return text->source.path == known->source.path; }))
                included.push_back(known);
    document.included = std::move(included);
    document.changed = false;
    document.analysed = true;
    return messages;
}

std::vector<Json> analyse_changed(LspServer& server) {
    std::vector<Json> messages;
    for (auto& [uri, document] : server.documents) {
        if (!document.changed) continue;
        for (Json& message : analyse(server, document)) messages.push_back(std::move(message));
    }
    return messages;
}

} // namespace pnr
