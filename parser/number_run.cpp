// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/number_run.h"

#include <charconv>
#include <cstring>
#include <limits>

namespace pnr {

namespace {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_blank(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

const char* skip_blanks(const char* at, const char* end) {
    for (;;) {
        while (at < end && is_blank(*at)) ++at;
        if (end - at < 2 || at[0] != '/' || at[1] != '/') return at;
        const void* line_end = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
        at = line_end ? static_cast<const char*>(line_end) : end;
    }
}

// Behind `1`, `-.5`, `2.5e-3`; null if none stands here.
const char* skip_number(const char* at, const char* end) {
    if (at < end && (*at == '-' || *at == '+')) ++at;
    const char* const first = at;
    while (at < end && is_digit(*at)) ++at;
    bool digits = at != first;
    if (at < end && *at == '.') {
        const char* const fraction = ++at;
        while (at < end && is_digit(*at)) ++at;
        digits |= at != fraction;
    }
    if (!digits) return nullptr;
    if (at < end && (*at == 'e' || *at == 'E')) {
        ++at;
        if (at < end && (*at == '-' || *at == '+')) ++at;
        const char* const exponent = at;
        while (at < end && is_digit(*at)) ++at;
        if (at == exponent) return nullptr;
    }
    return at;
}

} // namespace

const char* end_of_number_run(const char* at, const char* end) {
    bool in_vector = false, may_be_number = true; // two numbers in a row would be an expression
    for (;;) {
        at = skip_blanks(at, end);
        if (at == end) return nullptr;
        switch (*at) {
        case '}':
            return in_vector ? nullptr : at;
        case ',':
            if (in_vector && may_be_number) return nullptr;
            may_be_number = true, ++at;
            break;
        case '<':
            if (in_vector) return nullptr;
            in_vector = may_be_number = true, ++at;
            break;
        case '>':
            if (!in_vector || may_be_number) return nullptr;
            in_vector = false, may_be_number = true, ++at;
            break;
        default:
            if (!may_be_number || !(at = skip_number(at, end))) return nullptr;
            may_be_number = false;
        }
    }
}

bool NumberReader::at_end() {
    do at = skip_blanks(at, end);
    while (at < end && *at == ',' && ++at);
    return at == end;
}

bool NumberReader::at_vector() { return !at_end() && *at == '<'; }
bool NumberReader::at_number() { return !at_end() && *at != '<'; }

double NumberReader::number() {
    if (*at == '+') ++at;
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec == std::errc::result_out_of_range) {
        const char* from = at;
        while (from < result.ptr && *from != 'e' && *from != 'E') ++from;
        const bool tiny = result.ptr - from > 1 && from[1] == '-';
        value = tiny ? 0 : std::numeric_limits<double>::infinity();
    }
    at = result.ptr;
    return value;
}

bool NumberReader::vector(double* numbers, std::size_t count, std::size_t& found) {
    found = 0;
    if (!at_vector()) return false;
    ++at;
    for (;;) {
        at = skip_blanks(at, end);
        if (*at == '>') {
            ++at;
            return true;
        }
        if (*at == ',') {
            ++at;
            continue;
        }
        if (found == count) return false;
        numbers[found++] = number();
    }
}

} // namespace pnr
