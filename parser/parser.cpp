// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/parser.h"

#include "parser/expander.h"
#include "parser/suggest.h"

#include <fmt/format.h>

namespace pnr {

// ---- tokens
// ---------------------------------------------------------------------------------------------------------

std::string token_text(Parser& p, const Token& token, bool quoted) {
    if (token.kind == TokenKind::end)
        return p.in.frames.size() > 1 && p.in.frames.back().macro ? "the end of the macro"
                                                                  : "the end of the expression or file";
    const std::string& text = p.in.sources.files[token.span.source].text;
    constexpr std::size_t longest = 40;
    std::string shown = text.substr(token.span.begin, std::min<std::size_t>(token.span.end - token.span.begin, longest + 1));
    if (shown.size() > longest) shown = shown.substr(0, longest) + "...";
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return quoted ? fmt::format("`{}`", shown) : shown;
}

SourceRef source_ref(Parser& p, const Token& token) {
    const LineColumn place = p.in.sources.locate(token.span.source, token.span.begin);
    return {p.in.sources.files[token.span.source].path, place.line, place.column};
}

void expect(Parser& p, char punctuation, std::string_view to) {
    if (accept(p, punctuation)) return;
    const Token found = peek(p);
    fail(p, found, fmt::format("expected `{}` {}, found {}", punctuation, to, token_text(p, found)));
}

void accept_comma(Parser& p) {
    if (is(peek_operator(p), ',')) next(p);
}

namespace {

std::uint64_t place_hash(const Span& span, std::string_view message) {
    std::uint64_t h = 1469598103934665603ull; // FNV-1a
    for (const char c : message) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return h ^ (static_cast<std::uint64_t>(span.source) << 40) ^ span.begin;
}

// Statements that stand in no block but those that hold objects.
bool starts_statement(const Token& token) {
    switch (keyword_of(token)) {
    case "camera"_kw:
    case "light_source"_kw:
    case "global_settings"_kw:
    case "background"_kw:
    case "sphere"_kw:
    case "box"_kw:
    case "plane"_kw:
    case "cylinder"_kw:
    case "cone"_kw:
    case "torus"_kw:
    case "mesh"_kw:
    case "mesh2"_kw:
    case "union"_kw:
    case "merge"_kw:
    case "difference"_kw:
    case "intersection"_kw:
    case "object"_kw:
    case "sky_sphere"_kw:
        return true;
    default:
        return false;
    }
}

} // namespace

bool starts_line(const Parser& p, const Token& token) {
    const std::string& text = p.in.sources.files[token.span.source].text;
    std::size_t at = token.span.begin;
    while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) --at;
    return at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r';
}

// ---- blocks
// ---------------------------------------------------------------------------------------------------------

std::size_t open_blocks(const Parser& p) { return p.in.blocks.size(); }

void open_block(Parser& p, std::string_view what) {
    const Token brace = peek(p);
    if (!is(brace, '{'))
        fail(p, brace, fmt::format("expected `{{` to start {}, found {}", what, token_text(p, brace)));
    const auto depth = static_cast<std::size_t>(p.in.used.nesting) + p.in.blocks.size();
    if (depth >= static_cast<std::size_t>(p.in.options.budgets.nesting))
        stop_at_limit(p, brace, &Budgets::nesting, fmt::format("nested deeper than {} levels", p.in.options.budgets.nesting));
    next(p);
    p.in.blocks.push_back({brace, std::string(what), p.in.brace_depth});
}

bool close_block(Parser& p) {
    const Token& token = peek(p);
    if (is(token, '}')) {
        next(p);
        p.in.blocks.pop_back();
        return true;
    }
    if (token.kind == TokenKind::end) {
        const OpenBlock& open = p.in.blocks.back();
        fail(p, open.brace, fmt::format("the `{{` of {} is never closed", open.what));
    }
    return false;
}

void recover_block(Parser& p, std::size_t level) {
    Expander& in = p.in;
    in.blocks.resize(level);
    in.broken_blocks.insert(place_hash(in.blocks.back().brace.span, {}));
    if (in.resume) {
        in.blocks.pop_back();
        throw ParseFailure{};
    }
    const std::int64_t depth = in.blocks.back().depth;
    bool at_the_end = false;
    while (!at_the_end) {
        try {
            while (!at_end(p)) {
                const bool closes = in.brace_depth == depth && at(p, '}');
                next(p);
                if (!closes) continue;
                in.blocks.pop_back();
                return;
            }
            at_the_end = true;
        } catch (const ParseFailure&) {
            in.buffered = false; // a second error on the way; go on behind it
        }
    }
    in.blocks.pop_back();
    throw ParseFailure{};
}

