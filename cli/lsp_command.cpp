// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr lsp`: the language server's messages over standard input and output.
#include "cli/commands.h"
#include "cli/lsp.h"
#include "cli/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include <poll.h>
#include <unistd.h>

namespace pnr {

namespace {

constexpr std::size_t longest_message = 256'000'000, longest_header = 64'000;

struct Input {
    std::string bytes; // read, not yet used
    bool ended = false;
};

void read_more(Input& in) {
    char buffer[65536];
    const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
    if (got > 0)
        in.bytes.append(buffer, static_cast<std::size_t>(got));
    else
        in.ended = true;
}

bool is_waiting(const Input& in) {
    if (in.ended) return false;
    if (!in.bytes.empty()) return true;
    pollfd watched{STDIN_FILENO, POLLIN, 0};
    return ::poll(&watched, 1, 0) > 0 && (watched.revents & POLLIN) != 0;
}

// The number of a Content-Length line among these; nothing if there is none, or none that can be.
std::optional<std::size_t> content_length(std::string header) {
    std::transform(header.begin(), header.end(), header.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    constexpr std::string_view name = "content-length:";
    std::size_t at = header.find(name);
    if (at == std::string::npos) return {};
    at = header.find_first_not_of(' ', at + name.size());
    if (at == std::string::npos) return {};
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(header.data() + at, header.data() + header.size(), length);
    if (error != std::errc{} || length > longest_message) return {};
    return length;
}

// The next message's body; nothing when the input has ended or cannot be followed any more.
std::optional<std::string> next_message(Input& in) {
    for (;;) {
        constexpr std::string_view separator = "\r\n\r\n";
        const std::size_t end = in.bytes.find(separator);
        if (end == std::string::npos) {
            if (in.ended || in.bytes.size() > longest_header) return {};
            read_more(in);
            continue;
        }
        const std::optional<std::size_t> length = content_length(in.bytes.substr(0, end));
        in.bytes.erase(0, end + separator.size());
        if (!length) return std::string(); // no JSON: the client is told so
        while (in.bytes.size() < *length && !in.ended) read_more(in);
        if (in.bytes.size() < *length) return {};
        std::string body = in.bytes.substr(0, *length);
        in.bytes.erase(0, *length);
        return body;
    }
}

void send(const std::vector<nlohmann::json>& messages) {
    for (const nlohmann::json& message : messages) {
        const std::string body = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        print_answer(fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body));
    }
}

bool is_exit(const std::string& message) {
    const nlohmann::json request = nlohmann::json::parse(message, nullptr, false);
    return request.is_object() && request.value("method", nlohmann::json()) == "exit";
}

} // namespace

int run_lsp(const Options& options) {
    LspServer server;
    server.library = options.library;
    Input in;
    while (const std::optional<std::string> message = next_message(in)) {
        if (is_exit(*message)) return server.shut_down ? exit_done : exit_render;
        send(answer(server, *message));
        if (!is_waiting(in))
            send(analyse_changed(server)); // while letters come in, only the last state is read
    }
    return server.shut_down ? exit_done : exit_render;
}

} // namespace pnr
