// SPDX-License-Identifier: GPL-3.0-or-later
#include "ebnf.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>

namespace pnr::test {

namespace {

// ---- reading
// ------------------------------------------------------------------------------------------------------

struct Reader {
    std::string_view text;
    std::size_t at = 0;
};

[[noreturn]] void refuse(const Reader& r, const std::string& wanted) {
    throw std::runtime_error("EBNF: expected " + wanted + " at byte " + std::to_string(r.at) + ": " +
                             std::string(r.text.substr(r.at, 40)));
}

void skip(Reader& r) {
    for (;;) {
        while (r.at < r.text.size() && std::isspace(static_cast<unsigned char>(r.text[r.at])) != 0) ++r.at;
        if (r.text.substr(r.at, 2) != "(*") return;
        const std::size_t end = r.text.find("*)", r.at);
        r.at = end == std::string_view::npos ? r.text.size() : end + 2;
    }
}

bool accept(Reader& r, char sign) {
    skip(r);
    if (r.at >= r.text.size() || r.text[r.at] != sign) return false;
    ++r.at;
    return true;
}

void expect(Reader& r, char sign) {
    if (!accept(r, sign)) refuse(r, std::string(1, sign));
}

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string name(Reader& r) {
    skip(r);
    const std::size_t begin = r.at;
    while (r.at < r.text.size() && in_name(r.text[r.at])) ++r.at;
    if (begin == r.at) refuse(r, "a name");
    return std::string(r.text.substr(begin, r.at - begin));
}

Node choice(Reader& r);

std::string until(Reader& r, char sign) {
    const std::size_t end = r.text.find(sign, r.at);
    if (end == std::string_view::npos) refuse(r, std::string(1, sign));
    std::string inside(r.text.substr(r.at, end - r.at));
    r.at = end + 1;
    return inside;
}

Node factor(Reader& r) {
    skip(r);
    for (const char quote : {'"', '\''})
        if (accept(r, quote)) return {Node::Kind::terminal, until(r, quote), 0, {}};
    if (accept(r, '?')) return {Node::Kind::special, until(r, '?'), 0, {}};
    if (accept(r, '(')) {
        Node inside = choice(r);
        expect(r, ')');
        return inside;
    }
    if (accept(r, '[')) {
        Node node{Node::Kind::optional, {}, 0, {choice(r)}};
        expect(r, ']');
        return node;
    }
    if (accept(r, '{')) {
        Node node{Node::Kind::repeated, {}, 0, {choice(r)}};
        expect(r, '}');
        if (accept(r, '-')) node.kind = Node::Kind::at_least_once;
        return node;
    }
    const std::string word = name(r);
    if (std::isdigit(static_cast<unsigned char>(word[0])) == 0) return {Node::Kind::rule, word, 0, {}};
    expect(r, '*');
    return {Node::Kind::times, {}, std::stoi(word), {factor(r)}};
}

Node sequence(Reader& r) {
    Node node{Node::Kind::sequence, {}, 0, {factor(r)}};
    while (accept(r, ',')) node.children.push_back(factor(r));
    return node;
}

Node choice(Reader& r) {
    Node node{Node::Kind::choice, {}, 0, {sequence(r)}};
    while (accept(r, '|')) node.children.push_back(sequence(r));
    return node;
}

// ---- writing
// ------------------------------------------------------------------------------------------------------

constexpr int never = 1'000'000;

struct Making {
    const Grammar& grammar;
    const Writer& writer;
    std::mt19937& random;
    std::map<std::string, int> heights{}; // of the lowest tree of each rule
    std::string text{};
};

int pick(Making& m, int count) { return std::uniform_int_distribution<int>(0, count - 1)(m.random); }

int height(const Making& m, const Node& node, const std::string& inside) {
    switch (node.kind) {
    case Node::Kind::terminal:
    case Node::Kind::special:
    case Node::Kind::optional:
    case Node::Kind::repeated:
        return 0;
    case Node::Kind::rule: {
        if (node.text == "IDENTIFIER") return m.writer.names.contains(inside) ? 0 : never;
        if (m.writer.literals.contains(node.text)) return 0;
        const auto known = m.heights.find(node.text);
        return known == m.heights.end() ? never : std::min(never, known->second + 1);
    }
    case Node::Kind::choice: {
        int lowest = never;
        for (const Node& child : node.children) lowest = std::min(lowest, height(m, child, inside));
        return lowest;
    }
    default: {
        int highest = 0;
        for (const Node& child : node.children) highest = std::max(highest, height(m, child, inside));
        return highest;
    }
    }
}

void find_heights(Making& m) {
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [rule, node] : m.grammar.rules) {
            const int found = height(m, node, rule);
            const auto known = m.heights.find(rule);
            if (found >= never || (known != m.heights.end() && known->second <= found)) continue;
            m.heights[rule] = found;
            changed = true;
        }
    }
}

