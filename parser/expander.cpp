// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/expander.h"

#include "parser/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace pnr {

namespace {

// Ends a directive's expression when it stands behind a complete operand.
bool ends_expression(Keyword name) {
    switch (name) {
    case "declare"_kw:
    case "local"_kw:
    case "undef"_kw:
    case "macro"_kw:
    case "include"_kw:
    case "default"_kw:
    case "version"_kw:
    case "debug"_kw:
    case "render"_kw:
    case "statistics"_kw:
    case "warning"_kw:
    case "error"_kw:
    case "fopen"_kw:
    case "fclose"_kw:
    case "read"_kw:
    case "write"_kw:
        return true;
    default:
        return false;
    }
}

// Does this directive continue or close a construct that was opened before the token `start`?
bool closes_before(const TokenFrame& frame, const StoredToken& directive, std::uint32_t start) {
    StoredToken::Name name = directive.name;
    if (is_opener(static_cast<Keyword>(name.symbol))) return false;
    while (name.jump != no_jump && static_cast<Keyword>(name.symbol) != "end"_kw)
        name = frame.tokens[name.jump].name;
    if (static_cast<Keyword>(name.symbol) != "end"_kw) return false;
    return name.jump == no_jump || name.jump < start;
}

Token end_token(const TokenFrame& frame) {
    Token token = unpack(frame.tokens[frame.position < frame.end ? frame.position : frame.end], frame.source,
                         frame.chain);
    token.kind = TokenKind::end;
    return token;
}

const std::shared_ptr<const Macro>* macro_of(const Expander& in, Symbol symbol) {
    if (symbol >= in.symbols.size()) return nullptr;
    const auto& bindings = in.symbols[symbol].bindings;
    if (bindings.empty() || bindings.back().array) return nullptr;
    return std::get_if<std::shared_ptr<const Macro>>(&bindings.back().cell->value.data);
}

// True when the stream ends here for the directive whose expression is being read.
bool held(const Expander& in, const TokenFrame& frame, std::uint32_t index, bool behind_operand) {
    if (in.hold.frame != in.frames.size()) return false;
    if (index == frame.end) return true;
    const StoredToken& token = frame.tokens[index];
    if (kind_of(token) != TokenKind::directive) return false;
    if (behind_operand && ends_expression(static_cast<Keyword>(token.name.symbol))) return true;
    return closes_before(frame, token, in.hold.start);
}

[[noreturn]] void stop_at_tokens(Parser& p, const Token& at) {
    const std::int64_t most = p.in.options.budgets.tokens;
    constexpr std::int64_t suspicious = 100'000; // turns
    if (p.in.used.loop_turns > suspicious)
        stop_at_limit(p, p.in.last_loop, &Budgets::tokens,
             fmt::format("the scene has more than {} tokens after expansion; its loops have turned {} times",
                         most, p.in.used.loop_turns),
             "does this loop's condition ever become false?");
    stop_at_limit(p, at, &Budgets::tokens,
                  fmt::format("the scene has more than {} tokens after expansion", most));
}

// How many tokens the memory that is left can hold.
std::int64_t tokens_allowed(const Expander& in) {
    const std::int64_t left = in.options.budgets.bytes - *in.bytes;
    return std::max<std::int64_t>(left / static_cast<std::int64_t>(sizeof(StoredToken)), 1);
}

// A frame over the tokens of a `numbers` token, which are made now.
void push_part(Parser& p, const Span& span) {
    Expander& in = p.in;
    auto& tokens = in.parts[static_cast<std::uint64_t>(span.source) << 32 | span.begin];
    if (tokens.empty()) {
        tokens = lex(in.sources.files[span.source], in.words, in.strings,
                     {span.begin, span.end, false, tokens_allowed(in)});
        in.symbols.resize(std::max(in.symbols.size(), in.words.texts.size())); // what looked like a number may be a word
        *in.bytes += static_cast<std::int64_t>(tokens.size() * sizeof(StoredToken));
    }
    TokenFrame frame = in.frames.back();
    frame.tokens = tokens.data();
    frame.position = 0;
    frame.end = static_cast<std::uint32_t>(tokens.size() - 1);
    frame.first_local = in.locals.size();
    frame.first_loop = in.loops.size();
    frame.part = true;
    in.frames.push_back(std::move(frame));
}

void fill(Parser& p, bool behind_operand) {
    Expander& in = p.in;
    for (;;) {
        TokenFrame& frame = in.frames.back();
        if (in.hold.frame != 0 && held(in, frame, frame.position, behind_operand)) {
            in.buffer = end_token(frame);
            return; // not buffered: the next look finds it again
        }
        if (frame.position == frame.end) {
            if (in.frames.size() == 1) {
                in.buffer = end_token(frame);
                return;
            }
            pop_frame(p);
            continue;
        }
        const StoredToken& stored = frame.tokens[frame.position++];
        const Token token = unpack(stored, frame.source, frame.chain);
        if (++in.used.tokens > in.options.budgets.tokens) stop_at_tokens(p, token);
        switch (kind_of(stored)) {
        case TokenKind::directive:
            run_directive(p, token);
            if (in.buffered) return;
            continue;
        case TokenKind::word:
            if (const auto* macro = macro_of(in, token.symbol)) {
                call_macro(p, std::shared_ptr<const Macro>(*macro), token);
                continue;
            }
            break;
        case TokenKind::numbers:
            push_part(p, token.span);
            continue;
        case TokenKind::invalid:
            if (stored.name.jump == 0) stop(p, token, in.strings[token.symbol]);
            if (stored.name.jump == 1) {
                warn(p, token, in.strings[token.symbol]);
                continue;
            }
            fail(p, token, in.strings[token.symbol]);
        default:
            break;
        }
        in.buffer = token;
        in.buffered = true;
        return;
    }
}

std::uint32_t call_number(Expander& in, std::uint32_t parent, const Token& at, Symbol what) {
    constexpr std::size_t most =
        1'000'000; // deeper bookkeeping than this helps nobody: their tokens keep the parent's
    const std::uint64_t key =
        (static_cast<std::uint64_t>(parent) * 0x9e3779b97f4a7c15ull) ^
        ((static_cast<std::uint64_t>(at.span.source) << 32 | at.span.begin) * 0xd1342543de82ef95ull);
    const auto found = in.call_numbers.find(key);
    if (found != in.call_numbers.end()) return found->second;
    if (in.calls.size() >= most) return parent;
    in.calls.push_back({parent, at.span, what});
    return in.call_numbers[key] = static_cast<std::uint32_t>(in.calls.size() - 1);
}

} // namespace

