// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/block_words.h"

#include "parser/manual.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <span>
#include <string>

namespace pnr {

namespace {

enum class PartKind { word, rule, sign }; // "sphere", sphere, and ( ) [ ] { } | of the notation
struct Part {
    PartKind kind;
    std::string_view text;
};
using Parts = std::span<const Part>;

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '#'; }

bool is_word(const Part& part) { return part.kind == PartKind::word && in_name(part.text[0]); }
bool is_brace(const Part& part, std::string_view brace) {
    return part.kind == PartKind::word && part.text == brace;
}

// The parts of the right side of a rule; comments, commas and ? in words ? left out.
std::vector<Part> split_rule(std::string_view text) {
    std::vector<Part> parts;
    const auto behind = [&](std::size_t from, std::string_view sign) {
        const std::size_t end = text.find(sign, from);
        return end == std::string_view::npos ? text.size() : end + sign.size();
    };
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        std::size_t end = at + 1;
        if (text.substr(at, 2) == "(*") {
            end = behind(at, "*)");
        } else if (c == '?') {
            end = behind(at + 1, "?");
        } else if (c == '"') {
            end = behind(at + 1, "\"");
            if (end > at + 2) parts.push_back({PartKind::word, text.substr(at + 1, end - at - 2)});
        } else if (in_name(c)) {
            while (end < text.size() && in_name(text[end])) ++end;
            parts.push_back({PartKind::rule, text.substr(at, end - at)});
        } else if (std::string_view("()[]{}|").find(c) != std::string_view::npos) {
            parts.push_back({PartKind::sign, text.substr(at, 1)});
        }
        at = end;
    }
    return parts;
}

struct Rules {
    std::vector<std::string> texts;
    std::vector<std::string_view> order;
    std::map<std::string_view, std::vector<Part>> parts;
};

Rules read_rules() {
    Rules rules;
    rules.texts = grammar_rules();
    for (const std::string& text : rules.texts) {
        const std::string_view whole = text;
        const std::size_t equals = whole.find('=');
        const std::string_view name = whole.substr(0, whole.find(' '));
        rules.order.push_back(name);
        rules.parts[name] = split_rule(whole.substr(equals + 1));
    }
    return rules;
}

const Rules& all_rules() {
    static const Rules rules = read_rules();
    return rules;
}

// Rules of values and names: their words are no items of a block.
bool is_value(std::string_view rule) {
    static constexpr std::string_view values[] = {"expression", "vector", "float",   "color",
                                                  "int",        "bool",   "string",  "optional_bool",
                                                  "function",   "uv",     "vector_4"};
    return std::find(std::begin(values), std::end(values), rule) != std::end(values);
}

// What of a rule's parts stands in the blocks that parts[at], a "{", opens: up to its "}".
std::size_t closing(Parts parts, std::size_t at) {
    int depth = 0;
    for (std::size_t i = at; i < parts.size(); ++i) {
        if (is_brace(parts[i], "{")) ++depth;
        if (is_brace(parts[i], "}") && --depth == 0) return i;
    }
    return parts.size();
}

struct Collection {
    std::vector<std::string_view> words, rules; // found; and visited

    void add(std::string_view word) {
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
    }
};

// Is this the rule of a whole block, braces and all, or one of its alternatives?
bool opens_block(Parts parts) {
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (is_brace(parts[i], "{") &&
            (i == 0 || (parts[i - 1].kind == PartKind::sign && parts[i - 1].text == "|")))
            return true;
    return false;
}

// The words at the top of these parts and of the rules that they name, none of the blocks inside.
void collect(Collection& found, Parts parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Part& part = parts[i];
        if (is_brace(part, "{")) {
            i = closing(parts, i);
        } else if (is_word(part) && part.text[0] != '#') {
            found.add(part.text);
        } else if (part.kind == PartKind::rule && !is_value(part.text)) {
            const auto rule = all_rules().parts.find(part.text);
            if (rule == all_rules().parts.end() || opens_block(rule->second) ||
                std::find(found.rules.begin(), found.rules.end(), part.text) != found.rules.end())
                continue;
            found.rules.push_back(part.text);
            collect(found, rule->second);
        }
    }
}

// All that stands in the braces of these parts, which are a block's rule.
void collect_inside(Collection& found, Parts parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!is_brace(parts[i], "{")) continue;
        const std::size_t end = closing(parts, i);
        collect(found, parts.subspan(i + 1, end - i - 1));
        i = end;
    }
}

// The part behind a word and the alternatives beside it: in ( "a" | "b" ), x that is x for "a" too.
std::size_t behind_word(Parts parts, std::size_t at) {
    const auto is_sign = [&](std::size_t i, std::string_view sign) {
        return i < parts.size() && parts[i].kind == PartKind::sign && parts[i].text == sign;
    };
    std::size_t next = at + 1;
    while (is_sign(next, "|") && next + 1 < parts.size() && is_word(parts[next + 1])) next += 2;
    if (next > at + 1 && !is_sign(next, ")")) return parts.size(); // alternatives, but not in parentheses
    while (next < parts.size() && parts[next].kind == PartKind::sign && parts[next].text != "|") ++next;
    return next;
}

} // namespace

std::vector<std::string_view> block_words(std::string_view block) {
    Collection found;
    const Rules& rules = all_rules();
    if (block.empty()) {
        const auto scene = rules.parts.find("scene_item");
        if (scene != rules.parts.end()) collect(found, scene->second);
        return found.words;
    }
    for (const std::string_view name : rules.order) {
        const Parts parts = rules.parts.at(name);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (!is_word(parts[i]) || parts[i].text != block) continue;
            const std::size_t next = behind_word(parts, i);
            if (next >= parts.size()) continue;
            if (is_brace(parts[next], "{")) {
                const std::size_t end = closing(parts, next);
                collect(found, parts.subspan(next + 1, end - next - 1));
            } else if (parts[next].kind == PartKind::rule) {
                const auto rule = rules.parts.find(parts[next].text);
                if (rule != rules.parts.end() && opens_block(rule->second))
                    collect_inside(found, rule->second);
            }
        }
    }
    return found.words;
}

std::vector<std::string_view> value_words() {
    Collection found;
    for (const std::string_view name :
         {"color_literal", "color_channel", "constant", "function", "string_function"}) {
        const auto rule = all_rules().parts.find(name);
        if (rule != all_rules().parts.end()) collect(found, rule->second);
    }
    return found.words;
}

std::vector<std::string_view> directive_words() {
    Collection found;
    for (const std::string_view name : all_rules().order)
        for (const Part& part : all_rules().parts.at(name))
            if (is_word(part) && part.text[0] == '#' && part.text.size() > 1) found.add(part.text.substr(1));
    return found.words;
}

} // namespace pnr
