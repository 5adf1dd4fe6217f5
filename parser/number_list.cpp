// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/number_list.h"

#include <charconv>

namespace pnr {

namespace {

void skip_spaces(NumberCursor& c) {
    while (c.at < c.end && (*c.at == ' ' || *c.at == '\n' || *c.at == '\r' || *c.at == '\t')) ++c.at;
}

bool accept_character(NumberCursor& c, char wanted) {
    skip_spaces(c);
    if (c.at == c.end || *c.at != wanted) return false;
    ++c.at;
    return true;
}

// Whole numbers of up to 15 digits are exact in a double and need no general reader.
bool read_whole(NumberCursor& c, double& number) {
    constexpr std::ptrdiff_t exact = 15;
    const char* at = c.at;
    std::int64_t value = 0;
    while (at < c.end && at - c.at <= exact && *at >= '0' && *at <= '9') value = value * 10 + (*at++ - '0');
    if (at == c.at || at - c.at > exact) return false;
    if (at < c.end && (*at == '.' || *at == 'e' || *at == 'E')) return false;
    c.at = at;
    number = static_cast<double>(value);
    return true;
}

} // namespace

std::optional<std::string_view> peek_number_list(Parser& p) {
    if (p.in.buffered) return {};
    const TokenFrame& frame = p.in.frames.back();
    if (frame.position == frame.end) return {};
    const StoredToken& token = frame.tokens[frame.position];
    if (kind_of(token) != TokenKind::numbers) return {};
    return std::string_view(p.in.sources.files[frame.source].text).substr(token.begin, token.length);
}

void take_number_list(Parser& p) {
    TokenFrame& frame = p.in.frames.back();
    const StoredToken& token = frame.tokens[frame.position++];
    ++p.in.tokens_taken;
    tell_text(p.in, std::string_view(p.in.sources.files[frame.source].text).substr(token.begin, token.length));
    charge_work(p, unpack(token, frame.source, frame.chain), letters_work(token.length));
}

bool read_number(NumberCursor& c, double& number) {
    skip_spaces(c);
    const bool negative = c.at < c.end && *c.at == '-';
    if (c.at < c.end && (*c.at == '-' || *c.at == '+')) ++c.at;
    if (!read_whole(c, number)) {
        if (c.at == c.end || !((*c.at >= '0' && *c.at <= '9') || *c.at == '.')) return false;
        const auto result = std::from_chars(c.at, c.end, number);
        if (result.ec != std::errc()) return false;
        c.at = result.ptr;
    }
    if (negative) number = -number;
    return true;
}

bool read_vector(NumberCursor& c, int size, double* numbers) {
    if (!accept_character(c, '<')) return false;
    for (int i = 0; i < size; ++i) {
        if (i > 0 && !accept_character(c, ',')) return false;
        if (!read_number(c, numbers[i])) return false;
    }
    return accept_character(c, '>');
}

void skip_comma(NumberCursor& c) { accept_character(c, ','); }

bool at_list_end(NumberCursor& c) {
    skip_spaces(c);
    return c.at == c.end;
}

} // namespace pnr