void fill_buffer(Parser& p) { fill(p, false); }

bool ends_here(const Expander& in, const TokenFrame& frame, std::uint32_t index) {
    if (index == frame.end) return in.frames.size() == 1 || held(in, frame, index, true);
    const StoredToken& token = frame.tokens[index];
    switch (kind_of(token)) {
    case TokenKind::directive:
        return held(in, frame, index, true);
    case TokenKind::word:
        return macro_of(in, token.name.symbol) == nullptr;
    case TokenKind::invalid:
    case TokenKind::numbers:
        return false;
    default:
        return true;
    }
}

const Token& peek_operator(Parser& p) {
    if (!p.in.buffered) fill(p, true);
    return p.in.buffer;
}

const Token& peek_raw(Parser& p) {
    TokenFrame& frame = p.in.frames.back();
    p.in.buffer = frame.position < frame.end
                      ? unpack(frame.tokens[frame.position], frame.source, frame.chain)
                      : end_token(frame);
    return p.in.buffer;
}

Token next_raw(Parser& p) {
    TokenFrame& frame = p.in.frames.back();
    if (frame.position == frame.end) return end_token(frame);
    return unpack(frame.tokens[frame.position++], frame.source, frame.chain);
}

// ---- frames
// ---------------------------------------------------------------------------------------------------------

void push_text(Parser& p, std::uint32_t source, const Token& at) {
    Expander& in = p.in;
    const std::vector<StoredToken>& tokens = tokens_of(p, source);
    const std::uint32_t parent = in.frames.empty() ? 0 : in.frames.back().chain;
    if (!in.frames.empty() && ++in.used.include_depth > in.options.budgets.include_depth)
        stop_at_limit(p, at, &Budgets::include_depth, fmt::format("#include goes deeper than {} files", in.options.budgets.include_depth),
             "does a file include itself? Guard it with #ifndef");
    TokenFrame frame;
    frame.tokens = tokens.data();
    frame.end = static_cast<std::uint32_t>(tokens.size() - 1);
    frame.chain = in.frames.empty() ? 0 : call_number(in, parent, at, static_cast<Symbol>("include"_kw));
    frame.scope = static_cast<std::uint32_t>(in.frames.size());
    frame.source = source;
    frame.first_local = in.locals.size();
    frame.first_loop = in.loops.size();
    in.frames.push_back(std::move(frame));
}

void push_macro(Parser& p, const std::shared_ptr<const Macro>& macro, const Token& at) {
    Expander& in = p.in;
    const Budgets& budgets = in.options.budgets;
    if (++in.used.macro_calls > budgets.macro_calls)
        stop_at_limit(p, at, &Budgets::macro_calls, fmt::format("macros are called more than {} times", budgets.macro_calls));
    if (++in.used.macro_depth > budgets.macro_depth)
        stop_at_limit(p, at, &Budgets::macro_depth,
             fmt::format("macro `{}` is called inside itself or others more than {} deep",
                         in.words.text(macro->name), budgets.macro_depth),
             "does the recursion end? It needs an #if that stops it");
    TokenFrame frame;
    frame.tokens = macro->tokens;
    frame.position = macro->begin;
    frame.end = macro->end;
    frame.chain = call_number(in, at.chain, at, macro->name);
    frame.scope = static_cast<std::uint32_t>(in.frames.size());
    frame.source = macro->source;
    frame.first_local = in.locals.size();
    frame.first_loop = in.loops.size();
    frame.macro = macro;
    in.frames.push_back(std::move(frame));
}