void write(Making& m, const std::string& token) {
    constexpr int rarely = 60; // directives may stand between any two tokens
    const auto& directives = m.writer.directives;
    if (pick(m, rarely) == 0) m.text += directives[static_cast<std::size_t>(pick(m, static_cast<int>(directives.size())))] + " ";
    m.text += token + " ";
}

void make(Making& m, const Node& node, const std::string& inside, int room);

void make_rule(Making& m, const std::string& rule, const std::string& inside, int room) {
    if (rule == "IDENTIFIER") return write(m, m.writer.names.at(inside));
    const auto own = m.writer.literals.find(inside + "." + rule);
    const auto literal = own != m.writer.literals.end() ? own : m.writer.literals.find(rule);
    if (literal != m.writer.literals.end()) {
        const auto& choices = literal->second;
        const std::string& chosen = choices[static_cast<std::size_t>(pick(m, static_cast<int>(choices.size())))];
        if (!chosen.empty()) write(m, chosen);
        return;
    }
    const auto found = m.grammar.rules.find(rule);
    if (found == m.grammar.rules.end()) throw std::runtime_error("no rule `" + rule + "`");
    make(m, found->second, rule, room - 1);
}

void make_choice(Making& m, const Node& node, const std::string& inside, int room) {
    std::vector<const Node*> fitting;
    int lowest = never;
    for (const Node& child : node.children) lowest = std::min(lowest, height(m, child, inside));
    for (const Node& child : node.children) {
        const int h = height(m, child, inside);
        if (h < never && (h <= room || h == lowest)) fitting.push_back(&child);
    }
    if (fitting.empty()) throw std::runtime_error("rule `" + inside + "` has no sentence");
    make(m, *fitting[static_cast<std::size_t>(pick(m, static_cast<int>(fitting.size())))], inside, room);
}

void make(Making& m, const Node& node, const std::string& inside, int room) {
    constexpr int most = 3; // of what may be repeated
    switch (node.kind) {
    case Node::Kind::terminal:
        return write(m, node.text);
    case Node::Kind::special:
        return;
    case Node::Kind::rule:
        return make_rule(m, node.text, inside, room);
    case Node::Kind::choice:
        return make_choice(m, node, inside, room);
    case Node::Kind::sequence:
        for (const Node& child : node.children) make(m, child, inside, room);
        return;
    default:
        break;
    }
    int count = node.count;
    const Node& child = node.children.front();
    const bool fits = height(m, child, inside) <= room;
    if (node.kind == Node::Kind::optional) count = fits ? pick(m, 2) : 0;
    if (node.kind == Node::Kind::repeated) count = fits ? pick(m, most + 1) : 0;
    if (node.kind == Node::Kind::at_least_once) count = fits ? 1 + pick(m, most) : 1;
    for (int i = 0; i < count; ++i) make(m, child, inside, room);
}

} // namespace

Grammar read_grammar(std::string_view text) {
    Grammar grammar;
    Reader r{text};
    for (skip(r); r.at < text.size(); skip(r)) {
        const std::string rule = name(r);
        expect(r, '=');
        Node node = choice(r);
        expect(r, ';');
        // The same name in another section: both ways are the rule's.
        if (const auto known = grammar.rules.find(rule); known != grammar.rules.end())
            known->second = {Node::Kind::choice, {}, 0, {known->second, node}};
        else
            grammar.rules.emplace(rule, std::move(node));
        grammar.order.push_back(rule);
    }
    return grammar;
}

std::string sentence(const Grammar& grammar, const Writer& writer, const std::string& rule, std::mt19937& random) {
    Making m{grammar, writer, random};
    find_heights(m);
    constexpr int room = 9; // levels of rules
    make_rule(m, rule, "", room);
    return m.text;
}

} // namespace pnr::test
