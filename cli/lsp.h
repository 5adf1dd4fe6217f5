// SPDX-License-Identifier: GPL-3.0-or-later
// The language server: what an editor may ask about open scenes, and what it is told. Language Server
// Protocol 3.17, JSON-RPC 2.0. Nothing here reads or writes a stream; lsp_command.cpp does.
#pragma once

#include "cli/lsp_text.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace pnr {

struct LspDocument {
    std::string uri;
    EditorText text;
    // Of the last analysis: the texts that were included, and the documents that were told of problems.
    std::vector<std::shared_ptr<const EditorText>> included;
    std::set<std::string> told;
    bool changed = true; // since the last analysis
    bool analysed = false;
};

struct LspServer {
    std::vector<std::filesystem::path> library;   // -L
    std::map<std::string, LspDocument> documents; // by uri
    bool utf8 = false;                            // columns count bytes, else UTF-16 units
    bool initialized = false, shut_down = false;
};

// An answer that is an error, by JSON-RPC's and the protocol's numbers.
struct LspError : std::runtime_error {
    int code;
    LspError(int number, const std::string& text) : std::runtime_error(text), code(number) {}
};

// ---- places (lsp_places.cpp) ----

nlohmann::json lsp_position(const LspServer& server, const EditorText& text, std::uint32_t offset);
nlohmann::json lsp_range(const LspServer& server, const EditorText& text, std::uint32_t begin,
                         std::uint32_t end);
// The byte of a position; beyond the line's end its end, beyond the text the text's end.
std::uint32_t lsp_offset(const LspServer& server, const EditorText& text, const nlohmann::json& position);
std::string
path_of_uri(const std::string& uri); // "file:///a%20b.pnr": /a b.pnr; another scheme: as it stands
std::string uri_of_path(const std::string& path);
// Where an editor can open a text that the parser read: an embedded include is written to the user's cache
// folder first. Empty: nowhere.
std::string uri_of_source(const EditorText& text);

// ---- questions ----

// Reads the document with the real parser, and gives the notifications of its problems, for it and what it
// includes.
std::vector<nlohmann::json> analyse(const LspServer& server, LspDocument& document);
nlohmann::json lsp_completion(const LspServer& server, const LspDocument& document, std::uint32_t offset);
nlohmann::json lsp_hover(const LspServer& server, const LspDocument& document, std::uint32_t offset);
nlohmann::json lsp_definition(const LspServer& server, const LspDocument& document, std::uint32_t offset);
nlohmann::json lsp_symbols(const LspServer& server, const LspDocument& document);
nlohmann::json lsp_prepare_rename(const LspServer& server, const LspDocument& document, std::uint32_t offset);
nlohmann::json lsp_rename(const LspServer& server, const LspDocument& document, std::uint32_t offset,
                          const std::string& name);
nlohmann::json lsp_formatting(const LspServer& server, const LspDocument& document);
nlohmann::json lsp_colors(const LspServer& server, const LspDocument& document);
// Ways to write the colour of a swatch, over the bytes of the old one.
nlohmann::json lsp_color_presentations(const LspServer& server, const LspDocument& document,
                                       const nlohmann::json& color, std::uint32_t begin, std::uint32_t end);

// ---- messages ----

// One message of the client. Returns what is to be sent: for a request exactly one answer, also to nonsense.
std::vector<nlohmann::json> answer(LspServer& server, const std::string& message);
// The problems of documents that have changed since they were read.
std::vector<nlohmann::json> analyse_changed(LspServer& server);

} // namespace pnr