void pop_frame(Parser& p) {
    Expander& in = p.in;
    TokenFrame& frame = in.frames.back();
    while (!frame.part && in.locals.size() > frame.first_local) {
        auto& bindings = in.symbols[in.locals.back()].bindings;
        if (!bindings.empty() && bindings.back().scope == frame.scope) bindings.pop_back();
        in.locals.pop_back();
    }
    in.loops.resize(frame.first_loop);
    if (!frame.part) --(frame.macro ? in.used.macro_depth : in.used.include_depth);
    in.frames.pop_back();
}

const std::vector<StoredToken>& tokens_of(Parser& p, std::uint32_t source) {
    Expander& in = p.in;
    while (in.texts.size() <= source) in.texts.emplace_back();
    std::vector<StoredToken>& tokens = in.texts[source];
    if (tokens.empty()) {
        LexRange all;
        all.most = tokens_allowed(in);
        const std::size_t strings = in.strings.size();
        tokens = lex(in.sources.files[source], in.words, in.strings, all);
        *in.bytes += static_cast<std::int64_t>(tokens.size() * sizeof(StoredToken) +
                                               (in.strings.size() - strings) * sizeof(std::string));
        in.symbols.resize(in.words.texts.size());
    }
    return tokens;
}

// ---- names
// ----------------------------------------------------------------------------------------------------------

namespace {

Value& value_at(const Binding& binding) {
    return binding.array ? binding.array->elements[binding.element] : binding.cell->value;
}

constexpr int deepest_array = 16; // arrays in arrays

Value deep_copy(Parser& p, const Token& at, const Value& value, int depth) {
    const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value.data);
    if (!array) return value;
    if (depth > deepest_array) fail(p, at, fmt::format("arrays in arrays go deeper than {}", deepest_array));
    auto copy = make_array(p, at, (*array)->dimensions);
    for (std::size_t i = 0; i < copy->elements.size(); ++i)
        copy->elements[i] = deep_copy(p, at, (*array)->elements[i], depth + 1);
    return Value{std::move(copy)};
}

int array_depth(const Value& value) {
    const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value.data);
    if (!array) return 0;
    int deepest = 0;
    for (const Value& element : (*array)->elements) deepest = std::max(deepest, array_depth(element));
    return deepest + 1;
}

} // namespace

std::shared_ptr<ArrayValue> make_array(Parser& p, const Token& at, std::vector<int> dimensions) {
    std::size_t elements = 1;
    for (const int size : dimensions) elements *= static_cast<std::size_t>(size);
    charge(p, at, elements * sizeof(Value));
    charge_work(p, at, static_cast<std::int64_t>(elements) / 2 + 16);
    std::shared_ptr<ArrayValue> array(new ArrayValue, [ledger = p.in.bytes](ArrayValue* gone) {
        *ledger -= static_cast<std::int64_t>(gone->elements.size() * sizeof(Value));
        delete gone;
    });
    array->dimensions = std::move(dimensions);
    array->elements.resize(elements);
    return array;
}

Value stored_value(Parser& p, const Token& at, Value value) {
    if (const auto* text = std::get_if<std::string>(&value.data))
        charge_work(p, at, letters_work(text->size()));
    const auto* array = std::get_if<std::shared_ptr<ArrayValue>>(&value.data);
    if (!array) return value;
    if (array->use_count() > 1) return deep_copy(p, at, value, 1);
    if (array_depth(value) > deepest_array)
        fail(p, at, fmt::format("arrays in arrays go deeper than {}", deepest_array));
    return value;
}

Value* lookup(Expander& in, Symbol symbol) {
    if (symbol >= in.symbols.size()) return nullptr;
    const auto& bindings = in.symbols[symbol].bindings;
    if (bindings.empty()) return nullptr;
    Value& value = value_at(bindings.back());
    return value.data.index() == 0 ? nullptr : &value;
}

const Value* lookup(const Expander& in, Symbol symbol) { return lookup(const_cast<Expander&>(in), symbol); }

bool is_declared(const Expander& in, Symbol symbol) { return lookup(in, symbol) != nullptr; }

void bind(Parser& p, Symbol symbol, Binding binding) {
    Expander& in = p.in;
    binding.scope = in.frames.empty() ? 0 : in.frames.back().scope;
    if (binding.scope != 0) in.locals.push_back(symbol);
    in.symbols[symbol].bindings.push_back(std::move(binding));
}

