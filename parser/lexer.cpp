// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

namespace pnr {

namespace {

std::uint64_t long_hash(std::string_view word) { // FNV-1a
    std::uint64_t h = 14695981039346656037ull;
    for (const char c : word) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return h;
}

constexpr std::uint32_t hash_text(std::string_view word) { // likewise
    std::uint32_t h = 2166136261u;
    for (const char c : word) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
    return h ^ (h >> 15);
}

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view american(std::string_view word) {
    if (word == "colour") return "color";
    if (word == "colour_map") return "color_map";
    if (word == "fade_colour") return "fade_color";
    if (word == "quick_colour") return "quick_color";
    if (word == "use_colour") return "use_color";
    if (word == "grey") return "gray";
    return word;
}

struct Lexer {
    Words& words;
    std::vector<std::string>& strings;
    std::vector<StoredToken> tokens;
    const char* begin;
    const char* at;
    const char* end;
    bool keep_numbers;
    std::int64_t most;
    std::int64_t beside = 0; // memory that tokens take elsewhere, counted in tokens
    const char* long_string = nullptr; // the first string that runs over several lines
};

StoredToken& add(Lexer& lexer, TokenKind kind, const char* from, Symbol symbol) {
    constexpr std::size_t longest = (1u << 28) - 1;
    StoredToken& token = lexer.tokens.emplace_back();
    token.name = {symbol, no_jump};
    token.begin = static_cast<std::uint32_t>(from - lexer.begin);
    token.kind = static_cast<std::uint32_t>(kind) & 15;
    token.length = static_cast<std::uint32_t>(std::min<std::size_t>(
                       static_cast<std::size_t>(lexer.at - from), longest)) &
                   longest;
    return token;
}

Symbol add_string(Lexer& lexer, std::string text) {
    lexer.beside += static_cast<std::int64_t>((3 * sizeof(std::string) / 2 + text.size()) / sizeof(StoredToken));
    lexer.strings.push_back(std::move(text));
    return static_cast<Symbol>(lexer.strings.size() - 1);
}

void add_invalid(Lexer& lexer, const char* from, std::string message) {
    const Symbol text = add_string(lexer, std::move(message));
    add(lexer, TokenKind::invalid, from, text);
}

// Comments nest, as in POV-Ray.
void skip_block_comment(Lexer& lexer) {
    const char* from = lexer.at;
    int depth = 0;
    while (lexer.at < lexer.end) {
        const bool two = lexer.at + 1 < lexer.end;
        if (two && lexer.at[0] == '/' && lexer.at[1] == '*') {
            ++depth;
            lexer.at += 2;
        } else if (two && lexer.at[0] == '*' && lexer.at[1] == '/') {
            lexer.at += 2;
            if (--depth == 0) return;
        } else {
            ++lexer.at;
        }
    }
    lexer.at = from + 2; // the error points at the opener
    add_invalid(lexer, from, "`/*` opened here is never closed");
    lexer.at = lexer.end;
}

} // namespace

std::string utf8(unsigned code) {
    std::string out;
    if (code < 0x80) {
        out += static_cast<char>(code);
    } else if (code < 0x800) {
        out += static_cast<char>(0xc0 | (code >> 6));
        out += static_cast<char>(0x80 | (code & 0x3f));
    } else {
        out += static_cast<char>(0xe0 | (code >> 12));
        out += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
        out += static_cast<char>(0x80 | (code & 0x3f));
    }
    return out;
}

namespace {

// One escape, behind its backslash. Unknown ones keep the backslash: "C:\dir" is meant.
void unescape(Lexer& lexer, std::string& out) {
    const char c = *lexer.at++;
    switch (c) {
    case 'n':
        out += '\n';
        break;
    case 't':
        out += '\t';
        break;
    case 'r':
        out += '\r';
        break;
    case 'a':
        out += '\a';
        break;
    case 'b':
        out += '\b';
        break;
    case 'f':
        out += '\f';
        break;
    case 'v':
        out += '\v';
        break;
    case '0':
        out += '\0';
        break;
    case '"':
    case '\'':
    case '\\':
        out += c;
        break;
    case 'u': {
        unsigned code = 0;
        const char* last = lexer.end - lexer.at < 4 ? lexer.end : lexer.at + 4;
        const auto result = std::from_chars(lexer.at, last, code, 16);
        if (result.ptr == lexer.at + 4) {
            out += utf8(code);
            lexer.at += 4;
        } else {
            out += "\\u";
        }
        break;
    }
    default:
        out += '\\';
        out += c;
    }
}

// Where the last string is never closed, an earlier one that runs over several lines probably lacks its end, and
// what was read as text since then is none.
void blame_long_string(Lexer& lexer) {
    if (lexer.long_string == nullptr) return;
    const auto begin = static_cast<std::uint32_t>(lexer.long_string - lexer.begin);
    for (StoredToken& token : lexer.tokens) {
        if (token.begin != begin) continue;
        lexer.strings.emplace_back("this string runs over several lines, and the file's last one is never closed: is a "
                                   "closing `\"` missing here?");
        token.kind = static_cast<std::uint32_t>(TokenKind::invalid) & 15;
        token.name = {static_cast<Symbol>(lexer.strings.size() - 1), 0};
        token.length = 1;
    }
}

void lex_string(Lexer& lexer) {
    const char* from = lexer.at++;
    std::string text;
    while (lexer.at < lexer.end && *lexer.at != '"') {
        const char c = *lexer.at++;
        if (c == '\\' && lexer.at < lexer.end)
            unescape(lexer, text);
        else
            text += c;
    }
    if (lexer.at == lexer.end) {
        lexer.at = from + 1;
        blame_long_string(lexer);
        add_invalid(lexer, from, "the string opened here is never closed");
        lexer.at = lexer.end;
        return;
    }
    ++lexer.at;
    if (lexer.long_string == nullptr && text.find('\n') != std::string::npos) lexer.long_string = from;
    const Symbol kept = add_string(lexer, std::move(text));
    add(lexer, TokenKind::string, from, kept);
}

void lex_number(Lexer& lexer) {
    const char* from = lexer.at;
    double value = 0;
    const auto result = std::from_chars(from, lexer.end, value);
    lexer.at = result.ptr;
    if (result.ec == std::errc::result_out_of_range) {
        // Too small is 0; too large cannot be meant.
        const std::string_view text(from, static_cast<std::size_t>(result.ptr - from));
        const std::size_t exponent = text.find_first_of("eE");
        if (exponent == text.npos || text[exponent + 1] != '-') {
            add_invalid(lexer, from, "this number is too large");
            return;
        }
        value = 0;
    }
    add(lexer, TokenKind::number, from, 0).number = value;
}

void lex_word(Lexer& lexer) {
    const char* from = lexer.at;
    while (lexer.at < lexer.end && (is_letter(*lexer.at) || is_digit(*lexer.at))) ++lexer.at;
    const std::string_view word(from, static_cast<std::size_t>(lexer.at - from));
    add(lexer, TokenKind::word, from, lexer.words.intern(american(word)));
}

// Other languages' words for #end. They are taken for it, so that what they close is closed.
bool is_foreign_end(std::string_view word) {
    return word == "endif" || word == "endwhile" || word == "endfor" || word == "endmacro" || word == "endswitch";
}

void lex_directive(Lexer& lexer) {
    const char* from = lexer.at++;
    while (lexer.at < lexer.end && std::strchr(" \t\r\n", *lexer.at) != nullptr && *lexer.at != '\0')
        ++lexer.at;
    const char* word = lexer.at;
    while (lexer.at < lexer.end && (is_letter(*lexer.at) || is_digit(*lexer.at))) ++lexer.at;
    if (word == lexer.at) {
        lexer.at = from + 1;
        while (lexer.at < lexer.end && *lexer.at == '#') ++lexer.at; // a run of them is one
        if (lexer.at < lexer.end && is_letter(*lexer.at)) --lexer.at;
        add_invalid(lexer, from, "a `#` without the name of a directive means nothing");
        lexer.tokens.back().name.jump = 1; // POV-Ray passes over it
        return;
    }
    const std::string_view text(word, static_cast<std::size_t>(lexer.at - word));
    const bool ends = is_foreign_end(text);
    lexer.beside += 4; // while directives are paired
    add(lexer, TokenKind::directive, from, lexer.words.intern(ends ? "end" : text));
    if (ends) add_invalid(lexer, from, fmt::format("there is no directive `#{}`: `#end` closes all of them", text));
}

std::string invalid_character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%') return "the character `%` has no meaning here: the remainder is mod(a, b)";
    if (byte >= 0x20 && byte < 0x7f) return fmt::format("the character `{}` has no meaning here", c);
    return fmt::format("the byte 0x{:02x} has no meaning in a scene", byte);
}

// Signs of word processors that look like those of the language.
std::string_view plain_sign(unsigned code) {
    switch (code) {
    case 0x201c: // quotation marks
    case 0x201d:
    case 0x201e:
    case 0x00ab:
    case 0x00bb:
        return "\"";
    case 0x2010: // hyphens, dashes, minus
    case 0x2011:
    case 0x2012:
    case 0x2013:
    case 0x2014:
    case 0x2212:
        return "-";
    case 0x00d7:
    case 0x22c5:
        return "*";
    case 0x00f7:
        return "/";
    case 0x2264:
        return "<=";
    case 0x2265:
        return ">=";
    case 0x2260:
        return "!=";
    case 0x00a0:
    case 0x2009:
    case 0x202f:
    case 0x3000:
        return " ";
    default:
        return {};
    }
}

// A character of UTF-8 beyond ASCII: its code and length; length 1 and code 0 if the bytes are none.
std::pair<unsigned, std::ptrdiff_t> decode_utf8(const char* at, const char* end) {
    const auto byte = [&](std::ptrdiff_t i) { return static_cast<unsigned>(static_cast<unsigned char>(at[i])); };
    const std::ptrdiff_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc2 ? 2 : 1;
    if (length == 1 || byte(0) > 0xf4 || end - at < length) return {0, 1};
    unsigned code = byte(0) & (0xffu >> (length + 1));
    for (std::ptrdiff_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {0, 1};
        code = code << 6 | (byte(i) & 0x3f);
    }
    return {code, length};
}

void lex_foreign(Lexer& lexer) {
    const char* from = lexer.at;
    const auto [code, length] = decode_utf8(from, lexer.end);
    const std::string_view character(from, static_cast<std::size_t>(length));
    // A run of the same is one error.
    do lexer.at += length;
    while (lexer.end - lexer.at >= length && std::string_view(lexer.at, character.size()) == character);
    if (code == 0) return add_invalid(lexer, from, invalid_character(*from));
    const std::string_view plain = plain_sign(code);
    if (plain == " ")
        return add_invalid(lexer, from, fmt::format("this space is the character U+{:04X}: a plain one is needed", code));
    std::string message = fmt::format("the character `{}` (U+{:04X}) has no meaning in a scene", character, code);
    if (!plain.empty()) message += fmt::format(": is a plain `{}` meant?", plain);
    add_invalid(lexer, from, std::move(message));
}

void lex_punctuation(Lexer& lexer) {
    if (static_cast<unsigned char>(*lexer.at) >= 0x80) return lex_foreign(lexer);
    const char* from = lexer.at;
    const char c = *lexer.at++;
    if (std::strchr("{}()[]<>,;:.?=!+-*/&|^", c) == nullptr || c == '\0') {
        // A run of unreadable bytes is one error.
        while (lexer.at < lexer.end && *lexer.at == c) ++lexer.at;
        add_invalid(lexer, from, invalid_character(c));
        return;
    }
    auto symbol = static_cast<Symbol>(c);
    if (lexer.at < lexer.end && *lexer.at == '=' && (c == '<' || c == '>' || c == '!')) {
        symbol |= static_cast<Symbol>('=') << 8;
        ++lexer.at;
    }
    add(lexer, TokenKind::punctuation, from, symbol);
}

// Which bytes a list of numbers is made of.
constexpr std::array<bool, 256> make_number_bytes() {
    std::array<bool, 256> bytes{};
    for (const char c : {'+', '-', '.', ',', '<', '>', 'e', 'E', ' ', '\n', '\r', '\t'})
        bytes[static_cast<unsigned char>(c)] = true;
    for (char c = '0'; c <= '9'; ++c) bytes[static_cast<unsigned char>(c)] = true;
    return bytes;
}
constexpr std::array<bool, 256> number_bytes = make_number_bytes();

bool starts_number_list(const Lexer& lexer) {
    const std::size_t n = lexer.tokens.size();
    if (n < 2 || lexer.tokens[n - 2].kind != static_cast<std::uint32_t>(TokenKind::word)) return false;
    switch (static_cast<Keyword>(lexer.tokens[n - 2].name.symbol)) {
    case "vertex_vectors"_kw:
    case "normal_vectors"_kw:
    case "uv_vectors"_kw:
    case "face_indices"_kw:
    case "normal_indices"_kw:
    case "uv_indices"_kw:
    case "triangle"_kw:
    case "smooth_triangle"_kw:
        return true;
    default:
        return false;
    }
}

// Behind the `{` of a mesh's list: all up to its `}` as one token, if it is nothing but numbers.
void lex_number_list(Lexer& lexer) {
    constexpr std::ptrdiff_t worth_it = 20; // bytes
    const char* from = lexer.at;
    const char* at = from;
    while (at < lexer.end && number_bytes[static_cast<unsigned char>(*at)]) ++at;
    if (at == lexer.end || *at != '}' || at - from < worth_it) return;
    lexer.at = at;
    add(lexer, TokenKind::numbers, from, 0);
}

void lex_token(Lexer& lexer) {
    const char c = *lexer.at;
    const char following = lexer.at + 1 < lexer.end ? lexer.at[1] : '\0';
    if (c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v')
        ++lexer.at;
    else if (is_digit(c) || (c == '.' && is_digit(following)))
        lex_number(lexer);
    else if (is_letter(c))
        lex_word(lexer);
    else if (c == '/' && following == '/') {
        while (lexer.at < lexer.end && *lexer.at != '\n' && *lexer.at != '\r') ++lexer.at;
    } else if (c == '/' && following == '*')
        skip_block_comment(lexer);
    else if (c == '"')
        lex_string(lexer);
    else if (c == '#')
        lex_directive(lexer);
    else if (c == 0x1a && lexer.at + 1 == lexer.end)
        ++lexer.at; // DOS end of file
    else {
        lex_punctuation(lexer);
        if (c == '{' && lexer.keep_numbers && starts_number_list(lexer)) lex_number_list(lexer);
    }
}

// What a text of another encoding starts with; empty: it is none that is known.
std::string_view foreign_encoding(std::string_view text) {
    if (text.starts_with(std::string_view("\xff\xfe\0\0", 4)) || text.starts_with(std::string_view("\0\0\xfe\xff", 4)))
        return "UTF-32";
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return "UTF-16";
    if (text.size() >= 4 && text[0] != '\0' && text[1] == '\0' && text[2] != '\0' && text[3] == '\0') return "UTF-16";
    if (text.starts_with("\x7f" "ELF") || text.starts_with("\x89PNG") || text.starts_with("\xff\xd8\xff") ||
        text.starts_with("PK\x03\x04") || text.starts_with("\x1f\x8b"))
        return "no text at all";
    return {};
}

void lex_all(Lexer& lexer) {
    const std::string_view encoding = foreign_encoding({lexer.at, static_cast<std::size_t>(lexer.end - lexer.at)});
    if (lexer.at == lexer.begin && !encoding.empty()) {
        lexer.at += 2;
        add_invalid(lexer, lexer.begin, fmt::format("this file is {}: scenes are plain text in UTF-8 or ASCII", encoding));
        lexer.at = lexer.end;
    }
    if (lexer.at == lexer.begin && std::string_view(lexer.at, lexer.end).starts_with("\xef\xbb\xbf"))
        lexer.at += 3;
    while (lexer.at < lexer.end) {
        lex_token(lexer);
        if (static_cast<std::int64_t>(lexer.tokens.size()) + lexer.beside < lexer.most) continue;
        add_invalid(lexer, lexer.at - 1,
                    fmt::format("the scene's texts need too much memory: this is their token number {}", lexer.tokens.size()));
        lexer.at = lexer.end;
    }
    add(lexer, TokenKind::end, lexer.at, 0);
}

// ---- pairing of directives
// --------------------------------------------------------------------------------------

struct Opened {
    std::size_t opener;
    std::size_t last_branch;         // #if, #else, #case ...: it jumps to what comes next
    std::size_t breakable;           // 1 + the place in the stack of the loop or #switch that a #break here ends; 0: none
    std::vector<std::size_t> breaks; // waiting for the #end
};

bool is_directive(const StoredToken& token) { return token.kind == static_cast<std::uint32_t>(TokenKind::directive); }

bool takes_break(Keyword name) { return name == "while"_kw || name == "for"_kw || name == "switch"_kw; }

void pair_directives(std::vector<StoredToken>& tokens, std::vector<std::string>& strings) {
    std::vector<Opened> stack;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        if (!is_directive(tokens[i])) continue;
        const auto name = static_cast<Keyword>(tokens[i].name.symbol);
        const auto index = static_cast<std::uint32_t>(i);
        if (is_opener(name)) {
            const std::size_t around = stack.empty() || name == "macro"_kw ? 0 : stack.back().breakable;
            stack.push_back({i, i, takes_break(name) ? stack.size() + 1 : around, {}});
        } else if (name == "break"_kw) {
            if (!stack.empty() && stack.back().breakable > 0) stack[stack.back().breakable - 1].breaks.push_back(i);
        } else if (stack.empty()) {
            continue;
        } else if (name == "else"_kw || name == "elseif"_kw || name == "case"_kw || name == "range"_kw) {
            tokens[stack.back().last_branch].name.jump = index;
            stack.back().last_branch = i;
        } else if (name == "end"_kw) {
            const Opened& open = stack.back();
            tokens[open.last_branch].name.jump = index;
            for (const std::size_t each : open.breaks) tokens[each].name.jump = index;
            tokens[i].name.jump = static_cast<std::uint32_t>(open.opener);
            stack.pop_back();
        }
    }
    // Recovery may pass over the first one, so that all of them are marked.
    std::vector<std::pair<Symbol, Symbol>> messages; // by word
    for (const Opened& open : stack) {
        StoredToken& opener = tokens[open.opener];
        const Symbol word = opener.name.symbol;
        if (std::none_of(messages.begin(), messages.end(), [&](const auto& known) { return known.first == word; })) {
            strings.push_back("`#" + std::string(keyword_text(static_cast<Keyword>(word))) +
                              "` opened here is never closed by `#end`");
            messages.emplace_back(word, static_cast<Symbol>(strings.size() - 1));
        }
        opener.kind = static_cast<std::uint32_t>(TokenKind::invalid) & 15;
        opener.name.jump = 0; // nothing behind it can be trusted
        for (const auto& [known, text] : messages)
            if (known == word) opener.name.symbol = text;
    }
}

} // namespace

