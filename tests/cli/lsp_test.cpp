// SPDX-License-Identifier: GPL-3.0-or-later
// The language server as an editor drives it: the built program, framed messages through two pipes.
#include <gtest/gtest.h>

#include "parser/manual.h"
#include "run_pnr.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace pnr {
namespace {

using Json = nlohmann::json;

class Editor {
public:
    explicit Editor(const TemporaryFolder& folder, const Json& encodings = Json::array()) {
        std::signal(SIGPIPE, SIG_IGN);
        int to[2], from[2];
        if (::pipe(to) != 0 || ::pipe(from) != 0) throw std::runtime_error("pipe");
        child_ = ::fork();
        if (child_ == 0) {
            ::dup2(to[0], 0);
            ::dup2(from[1], 1);
            for (const int each : {to[0], to[1], from[0], from[1]}) ::close(each);
            ::setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
            ::execl(PNR_BINARY, PNR_BINARY, "lsp", nullptr);
            ::_exit(127);
        }
        ::close(to[0]);
        ::close(from[1]);
        out_ = to[1];
        in_ = from[0];
        request("initialize", {{"capabilities", {{"general", {{"positionEncodings", encodings}}}}}});
        notify("initialized", Json::object());
    }
    ~Editor() {
        ::close(out_);
        ::close(in_);
        if (child_ > 0) ::waitpid(child_, nullptr, 0);
    }
    Editor(const Editor&) = delete;
    Editor& operator=(const Editor&) = delete;