namespace {

// A new binding of the `frame`-th frame, though deeper frames may be open: the bindings of a name lie in the order of
// their scopes, and each frame's locals behind those of the frames below it.
void add_binding(Expander& in, Symbol symbol, Binding binding, std::size_t frame) {
    auto& bindings = in.symbols[symbol].bindings;
    auto place = bindings.end();
    while (place != bindings.begin() && (place - 1)->scope > binding.scope) --place;
    const bool is_local = binding.scope != 0;
    bindings.insert(place, std::move(binding));
    if (!is_local) return;
    if (frame == in.frames.size()) {
        in.locals.push_back(symbol);
        return;
    }
    in.locals.insert(in.locals.begin() + static_cast<std::ptrdiff_t>(in.frames[frame].first_local), symbol);
    for (std::size_t deeper = frame; deeper < in.frames.size(); ++deeper) ++in.frames[deeper].first_local;
}

} // namespace

void assign_in(Parser& p, Symbol symbol, Value value, bool local, std::size_t frame) {
    Expander& in = p.in;
    if (symbol >= in.symbols.size()) in.symbols.resize(in.words.texts.size());
    SymbolEntry& entry = in.symbols[symbol];
    entry.poisoned = false;
    const std::uint32_t here = frame == 0 ? 0 : in.frames[frame - 1].scope;
    auto visible = entry.bindings.rbegin(); // from there
    while (visible != entry.bindings.rend() && visible->scope > here) ++visible;
    if (visible != entry.bindings.rend() && (!local || visible->scope == here)) {
        value_at(*visible) = std::move(value);
        return;
    }
    auto cell = std::make_shared<Cell>();
    cell->value = std::move(value);
    add_binding(in, symbol, {local ? here : 0, std::move(cell), nullptr, 0}, frame);
}

void assign(Parser& p, Symbol symbol, Value value, bool local) {
    assign_in(p, symbol, std::move(value), local, p.in.frames.size());
}

void undefine(Expander& in, Symbol symbol) {
    if (symbol < in.symbols.size() && !in.symbols[symbol].bindings.empty())
        in.symbols[symbol].bindings.pop_back();
}

void tell_text(Expander& in, std::string_view text) {
    if (in.listener == Listener::none) return;
    tell(in, std::uint64_t{text.size()});
    while (!text.empty()) {
        std::uint64_t word = 0;
        const std::size_t bytes = std::min(text.size(), sizeof word);
        std::memcpy(&word, text.data(), bytes);
        tell(in, word);
        text.remove_prefix(bytes);
    }
}

void remember_told(Expander& in, const void* thing) { in.known_as[thing] = in.told; }

// Cameras and paint may use what the world was told, but the world must not change where they do.
void tell_thing(Expander& in, const void* thing) {
    const auto known = in.known_as.find(thing);
    if (known == in.known_as.end() || in.listener == Listener::none) return;
    tell(in, known->second[0]);
    if (in.listener != Listener::world) tell(in, known->second[static_cast<std::size_t>(in.listener)]);
}

const DeclaredBlock* first_block(const ArrayValue& array) {
    for (const Value& element : array.elements) {
        if (const auto* held_block = std::get_if<std::shared_ptr<const DeclaredBlock>>(&element.data))
            return held_block->get();
        if (const auto* inner = std::get_if<std::shared_ptr<ArrayValue>>(&element.data))
            if (const DeclaredBlock* found = first_block(**inner)) return found;
    }
    return nullptr;
}

// ---- limits
// ---------------------------------------------------------------------------------------------------------

Nesting::Nesting(Parser& p, const Token& at) : in(p.in) {
    const auto depth = static_cast<std::size_t>(++in.used.nesting) + in.blocks.size();
    if (depth > static_cast<std::size_t>(in.options.budgets.nesting)) {
        --in.used.nesting;
        stop_at_limit(p, at, &Budgets::nesting, fmt::format("nested deeper than {} levels", in.options.budgets.nesting));
    }
}

void charge_work(Parser& p, const Token& at, std::int64_t tokens) {
    p.in.used.tokens += tokens;
    if (p.in.used.tokens > p.in.options.budgets.tokens)
        stop_at_limit(p, at, &Budgets::tokens, "arrays, strings and files take more work than a scene may ask for",
             "does a loop make them without an end?");
}

void charge(Parser& p, const Token& at, std::size_t bytes) {
    *p.in.bytes += static_cast<std::int64_t>(bytes);
    if (*p.in.bytes > p.in.options.budgets.bytes)
        stop_at_limit(p, at, &Budgets::bytes, fmt::format("the scene needs more than {} MB", p.in.options.budgets.bytes / 1'000'000),
             "does a loop make objects without an end?");
}

} // namespace pnr
