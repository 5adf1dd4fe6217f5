// SPDX-License-Identifier: GPL-3.0-or-later
// Names: #declare #local #undef #macro #ifdef, and macro calls.
#include "parser/directive.h"
#include "parser/expression.h"

#include <fmt/format.h>

namespace pnr {

namespace {

// The name that a directive declares or asks for, as it stands in the text.
Token take_name(Parser& p, const Token& directive) {
    const Token name = next_raw(p);
    if (name.kind != TokenKind::word)
        fail(p, name,
             fmt::format("expected a name after `{}`, found {}", directive_name(p, directive),
                         token_text(p, name)));
    return name;
}

Token take_new_name(Parser& p, const Token& directive) {
    const Token name = take_name(p, directive);
    if (is_reserved(name.symbol))
        fail(p, name,
             fmt::format("`{}` is a word of the language and cannot be declared",
                         p.in.words.text(name.symbol)),
             "names that start with a capital letter never meet one");
    return name;
}

// A place that #declare writes to: a variable, or an element of an array.
struct Target {
    Symbol symbol = 0;
    std::shared_ptr<ArrayValue> array;
    std::size_t element = 0;
};

// `#declare deprecated [once] ["message"] NAME`: the message is for the day the name is used; it is passed
// over.
void skip_deprecated(Parser& p) {
    if (!is(peek_raw(p), "deprecated"_kw)) return;
    next_raw(p);
    if (is(peek_raw(p), "once"_kw)) next_raw(p);
    if (peek_raw(p).kind == TokenKind::string) next_raw(p);
}

Target take_target(Parser& p, const Token& directive) {
    const Token name = take_new_name(p, directive);
    Target target{name.symbol, nullptr, 0};
    if (!is(peek_raw(p), '[')) return target;
    Value* value = lookup(p.in, name.symbol);
    auto* array = value ? std::get_if<std::shared_ptr<ArrayValue>>(&value->data) : nullptr;
    if (!array)
        fail(p, name,
             value ? fmt::format("`{}` is {}, not an array", token_text(p, name), article_name(*value))
                   : fmt::format("`{}` is not declared", p.in.words.text(name.symbol)));
    std::tie(target.array, target.element) = take_subscripts(p, name, *array);
    while (is(peek_raw(p), '[')) { // an array in an array; what stands behind is not run yet
        Value& inner = target.array->elements[target.element];
        auto* deeper = std::get_if<std::shared_ptr<ArrayValue>>(&inner.data);
        if (!deeper) fail(p, peek(p), "this element is not an array");
        std::tie(target.array, target.element) =
            take_subscripts(p, name, std::shared_ptr<ArrayValue>(*deeper));
    }
    return target;
}

// A local name that means another kind of thing outside: whoever reads the macro is misled.
void warn_hidden(Parser& p, const Token& name, const Value& value) {
    if (name.symbol >= p.in.symbols.size()) return;
    const auto& bindings = p.in.symbols[name.symbol].bindings;
    if (bindings.empty() || bindings.back().array || bindings.back().scope == p.in.frames.back().scope) return;
    const Value& outside = bindings.back().cell->value;
    const auto is_named_thing = [](const Value& v) { return v.data.index() > 3; }; // not numbers, vectors, strings
    if (outside.data.index() == value.data.index() || !is_named_thing(outside)) return;
    warn(p, name, fmt::format("this local `{}` hides {} of the same name", p.in.words.text(name.symbol),
                              article_name(outside)));
}

void poison(Expander& in, Symbol symbol) {
    if (symbol < in.symbols.size()) in.symbols[symbol].poisoned = true;
}

} // namespace

void declare_directive(Parser& p, const Token& directive, bool local) {
    skip_deprecated(p);
    const Token name = peek_raw(p);
    const std::size_t frame = p.in.frames.size();
    try {
        const HoldScope hold(p);
        const Telling nobody(p.in, Listener::none); // numbers are told where they are used, blocks as they are read
        Target target = take_target(p, directive);
        expect(p, '=', "after the name to declare");
        p.in.hold.start = p.in.frames.back().position;
        Value value = stored_value(p, name, parse_value(p));
        if (!target.array) {
            if (local) warn_hidden(p, name, value);
            assign_in(p, target.symbol, std::move(value), local, frame);
        } else {
            Value& element = target.array->elements[target.element];
            if (element.data.index() == 0 &&
                std::holds_alternative<std::shared_ptr<const DeclaredBlock>>(value.data))
                charge(p, name, sizeof(DeclaredBlock));
            element = std::move(value);
        }
        accept_semicolon(p);
    } catch (const ParseFailure&) {
        if (name.kind == TokenKind::word) poison(p.in, name.symbol);
        throw;
    }
}

void undef_directive(Parser& p, const Token& directive) {
    const Token name = peek_raw(p);
    const Value* value = name.kind == TokenKind::word ? lookup(p.in, name.symbol) : nullptr;
    if (value && std::holds_alternative<std::shared_ptr<ArrayValue>>(value->data)) {
        const HoldScope hold(p);
        const Target target = take_target(p, directive);
        if (target.array)
            target.array->elements[target.element] = {};
        else
            undefine(p.in, name.symbol);
    } else {
        undefine(p.in, take_name(p, directive).symbol);
    }
    accept_semicolon(p);
}

bool ifdef_condition(Parser& p, const Token& directive) {
    expect_raw(p, '(', directive);
    const Token name = take_name(p, directive);
    const Value* value = lookup(p.in, name.symbol);
    if (is(peek_raw(p), '[')) {
        const auto* array = value ? std::get_if<std::shared_ptr<ArrayValue>>(&value->data) : nullptr;
        if (!array) fail(p, name, fmt::format("`{}` is not an array", p.in.words.text(name.symbol)));
        const auto [elements, element] = take_subscripts(p, name, *array);
        value = elements->elements[element].data.index() == 0 ? nullptr : &elements->elements[element];
        expect(p, ')', "to close the condition");
        return value != nullptr;
    }
    expect_raw(p, ')', directive);
    return value != nullptr;
}

void macro_directive(Parser& p, const Token& directive) {
    auto macro = std::make_shared<Macro>();
    skip_deprecated(p);
    const Token name = take_new_name(p, directive);
    macro->name = name.symbol;
    macro->span = name.span;
    expect_raw(p, '(', directive);
    while (!is(peek_raw(p), ')')) {
        macro->parameters.push_back(take_new_name(p, directive).symbol);
        if (is(peek_raw(p), ',')) // POV-Ray lets it be missing
            next_raw(p);
        else if (!is(peek_raw(p), ')') && peek_raw(p).kind != TokenKind::word)
            fail(p, peek_raw(p),
                 fmt::format("expected `,` or `)` in the macro's parameters, found {}",
                             token_text(p, peek_raw(p))));
    }
    next_raw(p);
    TokenFrame& frame = p.in.frames.back();
    macro->tokens = frame.tokens;
    macro->source = frame.source;
    macro->begin = frame.position;
    macro->end = static_cast<std::uint32_t>(directive.value);
    frame.position = macro->end + 1;
    // Macros are global wherever they are defined, as in POV-Ray.
    auto cell = std::make_shared<Cell>();
    cell->value.data = std::shared_ptr<const Macro>(std::move(macro));
    SymbolEntry& entry = p.in.symbols[name.symbol];
    entry.poisoned = false;
    if (entry.bindings.empty())
        entry.bindings.push_back({0, std::move(cell), nullptr, 0});
    else
        entry.bindings.back() = {entry.bindings.back().scope, std::move(cell), nullptr, 0};
}

// ---- calls
// ----------------------------------------------------------------------------------------------------------

namespace {

// The index behind the `]`s that follow tokens[i], or i + 1 if there are none.
std::uint32_t behind_subscripts(const TokenFrame& frame, std::uint32_t i) {
    ++i;
    int depth = 0;
    while (i < frame.end) {
        const StoredToken& token = frame.tokens[i];
        if (is(token, '['))
            ++depth;
        else if (depth == 0)
            break;
        else if (is(token, ']'))
            --depth;
        ++i;
    }
    return i;
}

// Is the next argument an identifier alone, with subscripts or not? Then it is passed by reference.
bool by_reference(Parser& p) {
    if (p.in.buffered) return false;
    const TokenFrame& frame = p.in.frames.back();
    if (frame.position >= frame.end) return false;
    const StoredToken& token = frame.tokens[frame.position];
    if (kind_of(token) != TokenKind::word || is_reserved(token.name.symbol)) return false;
    const Value* value = lookup(p.in, token.name.symbol);
    if (value && std::holds_alternative<std::shared_ptr<const Macro>>(value->data)) return false;
    const std::uint32_t behind = behind_subscripts(frame, frame.position);
    return behind < frame.end && (is(frame.tokens[behind], ',') || is(frame.tokens[behind], ')'));
}

Binding reference_argument(Parser& p) {
    const Token name = next_raw(p);
    SymbolEntry& entry = p.in.symbols[name.symbol];
    if (is(peek_raw(p), '[')) {
        Value* value = lookup(p.in, name.symbol);
        auto* array = value ? std::get_if<std::shared_ptr<ArrayValue>>(&value->data) : nullptr;
        if (!array) fail(p, name, fmt::format("`{}` is not an array", p.in.words.text(name.symbol)));
        Binding binding;
        std::tie(binding.array, binding.element) = take_subscripts(p, name, *array);
        while (is(peek(p), '[')) {
            auto* deeper =
                std::get_if<std::shared_ptr<ArrayValue>>(&binding.array->elements[binding.element].data);
            if (!deeper) fail(p, peek(p), "this element is not an array");
            std::tie(binding.array, binding.element) =
                take_subscripts(p, name, std::shared_ptr<ArrayValue>(*deeper));
        }
        return binding;
    }
    // A name without a value is passed all the same: the macro may declare it.
    if (entry.bindings.empty()) entry.bindings.push_back({0, std::make_shared<Cell>(), nullptr, 0});
    return entry.bindings.back();
}

void take_arguments(Parser& p, const Macro& macro, const Token& name, std::vector<Binding>& arguments) {
    if (!is(peek_raw(p), '('))
        fail(p, name, fmt::format("`{}` is a macro: its call needs `(`", p.in.words.text(macro.name)));
    next_raw(p);
    const std::size_t wanted = macro.parameters.size();
    if (is(peek_raw(p), ')')) {
        next_raw(p);
    } else {
        for (;;) {
            if (by_reference(p)) {
                arguments.push_back(reference_argument(p));
            } else {
                auto cell = std::make_shared<Cell>();
                cell->value = stored_value(p, name, parse_value(p));
                arguments.push_back({0, std::move(cell), nullptr, 0});
            }
            if (accept(p, ')')) break;
            if (!accept(p, ',') && arguments.size() >= wanted) // POV-Ray lets it be missing
                expect(p, ',', "or `)` between the arguments");
        }
    }
    if (arguments.size() != wanted)
        fail(p, name,
             fmt::format("macro `{}` takes {} argument{}, {} {} given", p.in.words.text(macro.name), wanted,
                         wanted == 1 ? "" : "s", arguments.size(), arguments.size() == 1 ? "is" : "are"));
}

} // namespace

void call_macro(Parser& p, const std::shared_ptr<const Macro>& macro, const Token& name) {
    std::vector<Binding> arguments;
    {
        const Nesting nesting(p, name);
        const Hold before = p.in.hold;
        p.in.hold = {};
        try {
            take_arguments(p, *macro, name, arguments);
        } catch (const ParseFailure&) {
            p.in.hold = before;
            throw;
        }
        p.in.hold = before;
    }
    push_macro(p, macro, name);
    for (std::size_t i = 0; i < arguments.size(); ++i) bind(p, macro->parameters[i], std::move(arguments[i]));
}

} // namespace pnr