    void send_bytes(const std::string& bytes) {
        for (std::size_t sent = 0; sent < bytes.size();) {
            const ssize_t wrote = ::write(out_, bytes.data() + sent, bytes.size() - sent);
            if (wrote <= 0) throw std::runtime_error("the server is gone");
            sent += static_cast<std::size_t>(wrote);
        }
    }
    void send(const Json& message) {
        const std::string body = message.dump();
        send_bytes("Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    }
    void notify(const std::string& method, const Json& params) {
        send({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
    }
    // The whole answer; the notifications before it are kept.
    Json request(const std::string& method, const Json& params) {
        const int id = ++last_id_;
        send({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}});
        for (;;) {
            Json message = receive();
            if (message.contains("id") && message["id"] == id) return message;
            note(message);
        }
    }
    Json receive() {
        for (;;) {
            const std::size_t head = buffer_.find("\r\n\r\n");
            if (head != std::string::npos) {
                const std::size_t length = std::stoul(buffer_.substr(buffer_.find(':') + 1));
                if (buffer_.size() >= head + 4 + length) {
                    const Json message = Json::parse(buffer_.substr(head + 4, length));
                    buffer_.erase(0, head + 4 + length);
                    return message;
                }
            }
            char bytes[65536];
            const ssize_t got = ::read(in_, bytes, sizeof bytes);
            if (got <= 0) throw std::runtime_error("the server is gone");
            buffer_.append(bytes, static_cast<std::size_t>(got));
        }
    }
    // The problems that the server publishes next for this document.
    Json problems(const std::string& uri) {
        while (!published.contains(uri)) note(receive());
        Json list = published[uri];
        published.erase(uri);
        return list;
    }
    void open(const std::string& uri, const std::string& text) {
        notify("textDocument/didOpen",
               {{"textDocument", {{"uri", uri}, {"languageId", "pnr"}, {"version", 1}, {"text", text}}}});
    }
    void change(const std::string& uri, const std::string& text) {
        notify("textDocument/didChange", {{"textDocument", {{"uri", uri}, {"version", 2}}},
                                          {"contentChanges", Json::array({{{"text", text}}})}});
    }
    Json ask(const std::string& what, const std::string& uri, int line, int character,
             Json more = Json::object()) {
        more["textDocument"] = {{"uri", uri}};
        more["position"] = {{"line", line}, {"character", character}};
        return request("textDocument/" + what, more);
    }
    int close_and_wait() {
        ::close(out_);
        out_ = -1;
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    }

    std::map<std::string, Json> published; // problems, by uri, not yet looked at

private:
    void note(const Json& message) {
        if (message.value("method", "") == "textDocument/publishDiagnostics")
            published[message["params"]["uri"]] = message["params"]["diagnostics"];
    }

    int in_ = -1, out_ = -1, last_id_ = 0;
    pid_t child_ = 0;
    std::string buffer_;
};

Json place(int line, int character) { return {{"line", line}, {"character", character}}; }
Json range(int line, int begin, int end) {
    return {{"start", place(line, begin)}, {"end", place(line, end)}};
}
std::string uri_in(const TemporaryFolder& folder, const std::string& name) {
    return "file://" + (folder / name).string();
}

std::set<std::string> labels(const Json& items) {
    std::set<std::string> found;
    for (const Json& item : items["result"]) found.insert(item["label"]);
    return found;
}

constexpr const char* scene = R"(#include "colors.inc"
#include "mine.inc"
// What the ball is made of.
#declare Skin = texture { pigment { rgb <1, 0.5, 0> } }
#macro Ball(Place, Size)
    sphere { Place, Size texture { Skin } }
#end
camera { location <0, 1, -4> look_at 0 }
light_source { <3, 5, -4>, rgb 1 }
Ball(<0, 1, 0>, Half)
object { Own pigment { Red } npr { style oil } }
)";

// A folder with an include, and an editor with the scene open.
struct Session {
    TemporaryFolder folder;
    std::string uri;
    std::optional<Editor> editor;
    Session() {
        folder.write("mine.inc", "#declare Half = 0.5;\n#declare Own = box { 0, 1 };\n");
        uri = uri_in(folder, "a b.pnr");
        uri.replace(uri.find(' '), 1, "%20");
        editor.emplace(folder);
        editor->open(uri, scene);
    }
};

TEST(Lsp, SaysWhatItCanAndLeavesAsAsked) {
    const TemporaryFolder folder;
    Editor editor(folder);
    const Json answer = editor.request("initialize", Json::object());
    const Json& can = answer["result"]["capabilities"];
    EXPECT_EQ(can["textDocumentSync"]["change"], 1);
    EXPECT_EQ(can["positionEncoding"], "utf-16");
    for (const char* what : {"hoverProvider", "definitionProvider", "documentSymbolProvider",
                             "documentFormattingProvider", "colorProvider"})
        EXPECT_EQ(can[what], true) << what;
    EXPECT_TRUE(editor.request("shutdown", Json::object())["result"].is_null());
    editor.notify("exit", Json::object());
    EXPECT_EQ(editor.close_and_wait(), 0);
    Editor rude(folder);
    EXPECT_EQ(rude.close_and_wait(), 1) << "gone without a shutdown";
}

TEST(Lsp, ProblemsComeAndGoWithTheText) {
    Session s;
    EXPECT_EQ(s.editor->problems(s.uri), Json::array());
    std::string broken = scene;
    broken.replace(broken.find("look_at"), 7, "lok_at_");
    s.editor->change(s.uri, broken);
    const Json found = s.editor->problems(s.uri);
    ASSERT_EQ(found.size(), 1u) << found;
    EXPECT_EQ(found[0]["severity"], 1);
    EXPECT_EQ(found[0]["range"], range(7, 29, 36));
    EXPECT_NE(found[0]["message"].get<std::string>().find("did you mean `look_at`?"), std::string::npos);
    s.editor->change(s.uri, scene);
    EXPECT_EQ(s.editor->problems(s.uri), Json::array());
}

TEST(Lsp, ProblemsOfAnIncludeAreToldThere) {
    Session s;
    const std::string included = uri_in(s.folder, "mine.inc");
    s.folder.write("mine.inc", "#declare Half = 0.5;\n#declare Own = bx { 0, 1 };\n");
    s.editor->notify("textDocument/didSave", {{"textDocument", {{"uri", s.uri}}}});
    const Json found = s.editor->problems(included);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0]["range"]["start"]["line"], 1);
    s.folder.write("mine.inc", "#declare Half = 0.5;\n#declare Own = box { 0, 1 };\n");
    s.editor->notify("textDocument/didSave", {{"textDocument", {{"uri", s.uri}}}});
    EXPECT_EQ(s.editor->problems(included), Json::array());
}

TEST(Lsp, AnIncludeNeedsNoCameraAndNoUseOfItsNames) {
    const TemporaryFolder folder;
    Editor editor(folder);
    const std::string text = "#declare Half = 0.5;\n#macro Ball() sphere { 0, Half } #end\n";
    editor.open(uri_in(folder, "mine.inc"), text);
    EXPECT_EQ(editor.problems(uri_in(folder, "mine.inc")), Json::array());
    editor.open(uri_in(folder, "mine.pnr"), text);
    EXPECT_FALSE(editor.problems(uri_in(folder, "mine.pnr")).empty());
}

TEST(Lsp, AnEndlessLoopIsNoError) {
    Session s;
    s.editor->problems(s.uri);
    s.editor->change(s.uri, "#while (1)\n#end\n");
    const Json found = s.editor->problems(s.uri);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0]["severity"], 3) << found;
}

