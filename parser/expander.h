// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the directives. It holds a stack of frames (a file, a macro's body), each a position in an array of
// tokens, and hands the parser one token after the other. Loops set the position back, branches not taken are
// jumped over, a macro call or an #include pushes a frame.
//
// Names. Lookup is dynamic, as in POV-Ray: a macro sees its caller's locals. Each symbol has a stack of
// bindings; the top is what the name means now. A scope belongs to a frame; its bindings are popped with it.
#pragma once

#include "parser/diagnostic.h"
#include "parser/lexer.h"
#include "parser/load_scene.h"
#include "parser/value.h"

#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace pnr {

struct Parser;

// A #macro: where its body lies. Token arrays live as long as the Expander.
struct Macro {
    Symbol name = 0;
    std::vector<Symbol> parameters;
    const StoredToken* tokens = nullptr;
    std::uint32_t begin = 0, end = 0; // of the body; tokens[end] is the #end
    std::uint32_t source = 0;
    Span span; // of the name in the #macro line
};

// A variable's place. Macro parameters share the cell of the caller's variable, or point into its array.
struct Cell {
    Value value;
};
struct Binding {
    std::uint32_t scope = 0; // 0: global
    std::shared_ptr<Cell> cell;
    std::shared_ptr<ArrayValue> array; // if set, the place is this array's element
    std::size_t element = 0;
};
struct SymbolEntry {
    std::vector<Binding> bindings;
    bool poisoned = false; // its declaration failed, or it was reported as unknown: say so once
};

struct TokenFrame {
    const StoredToken* tokens = nullptr;
    std::uint32_t position = 0, end = 0;
    std::uint32_t chain = 0; // of the tokens that come from here
    std::uint32_t scope = 0;
    std::uint32_t source = 0;
    std::size_t first_local = 0;        // Expander::locals from here on belong to this scope
    std::size_t first_loop = 0;         // likewise Expander::loops
    std::shared_ptr<const Macro> macro; // null: a file, or a part of one
    bool part = false;                  // a list of numbers, read in the scope of the frame below
};

struct ForLoop {            // a #for that is running
    double opener = 0;      // index of its token
    std::uint32_t body = 0; // index of its first token
    Symbol variable = 0;
    double value = 0, last = 0, step = 1;
};

struct Call { // a macro call or #include: how tokens came to be where they are
    std::uint32_t parent = 0;
    Span at;
    Symbol macro = 0; // keyword `include` for a file
};

struct OpenBlock {
    Token brace;
    std::string what;
    std::int64_t depth = 0; // Expander::brace_depth inside it
};

// While a directive's own expression is read: what comes behind it in the same frame is not run before the
// directive has been. `start` is the expression's first token.
struct Hold {
    std::size_t frame = 0; // number of frames; 0: no hold
    std::uint32_t start = 0;
};

struct Counters {
    std::int64_t loop_turns = 0, macro_calls = 0, tokens = 0;
    int failures = 0, warnings = 0;
    int nesting = 0, macro_depth = 0, include_depth = 0;
};

// Whom what is read concerns. Paint changes no light (what of it does is in World::objects); texts of #debug and the like
// concern nobody.
enum class Listener : std::uint8_t { world = 0, camera = 1, paint = 2, none = 3 };
using Told = std::array<std::uint64_t, 3>; // a hash for each listener

struct Expander {
    Sources& sources;
    std::vector<Diagnostic>& diagnostics;
    const LoadOptions& options;
    std::string scene_folder;
    std::uint32_t main_source = 0; // the scene's own file

    Words words;
    std::vector<std::string> strings;
    std::deque<std::vector<StoredToken>> texts;           // tokens, by source
    std::unordered_map<std::uint64_t, std::vector<StoredToken>> parts; // of `numbers` tokens, by source and place
    std::unordered_map<std::string, std::string> written; // texts that #write made, by the name it was given
    std::unordered_map<std::string, std::uint32_t> files; // path -> source, of included files

    std::vector<SymbolEntry> symbols;
    std::vector<TokenFrame> frames;
    std::vector<Symbol> locals;
    std::vector<ForLoop> loops;
    std::vector<Call> calls{Call{}};
    std::unordered_map<std::uint64_t, std::uint32_t>
        call_numbers; // (parent, source, place) hashed -> index into calls

    Token buffer; // the token that peek shows, if `buffered`
    bool buffered = false;
    std::int64_t tokens_taken = 0;
    std::int64_t brace_depth = 0;
    std::vector<OpenBlock> blocks;
    Hold hold;

    Counters used;
    Token last_loop; // the #while or #for that turned last
    std::shared_ptr<std::int64_t> bytes =
        std::make_shared<std::int64_t>(0); // in use; arrays give theirs back
    int errors = 0;
    std::unordered_set<std::uint64_t> reported; // hashes of (place, message)
    std::unordered_set<std::uint64_t> broken_blocks; // hashes of the braces of blocks that held an error
    bool resume = false; // a forgotten brace: all open blocks are left, the token that is next starts a statement
    std::vector<std::uint32_t> random_streams;
    double version = 3.7;
    bool version_said = false;
    std::string debug_output;
    // Hashes of what the blocks were told (LoadResult::world_hash, camera_hash), and whose block is being read.
    Told told{1469598103934665603ull, 1469598103934665603ull, 1469598103934665603ull};
    Listener listener = Listener::world;
    // The hashes when a declared block, function or spline was read: what its name stands for.
    std::unordered_map<const void*, Told> known_as;
    std::vector<std::string> assets; // files that the blocks name: pictures, meshes, fonts ...

    Expander(Sources& all_sources, std::vector<Diagnostic>& all_diagnostics, const LoadOptions& load_options)
        : sources(all_sources), diagnostics(all_diagnostics), options(load_options) {}
};