void recover_statement(Parser& p) {
    Expander& in = p.in;
    in.blocks.clear();
    if (in.resume) { // the statement is next
        in.resume = false;
        in.brace_depth = 0;
        return;
    }
    bool taken = false;
    for (;;) {
        try {
            if (at_end(p)) return;
            // The next statement starts behind a closed block or a `;`, or with its word on a new line.
            if (taken && in.brace_depth <= 0 && starts_statement(peek(p)) && starts_line(p, peek(p))) return;
            const Token token = next(p);
            taken = true;
            if (in.brace_depth <= 0 && (is(token, '}') || is(token, ';'))) {
                in.brace_depth = 0;
                return;
            }
        } catch (const ParseFailure&) {
            in.buffered = false;
            if (taken && in.brace_depth <= 0) return;
        }
    }
}

// ---- errors
// ---------------------------------------------------------------------------------------------------------

namespace {

// How the tokens of this chain came to be where they are; the middle of a deep recursion is left out.
std::vector<Note> chain_notes(const Expander& in, std::uint32_t chain) {
    constexpr std::size_t shown_at_each_end = 4;
    std::vector<Note> notes;
    while (chain != 0) {
        const Call& call = in.calls[chain];
        int times = 0; // a recursion calls at one place again and again
        do {
            ++times;
            chain = in.calls[chain].parent;
        } while (chain != 0 && in.calls[chain].at.source == call.at.source &&
                 in.calls[chain].at.begin == call.at.begin);
        const bool file = call.macro == static_cast<Symbol>("include"_kw);
        std::string text =
            file ? "included here" : fmt::format("in macro `{}`, called here", in.words.text(call.macro));
        if (times > 1) text += fmt::format(" ({} times)", times);
        notes.push_back({call.at, std::move(text)});
    }
    if (notes.size() > 2 * shown_at_each_end) {
        const std::size_t left_out = notes.size() - 2 * shown_at_each_end;
        const auto first = notes.begin() + shown_at_each_end;
        notes.erase(first, first + static_cast<std::ptrdiff_t>(left_out));
        notes[shown_at_each_end].text += fmt::format(" ({} calls between are not shown)", left_out);
    }
    return notes;
}

bool is_reported(const Expander& in, const Token& at, std::string_view message) {
    return in.reported.contains(place_hash(at.span, message));
}

// The same words about the same place are said once, however often a loop comes by. A block that holds an error is
// not blamed for what it lacks.
void record(Parser& p, Severity severity, const Token& at, std::string message, std::string help,
            std::vector<Note> notes = {}) {
    Expander& in = p.in;
    // A warning behind an error may be that error's echo ("no pigment" where the pigment could not be read).
    if (severity == Severity::warning && (in.errors > 0 || in.used.warnings >= in.options.budgets.warnings))
        return;
    if (in.broken_blocks.contains(place_hash(at.span, {}))) return;
    if (!in.reported.insert(place_hash(at.span, message)).second) return;
    for (Note& note : chain_notes(in, at.chain)) notes.push_back(std::move(note));
    in.diagnostics.push_back({severity, at.span, std::move(message), std::move(notes), std::move(help)});
    if (severity == Severity::warning && ++in.used.warnings == in.options.budgets.warnings)
        in.diagnostics.push_back({Severity::note, at.span, "more warnings are not shown", {}, {}});
    if (severity == Severity::error && ++in.errors == in.options.budgets.errors) {
        in.diagnostics.push_back(
            {Severity::note, at.span, fmt::format("{} errors; the rest is not read", in.errors), {}, {}});
        throw ParseStop{};
    }
}

} // namespace

void give_up(Parser& p, const Token& at) {
    if (++p.in.used.failures < p.in.options.budgets.failures) throw ParseFailure{};
    p.in.diagnostics.push_back(
        {Severity::note, at.span, "the same errors occur over and over; the rest is not read", {}, {}});
    throw ParseStop{};
}

void fail(Parser& p, const Token& at, std::string message, std::string help) {
    record(p, Severity::error, at, std::move(message), std::move(help));
    give_up(p, at);
}

void stop(Parser& p, const Token& at, std::string message, std::string help) {
    Token located = at;
    if (located.chain == 0 && !p.in.frames.empty()) located.chain = p.in.frames.back().chain;
    record(p, Severity::error, located, std::move(message), std::move(help));
    throw ParseStop{};
}