TEST(Lsp, CompletesWhatMayStandThere) {
    Session s;
    const auto top = labels(s.editor->ask("completion", s.uri, 11, 0));
    for (const char* word : {"sphere", "camera", "Ball", "Skin", "Half", "Own", "Red"})
        EXPECT_TRUE(top.contains(word)) << word;
    EXPECT_FALSE(top.contains("translate"));
    const auto camera = labels(s.editor->ask("completion", s.uri, 7, 9));
    EXPECT_TRUE(camera.contains("look_at"));
    EXPECT_FALSE(camera.contains("sphere"));
    const auto npr = labels(s.editor->ask("completion", s.uri, 10, 35));
    EXPECT_TRUE(npr.contains("seeds"));
    EXPECT_FALSE(npr.contains("pigment"));
    s.editor->change(s.uri, std::string(scene) + "#de");
    const auto directives = labels(s.editor->ask("completion", s.uri, 11, 3));
    EXPECT_TRUE(directives.contains("declare"));
    EXPECT_FALSE(directives.contains("sphere"));
}

TEST(Lsp, HoverSaysWhatHelpSays) {
    Session s;
    const Json word = s.editor->ask("hover", s.uri, 7, 10)["result"];
    EXPECT_EQ(word["range"], range(7, 9, 17));
    EXPECT_EQ(word["contents"]["value"], "```pnr\n" + manual_text("location") + "```");
    const Json directive = s.editor->ask("hover", s.uri, 4, 3)["result"];
    EXPECT_EQ(directive["contents"]["value"], "```pnr\n" + manual_text("macro") + "```");
    const TemporaryFolder folder;
    EXPECT_EQ(run_pnr(folder, {"help", "location"}).out, manual_text("location"));
    const auto name = s.editor->ask("hover", s.uri, 5, 36)["result"]["contents"]["value"].get<std::string>();
    EXPECT_NE(name.find("// What the ball is made of.\n#declare Skin = "), std::string::npos) << name;
    EXPECT_TRUE(s.editor->ask("hover", s.uri, 8, 16)["result"].is_null());
}

TEST(Lsp, DefinitionsAreFoundHereAndInIncludes) {
    Session s;
    const Json own = s.editor->ask("definition", s.uri, 5, 36)["result"];
    EXPECT_EQ(own["uri"], s.uri);
    EXPECT_EQ(own["range"], range(3, 9, 13));
    const Json parameter = s.editor->ask("definition", s.uri, 5, 14)["result"];
    EXPECT_EQ(parameter["range"], range(4, 12, 17));
    const Json other = s.editor->ask("definition", s.uri, 9, 17)["result"];
    EXPECT_EQ(other["uri"], uri_in(s.folder, "mine.inc"));
    EXPECT_EQ(other["range"], range(0, 9, 13));
    EXPECT_EQ(s.editor->ask("definition", s.uri, 1, 12)["result"]["uri"], uri_in(s.folder, "mine.inc"));
    const Json embedded = s.editor->ask("definition", s.uri, 10, 24)["result"];
    ASSERT_TRUE(embedded["uri"].is_string());
    const auto uri = embedded["uri"].get<std::string>();
    std::ifstream file(uri.substr(7));
    std::string line;
    for (int i = 0; i <= embedded["range"]["start"]["line"].get<int>(); ++i) std::getline(file, line);
    EXPECT_NE(line.find("Red"), std::string::npos) << uri;
    EXPECT_TRUE(s.editor->ask("definition", s.uri, 7, 10)["result"].is_null());
}

TEST(Lsp, TheOutlineHasNamesAndObjects) {
    Session s;
    const Json outline =
        s.editor->request("textDocument/documentSymbol", {{"textDocument", {{"uri", s.uri}}}})["result"];
    std::vector<std::string> names;
    for (const Json& symbol : outline) names.push_back(symbol["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"Skin", "Ball", "camera", "light_source", "object"}));
    EXPECT_EQ(outline[1]["range"], (Json{{"start", place(4, 0)}, {"end", place(6, 4)}}));
    EXPECT_EQ(outline[1]["selectionRange"], range(4, 7, 11));
}

std::string edited(const std::string& text, const Json& edits) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
        const auto begin = (*edit)["range"]["start"]["character"].get<std::size_t>();
        const auto end = (*edit)["range"]["end"]["character"].get<std::size_t>();
        lines.at((*edit)["range"]["start"]["line"].get<std::size_t>())
            .replace(begin, end - begin, (*edit)["newText"].get<std::string>());
    }
    std::string all;
    for (const std::string& line : lines) all += line + "\n";
    return all;
}

