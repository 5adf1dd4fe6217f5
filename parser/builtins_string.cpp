// SPDX-License-Identifier: GPL-3.0-or-later
// The functions whose value is a string, and those that make numbers of strings.
#include "parser/builtins.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

namespace pnr {

namespace {

void check_length(Parser& p, const Token& name, std::size_t length) {
    if (static_cast<std::int64_t>(length) > p.in.options.budgets.string_length)
        stop_at_limit(p, name, &Budgets::string_length,
             fmt::format("the string is longer than {} characters", p.in.options.budgets.string_length));
    charge_work(p, name, letters_work(length));
}

// str(value, length, precision): as C's %f with that many places, padded to `length`: with blanks, or with
// zeros when it is negative; a negative precision stands for six places.
std::string format_number(double value, double length, double precision) {
    const int places = precision < 0 ? 6 : static_cast<int>(std::min(precision, 60.0));
    const int width = static_cast<int>(std::min(std::abs(length), 1000.0));
    if (length < 0) return fmt::format("{:0{}.{}f}", value, width, places);
    return fmt::format("{:{}.{}f}", value, width, places);
}

std::string str_function(Parser& p, const Token& name) {
    const double value = number_argument(p);
    comma_argument(p, name);
    const double length = number_argument(p);
    comma_argument(p, name);
    return format_number(value, length, number_argument(p));
}

// vstr(n, vector, separator, length, precision)
std::string vstr_function(Parser& p, const Token& name) {
    const Token first = peek(p);
    const double count = number_argument(p);
    if (count < 2 || count > 5) fail(p, first, fmt::format("vstr writes 2 to 5 components, not {}", count));
    comma_argument(p, name);
    VectorValue value =
        parse_operand_expression(p, Angles::compare); // a number is a vector with zeros behind it
    comma_argument(p, name);
    const std::string separator = parse_string(p);
    comma_argument(p, name);
    const double length = number_argument(p);
    comma_argument(p, name);
    const double precision = number_argument(p);
    std::string text = format_number(value.v[0], length, precision);
    for (int i = 1; i < static_cast<int>(count); ++i)
        text += separator + format_number(value.v[i], length, precision);
    check_length(p, name, text.size());
    return text;
}

std::string concat_function(Parser& p, const Token& name) {
    std::string text = parse_string(p);
    while (accept(p, ',')) {
        text += parse_string(p);
        check_length(p, name, text.size());
    }
    return text;
}

// Characters of UTF-8 text: where each begins, and the end.
std::vector<std::size_t> character_places(std::string_view text) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < text.size(); ++i)
        if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) places.push_back(i);
    places.push_back(text.size());
    return places;
}

std::size_t character_count(std::string_view text) { return character_places(text).size() - 1; }

// The code of the character at text[i], which is its first byte.
int character_code(std::string_view text, std::size_t i) {
    const auto byte = [&](std::size_t k) {
        return k < text.size() ? static_cast<unsigned char>(text[k]) : 0;
    };
    const int first = byte(i);
    if (first < 0xC0) return first;
    if (first < 0xE0) return (first & 0x1F) << 6 | (byte(i + 1) & 0x3F);
    if (first < 0xF0) return (first & 0x0F) << 12 | (byte(i + 1) & 0x3F) << 6 | (byte(i + 2) & 0x3F);
    return (first & 0x07) << 18 | (byte(i + 1) & 0x3F) << 12 | (byte(i + 2) & 0x3F) << 6 |
           (byte(i + 3) & 0x3F);
}

// substr(text, first, count): counted from 1.
std::string substr_function(Parser& p, const Token& name) {
    const std::string text = parse_string(p);
    const std::vector<std::size_t> places = character_places(text);
    comma_argument(p, name);
    const Token at_first = peek(p);
    const double first = number_argument(p);
    comma_argument(p, name);
    const double count = number_argument(p);
    const std::size_t size = places.size() - 1;
    if (first < 1 || count < 0 || first - 1 + count > static_cast<double>(size))
        fail(p, at_first,
             fmt::format("substr: characters {} to {} of a string that has {}", first, first + count - 1,
                         size));
    const std::size_t begin = static_cast<std::size_t>(first) - 1,
                      end = begin + static_cast<std::size_t>(count);
    return text.substr(places[begin], places[end] - places[begin]);
}

