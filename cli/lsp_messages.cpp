// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/lsp.h"
#include "cli/options.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace pnr {

namespace {

using Json = nlohmann::json;

// JSON-RPC's numbers.
constexpr int parse_error = -32700, invalid_request = -32600, method_not_found = -32601,
              invalid_params = -32602, internal_error = -32603, not_initialized = -32002;

Json initialize(LspServer& server, const Json& params) {
    server.initialized = true;
    const Json general = params.value("capabilities", Json::object()).value("general", Json::object());
    const Json encodings = general.value("positionEncodings", Json::array());
    server.utf8 = std::find(encodings.begin(), encodings.end(), Json("utf-8")) != encodings.end();
    return {{"serverInfo", {{"name", "pnr"}, {"version", version()}}},
            {"capabilities",
             {{"positionEncoding", server.utf8 ? "utf-8" : "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", 1}, {"save", true}}},
              {"completionProvider", {{"triggerCharacters", {"#"}}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"documentSymbolProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"documentFormattingProvider", true},
              {"colorProvider", true}}}};
}

// The document that a request is about, read at least once.
LspDocument& document_of(LspServer& server, const Json& params, std::vector<Json>& messages) {
    const auto found = server.documents.find(params.at("textDocument").at("uri").get<std::string>());
    if (found == server.documents.end()) throw LspError(invalid_params, "this document is not open");
    if (!found->second.analysed) messages = analyse(server, found->second);
    return found->second;
}

Json result_of(LspServer& server, const std::string& method, const Json& params,
               std::vector<Json>& messages) {
    if (method == "initialize") return initialize(server, params);
    if (!server.initialized) throw LspError(not_initialized, "`initialize` comes first");
    if (server.shut_down) throw LspError(invalid_request, "the server is shut down");
    if (method == "shutdown") {
        server.shut_down = true;
        return nullptr;
    }
    static constexpr std::string_view whole[] = {"textDocument/documentSymbol", "textDocument/formatting",
                                                 "textDocument/documentColor",
                                                 "textDocument/colorPresentation"};
    static constexpr std::string_view placed[] = {"textDocument/completion", "textDocument/hover",
                                                  "textDocument/definition", "textDocument/prepareRename",
                                                  "textDocument/rename"};
    const auto among = [&](const auto& names) {
        return std::find(std::begin(names), std::end(names), method) != std::end(names);
    };
    if (!among(whole) && !among(placed))
        throw LspError(method_not_found, "`" + method + "` is not known here");
    const LspDocument& document = document_of(server, params, messages);
    if (method == "textDocument/documentSymbol") return lsp_symbols(server, document);
    if (method == "textDocument/formatting") return lsp_formatting(server, document);
    if (method == "textDocument/documentColor") return lsp_colors(server, document);
    if (method == "textDocument/colorPresentation") {
        const Json& range = params.at("range");
        return lsp_color_presentations(server, document, params.at("color"),
                                       lsp_offset(server, document.text, range.at("start")),
                                       lsp_offset(server, document.text, range.at("end")));
    }
    const std::uint32_t offset = lsp_offset(server, document.text, params.at("position"));
    if (method == "textDocument/completion") return lsp_completion(server, document, offset);
    if (method == "textDocument/hover") return lsp_hover(server, document, offset);
    if (method == "textDocument/definition") return lsp_definition(server, document, offset);
    if (method == "textDocument/prepareRename") return lsp_prepare_rename(server, document, offset);
    return lsp_rename(server, document, offset, params.at("newName").get<std::string>());
}

std::vector<Json> close_document(LspServer& server, const std::string& uri) {
    const auto found = server.documents.find(uri);
    if (found == server.documents.end()) return {};
    std::set<std::string> told = found->second.told;
    told.insert(uri);
    server.documents.erase(found);
    std::vector<Json> messages;
    for (const std::string& each : told)
        messages.push_back({{"jsonrpc", "2.0"},
                            {"method", "textDocument/publishDiagnostics"},
                            {"params", {{"uri", each}, {"diagnostics", Json::array()}}}});
    return messages;
}

std::vector<Json> take_notice(LspServer& server, const std::string& method, const Json& params) {
    if (!server.initialized || !method.starts_with("textDocument/")) return {};
    const Json& named = params.at("textDocument");
    const auto uri = named.at("uri").get<std::string>();
    if (method == "textDocument/didOpen" || method == "textDocument/didChange") {
        const std::string text = method == "textDocument/didOpen"
                                     ? named.at("text").get<std::string>()
                                     : params.at("contentChanges")
                                           .at(params.at("contentChanges").size() - 1)
                                           .at("text")
                                           .get<std::string>();
        LspDocument& document = server.documents[uri];
        document.uri = uri;
        document.text = read_editor_text(path_of_uri(uri), text);
        document.changed = true;
    } else if (method == "textDocument/didClose") {
        return close_document(server, uri);
    } else if (method == "textDocument/didSave") {
        for (auto& [each, document] : server.documents) document.changed = true; // it may be included there
    }
    return {};
}

Json failure(const Json& id, int code, const std::string& text) {
    return {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}};
}

} // namespace

std::vector<Json> answer(LspServer& server, const std::string& message) {
    const Json request = Json::parse(message, nullptr, false);
    if (request.is_discarded()) return {failure(nullptr, parse_error, "this is no JSON")};
    if (!request.is_object()) return {failure(nullptr, invalid_request, "a request is expected")};
    const bool wants_answer = request.contains("id");
    const Json id = wants_answer ? request["id"] : Json();
    if (!request.contains("method") || !request["method"].is_string()) {
        if (request.contains("result") || request.contains("error"))
            return {}; // an answer to nothing we asked
        return {failure(id, invalid_request, "a method is expected")};
    }
    const auto method = request["method"].get<std::string>();
    const Json params = request.value("params", Json::object());
    std::vector<Json> messages;
    try {
        if (!wants_answer) return take_notice(server, method, params);
        Json result = result_of(server, method, params, messages);
        messages.push_back({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
        return messages;
    } catch (const LspError& error) {
        messages.push_back(failure(id, error.code, error.what()));
    } catch (const Json::exception& error) {
        messages.push_back(failure(id, invalid_params, error.what()));
    } catch (const std::exception& error) {
        messages.push_back(failure(id, internal_error, error.what()));
    }
    if (!wants_answer) messages.clear();
    return messages;
}

} // namespace pnr