void stop_at_limit(Parser& p, const Token& at, std::int64_t Budgets::*budget, std::string message,
                   std::string question) {
    if (!question.empty()) question += question.back() == '?' ? " " : "; ";
    stop(p, at, std::move(message), question + limit_help(p.in.options.budgets, budget));
}

void error(Parser& p, const Token& at, std::string message, std::string help) {
    record(p, Severity::error, at, std::move(message), std::move(help));
}

void warn(Parser& p, const Token& at, std::string message, std::string help) {
    record(p, Severity::warning, at, std::move(message), std::move(help));
}

namespace {

// A statement's word on a new line inside a block that cannot hold one: the block's `}` was forgotten. The
// statement is read as one, after the blocks around it are left.
void check_forgotten_brace(Parser& p, const Token& token, std::string_view inside) {
    if (p.in.blocks.empty() || !starts_statement(token) || !starts_line(p, token)) return;
    const OpenBlock& open = p.in.blocks.back();
    if (open.brace.span.source != token.span.source) return;
    record(p, Severity::error, token,
           fmt::format("`{}` is never closed: expected `}}` before {}", inside, token_text(p, token)), {},
           {{open.brace.span, "its `{` is here"}});
    p.in.resume = true;
    give_up(p, token);
}

} // namespace

void unexpected(Parser& p, std::string_view inside, std::initializer_list<Keyword> allowed) {
    const Token token = peek(p);
    if (token.kind == TokenKind::word && token.symbol < p.in.symbols.size() && p.in.symbols[token.symbol].poisoned)
        give_up(p, token);
    check_forgotten_brace(p, token, inside);
    const Value* value = token.kind == TokenKind::word ? lookup(p.in, token.symbol) : nullptr;
    std::string message;
    if (value && !is_keyword(token.symbol))
        message = fmt::format("{} is {}, which cannot stand in {} so", token_text(p, token), article_name(*value),
                              inside);
    else if (token.kind == TokenKind::word && !is_keyword(token.symbol))
        message = fmt::format("unknown word {} in {}", token_text(p, token), inside);
    else
        message = fmt::format("unexpected {} in {}", token_text(p, token), inside);
    if (is_reported(p.in, token, message)) give_up(p, token);
    std::vector<Note> notes;
    if (!p.in.blocks.empty())
        notes.push_back(
            {p.in.blocks.back().brace.span, fmt::format("{} opened here", p.in.blocks.back().what)});
    std::string help = help_for_unexpected(p, token, inside, allowed);
    record(p, Severity::error, token, std::move(message), std::move(help), std::move(notes));
    give_up(p, token);
}

void missing_value(Parser& p, const Token& found, std::string_view wanted) {
    if (found.kind == TokenKind::word) check_forgotten_brace(p, found, p.in.blocks.empty() ? "" : p.in.blocks.back().what);
    std::string message = fmt::format("expected {}, found {}", wanted, token_text(p, found));
    if (is_reported(p.in, found, message)) give_up(p, found);
    fail(p, found, std::move(message), help_for_missing_value(p, found));
}

// ---- names of types
// -------------------------------------------------------------------------------------------------

const char* type_name(const Value& value) {
    switch (value.data.index()) {
    case 0:
        return "nothing";
    case 1:
        return "number";
    case 2:
        return std::get<VectorValue>(value.data).is_color ? "colour" : "vector";
    case 3:
        return "string";
    case 4:
        return "array";
    case 6:
        return "macro";
    case 7:
        return "function";
    case 8:
        return "open file";
    case 9:
        return "spline";
    default:
        break;
    }
    static constexpr const char* blocks[] = {
        "object", "texture",   "pigment",   "finish",     "interior", "light source",
        "camera", "transform", "npr block", "colour map", "pigment map", "normal", "slope map",
        "normal map", "texture map", "material", "sky sphere", "fog", "rainbow", "block without meaning here"};
    static_assert(std::size(blocks) == std::variant_size_v<DeclaredBlock>);
    return blocks[std::get<std::shared_ptr<const DeclaredBlock>>(value.data)->index()];
}

std::string article_name(const Value& value) {
    const std::string name = type_name(value);
    if (name == "nothing") return name;
    const bool vowel = std::string_view("aeio").find(name[0]) != std::string_view::npos;
    return fmt::format("{} {}", vowel ? "an" : "a", name);
}

} // namespace pnr