// One more thing that a block was told: a word, a sign, or a value.
inline void add_told(std::uint64_t& told, std::uint64_t thing) {
    told = (told ^ thing) * 0x9e3779b97f4a7c15ull;
    told ^= told >> 29;
}
inline void tell(Expander& in, std::uint64_t thing) {
    if (in.listener != Listener::none) add_told(in.told[static_cast<std::size_t>(in.listener)], thing);
}
inline void tell(Expander& in, double value) { tell(in, std::bit_cast<std::uint64_t>(value + 0.0)); } // -0 is 0
void tell_text(Expander& in, std::string_view text);

// A thing that names may stand for has been read; and one is used. Names alone would not do: another run may have
// given them to other things.
void remember_told(Expander& in, const void* thing);
void tell_thing(Expander& in, const void* thing);

// Whom all that is read while this lives is told to.
struct Telling {
    Expander& in;
    Listener before;
    Telling(Expander& expander, Listener listener) : in(expander), before(expander.listener) { in.listener = listener; }
    ~Telling() { in.listener = before; }
    Telling(const Telling&) = delete;
    Telling& operator=(const Telling&) = delete;
};

// Thrown when the run cannot go on: a budget is used up, or there are too many errors. Recorded before.
struct ParseStop {};

// ---- the stream
// ---------------------------------------------------------------------------------------------------

void fill_buffer(Parser& p); // the next token after expansion into in.buffer
// May an expression end before tokens[index] for certain, whatever runs next? Not at a macro, nor where directives
// or the frame around have a word.
bool ends_here(const Expander& in, const TokenFrame& frame, std::uint32_t index);
// Between an operand and an operator: like peek, but in a directive's expression it shows `end` where the
// expression must end before the next directive runs.
const Token& peek_operator(Parser& p);
// The next token of the current frame as it stands, no directive run, no macro expanded. Only with an empty
// buffer.
const Token& peek_raw(Parser& p);
Token next_raw(Parser& p);
void run_directive(Parser& p, const Token& directive); // directive.cpp; the token has been passed
void call_macro(Parser& p, const std::shared_ptr<const Macro>& macro, const Token& name);
void push_text(Parser& p, std::uint32_t source,
               const Token& at); // a frame over a whole text, with its own scope
void push_macro(Parser& p, const std::shared_ptr<const Macro>& macro, const Token& at);
void pop_frame(Parser& p);
const std::vector<StoredToken>& tokens_of(Parser& p, std::uint32_t source); // lexed on first use
// A stored token as the parser sees it. A directive's `value` is its jump.
inline TokenKind kind_of(const StoredToken& token) { return static_cast<TokenKind>(token.kind); }
inline Token unpack(const StoredToken& stored, std::uint32_t source, std::uint32_t chain) {
    Token token;
    token.kind = kind_of(stored);
    token.span = {source, stored.begin, stored.begin + stored.length};
    token.chain = chain;
    if (token.kind == TokenKind::number) {
        token.value = stored.number;
    } else {
        token.symbol = stored.name.symbol;
        token.value = stored.name.jump;
    }
    return token;
}
inline bool is(const StoredToken& token, char punctuation) {
    return kind_of(token) == TokenKind::punctuation && token.name.symbol == static_cast<Symbol>(punctuation);
}

// ---- names
// ----------------------------------------------------------------------------------------------------------

const Value* lookup(const Expander& in, Symbol symbol); // null: not declared (or declared without a value)
Value* lookup(Expander& in, Symbol symbol);
bool is_declared(const Expander& in, Symbol symbol);
// An array of unset elements; its memory is charged until it is freed.
std::shared_ptr<ArrayValue> make_array(Parser& p, const Token& at, std::vector<int> dimensions);
// What an assignment stores: arrays are copied unless nobody else holds them. Arrays in arrays in arrays ...
// are an error.
Value stored_value(Parser& p, const Token& at, Value value);
// #declare: the visible variable, or a new global. #local: this frame's, or a new one in it.
void assign(Parser& p, Symbol symbol, Value value, bool local); // of a stored value
// The same, as if the `frame`-th frame were the innermost one: a macro that gives a value may still be open behind it.
void assign_in(Parser& p, Symbol symbol, Value value, bool local, std::size_t frame);
void bind(Parser& p, Symbol symbol, Binding binding);           // a new binding in the current scope
void undefine(Expander& in, Symbol symbol);
// The value of the identifier that is next, with its subscripts, all taken. Error if it has none.
const Value& take_variable(Parser& p);
const DeclaredBlock* first_block(const ArrayValue& array); // some element that is a block; null: none
std::string article_name(const Value& value);              // "a texture", "an array"

// ---- limits
// ---------------------------------------------------------------------------------------------------------

// One level deeper in the parser's own recursion; error beyond the budget.
struct Nesting {
    Expander& in;
    Nesting(Parser& p, const Token& at);
    ~Nesting() { --in.used.nesting; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
};
// Counts a failure and throws ParseFailure: for errors that have been recorded before.
// Counts work that no token shows, as tokens: elements of arrays, letters of strings, files looked for.
inline std::int64_t letters_work(std::size_t letters) { return static_cast<std::int64_t>(letters / 8); }
void charge_work(Parser& p, const Token& at, std::int64_t tokens);
[[noreturn]] void give_up(Parser& p, const Token& at);
[[noreturn]] void stop(Parser& p, const Token& at, std::string message, std::string help = {});
// The same for a budget that is used up: the help says how to raise it, behind `question`.
[[noreturn]] void stop_at_limit(Parser& p, const Token& at, std::int64_t Budgets::*budget, std::string message,
                                std::string question = {});

} // namespace pnr
