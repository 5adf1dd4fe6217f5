// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/format_text.h"

#include "parser/lexer.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace pnr {

namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

struct LexedText {
    SourceText source;
    Words words{};
    std::vector<std::string> strings{};
    std::vector<StoredToken> tokens{};

    explicit LexedText(const std::string& text) : source{"", text} {
        LexRange range;
        range.keep_numbers = false;
        tokens = lex(source, words, strings, range);
        tokens.pop_back(); // the end
    }
    std::string_view text(const StoredToken& token) const {
        return std::string_view(source.text).substr(token.begin, token.length);
    }
};

TokenKind kind_of(const StoredToken& token) { return static_cast<TokenKind>(token.kind); }
Keyword name_of(const StoredToken& directive) { return static_cast<Keyword>(directive.name.symbol); }
bool is_branch(Keyword name) {
    return name == "else"_kw || name == "elseif"_kw || name == "case"_kw || name == "range"_kw;
}

// What stands on the page: a token or a comment, and how it is set off from what stands before it.
struct Piece {
    std::string_view text;
    const StoredToken* token = nullptr; // null: a comment
    int breaks = 0;                     // ends of lines before it
    std::size_t blanks = 0;             // and blanks, on its line
};

// The length of the block comment that the text begins with; they nest.
std::size_t block_comment_length(std::string_view text) {
    int depth = 0;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::string_view two = text.substr(at, 2);
        if (two == "/*" || two == "*/") {
            depth += two == "/*" ? 1 : -1;
            at += 2;
            if (depth == 0) break;
        } else {
            ++at;
        }
    }
    return at;
}

std::string_view without_blanks_behind(std::string_view text) {
    return text.substr(0, text.find_last_not_of(" \t\f\v") + 1);
}

// The comments between two tokens; what is left before the token goes into `next`.
void add_comments(std::string_view gap, std::vector<Piece>& pieces, Piece& next) {
    while (!gap.empty()) {
        if (gap.starts_with("//") || gap.starts_with("/*")) {
            const std::size_t length = gap[1] == '/' ? std::min(gap.find_first_of("\r\n"), gap.size()) : block_comment_length(gap);
            next.text = gap[1] == '/' ? without_blanks_behind(gap.substr(0, length)) : gap.substr(0, length);
            pieces.push_back(next);
            next = {};
            gap.remove_prefix(length);
        } else if (gap[0] == '\n' || gap[0] == '\r') {
            ++next.breaks;
            next.blanks = 0;
            gap.remove_prefix(gap.starts_with("\r\n") ? 2 : 1);
        } else {
            ++next.blanks;
            gap.remove_prefix(1);
        }
    }
}

std::vector<Piece> make_pieces(const LexedText& lexed) {
    std::vector<Piece> pieces;
    const std::string_view text = lexed.source.text;
    std::size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    Piece next;
    for (const StoredToken& token : lexed.tokens) {
        add_comments(text.substr(at, token.begin - at), pieces, next);
        next.text = lexed.text(token);
        next.token = &token;
        pieces.push_back(next);
        next = {};
        at = token.begin + token.length;
    }
    add_comments(text.substr(at), pieces, next);
    return pieces;
}

// ---- indentation ----

struct Depth {
    int braces = 0, brackets = 0;
    std::vector<int> directives; // open ones: the braces that were open when they began
    bool continued = false;      // the last token was an operator: its operand is still to come

    int levels() const { return braces + brackets + static_cast<int>(directives.size()) + (continued ? 1 : 0); }
};

void pass_directive(Depth& depth, Keyword name) {
    if (is_opener(name))
        depth.directives.push_back(depth.braces);
    else if (depth.directives.empty())
        return;
    else if (is_branch(name))
        depth.braces = depth.directives.back(); // a branch may leave braces open that another one opens too
    else if (name == "end"_kw)
        depth.directives.pop_back();
}

void pass_token(Depth& depth, const StoredToken& token, std::string_view text) {
    depth.continued = false;
    if (kind_of(token) == TokenKind::directive) {
        depth.brackets = 0;
        return pass_directive(depth, name_of(token));
    }
    if (kind_of(token) != TokenKind::punctuation) return;
    if (text == "{")
        ++depth.braces;
    else if (text == "}")
        depth.braces = std::max(0, depth.braces - 1), depth.brackets = 0;
    else if (text == "(" || text == "[")
        ++depth.brackets;
    else if (text == ")" || text == "]")
        depth.brackets = std::max(0, depth.brackets - 1);
    else
        depth.continued = std::string_view("=+-*/?:&|^").find(text) != std::string_view::npos;
}