TEST(Lsp, ANameIsRenamedEverywhere) {
    Session s;
    EXPECT_EQ(s.editor->ask("prepareRename", s.uri, 5, 36)["result"]["range"], range(5, 35, 39));
    const Json edits =
        s.editor->ask("rename", s.uri, 5, 36, {{"newName", "Peel"}})["result"]["changes"][s.uri];
    EXPECT_EQ(edits.size(), 2u);
    std::string expected = scene;
    for (std::size_t at; (at = expected.find("Skin")) != std::string::npos;) expected.replace(at, 4, "Peel");
    EXPECT_EQ(edited(scene, edits), expected);
    for (const char* taken : {"sphere", "2x", "", "Ball", "Red", "a b"})
        EXPECT_TRUE(s.editor->ask("rename", s.uri, 5, 36, {{"newName", taken}}).contains("error")) << taken;
    EXPECT_TRUE(s.editor->ask("rename", s.uri, 9, 17, {{"newName", "Third"}}).contains("error"))
        << "declared in an include";
    EXPECT_TRUE(s.editor->ask("prepareRename", s.uri, 7, 3).contains("error")) << "a word of the language";
}

TEST(Lsp, FormattingIsThatOfFmt) {
    Session s;
    const std::string crooked = "union {\nsphere { 0, 1 }\n      box { 0, 1 } }\n";
    s.editor->change(s.uri, crooked);
    const Json edits = s.editor->request("textDocument/formatting", {{"textDocument", {{"uri", s.uri}}},
                                                                     {"options", Json::object()}})["result"];
    ASSERT_EQ(edits.size(), 1u);
    EXPECT_EQ(edits[0]["newText"], run_pnr(s.folder, {"fmt"}, {}, crooked).out);
    s.editor->change(s.uri, "sphere { \"");
    EXPECT_TRUE(s.editor
                    ->request("textDocument/formatting",
                              {{"textDocument", {{"uri", s.uri}}}, {"options", Json::object()}})
                    .contains("error"));
}

TEST(Lsp, SwatchesAreColoursAsDisplayed) {
    Session s;
    s.editor->change(s.uri, "sphere { 0, 1 pigment { rgb <1, 0.5, 0> } }\nsphere { 3, 1 pigment { srgbt "
                            "<0.2, 0.4, 0.6, 0.25> } }\n"
                            "sphere { 3, 1 pigment { rgb <A, 0, 0> } }\n");
    const Json colors =
        s.editor->request("textDocument/documentColor", {{"textDocument", {{"uri", s.uri}}}})["result"];
    ASSERT_EQ(colors.size(), 2u) << colors;
    EXPECT_EQ(colors[0]["range"], range(0, 24, 39));
    EXPECT_NEAR(colors[0]["color"]["green"].get<double>(), 0.735357, 1e-5) << "0.5 of linear light";
    EXPECT_EQ(colors[1]["color"]["green"], 0.4);
    EXPECT_EQ(colors[1]["color"]["alpha"], 0.75);
    const Json ways =
        s.editor->request("textDocument/colorPresentation", {{"textDocument", {{"uri", s.uri}}},
                                                             {"color", colors[0]["color"]},
                                                             {"range", colors[0]["range"]}})["result"];
    EXPECT_EQ(ways[0]["label"], "rgb <1, 0.5, 0>");
    EXPECT_EQ(ways[0]["textEdit"]["range"], colors[0]["range"]);
}

TEST(Lsp, ColumnsCountAsTheClientDoes) {
    const std::string text =
        "/* \xc3\xa9\xf0\x9f\x8e\xa8 */ sphere { 0, 1 }\n"; // two letters: 2 bytes, 1 unit; 4 bytes, 2 units
    for (const bool bytes : {false, true}) {
        const TemporaryFolder folder;
        Editor editor(folder, bytes ? Json{"utf-8", "utf-16"} : Json{"utf-16"});
        const std::string uri = uri_in(folder, "a.pnr");
        editor.open(uri, text);
        const int column = bytes ? 13 : 10;
        EXPECT_EQ(editor.ask("hover", uri, 0, column + 1)["result"]["range"], range(0, column, column + 6));
    }
}