bool is_opener(Keyword name) {
    return name == "if"_kw || name == "ifdef"_kw || name == "ifndef"_kw || name == "while"_kw ||
           name == "for"_kw || name == "switch"_kw || name == "macro"_kw;
}

Words::Words() : table(4096, 0) {
    for (Symbol s = 0; s < keyword_count; ++s) intern(keyword_text(static_cast<Keyword>(s)));
}

Symbol Words::intern(std::string_view word) {
    const std::size_t mask = table.size() - 1;
    std::size_t slot = hash_text(word) & mask;
    while (table[slot] != 0) {
        if (texts[table[slot] - 1] == word) return table[slot] - 1;
        slot = (slot + 1) & mask;
    }
    texts.emplace_back(word);
    hashes.push_back(long_hash(word));
    table[slot] = static_cast<std::uint32_t>(texts.size());
    if (texts.size() * 2 > table.size()) { // grow, and enter everything again
        table.assign(table.size() * 2, 0);
        for (std::size_t i = 0; i < texts.size(); ++i) {
            std::size_t free = hash_text(texts[i]) & (table.size() - 1);
            while (table[free] != 0) free = (free + 1) & (table.size() - 1);
            table[free] = static_cast<std::uint32_t>(i + 1);
        }
    }
    return static_cast<Symbol>(texts.size() - 1);
}

std::vector<StoredToken> lex(const SourceText& source, Words& words, std::vector<std::string>& strings,
                             const LexRange& range) {
    const char* begin = source.text.data();
    const char* end = begin + std::min<std::size_t>(range.end, source.text.size());
    Lexer lexer{words, strings, {}, begin, begin + range.begin, end, range.keep_numbers, range.most};
    lexer.tokens.reserve(static_cast<std::size_t>(end - lexer.at) / 5 + 2);
    lex_all(lexer);
    pair_directives(lexer.tokens, strings);
    return std::move(lexer.tokens);
}

} // namespace pnr
