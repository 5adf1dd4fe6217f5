// SPDX-License-Identifier: GPL-3.0-or-later
// #fopen #write #read #fclose. What a scene writes lives in memory, and can be read and included in the same
// run.
#include "parser/directive.h"
#include "parser/expression.h"
#include "parser/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pnr {

namespace {

Token take_handle_name(Parser& p, const Token& directive) {
    const Token name = next_raw(p);
    if (name.kind != TokenKind::word || is_reserved(name.symbol))
        fail(p, name,
             fmt::format("expected the file's name after `{}`, found {}", directive_name(p, directive),
                         token_text(p, name)));
    return name;
}

OpenFile& open_file(Parser& p, const Token& name) {
    const Value* value = lookup(p.in, name.symbol);
    const auto* file = value ? std::get_if<std::shared_ptr<OpenFile>>(&value->data) : nullptr;
    if (!file) fail(p, name, fmt::format("{} is no open file", token_text(p, name)), "#fopen opens one");
    return **file;
}

void append(Parser& p, const Token& at, std::string& text, std::string_view more) {
    charge(p, at, more.size());
    text += more;
}

// As POV-Ray writes it: numbers with %g, vectors in angle brackets.
std::string written(Parser& p) {
    if (at_string(p)) return parse_string(p);
    const VectorValue value = parse_operand_expression(p, Angles::compare);
    if (value.size == 1) return fmt::format("{:g}", value.v[0]);
    std::string text = "<";
    for (int i = 0; i < value.size; ++i) text += fmt::format("{}{:g}", i > 0 ? "," : "", value.v[i]);
    return text + ">";
}

// `uint8 EXPR` and its kin: each number as so many bytes, rounded and held within the range.
struct BinaryFormat {
    int bytes = 1;
    bool is_signed = false, big_end_first = false;
};

std::optional<BinaryFormat> binary_format(const Token& token) {
    switch (keyword_of(token)) {
    case "uint8"_kw:
        return BinaryFormat{1, false, false};
    case "sint8"_kw:
        return BinaryFormat{1, true, false};
    case "uint16be"_kw:
        return BinaryFormat{2, false, true};
    case "uint16le"_kw:
        return BinaryFormat{2, false, false};
    case "sint16be"_kw:
        return BinaryFormat{2, true, true};
    case "sint16le"_kw:
        return BinaryFormat{2, true, false};
    case "sint32be"_kw:
        return BinaryFormat{4, true, true};
    case "sint32le"_kw:
        return BinaryFormat{4, true, false};
    default:
        return std::nullopt;
    }
}

std::string written_binary(Parser& p, BinaryFormat format) {
    next(p);
    const VectorValue value = parse_operand_expression(p, Angles::compare);
    const int bits = 8 * format.bytes - (format.is_signed ? 1 : 0);
    const double most = std::ldexp(1.0, bits) - 1, least = format.is_signed ? -most - 1 : 0;
    std::string bytes;
    for (int i = 0; i < value.size; ++i) {
        const auto number = static_cast<std::int64_t>(std::floor(std::clamp(value.v[i], least, most) + 0.5));
        for (int b = 0; b < format.bytes; ++b) {
            const int shift = 8 * (format.big_end_first ? format.bytes - 1 - b : b);
            bytes += static_cast<char>(number >> shift & 0xFF);
        }
    }
    return bytes;
}

// One value of a text file: a string, a number, or a vector; false at its end.
bool read_value(Parser& p, const Token& at, OpenFile& file, Value& value) {
    const std::vector<StoredToken>& tokens = tokens_of(p, file.source);
    const auto number = [&](double& result) {
        const bool negative = is(tokens[file.position], '-');
        if (negative || is(tokens[file.position], '+')) ++file.position;
        if (kind_of(tokens[file.position]) != TokenKind::number)
            fail(p, at, "this file holds no number here");
        result = tokens[file.position++].number * (negative ? -1 : 1);
    };
    const StoredToken& token = tokens[file.position];
    if (kind_of(token) == TokenKind::end) return false;
    if (kind_of(token) == TokenKind::string) {
        value.data = p.in.strings[token.name.symbol];
        ++file.position;
    } else if (is(token, '<')) {
        VectorValue vector;
        vector.size = 0;
        do {
            ++file.position;
            if (vector.size == 5) fail(p, at, "a vector has at most 5 components");
            number(vector.v[vector.size++]);
        } while (is(tokens[file.position], ','));
        if (!is(tokens[file.position], '>')) fail(p, at, "this file holds a vector that is not closed");
        ++file.position;
        value.data = vector;
    } else {
        double result = 0;
        number(result);
        value.data = result;
    }
    if (is(tokens[file.position], ',')) ++file.position;
    return true;
}

// What a file on disk holds stays in front of what is appended.
void start_appending(Parser& p, const Token& at, const std::string& name) {
    if (p.in.written.contains(name)) return;
    std::string& text = p.in.written[name];
    const auto before = read_text(writable_path(p.in, name).string(),
                                  static_cast<std::size_t>(p.in.options.budgets.file_bytes));
    if (before) append(p, at, text, *before);
}

} // namespace