TEST(Lsp, NonsenseIsAnswered) {
    const TemporaryFolder folder;
    Editor editor(folder);
    editor.send_bytes("Content-Length: 5\r\n\r\n{\"a\":");
    EXPECT_EQ(editor.receive()["error"]["code"], -32700);
    editor.send_bytes("Content-Type: x\r\n\r\n");
    EXPECT_EQ(editor.receive()["error"]["code"], -32700);
    editor.send(Json::array());
    EXPECT_EQ(editor.receive()["error"]["code"], -32600);
    EXPECT_EQ(editor.request("textDocument/unknown", Json::object())["error"]["code"], -32601);
    EXPECT_EQ(editor.request("textDocument/hover", Json::object())["error"]["code"], -32602);
    EXPECT_EQ(editor.ask("hover", "file:///not/open.pnr", 0, 0)["error"]["code"], -32602);
    editor.notify("textDocument/didOpen", Json::object());
    editor.notify("textDocument/didChange",
                  {{"textDocument", {{"uri", "file:///a.pnr"}}}, {"contentChanges", Json::array()}});
    editor.notify("$/cancelRequest", {{"id", 1}});
    const std::string uri = uri_in(folder, "a.pnr");
    editor.open(uri, "sphere { 0, 1 }");
    EXPECT_TRUE(editor.ask("hover", uri, 999, 999)["result"].is_null());
    EXPECT_FALSE(editor.ask("hover", uri, 0, 2)["result"].is_null()) << "still there";
}

// Every way a text can look while it is typed: each question gets its one answer, whatever it is.
TEST(Lsp, EveryPrefixOfASceneIsAnswered) {
    Session s;
    const std::string text = scene;
    for (std::size_t length = 0; length <= text.size(); ++length) {
        const std::string typed = text.substr(0, length);
        s.editor->change(s.uri, typed);
        const auto line = static_cast<int>(std::count(typed.begin(), typed.end(), '\n'));
        const auto column =
            static_cast<int>(length - (typed.rfind('\n') == std::string::npos ? 0 : typed.rfind('\n') + 1));
        ASSERT_TRUE(s.editor->ask("completion", s.uri, line, column)["result"].is_array()) << typed;
        ASSERT_TRUE(s.editor->ask("hover", s.uri, line, column).contains("result")) << typed;
        ASSERT_TRUE(s.editor->ask("definition", s.uri, line, column).contains("result")) << typed;
        const Json whole = {{"textDocument", {{"uri", s.uri}}}, {"options", Json::object()}};
        ASSERT_TRUE(s.editor->request("textDocument/documentSymbol", whole)["result"].is_array()) << typed;
        ASSERT_TRUE(s.editor->request("textDocument/documentColor", whole)["result"].is_array()) << typed;
        const Json formatted = s.editor->request("textDocument/formatting", whole);
        ASSERT_TRUE(formatted.contains("result") || formatted.contains("error")) << typed;
        const Json renamed = s.editor->ask("rename", s.uri, line, column, {{"newName", "Fresh"}});
        ASSERT_TRUE(renamed.contains("result") || renamed.contains("error")) << typed;
        if (length % 40 == 0) {
            ASSERT_TRUE(s.editor->problems(s.uri).is_array());
        }
    }
}

TEST(Lsp, OnlyTheLastOfManyChangesIsRead) {
    const TemporaryFolder folder;
    Editor editor(folder);
    const std::string uri = uri_in(folder, "long.pnr");
    std::string text = "camera { location -9*z look_at 0 } light_source { 9*y, 1 }\n";
    for (int i = 0; i < 1000; ++i)
        text +=
            "sphere { <" + std::to_string(i) + ", 0, 0>, 0.5 pigment { rgb <1, 0.5, 0.2> } rotate 30*y }\n";
    editor.open(uri, text);
    EXPECT_EQ(editor.problems(uri), Json::array());
    for (int i = 0; i < 20; ++i)
        editor.change(uri, text + "sphere { 0, " + std::string(static_cast<std::size_t>(i), '1'));
    editor.change(uri, text);
    while (!editor.problems(uri).empty()) {} // ends, for the last text has none
}

} // namespace
} // namespace pnr
