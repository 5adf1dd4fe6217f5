// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/suggest.h"

#include "parser/expression.h"
#include "parser/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pnr {

namespace {

// Blocks, and words that stand in them alone: who writes such a word elsewhere forgot the block.
constexpr std::pair<std::string_view, std::string_view> homes[] = {
    {"finish", "ambient diffuse emission phong phong_size specular roughness metallic reflection brilliance crand irid "
               "subsurface conserve_energy"},
    {"interior", "ior caustics dispersion dispersion_samples fade_color"},
    {"pigment", "color rgb rgbf rgbt rgbft srgb srgbf srgbt srgbft color_map pigment_map image_map quick_color checker "
                "brick hexagon gradient agate bozo granite marble wood leopard onion radial spotted crackle"},
    {"normal", "bumps dents ripples waves wrinkles bump_map normal_map slope_map bump_size"},
    {"texture", "texture_map material_map tiles"},
    {"interior { media", "absorption scattering density"},
    {"global_settings", "assumed_gamma max_trace_level ambient_light adc_bailout radiosity irid_wavelength "
                        "number_of_waves max_intersections paper_mode"},
    {"camera", "location look_at angle direction right up sky perspective orthographic fisheye ultra_wide_angle omnimax "
               "panoramic focal_point blur_samples variance confidence aperture"},
    {"light_source", "spotlight shadowless point_at tightness area_light adaptive jitter circular orient looks_like "
                     "projected_through fade_power fade_distance emitter radiance power"},
    {"npr", "seeds field interpolation ilic style mix"},
    {"npr { ilic", "length cell noise edge layer relief"},
    {"npr { seeds", "rbf"},
    {"global_settings { photons", "spacing gather media autostop jitter max_trace_level"},
};

// Words of an object's block: at the top of a scene they lack their object.
constexpr std::string_view object_words = "texture pigment finish interior material normal npr translate rotate scale "
                                          "matrix transform no_shadow no_image hollow inverse clipped_by bounded_by";
constexpr std::string_view directive_words = "declare local undef macro if ifdef ifndef else elseif switch case range "
                                             "break while for end include default version debug warning error fopen "
                                             "fclose read write";
constexpr std::string_view statement_words = "sphere box plane cylinder cone torus disc triangle mesh mesh2 union merge "
                                             "intersection difference object light_source camera";

constexpr std::pair<std::string_view, std::string_view> syntaxes[] = {
    {"sphere", "sphere { <centre>, radius ... }"},
    {"box", "box { <corner>, <opposite corner> ... }"},
    {"plane", "plane { <normal>, distance ... }"},
    {"cylinder", "cylinder { <one end>, <other end>, radius ... }"},
    {"cone", "cone { <one end>, radius there, <other end>, radius there ... }"},
    {"torus", "torus { major radius, minor radius ... }"},
    {"disc", "disc { <centre>, <normal>, radius [, radius of the hole] ... }"},
    {"triangle", "triangle { <corner>, <corner>, <corner> ... }"},
    {"light_source", "light_source { <position>, rgb <r, g, b> ... }"},
    {"seed", "seed { <point>, <direction> [weight number] }"},
    {"superellipsoid", "superellipsoid { <east, north> ... }"},
};

bool holds_word(std::string_view words, std::string_view word) {
    for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' ')) return true;
    }
    return false;
}

std::string_view home_of(std::string_view word) {
    for (const auto& [block, words] : homes)
        if (holds_word(words, word)) return block;
    return {};
}

// What stands behind the token that is next, as it stands in the text.
const StoredToken* token_behind(const Parser& p) {
    const TokenFrame& frame = p.in.frames.back();
    const std::uint32_t index = frame.position + (p.in.buffered ? 0u : 1u);
    return index < frame.end ? &frame.tokens[index] : nullptr;
}

bool followed_by(const Parser& p, const Token& name, char punctuation) {
    const TokenFrame& frame = p.in.frames.back();
    if (name.span.source != frame.source) return false;
    const std::uint32_t from = frame.position > 1 ? frame.position - 2 : 0;
    for (std::uint32_t i = from; i < std::min(frame.position + 2, frame.end); ++i)
        if (frame.tokens[i].begin == name.span.begin)
            return i + 1 < frame.end && is(frame.tokens[i + 1], punctuation);
    return false;
}

bool is_macro(const Value& value) { return std::holds_alternative<std::shared_ptr<const Macro>>(value.data); }
bool is_function(const Value& value) { return std::holds_alternative<std::shared_ptr<const Function>>(value.data); }

template <class Wanted>
std::vector<std::string_view> declared_names(const Parser& p, Wanted wanted) {
    std::vector<std::string_view> names;
    constexpr std::size_t enough = 20'000; // who declares more gets no better hints for it
    for (Symbol s = 0; s < p.in.symbols.size() && names.size() < enough; ++s)
        if (const Value* value = lookup(p.in, s); value && wanted(*value)) names.push_back(p.in.words.text(s));
    return names;
}

// A known word that stands in the wrong place.
std::string help_for_misplaced(std::string_view word, std::string_view inside) {
    const bool in_scene = inside == "a scene";
    if (in_scene && holds_word(directive_words, word)) return fmt::format("did you mean `#{}`?", word);
    if (in_scene && holds_word(object_words, word))
        return fmt::format("`{}` belongs into the object that it is about: sphere {{ ... {} ... }}", word, word);
    const std::string_view home = home_of(word);
    if (!home.empty() && home != inside) return fmt::format("`{0}` belongs into `{1}`: {1} {{ {0} ... }}", word, home);
    if (!in_scene && holds_word(statement_words, word) && !holds_word("union merge intersection difference", inside))
        return "is a `}` missing before it? Several objects in one make a union { ... }";
    return {};
}