void fopen_directive(Parser& p, const Token& directive) {
    const Token name = take_handle_name(p, directive);
    const Token at = peek_raw(p);
    auto file = std::make_shared<OpenFile>();
    {
        const HoldScope hold(p);
        file->name = parse_string(p);
        const Token mode = next(p);
        file->writing = is(mode, "write"_kw) || is(mode, "append"_kw);
        if (!file->writing && !is(mode, "read"_kw))
            fail(p, mode, fmt::format("expected `read`, `write` or `append`, found {}", token_text(p, mode)));
        if (is(mode, "write"_kw)) p.in.written[file->name].clear();
        if (is(mode, "append"_kw)) start_appending(p, at, file->name);
        if (file->writing && !p.in.options.allow_write.empty() && writable_path(p.in, file->name).empty())
            warn(p, at, fmt::format("\"{}\" lies outside of the folder that may be written: it stays in memory",
                                    file->name));
    }
    if (!file->writing) file->source = open_include(p, at, file->name);
    assign(p, name.symbol, Value{std::move(file)}, false);
}

void fclose_directive(Parser& p, const Token& directive) {
    const Token name = take_handle_name(p, directive);
    if (lookup(p.in, name.symbol)) { // #read at the end has closed it already
        open_file(p, name);
        undefine(p.in, name.symbol);
    }
}

void write_directive(Parser& p, const Token& directive) {
    const Telling nobody(p.in, Listener::none);
    expect_raw(p, '(', directive);
    const Token name = take_handle_name(p, directive);
    const OpenFile& file = open_file(p, name);
    if (!file.writing) fail(p, name, fmt::format("{} was opened to be read", token_text(p, name)));
    const std::string path = file.name;
    std::string text;
    while (!at(p, ')')) { // the commas may be missing, as in POV-Ray
        accept(p, ',');
        const auto format = binary_format(peek(p));
        text += format ? written_binary(p, *format) : written(p);
    }
    expect(p, ')', "to close the list of what is written");
    append(p, name, p.in.written[path], text);
}

void read_directive(Parser& p, const Token& directive) {
    expect_raw(p, '(', directive);
    const Token name = take_handle_name(p, directive);
    const Value* value = lookup(p.in, name.symbol);
    const auto* held_file = value ? std::get_if<std::shared_ptr<OpenFile>>(&value->data) : nullptr;
    if (!held_file || (*held_file)->writing)
        fail(p, name, fmt::format("{} is no file that is open to be read", token_text(p, name)));
    const std::shared_ptr<OpenFile> file = *held_file;
    while (is(peek_raw(p), ',')) {
        next_raw(p);
        const Token variable = take_handle_name(p, directive);
        Value read;
        if (read_value(p, name, *file, read)) assign(p, variable.symbol, std::move(read), false);
    }
    expect_raw(p, ')', directive);
    // At its end the name is undefined: `#while (defined(File))` is how POV-Ray's scenes go through a file.
    if (tokens_of(p, file->source)[file->position].kind ==
        static_cast<std::uint32_t>(TokenKind::end)) undefine(p.in, name.symbol);
}

} // namespace pnr
