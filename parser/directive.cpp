// SPDX-License-Identifier: GPL-3.0-or-later
// Running directives: branches, loops, files, messages. Declarations are in directive_declare.cpp.
#include "parser/directive.h"

#include "parser/blocks.h"
#include "parser/expression.h"
#include "parser/library.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

std::string directive_name(Parser& p, const Token& directive) {
    return fmt::format("#{}", p.in.words.text(directive.symbol));
}

Token expect_raw(Parser& p, char punctuation, const Token& directive) {
    const Token& token = peek_raw(p);
    if (!is(token, punctuation))
        fail(p, token,
             fmt::format("expected `{}` after `{}`, found {}", punctuation, directive_name(p, directive),
                         token_text(p, token)));
    return next_raw(p);
}

void accept_semicolon(Parser& p) {
    if (p.in.buffered) {
        accept(p, ';');
        return;
    }
    const TokenFrame& frame = p.in.frames.back();
    if (frame.position < frame.end && is(frame.tokens[frame.position], ';')) ++p.in.frames.back().position;
}

namespace {

// Values closer than this are equal, as for POV-Ray's `=`.
constexpr double equal_within = 1e-10;

// `index`: a directive's value, of the frame's tokens.
void jump(Parser& p, double index) { p.in.frames.back().position = static_cast<std::uint32_t>(index); }

Token token_at(Parser& p, double index) {
    const TokenFrame& frame = p.in.frames.back();
    return unpack(frame.tokens[static_cast<std::size_t>(index)], frame.source, frame.chain);
}

// `(expression)`.
double condition_value(Parser& p, const Token& directive) {
    expect_raw(p, '(', directive);
    const double value = parse_condition(p);
    expect(p, ')', "to close the condition");
    return value;
}

bool condition(Parser& p, const Token& directive) {
    const auto name = static_cast<Keyword>(directive.symbol);
    if (name == "ifdef"_kw) return ifdef_condition(p, directive);
    if (name == "ifndef"_kw) return !ifdef_condition(p, directive);
    return is_true(condition_value(p, directive));
}

// The index of the #end of the construct that `branch` belongs to.
double end_of(Parser& p, const Token& branch) {
    double index = branch.value;
    for (;;) {
        if (index == no_jump) fail(p, branch, "there is no `#if` or `#switch` that this belongs to");
        const Token token = token_at(p, index);
        if (static_cast<Keyword>(token.symbol) == "end"_kw) return index;
        index = token.value;
    }
}

void jump_behind_end(Parser& p, const Token& branch) { jump(p, end_of(p, branch) + 1); }

void if_directive(Parser& p, const Token& opener) {
    Token branch = opener;
    while (!condition(p, branch)) {
        const double index = branch.value;
        branch = token_at(p, index);
        jump(p, index + 1);
        if (static_cast<Keyword>(branch.symbol) != "elseif"_kw) return; // #else: its body; #end: behind it
    }
}

void switch_directive(Parser& p, const Token& opener) {
    const double value = condition_value(p, opener);
    double index = opener.value;
    for (;;) {
        const Token branch = token_at(p, index);
        jump(p, index + 1);
        const auto name = static_cast<Keyword>(branch.symbol);
        if (name == "case"_kw) {
            if (std::abs(condition_value(p, branch) - value) < equal_within) return;
        } else if (name == "range"_kw) {
            expect_raw(p, '(', branch);
            const double low = parse_condition(p);
            accept_comma(p);
            const double high = parse_condition(p);
            expect(p, ')', "to close the range");
            if (value >= low - equal_within && value <= high + equal_within) return;
        } else {
            return; // #else: its body; #end: behind it
        }
        index = branch.value;
    }
}

// A case reached from the one above: its body follows, its value does not matter.
void fall_through(Parser& p, const Token& branch) {
    if (branch.value == no_jump) fail(p, branch, "there is no `#switch` that this belongs to");
    expect_raw(p, '(', branch);
    parse_condition(p);
    if (accept(p, ',')) parse_condition(p);
    expect(p, ')', "to close the condition");
}

// An #else reached from above: behind an #if it is passed over; in a #switch it is one more case to fall
// into.
void else_directive(Parser& p, const Token& branch) {
    const Token opener = token_at(p, token_at(p, end_of(p, branch)).value);
    if (static_cast<Keyword>(opener.symbol) != "switch"_kw) jump_behind_end(p, branch);
}

void count_turn(Parser& p, const Token& opener) {
    p.in.last_loop = opener;
    if (++p.in.used.loop_turns > p.in.options.budgets.loop_turns)
        stop_at_limit(p, opener, &Budgets::loop_turns,
             fmt::format("the scene's loops turn more than {} times", p.in.options.budgets.loop_turns),
             "does this loop's condition ever become false?");
}

void while_directive(Parser& p, const Token& opener) {
    if (condition(p, opener))
        count_turn(p, opener);
    else
        jump(p, opener.value + 1);
}

bool for_goes_on(const ForLoop& loop) {
    // The last value counts although the steps' rounding may have passed it a little.
    const double slack = std::abs(loop.step) * 1e-9;
    return loop.step > 0 ? loop.value <= loop.last + slack : loop.value >= loop.last - slack;
}

void for_directive(Parser& p, const Token& opener) {
    expect_raw(p, '(', opener);
    const Token name = next_raw(p);
    if (name.kind != TokenKind::word || is_reserved(name.symbol))
        fail(p, name, fmt::format("expected the name of the loop's variable, found {}", token_text(p, name)));
    ForLoop loop;
    loop.variable = name.symbol;
    expect(p, ',', "after the loop's variable");
    loop.value = parse_condition(p);
    expect(p, ',', "after the first value");
    loop.last = parse_condition(p);
    if (accept(p, ',')) loop.step = parse_condition(p);
    expect(p, ')', "to close the loop's head");
    if (std::abs(loop.step) < equal_within) fail(p, opener, "a loop with a step of 0 never ends");
    assign(p, loop.variable, Value{loop.value}, true);
    if (!for_goes_on(loop)) {
        jump(p, opener.value + 1);
        return;
    }
    count_turn(p, opener);
    loop.body = p.in.frames.back().position;
    loop.opener = token_at(p, opener.value).value;
    p.in.loops.push_back(loop);
}

// Is the innermost loop of this frame the one that `opener` opened? Not if an error made us come in from the side.
bool runs(const Parser& p, double opener) {
    const auto& loops = p.in.loops;
    return loops.size() > p.in.frames.back().first_loop && loops.back().opener == opener;
}

void next_for_turn(Parser& p, const Token& opener, double index) {
    if (!runs(p, index)) return;
    ForLoop& loop = p.in.loops.back();
    // The body may have changed the variable, as in POV-Ray.
    const Value* value = lookup(p.in, loop.variable);
    const double* number = value ? std::get_if<double>(&value->data) : nullptr;
    loop.value = (number ? *number : loop.value) + loop.step;
    assign(p, loop.variable, Value{loop.value}, true);
    if (for_goes_on(loop)) {
        count_turn(p, opener);
        p.in.frames.back().position = loop.body;
    } else {
        p.in.loops.pop_back();
    }
}

void end_directive(Parser& p, const Token& end) {
    if (end.value == no_jump)
        fail(p, end, "`#end` without an `#if`, `#while`, `#for`, `#switch` or `#macro`");
    const Token opener = token_at(p, end.value);
    const auto name = static_cast<Keyword>(opener.symbol);
    if (name == "while"_kw) {
        jump(p, end.value + 1);
        while_directive(p, opener);
    } else if (name == "for"_kw) {
        next_for_turn(p, opener, end.value);
    }
}

void break_directive(Parser& p, const Token& directive) {
    if (directive.value == no_jump) fail(p, directive, "`#break` outside of a loop or `#switch`");
    const Token end = token_at(p, directive.value);
    if (static_cast<Keyword>(token_at(p, end.value).symbol) == "for"_kw && runs(p, end.value))
        p.in.loops.pop_back();
    jump(p, directive.value + 1);
}

std::string message_text(Parser& p) {
    const HoldScope hold(p);
    const Telling nobody(p.in, Listener::none);
    return parse_string(p);
}

void include_directive(Parser& p, const Token& directive) {
    const Token name = peek_raw(p);
    const std::string file = message_text(p);
    if (p.in.buffered) fail(p, p.in.buffer, "expected nothing behind the name of the file");
    Token at = name;
    at.chain = directive.chain;
    charge_work(p, at, 1000); // looking for the file
    push_text(p, open_include(p, at, file), at);
}

void version_directive(Parser& p) {
    const HoldScope hold(p);
    if (peek(p).kind == TokenKind::word && p.in.words.text(peek(p).symbol) == "unofficial") {
        next(p);
        if (peek(p).kind == TokenKind::word && !at_expression(p)) next(p);
    }
    p.in.version = parse_condition(p);
    for (std::uint64_t& told : p.in.told) add_told(told, std::bit_cast<std::uint64_t>(p.in.version));
    p.in.version_said = true;
    accept_semicolon(p);
}

void default_directive(Parser& p) {
    const Hold before = p.in.hold;
    p.in.hold = {};
    open_block(p, "#default");
    const std::size_t level = open_blocks(p);
    try {
        parse_default_block(p);
        if (!close_block(p)) unexpected(p, "#default", {"texture"_kw, "pigment"_kw, "finish"_kw, "npr"_kw});
    } catch (const ParseFailure&) {
        recover_block(p, level);
    }
    p.in.hold = before;
}

void debug_directive(Parser& p) {
    const std::string text = message_text(p);
    const auto most = static_cast<std::size_t>(p.in.options.budgets.debug_output);
    if (p.in.debug_output.size() < most) p.in.debug_output += text.substr(0, most - p.in.debug_output.size());
}

void error_directive(Parser& p, const Token& directive) {
    std::string text = message_text(p);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    stop(p, directive, fmt::format("the scene says: {}", text));
}

void warning_directive(Parser& p, const Token& directive) {
    std::string text = message_text(p);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    warn(p, directive, text);
}

[[noreturn]] void unknown_directive(Parser& p, const Token& directive) {
    static constexpr std::string_view names[] = {
        "declare", "local", "undef",   "macro", "if",    "ifdef",  "ifndef", "else",    "elseif",
        "switch",  "case",  "range",   "break", "while", "for",    "end",    "include", "default",
        "version", "debug", "warning", "error", "fopen", "fclose", "read",   "write",
        "render",  "statistics"};
    const std::string_view nearest =
        nearest_word(p.in.words.text(directive.symbol), {std::begin(names), std::end(names)});
    fail(p, directive, fmt::format("there is no directive `{}`", directive_name(p, directive)),
         nearest.empty() ? "" : fmt::format("did you mean `#{}`?", nearest));
}

void dispatch(Parser& p, const Token& directive) {
    switch (static_cast<Keyword>(directive.symbol)) {
    case "declare"_kw:
        return declare_directive(p, directive, false);
    case "local"_kw:
        return declare_directive(p, directive, true);
    case "undef"_kw:
        return undef_directive(p, directive);
    case "macro"_kw:
        return macro_directive(p, directive);
    case "if"_kw:
    case "ifdef"_kw:
    case "ifndef"_kw:
        return if_directive(p, directive);
    case "else"_kw:
        return else_directive(p, directive);
    case "elseif"_kw:
        return jump_behind_end(p, directive);
    case "switch"_kw:
        return switch_directive(p, directive);
    case "case"_kw:
    case "range"_kw:
        return fall_through(p, directive);
    case "break"_kw:
        return break_directive(p, directive);
    case "while"_kw:
        return while_directive(p, directive);
    case "for"_kw:
        return for_directive(p, directive);
    case "end"_kw:
        return end_directive(p, directive);
    case "include"_kw:
        return include_directive(p, directive);
    case "default"_kw:
        return default_directive(p);
    case "version"_kw:
        return version_directive(p);
    case "debug"_kw:
    case "render"_kw: // streams that POV-Ray 3.7 has given up, too
    case "statistics"_kw:
        return debug_directive(p);
    case "warning"_kw:
        return warning_directive(p, directive);
    case "error"_kw:
        return error_directive(p, directive);
    case "fopen"_kw:
        return fopen_directive(p, directive);
    case "fclose"_kw:
        return fclose_directive(p, directive);
    case "read"_kw:
        return read_directive(p, directive);
    case "write"_kw:
        return write_directive(p, directive);
    default:
        unknown_directive(p, directive);
    }
}

// Puts the buffered token back, if it came from this frame.
void unread(Parser& p) {
    Expander& in = p.in;
    TokenFrame& frame = in.frames.back();
    if (in.buffered && frame.position > 0 && in.buffer.span.source == frame.source &&
        in.buffer.span.begin == frame.tokens[frame.position - 1].begin)
        --frame.position;
    in.buffered = false;
}

// After a failure in a directive: leaves what was begun in it and skips to behind its `;`, or to the next
// directive, or to the `}` of the block around it.
void recover_directive(Parser& p, const Token& directive, std::size_t frames, std::size_t blocks,
                       std::int64_t brace_depth) {
    Expander& in = p.in;
    while (in.frames.size() > frames) pop_frame(p);
    in.blocks.resize(std::min(in.blocks.size(), blocks));
    in.brace_depth = brace_depth;
    unread(p);
    if (in.resume) return;
    if (is_opener(static_cast<Keyword>(directive.symbol)) && directive.value != no_jump) {
        jump_behind_end(p, directive);
        return;
    }
    TokenFrame& frame = in.frames.back();
    // The failing token may have been passed: a directive or brace just behind us is ours to look at again.
    int depth = 0;
    while (frame.position < frame.end) {
        const StoredToken& token = frame.tokens[frame.position];
        if (kind_of(token) == TokenKind::directive) {
            const bool opens = is_opener(static_cast<Keyword>(token.name.symbol)) && token.name.jump != no_jump;
            if (depth == 0 || !opens) return;
            jump_behind_end(p, unpack(token, frame.source, frame.chain)); // not into a loop from the side
            continue;
        }
        if (is(token, '}') && depth-- == 0) return;
        ++frame.position;
        if (is(token, '{')) ++depth;
        if (depth == 0 && (is(token, ';') || is(token, '}'))) return;
    }
}

} // namespace

void run_directive(Parser& p, const Token& token) {
    Expander& in = p.in;
    const std::size_t frames = in.frames.size(), blocks = in.blocks.size();
    const std::int64_t brace_depth = in.brace_depth;
    const Hold hold = in.hold;
    const Nesting nesting(p, token);
    try {
        dispatch(p, token);
    } catch (const ParseFailure&) {
        in.hold = hold;
        recover_directive(p, token, frames, blocks, brace_depth);
    }
}

} // namespace pnr
