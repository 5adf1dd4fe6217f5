// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/manual.h"

#include "parser/course.h"
#include "parser/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace pnr {

namespace {

std::string_view embedded_text(std::string_view name) {
    for (const EmbeddedFile& file : embedded_manual())
        if (file.name == name) return file.text;
    return {};
}

// Cuts the first line off, without its end.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

std::vector<std::string_view> split_words(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; (at = line.find_first_not_of(' ', at)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.find(' ', at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

std::vector<ManualEntry> read_entries(std::string_view text) {
    constexpr std::string_view heading = "# ---- ";
    std::vector<ManualEntry> entries;
    std::string_view part;
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        if (line.starts_with(heading))
            part = line.substr(heading.size());
        else if (line.starts_with("@ "))
            entries.push_back({split_words(line.substr(2)), {}, {}, part});
        else if (line.empty() || line[0] == '#' || entries.empty())
            continue;
        else if (line.starts_with("> "))
            entries.back().example += fmt::format("{}\n", line.substr(2));
        else
            entries.back().text += fmt::format("{}\n", line);
    }
    return entries;
}

struct GrammarRule {
    std::string_view name, text;
};

// A rule begins in the first column with `name =` and goes to the next empty line, rule or comment in that column.
std::vector<GrammarRule> read_rules(std::string_view text) {
    std::vector<GrammarRule> rules;
    bool inside = false;
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        const std::size_t equals = line.find(" = ");
        const std::vector<std::string_view> words = split_words(line.substr(0, std::min(equals, line.size())));
        if (line.empty() || line[0] == '(')
            inside = false;
        else if (line[0] != ' ' && words.size() == 1 && equals != std::string_view::npos) {
            rules.push_back({words[0], line});
            inside = true;
        } else if (inside) {
            const std::string_view so_far = rules.back().text;
            rules.back().text = {so_far.data(), line.data() + line.size()};
        }
    }
    return rules;
}

std::string_view without_hash(std::string_view word) {
    return word.starts_with('#') ? word.substr(1) : word;
}

std::string joined(const std::vector<std::string_view>& words, std::string_view separator) {
    std::string text;
    for (const std::string_view word : words) text += fmt::format("{}{}", text.empty() ? "" : separator, word);
    return text;
}

std::string indented(std::string_view text) {
    std::string result;
    while (!text.empty()) result += fmt::format("    {}\n", take_line(text));
    return result;
}

// The lessons that use a word: the first three by name, since all of them say `rgb`.
std::string course_text(std::string_view word) {
    constexpr std::size_t most = 3;
    const std::vector<Lesson> lessons = lessons_with(without_hash(word));
    std::string text = lessons.empty() ? "" : "\nin the course:\n";
    for (std::size_t i = 0; i < std::min(most, lessons.size()); ++i)
        text += fmt::format("    scenes/course/{}    {}\n", lessons[i].file, lessons[i].title);
    if (lessons.size() > most) text += fmt::format("    and {} more\n", lessons.size() - most);
    return text;
}

// The same of all words of an entry, as numbers of lessons.
std::string course_line(const ManualEntry& entry) {
    std::vector<std::string_view> numbers;
    for (const std::string_view name : entry.names)
        for (const Lesson& lesson : lessons_with(name)) {
            std::string_view number = lesson.file.substr(0, lesson.file.find('_'));
            number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
            numbers.push_back(number);
        }
    const auto before = [](std::string_view a, std::string_view b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    };
    std::sort(numbers.begin(), numbers.end(), before);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    if (numbers.empty()) return {};
    return fmt::format("\nIn the course: {} {}.\n", numbers.size() == 1 ? "lesson" : "lessons", joined(numbers, ", "));
}

} // namespace

const std::vector<ManualEntry>& manual_entries() {
    static const std::vector<ManualEntry> entries = read_entries(embedded_text("manual.txt"));
    return entries;
}

const ManualEntry* find_manual_entry(std::string_view word) {
    word = without_hash(word);
    for (const ManualEntry& entry : manual_entries())
        if (std::find(entry.names.begin(), entry.names.end(), word) != entry.names.end()) return &entry;
    return nullptr;
}

std::vector<std::string> grammar_rules(std::string_view word) {
    word = without_hash(word);
    const std::string plain = fmt::format("\"{}\"", word), directive = fmt::format("\"#{}\"", word);
    std::vector<std::string> found;
    for (const GrammarRule& rule : read_rules(embedded_text("pnr.ebnf")))
        if (rule.name == word || rule.text.find(plain) != std::string_view::npos ||
            rule.text.find(directive) != std::string_view::npos)
            found.emplace_back(rule.text);
    return found;
}

std::vector<std::string> grammar_rules() {
    std::vector<std::string> all;
    for (const GrammarRule& rule : read_rules(embedded_text("pnr.ebnf"))) all.emplace_back(rule.text);
    return all;
}

std::string manual_text(std::string_view word) {
    const ManualEntry* entry = find_manual_entry(word);
    if (entry == nullptr) return {};
    std::string text = fmt::format("{}    ({})\n", joined(entry->names, ", "), entry->part);
    text += indented(entry->text) + "\nexample:\n" + indented(entry->example);
    // A rule that lists hundreds of words helps nobody: of those the lines with the word.
    constexpr std::size_t long_rule = 6;
    std::string rules;
    const std::string quoted = fmt::format("\"{}\"", without_hash(word)), directive = fmt::format("\"#{}\"", without_hash(word));
    for (const std::string& rule : grammar_rules(word)) {
        const bool whole = static_cast<std::size_t>(std::count(rule.begin(), rule.end(), '\n')) < long_rule;
        std::string_view rest = rule;
        for (bool first = true; !rest.empty(); first = false) {
            const std::string_view line = take_line(rest);
            const bool has = line.find(quoted) != std::string_view::npos || line.find(directive) != std::string_view::npos;
            if (whole || has)
                rules += fmt::format("    {}\n", line);
            else if (first)
                rules += fmt::format("    {} = ...\n", split_words(line)[0]);
        }
    }
    if (!rules.empty()) text += "\ngrammar:\n" + rules;
    return text + course_text(word);
}

std::string near_manual_word(std::string_view word) {
    std::vector<std::string_view> names;
    for (const ManualEntry& entry : manual_entries()) names.insert(names.end(), entry.names.begin(), entry.names.end());
    const std::string hint = did_you_mean(without_hash(word), names);
    return hint.empty() ? hint : "; " + hint;
}

std::string manual_markdown() {
    std::string text = "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n# The words of the language\n\n"
                       "`pnr help WORD` says the same and the rule of `grammar/pnr.ebnf`. Made from `grammar/manual.txt` by\n"
                       "`pnr help --manual`. Behind a word in parentheses stands its default.\n";
    std::string_view part;
    for (const ManualEntry& entry : manual_entries()) {
        if (entry.part != part) text += fmt::format("\n## {}{}\n", static_cast<char>(std::toupper(static_cast<unsigned char>(entry.part[0]))), entry.part.substr(1));
        part = entry.part;
        text += fmt::format("\n### `{}`\n{}```pov\n{}```\n", joined(entry.names, "` `"), entry.text, entry.example) + course_line(entry);
    }
    return text;
}

} // namespace pnr