std::string chr_function(Parser& p) {
    const Token first = peek(p);
    const double code = number_argument(p);
    if (code < 0 || code > 65535) fail(p, first, fmt::format("{} is no character's code", code));
    return utf8(static_cast<unsigned>(code));
}

std::string datetime_function(Parser& p, const Token& name) {
    constexpr double epoch_2000 = 946684800;
    const auto seconds = static_cast<std::time_t>(std::floor(number_argument(p) * 86400 + epoch_2000 + 0.5));
    const std::string format = accept(p, ',') ? parse_string(p) : "%Y-%m-%d %H:%M:%SZ";
    std::tm utc{};
    if (!gmtime_r(&seconds, &utc)) fail(p, name, "this day lies too far away");
    char buffer[256];
    const std::size_t length = std::strftime(buffer, sizeof buffer, format.c_str(), &utc);
    return {buffer, length};
}

std::string change_case(std::string text, bool upper) {
    for (char& c : text) {
        if (upper && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
        if (!upper && c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

// The number that the text starts with, as C reads it; 0 if it starts with none.
double value_of_text(Parser& p, const Token& at, const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str()) warn(p, at, fmt::format("val: `{}` is no number; it counts as 0", text));
    if (!std::isfinite(value)) fail(p, at, fmt::format("val: `{}` is no finite number", text));
    return value;
}

// Between the codes of the first characters that differ; 0 stands for the end.
int difference(std::string_view a, std::string_view b) {
    std::size_t i = 0;
    while (i < a.size() && i < b.size() && a[i] == b[i]) ++i;
    while (i > 0 && i < a.size() && (static_cast<unsigned char>(a[i]) & 0xC0) == 0x80) --i;
    return (i < a.size() ? character_code(a, i) : 0) - (i < b.size() ? character_code(b, i) : 0);
}

} // namespace

double number_of_strings(Parser& p, const Token& name) {
    const Token first = peek(p);
    const std::string text = parse_string(p);
    switch (static_cast<Keyword>(name.symbol)) {
    case "strlen"_kw:
        return static_cast<double>(character_count(text));
    case "asc"_kw:
        return text.empty() ? 0 : character_code(text, 0);
    case "val"_kw:
        return value_of_text(p, first, text);
    default: // strcmp
        comma_argument(p, name);
        return difference(text, parse_string(p));
    }
}

bool is_string_builtin(Keyword word) {
    switch (word) {
    case "str"_kw:
    case "vstr"_kw:
    case "concat"_kw:
    case "substr"_kw:
    case "chr"_kw:
    case "strupr"_kw:
    case "strlwr"_kw:
    case "datetime"_kw:
        return true;
    default:
        return false;
    }
}

std::string call_string_builtin(Parser& p, const Token& name) {
    open_arguments(p, name);
    std::string text;
    switch (static_cast<Keyword>(name.symbol)) {
    case "str"_kw:
        text = str_function(p, name);
        break;
    case "vstr"_kw:
        text = vstr_function(p, name);
        break;
    case "concat"_kw:
        text = concat_function(p, name);
        break;
    case "substr"_kw:
        text = substr_function(p, name);
        break;
    case "chr"_kw:
        text = chr_function(p);
        break;
    case "strupr"_kw:
        text = change_case(parse_string(p), true);
        break;
    case "strlwr"_kw:
        text = change_case(parse_string(p), false);
        break;
    default:
        text = datetime_function(p, name);
        break;
    }
    close_arguments(p, name);
    return text;
}

} // namespace pnr