std::string help_for_sign(Parser& p, const Token& token, std::string_view inside) {
    const StoredToken* behind = token_behind(p);
    if (is(token, '}')) return "there is no `{` that it closes";
    if (is(token, '*') && behind && is(*behind, '/')) return "a `*/` without its `/*`";
    if (is(token, ';') && inside != "a scene") return "items of a block stand without `;`";
    if (is(token, '^')) return "powers are written pow(a, b)";
    if (is(token, '[')) return "only an array has elements, and only a map has entries in brackets";
    if (is(token, ':')) return "items of a block stand without `:`";
    return {};
}

} // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& candidates) {
    const std::string_view nearest = nearest_word(word, candidates);
    return nearest.empty() ? std::string() : fmt::format("did you mean `{}`?", nearest);
}

std::string usage_of(const Value& value, std::string_view name) {
    if (is_macro(value)) return fmt::format("a macro is called: {}(...)", name);
    if (is_function(value)) return fmt::format("a function is called: {}(...)", name);
    const auto* vector = std::get_if<VectorValue>(&value.data);
    if (vector && vector->is_color) return fmt::format("a colour stands in a pigment: pigment {{ {} }}", name);
    const auto* held = std::get_if<std::shared_ptr<const DeclaredBlock>>(&value.data);
    if (!held) return {};
    static constexpr const char* words[] = {"object",       "texture", "pigment",   "finish", "interior",
                                            "light_source", "camera",  "transform", "npr",    "color_map",
                                            "material"};
    const std::size_t kind = (*held)->index();
    return kind < std::size(words) ? fmt::format("it is used so: {} {{ {} }}", words[kind], name) : std::string();
}

std::string help_for_unknown_name(Parser& p, const Token& name) {
    const std::string_view word = p.in.words.text(name.symbol);
    std::vector<std::string_view> candidates;
    if (followed_by(p, name, '(')) {
        candidates = declared_names(p, [](const Value& v) { return is_macro(v) || is_function(v); });
        for (Symbol s = 0; s < keyword_count; ++s)
            if (is_number_builtin(static_cast<Keyword>(s)) || is_string_builtin(static_cast<Keyword>(s)))
                candidates.push_back(p.in.words.text(s));
    } else {
        candidates = declared_names(p, [](const Value&) { return true; });
    }
    std::string help = did_you_mean(word, candidates);
    if (const std::string file = include_that_declares(p, word); !file.empty())
        return fmt::format("#include \"{}\" declares it", file);
    if (help.empty() && followed_by(p, name, '.')) help = "names of files stand in quotes: \"colors.inc\"";
    if (help.empty() && followed_by(p, name, ':')) help = "items of a block stand without `:`";
    return help;
}

std::string help_for_unexpected(Parser& p, const Token& token, std::string_view inside,
                                std::initializer_list<Keyword> allowed) {
    if (token.kind == TokenKind::punctuation)
        if (std::string help = help_for_sign(p, token, inside); !help.empty()) return help;
    if (token.kind == TokenKind::word) {
        const std::string_view word = p.in.words.text(token.symbol);
        const Value* value = lookup(p.in, token.symbol);
        if (value && !is_keyword(token.symbol))
            if (std::string help = usage_of(*value, word); !help.empty()) return help;
        std::vector<std::string_view> candidates;
        for (const Keyword keyword : allowed) candidates.push_back(keyword_text(keyword));
        if (!value && !is_keyword(token.symbol)) {
            for (const std::string_view name : declared_names(p, [](const Value& v) {
                     return !std::holds_alternative<double>(v.data);
                 }))
                candidates.push_back(name);
        }
        if (std::string help = did_you_mean(word, candidates); !help.empty()) return help;
        if (std::string help = help_for_misplaced(word, inside); !help.empty()) return help;
        if (!value && !is_keyword(token.symbol)) {
            if (followed_by(p, token, '=')) return fmt::format("a name gets its value by #declare {} = ...", word);
            if (followed_by(p, token, '(')) return "no macro of this name is declared";
            candidates.clear();
            for (Symbol s = 0; s < keyword_count; ++s) candidates.push_back(keyword_text(static_cast<Keyword>(s)));
            const std::string_view nearest = nearest_word(word, candidates);
            const bool is_name = word[0] >= 'A' && word[0] <= 'Z'; // the language's words are lower case
            if (is_name)
                if (std::string file = include_that_declares(p, word); !file.empty())
                    return fmt::format("#include \"{}\" declares it", file);
            if (!nearest.empty() && word.size() > 4 && !is_name) return fmt::format("did you mean `{}`?", nearest);
        }
    }
    const bool is_name = token.kind == TokenKind::word && !is_keyword(token.symbol);
    if (inside != "a scene" && !is_name && at_expression(p) && !p.in.blocks.empty())
        return "is a `,`, an operator or a word missing before it?";
    if (allowed.size() == 0 || allowed.size() > 8) return {};
    std::string help = "expected here:";
    for (const Keyword keyword : allowed) help += fmt::format(" `{}`", keyword_text(keyword));
    return help;
}

std::string syntax_of(std::string_view block) {
    for (const auto& [name, syntax] : syntaxes)
        if (name == block) return std::string(syntax);
    return fmt::format("{} {{ ... }}", block);
}

std::string help_for_missing_value(Parser& p, const Token& found) {
    if (is(found, '{')) return "a vector is written in < >: <0, 1, 0>";
    if (is(found, '=')) return "`=` alone compares, and declares";
    if (is(found, '&') || is(found, '|')) return "`&` is and, `|` is or, written once";
    if (p.in.blocks.empty()) return {};
    for (const auto& [block, syntax] : syntaxes)
        if (block == p.in.blocks.back().what) return fmt::format("it is written {}", syntax);
    return {};
}

} // namespace pnr
