// SPDX-License-Identifier: GPL-3.0-or-later
// The recursive descent parser's state and its small vocabulary. Two halves meet here:
//  - the language: lexer, expander (directives, macros), expressions; what these functions are made of;
//  - the blocks: objects, textures, lights, camera, settings; what uses them (blocks.h).
// Every parsing function bears the name of its rule in grammar/pnr.ebnf.
#pragma once

#include "core/pattern_assets.h"
#include "core/scene.h"
#include "core/settings.h"
#include "parser/diagnostic.h"
#include "parser/keywords.h"
#include "parser/token.h"
#include "parser/value.h"

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace pnr {

struct Expander; // expander.h
struct Probe;    // core/probe.h

struct Parser {
    Expander& in;
    Scene& scene;
    Settings& settings;
    // #default { texture | pigment | finish | npr }: what new objects start from.
    Texture default_texture;
    PaintWord
        paint_defaults; // global_settings { npr { ... } } and #default { npr { ... } }, merged at the end
    std::set<std::string, std::less<>> left_out; // features that were warned about
    int light_groups = 0; // so far
    // What inside() and trace() have built; the objects are kept, so that no other takes their place.
    std::map<std::shared_ptr<const DeclaredBlock>, std::shared_ptr<const Probe>> probes{};
    bool noise_said = false; // global_settings { noise_generator }
    std::map<std::shared_ptr<const DeclaredBlock>, std::optional<Bounds>> extents{}; // min_extent, max_extent
    PatternAssets pattern_assets{}; // of functions, which are evaluated while the scene is read
};

// Thrown after an error was recorded, to unwind to the nearest place that can recover (a block's end).
struct ParseFailure {};

// ---- tokens
// ---------------------------------------------------------------------------------------------------

// References from peek stay valid until the next call that takes a token.
const Token& peek(Parser& p); // the next token after expansion; directives have been run
Token next(Parser& p);        // takes it
bool at(Parser& p, Keyword keyword);
bool at(Parser& p, char punctuation);
bool accept(Parser& p, Keyword keyword); // takes it if it is next
bool accept(Parser& p, char punctuation);
void expect(Parser& p, char punctuation,
            std::string_view to); // error `expected "{" to start sphere`, throws ParseFailure
void accept_comma(Parser& p);     // POV-Ray's optional comma between numbers and vectors
// As the text has it; for messages in backticks, with "the end of the file" and "the string" for what has no
// short text.
std::string token_text(Parser& p, const Token& token, bool quoted = true);
SourceRef source_ref(Parser& p, const Token& token);

// Opens a block: expects `{`, calls `item` until the matching `}`. `item` must take at least one token or
// call unexpected(). Errors inside recover at the block's end; an unclosed block is reported at its opener.
// After it, the token behind `}` is next.
template <class F>
void block(Parser& p, std::string_view what, F item);
void open_block(Parser& p, std::string_view what);
bool close_block(Parser& p); // true and taken if at `}`; error with the opener's place at the end of input
// After a ParseFailure inside the `level`-th open block: skips to behind its `}`. At the end of input it
// throws on.
void recover_block(Parser& p, std::size_t level);
std::size_t open_blocks(const Parser& p);
// After a ParseFailure at the top level: skips the rest of the statement, `WORD ... { ... }`, at least one
// token.
void recover_statement(Parser& p);

// Records an error about a token and throws. `unexpected` lists what could stand here and suggests the
// nearest word.
[[noreturn]] void fail(Parser& p, const Token& at, std::string message, std::string help = {});
[[noreturn]] void unexpected(Parser& p, std::string_view inside, std::initializer_list<Keyword> allowed);
// "expected `wanted`, found ...", with how the block's items are written.
[[noreturn]] void missing_value(Parser& p, const Token& found, std::string_view wanted);
bool starts_line(const Parser& p, const Token& token); // nothing but spaces before it
void error(Parser& p, const Token& at, std::string message, std::string help = {}); // records and goes on
void warn(Parser& p, const Token& at, std::string message, std::string help = {});
// Books memory that the scene's text asks for (objects, meshes, arrays); beyond the budget: an error at the
// token that ends the run.
void charge(Parser& p, const Token& at, std::size_t bytes);

// ---- expressions (expression.cpp)
// -----------------------------------------------------------------------------

// None of these takes `<` or `>` between operands as a comparison outside parentheses: `box { -1 <1,1,1> }`
// is POV-Ray.
bool at_expression(Parser& p); // could a number, vector, colour or numeric identifier start here
double parse_float(Parser& p); // a full numeric expression; a vector is an error
double parse_float_in(Parser& p, double low, double high,
                      std::string_view what); // range error otherwise; finite
int parse_int(Parser& p, int low, int high, std::string_view what);
bool parse_bool(Parser& p);          // on off yes no true false or a number
bool parse_optional_bool(Parser& p); // the same; true if none stands there
Vec3 parse_vector(Parser& p);        // 3 components; a number is promoted to all three; finite
Vec2 parse_uv(Parser& p);
ColorFT
parse_color(Parser& p); // rgb <..>, color rgb .., rgbft, srgb .., named, vector, red green blue ... words
std::string parse_string(Parser& p);
Value parse_value(Parser& p); // right side of #declare: expression, array, or block (parse_declared_block)

// The declared block behind an identifier token that is next (or an element of an array of them), if it is
// one of T; taken then. Valid until the identifier is declared anew.
template <class T>
const T* accept_declared(Parser& p);

// File named in the text, searched in the folder of the file that says it, the scene's, the library path.
// Error with did-you-mean if missing. Paths that leave these folders ("..", absolute) are refused.
std::string resolve_file(Parser& p, const Token& at, const std::string& name);

} // namespace pnr

#include "parser/parser_impl.h" // the templates