// A block that an operator is waiting for, `#declare A =` and in the next line `union {`, is no continued sum.
bool opens_block(const std::vector<Piece>& pieces, std::size_t first) {
    for (std::size_t i = first; i < pieces.size() && (i == first || pieces[i].breaks == 0); ++i)
        if (pieces[i].token != nullptr && pieces[i].text == "{") return true;
    return false;
}

// Of the line that begins with this piece; a closer or a branch stands where its opener's line does.
int levels_at(Depth depth, const std::vector<Piece>& pieces, std::size_t first) {
    if (depth.continued && opens_block(pieces, first)) depth.continued = false;
    for (std::size_t i = first; i < pieces.size() && pieces[i].token != nullptr; ++i) {
        if (i > first && pieces[i].breaks > 0) break;
        const bool closer = pieces[i].text == "}" || pieces[i].text == ")" || pieces[i].text == "]";
        const bool directive = kind_of(*pieces[i].token) == TokenKind::directive;
        if (!closer && !(directive && name_of(*pieces[i].token) == "end"_kw)) {
            if (directive && is_branch(name_of(*pieces[i].token))) {
                pass_directive(depth, name_of(*pieces[i].token));
                return std::max(0, depth.levels() - 1);
            }
            break;
        }
        if (directive && !depth.directives.empty()) depth.braces = depth.directives.back();
        pass_token(depth, *pieces[i].token, pieces[i].text);
    }
    return depth.levels();
}

// ---- spaces ----

bool one_of(const Piece& piece, std::string_view signs) {
    return piece.token != nullptr && kind_of(*piece.token) == TokenKind::punctuation && piece.text.size() == 1 &&
           signs.find(piece.text[0]) != std::string_view::npos;
}

// Between two pieces of one line. Where it is a matter of taste (operators, the signs of vectors, points, a parenthesis
// behind a name) the author's own is kept, as one.
std::size_t blanks_between(const Piece& before, const Piece& piece) {
    if (piece.token == nullptr) return std::max<std::size_t>(piece.text.starts_with("//") ? piece.blanks : 1, 1);
    if (before.token == nullptr) return 1;
    if (one_of(piece, ",;)]") || one_of(before, "([")) return 0;
    if (one_of(before, "{") && one_of(piece, "}")) return piece.blanks > 0 ? 1 : 0;
    if (one_of(piece, "{}") || one_of(before, "{},;")) return 1;
    const bool signs = kind_of(*before.token) == TokenKind::punctuation || kind_of(*piece.token) == TokenKind::punctuation;
    return signs && piece.blanks == 0 ? 0 : 1;
}

std::string lay_out(const std::vector<Piece>& pieces) {
    constexpr std::size_t indentation = 4;
    std::string text;
    Depth depth;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        if (i == 0 || piece.breaks > 0) {
            if (i > 0) text.append(static_cast<std::size_t>(std::min(piece.breaks, 2)), '\n');
            text.append(indentation * static_cast<std::size_t>(levels_at(depth, pieces, i)), ' ');
        } else {
            text.append(blanks_between(pieces[i - 1], piece), ' ');
        }
        text += piece.text;
        if (piece.token != nullptr) pass_token(depth, *piece.token, piece.text);
    }
    return text.empty() ? text : text + "\n";
}

bool same_tokens(const LexedText& a, const LexedText& b) {
    return std::equal(a.tokens.begin(), a.tokens.end(), b.tokens.begin(), b.tokens.end(),
                      [&](const StoredToken& s, const StoredToken& t) { return s.kind == t.kind && a.text(s) == b.text(t); });
}

} // namespace

FormattedText format_text(const std::string& text) {
    const LexedText lexed(text);
    for (const StoredToken& token : lexed.tokens)
        if (kind_of(token) == TokenKind::invalid) return {{}, lexed.strings[token.name.symbol], token.begin};
    FormattedText formatted{lay_out(make_pieces(lexed)), {}, 0};
    if (text.starts_with(byte_order_mark)) formatted.text.insert(0, byte_order_mark);
    // Nothing is written that means anything else, whatever the rules above may have overlooked.
    if (!same_tokens(lexed, LexedText(formatted.text))) return {{}, "this text cannot be laid out anew", 0};
    return formatted;
}

} // namespace pnr
